//! One sweep of a planar lidar, with the fields of `sensor_msgs/LaserScan`, and what such a lidar
//! can see (floor 0).

mod sight;

pub use sight::Sight;

use crate::geometry::{Point, Pose};

/// Distances by angle, as REP 117 reads them: `+inf` saw nothing within reach,
/// `-inf` is too near to measure, NaN is no measurement.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LaserScan {
    /// When the sweep was taken, seconds.
    pub stamp_s: f64,
    /// Heading of the first ray in the lidar's frame, radians.
    pub angle_min_rad: f64,
    /// Angle between neighbouring rays, radians, counter-clockwise positive.
    pub angle_increment_rad: f64,
    /// Readings below this many metres are no obstacle.
    pub range_min_m: f64,
    /// Readings above this many metres are no obstacle; infinite where the sensor tells none.
    pub range_max_m: f64,
    /// One reading a ray, metres.
    pub ranges_m: Vec<f32>,
}

/// No planar lidar reaches this far, metres: a `range_max` from here on tells no limit.
pub const BEYOND_ALL_LIDARS_M: f64 = 1000.0;
/// Nothing is measured nearer than this, metres, where `range_min` tells nothing.
const NEAREST_M: f64 = 0.001;

/// `range_min` and `range_max` in metres, as far as they can be. Of a sensor that tells no
/// limit (infinite, NaN, 0, the largest number there is) the latter is infinite; where the
/// two contradict each other, neither is believed.
#[must_use]
pub fn believable_limits(range_min: f32, range_max: f32) -> (f64, f64) {
    let (min_m, max_m) = (f64::from(range_min), f64::from(range_max));
    let min_m = if (0.0..BEYOND_ALL_LIDARS_M).contains(&min_m) { min_m } else { NEAREST_M };
    if !(max_m > 0.0 && max_m < BEYOND_ALL_LIDARS_M) {
        (min_m, f64::INFINITY)
    } else if min_m >= max_m {
        (NEAREST_M, f64::INFINITY)
    } else {
        (min_m, max_m)
    }
}

/// What one ray of a scan says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Something stands at this distance in metres.
    Hit(f64),
    /// Nothing stands up to this distance in metres.
    Clear(f64),
    /// Nothing can be said: too near, not a number, or out of the sensor's range.
    None,
}

/// Why a scan shows nothing at all, not even free space.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoSight {
    /// There are no rays.
    #[error("it has no ranges")]
    Empty,
    /// Nobody can tell where the rays point.
    #[error(
        "angle_min is {angle_min_rad} and angle_increment {angle_increment_rad}: must be finite, the increment not 0"
    )]
    Angles {
        /// As given, radians.
        angle_min_rad: f64,
        /// As given, radians.
        angle_increment_rad: f64,
    },
    /// No ray measured anything.
    #[error("none of its {rays} ranges is a measurement within {range_min_m} to {range_max_m} m")]
    NoMeasurement {
        /// How many rays there are.
        rays: usize,
        /// As given, metres.
        range_min_m: f64,
        /// As given, metres.
        range_max_m: f64,
    },
}

impl LaserScan {
    /// The sweep of a lidar that hangs upside down, as one in its place that stands upright
    /// would have taken it: the other way round.
    #[must_use]
    pub fn turned_upright(self) -> Self {
        let (angle_min_rad, angle_increment_rad) = (-self.angle_min_rad, -self.angle_increment_rad);
        Self { angle_min_rad, angle_increment_rad, ..self }
    }

    /// Whether the scan shows something, be it free space: a lidar that is covered, dusty
    /// or broken sends scans too.
    ///
    /// # Errors
    /// [`NoSight`] with what is wrong.
    pub fn sight(&self) -> Result<(), NoSight> {
        let &Self { angle_min_rad, angle_increment_rad, range_min_m, range_max_m, .. } = self;
        let rays = self.ranges_m.len();
        if rays == 0 {
            return Err(NoSight::Empty);
        }
        let are_angles = angle_min_rad.is_finite() && angle_increment_rad.is_finite();
        if !are_angles || (rays > 1 && angle_increment_rad == 0.0) {
            return Err(NoSight::Angles { angle_min_rad, angle_increment_rad });
        }
        // A range of 0 is what many drivers send for "nothing measured".
        let measured = |&range: &f32| match self.reading(range) {
            Reading::Hit(range_m) => range_m > 0.0,
            Reading::Clear(range_m) => range_m > 0.0,
            Reading::None => false,
        };
        if self.ranges_m.iter().any(measured) {
            Ok(())
        } else {
            Err(NoSight::NoMeasurement { rays, range_min_m, range_max_m })
        }
    }

    /// Heading of ray `index` in the lidar's frame, radians.
    #[must_use]
    pub fn angle_rad(&self, index: usize) -> f64 {
        self.angle_min_rad + self.angle_increment_rad * index as f64
    }

    /// What a range means under REP 117 and this scan's limits.
    #[must_use]
    pub fn reading(&self, range_m: f32) -> Reading {
        let range = f64::from(range_m);
        if range == f64::INFINITY {
            Reading::Clear(self.range_max_m)
        } else if range >= self.range_min_m && range <= self.range_max_m {
            Reading::Hit(range)
        } else {
            Reading::None
        }
    }

    /// All rays as angle in the lidar's frame (radians) and reading.
    pub fn readings(&self) -> impl Iterator<Item = (f64, Reading)> + '_ {
        self.ranges_m.iter().enumerate().map(|(i, &range)| (self.angle_rad(i), self.reading(range)))
    }

    /// The hit points in the frame in which the lidar stands at `lidar_pose`.
    pub fn hits<'a>(&'a self, lidar_pose: &'a Pose) -> impl Iterator<Item = Point> + 'a {
        self.readings().filter_map(|(angle, reading)| match reading {
            Reading::Hit(range) => {
                let heading = lidar_pose.yaw + angle;
                Some(Point::new(lidar_pose.x + range * heading.cos(), lidar_pose.y + range * heading.sin()))
            }
            Reading::Clear(_) | Reading::None => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_that_cannot_be_are_not_believed() {
        let unlimited = (0.125, f64::INFINITY);
        for range_max in [f32::INFINITY, f32::NAN, 0.0, -1.0, f32::MAX, f32::NEG_INFINITY] {
            assert_eq!(believable_limits(0.125, range_max), unlimited, "{range_max}");
        }
        assert_eq!(believable_limits(0.125, 8.0), (0.125, 8.0));
        for (range_min, range_max) in [(8.0, 0.125), (8.0, 8.0), (f32::NAN, f32::INFINITY), (f32::INFINITY, 0.0)] {
            assert_eq!(believable_limits(range_min, range_max), (NEAREST_M, f64::INFINITY), "{range_min} {range_max}");
        }
        assert_eq!(believable_limits(-1.0, 8.0), (NEAREST_M, 8.0));
    }

    #[test]
    fn rep_117_tells_hits_from_clear_and_nothing() {
        let scan = LaserScan { range_min_m: 0.1, range_max_m: 5.0, ..LaserScan::default() };
        let cases = [
            (1.0, Reading::Hit(1.0)),
            (f32::INFINITY, Reading::Clear(5.0)),
            (f32::NEG_INFINITY, Reading::None),
            (f32::NAN, Reading::None),
            (0.05, Reading::None),
            (6.0, Reading::None),
        ];
        for (range, expected) in cases {
            assert_eq!(scan.reading(range), expected, "{range}");
        }
    }

    #[test]
    fn scans_that_show_nothing_are_no_sight() {
        let whole = LaserScan {
            angle_increment_rad: 0.1,
            range_min_m: 0.1,
            range_max_m: 5.0,
            ranges_m: vec![f32::NAN, 0.0, 1.0],
            ..LaserScan::default()
        };
        assert_eq!(whole.sight(), Ok(()));
        let with = |ranges_m: &[f32]| LaserScan { ranges_m: ranges_m.to_vec(), ..whole.clone() };
        assert_eq!(with(&[f32::INFINITY; 3]).sight(), Ok(()), "a free field is a sight");
        assert_eq!(with(&[]).sight(), Err(NoSight::Empty));
        for nothing in [f32::NAN, 0.0, f32::NEG_INFINITY, 9.0] {
            let said = with(&[nothing; 3]).sight().unwrap_err().to_string();
            assert_eq!(said, "none of its 3 ranges is a measurement within 0.1 to 5 m", "{nothing}");
        }
        assert!(LaserScan { range_min_m: 0.0, ..with(&[0.0; 3]) }.sight().is_err());
        for (angle_min_rad, angle_increment_rad) in [(f64::NAN, 0.1), (0.0, f64::NAN), (0.0, 0.0), (0.0, f64::INFINITY)]
        {
            let scan = LaserScan { angle_min_rad, angle_increment_rad, ..whole.clone() };
            assert!(matches!(scan.sight(), Err(NoSight::Angles { .. })), "{angle_min_rad} {angle_increment_rad}");
        }
    }
}
