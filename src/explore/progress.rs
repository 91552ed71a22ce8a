//! Whether the robot gets anywhere.

use crate::geometry::{Point, Pose};

/// Watches for a robot that stays at the same position for too long.
#[derive(Clone, Copy, Debug)]
pub struct ProgressMonitor {
    anchor: Point,
    since_s: f64,
}

impl ProgressMonitor {
    /// Starts watching at a pose and a time in seconds.
    #[must_use]
    pub fn new(pose: &Pose, now_s: f64) -> Self {
        Self { anchor: pose.position(), since_s: now_s }
    }

    /// Seconds since the robot was last `distance_m` away from where it is now.
    pub fn stuck_for_s(&mut self, pose: &Pose, now_s: f64, distance_m: f64) -> f64 {
        if pose.distance_to(self.anchor) >= distance_m {
            *self = Self::new(pose, now_s);
        }
        now_s - self.since_s
    }

    /// Forgives the time in which the robot was not meant to move.
    pub const fn pause(&mut self, now_s: f64) {
        self.since_s = now_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_resets_and_trembling_does_not() {
        let mut monitor = ProgressMonitor::new(&Pose::default(), 0.0);
        assert_eq!(monitor.stuck_for_s(&Pose::new(0.1, 0.0, 0.0), 5.0, 0.25), 5.0);
        assert_eq!(monitor.stuck_for_s(&Pose::new(0.3, 0.0, 0.0), 6.0, 0.25), 0.0);
        assert_eq!(monitor.stuck_for_s(&Pose::new(0.2, 0.0, 0.0), 9.0, 0.25), 3.0);
        monitor.pause(20.0);
        assert_eq!(monitor.stuck_for_s(&Pose::new(0.2, 0.0, 0.0), 21.0, 0.25), 1.0);
    }
}
