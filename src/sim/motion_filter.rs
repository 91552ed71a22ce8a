//! Which scans the mapper takes: those from a new place.
//!
//! SLAM systems skip scans taken where the last one was (Cartographer's motion filter,
//! gmapping's `linearUpdate` and `angularUpdate`).

use super::MapperConfig;
use crate::geometry::{Pose, shortest_angle};

/// Slack for poses that are sums of many steps, metres and radians.
const ROUNDING: f64 = 1e-6;

/// Remembers where the last scan was taken in.
#[derive(Clone, Copy, Debug, Default)]
pub struct MotionFilter {
    last: Option<(Pose, f64)>,
}

impl MotionFilter {
    /// Whether a scan from a pose at a time in seconds is to be taken in; if so it is
    /// the last one from now on.
    pub fn accepts(&mut self, pose: &Pose, stamp_s: f64, config: &MapperConfig) -> bool {
        let is_new = self.last.is_none_or(|(last, last_s)| {
            pose.distance_to(last.position()) >= config.filter_distance_m - ROUNDING
                || shortest_angle(last.yaw, pose.yaw).abs() >= config.filter_angle_rad - ROUNDING
                || stamp_s - last_s >= config.filter_time_s - ROUNDING
        });
        if is_new {
            self.last = Some((*pose, stamp_s));
        }
        is_new
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_place_a_new_heading_and_a_new_time_count() {
        let config = MapperConfig {
            filter_distance_m: 0.1,
            filter_angle_rad: 0.2,
            filter_time_s: 1.0,
            ..MapperConfig::default()
        };
        let mut filter = MotionFilter::default();
        let cases = [
            (Pose::new(0.0, 0.0, 0.0), 0.0, true),
            (Pose::new(0.05, 0.0, 0.0), 0.1, false),
            (Pose::new(0.1, 0.0, 0.0), 0.2, true),
            (Pose::new(0.1, 0.0, 0.1), 0.3, false),
            (Pose::new(0.1, 0.0, -0.2), 0.4, true),
            (Pose::new(0.1, 0.0, -0.2), 1.3, false),
            (Pose::new(0.1, 0.0, -0.2), 1.4, true),
        ];
        for (pose, stamp_s, expected) in cases {
            assert_eq!(filter.accepts(&pose, stamp_s, &config), expected, "{stamp_s}");
        }
    }
}
