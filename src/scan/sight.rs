//! How far and how wide a robot's lidar sees.

use crate::geometry::{Point, Pose, shortest_angle};

/// What a lidar can see of what lies around its robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Its range, metres.
    pub range_m: f64,
    /// Its opening angle around the heading, radians.
    pub field_of_view_rad: f64,
    /// Heading of its middle in the base frame, radians.
    pub heading_rad: f64,
}

/// A lidar with this opening angle or more leaves nothing out worth a turn, radians.
const ALL_ROUND_RAD: f64 = 6.0;

impl Sight {
    /// That of a lidar that sees all round, however far.
    pub const EVERYWHERE: Self =
        Self { range_m: f64::INFINITY, field_of_view_rad: std::f64::consts::TAU, heading_rad: 0.0 };

    /// Whether it sees all round.
    #[must_use]
    pub fn is_all_round(&self) -> bool {
        self.field_of_view_rad >= ALL_ROUND_RAD
    }

    /// Whether a point lies within its opening angle, for a robot at a pose, however far.
    #[must_use]
    pub fn covers(&self, from: &Pose, target: Point) -> bool {
        let aside_rad = shortest_angle(from.yaw + self.heading_rad, Pose::facing(from.position(), target).yaw);
        self.is_all_round() || aside_rad.abs() <= 0.5 * self.field_of_view_rad
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_view_covers_what_lies_before_it() {
        // It looks to the left of the robot, which faces west.
        let narrow = Sight { range_m: 5.0, field_of_view_rad: 1.0, heading_rad: std::f64::consts::FRAC_PI_2 };
        let from = Pose::new(1.0, 1.0, std::f64::consts::PI);
        let covers = |x: f64, y: f64| narrow.covers(&from, Point::new(x, y));
        assert_eq!(
            [covers(1.0, 0.0), covers(1.4, 0.0), covers(2.0, 0.0), covers(1.0, 2.0)],
            [true, true, false, false]
        );
        assert!(Sight::EVERYWHERE.covers(&from, Point::new(1.0, 2.0)) && !narrow.is_all_round());
    }
}
