//! Tells whether the robot comes nearer to its goal, or has made no progress for too long.

use crate::geometry::{Pose, shortest_angle};
use std::f64::consts::PI;

/// Watches for a robot that stays at the same position for too long.
#[derive(Clone, Copy, Debug)]
pub struct ProgressMonitor {
    anchor: Pose,
    since_s: f64,
    /// Where it was when it last moved at all, and when.
    still: (Pose, f64),
    has_moved: bool,
    /// Where it has been turning, with its last heading, how far it turned there, radians, and since
    /// when.
    turning: (Pose, f64, f64),
}

/// Motion below this is standing still, metres and radians.
const STILL_M: f64 = 0.05;
const STILL_RAD: f64 = 0.15;
/// A robot that came farther than this has not turned on the spot, metres.
const SPOT_M: f64 = 0.1;
/// Half a turn faces every goal: one that turned farther on the spot, to and fro or round and round,
/// gets nowhere, radians.
const IN_VAIN_RAD: f64 = PI + 0.6;
/// A follower that turns at each corner of a winding way goes on within less, seconds.
const IN_VAIN_S: f64 = 10.0;

impl ProgressMonitor {
    /// Starts watching at a pose and a time in seconds.
    #[must_use]
    pub const fn new(pose: &Pose, now_s: f64) -> Self {
        Self { anchor: *pose, since_s: now_s, still: (*pose, now_s), has_moved: false, turning: (*pose, 0.0, now_s) }
    }

    /// Seconds since the robot was last `distance_m` away from where it is now.
    pub fn stuck_for_s(&mut self, pose: &Pose, now_s: f64, distance_m: f64) -> f64 {
        if pose.distance_to(self.anchor.position()) >= distance_m {
            (self.anchor, self.since_s) = (*pose, now_s);
        }
        now_s - self.since_s
    }

    /// Seconds since the robot last moved or turned at all.
    pub fn still_for_s(&mut self, pose: &Pose, now_s: f64) -> f64 {
        let (last, since_s) = self.still;
        let has_moved =
            pose.distance_to(last.position()) >= STILL_M || shortest_angle(last.yaw, pose.yaw).abs() >= STILL_RAD;
        if has_moved {
            (self.still, self.has_moved) = ((*pose, now_s), true);
            return 0.0;
        }
        now_s - since_s
    }

    /// Whether the robot has turned on the spot farther and for longer than any goal asks for.
    pub fn turns_in_vain(&mut self, pose: &Pose, now_s: f64) -> bool {
        let (spot, turned_rad, since_s) = self.turning;
        if pose.distance_to(spot.position()) > SPOT_M {
            self.turning = (*pose, 0.0, now_s);
            return false;
        }
        // What is less is noise of the localisation.
        let more_rad = shortest_angle(spot.yaw, pose.yaw).abs();
        if more_rad >= STILL_RAD {
            self.turning = (Pose { yaw: pose.yaw, ..spot }, turned_rad + more_rad, since_s);
        }
        self.turning.1 >= IN_VAIN_RAD && now_s - since_s >= IN_VAIN_S
    }

    /// Whether it has moved or turned since the watching began.
    #[must_use]
    pub const fn has_moved(&self) -> bool {
        self.has_moved
    }

    /// Forgives the time in which the robot was not meant to move.
    pub const fn pause(&mut self, now_s: f64) {
        self.since_s = now_s;
        self.still.1 = now_s;
        (self.turning.1, self.turning.2) = (0.0, now_s);
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

    #[test]
    fn half_a_turn_faces_every_goal_and_more_is_in_vain() {
        let at = |x: f64, yaw: f64| Pose::new(x, 0.0, yaw);
        let mut monitor = ProgressMonitor::new(&at(0.0, 0.0), 0.0);
        let turned = |monitor: &mut ProgressMonitor, x: f64, yaws: &[f64]| {
            // Four seconds from one look to the next.
            let looks = yaws.iter().zip(1..);
            looks.filter(|&(&yaw, i)| monitor.turns_in_vain(&at(x, yaw), 200.0 * x + 4.0 * f64::from(i))).count()
        };
        assert_eq!(turned(&mut monitor, 0.0, &[0.5, 1.0, 1.5, 2.0, 2.5, 3.1, 3.05, 3.1, 3.05]), 0);
        assert_eq!(turned(&mut monitor, 0.2, &[3.1, 2.0, 1.0, 0.0]), 0, "it came away");
        assert_eq!(turned(&mut monitor, 0.25, &[0.3, 0.7]), 1, "to and fro");
        let mut monitor = ProgressMonitor::new(&at(0.0, 0.0), 0.0);
        let quick = |monitor: &mut ProgressMonitor, now_s: f64, yaw: f64| monitor.turns_in_vain(&at(0.0, yaw), now_s);
        let turns = [(1.0, 2.0), (2.0, 0.0), (3.0, 2.0), (9.9, 2.0)];
        assert!(!turns.into_iter().any(|(now_s, yaw)| quick(&mut monitor, now_s, yaw)), "it may go on yet");
        assert!(quick(&mut monitor, 10.0, 2.0));
    }

    #[test]
    fn turning_is_no_standing_still() {
        let mut monitor = ProgressMonitor::new(&Pose::default(), 0.0);
        assert_eq!(monitor.still_for_s(&Pose::new(0.02, 0.0, 0.1), 4.0), 4.0);
        assert!(!monitor.has_moved());
        assert_eq!(monitor.still_for_s(&Pose::new(0.0, 0.0, 0.2), 5.0), 0.0);
        assert!(monitor.has_moved());
        assert_eq!(monitor.still_for_s(&Pose::new(0.04, 0.0, 0.2), 9.0), 4.0);
        assert_eq!(monitor.still_for_s(&Pose::new(0.06, 0.0, 0.2), 10.0), 0.0);
    }
}
