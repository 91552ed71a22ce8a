//! Where the time of a run goes: driving, turning, and what is waited for.

use super::state::Phase;
use crate::geometry::{Pose, shortest_angle};
use serde::{Deserialize, Serialize};

/// Seconds of a run, by what the robot was about. They add up to the run's time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct TimeSpent {
    /// Moving along.
    pub driving_s: f64,
    /// Turning on the spot.
    pub turning_s: f64,
    /// Standing until a map came.
    pub waiting_for_map_s: f64,
    /// Standing though a goal is under way: the navigation plans, clears, recovers.
    pub waiting_for_motion_s: f64,
    /// Standing for want of a navigation.
    pub waiting_for_navigation_s: f64,
    /// Standing for want of a pose.
    pub waiting_for_pose_s: f64,
    /// Standing between two attempts while all goals fail.
    pub pausing_s: f64,
}

impl TimeSpent {
    /// Everything but driving and turning, seconds.
    #[must_use]
    pub fn idle_s(&self) -> f64 {
        self.waiting_for_map_s
            + self.waiting_for_motion_s
            + self.waiting_for_navigation_s
            + self.waiting_for_pose_s
            + self.pausing_s
    }

    /// All of it, seconds.
    #[must_use]
    pub fn total_s(&self) -> f64 {
        self.driving_s + self.turning_s + self.idle_s()
    }
}

/// Slower than this is standing, metres and radians per second.
const STILL_MPS: f64 = 0.02;
const STILL_RPS: f64 = 0.05;
/// A longer step than this is a gap in the observations, seconds: its time counts for the
/// phase, not for motion.
const LONGEST_STEP_S: f64 = 5.0;

/// Keeps the account.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    spent: TimeSpent,
    last: Option<(f64, Option<Pose>)>,
}

impl Ledger {
    /// What was spent so far.
    #[must_use]
    pub const fn spent(&self) -> &TimeSpent {
        &self.spent
    }

    /// Goes on from what an earlier session spent.
    pub const fn go_on_from(&mut self, spent: TimeSpent) {
        self.spent = spent;
    }

    /// Books the time since the last tick.
    pub fn book(&mut self, now_s: f64, pose: Option<&Pose>, phase: Phase) {
        let Some((last_s, last_pose)) = self.last.replace((now_s, pose.copied())) else { return };
        let dt_s = now_s - last_s;
        if dt_s <= 0.0 {
            return;
        }
        let moved = match (last_pose, pose) {
            (Some(a), Some(b)) if dt_s <= LONGEST_STEP_S => {
                Some((a.distance_to(b.position()) / dt_s, shortest_angle(a.yaw, b.yaw).abs() / dt_s))
            }
            _ => None,
        };
        let spent = &mut self.spent;
        let account = match (moved, phase) {
            (Some((mps, _)), _) if mps > STILL_MPS => &mut spent.driving_s,
            (Some((_, rps)), _) if rps > STILL_RPS => &mut spent.turning_s,
            (_, Phase::WaitingForMap | Phase::Ended) => &mut spent.waiting_for_map_s,
            (_, Phase::WaitingForPose) => &mut spent.waiting_for_pose_s,
            (_, Phase::WaitingForNavigation) => &mut spent.waiting_for_navigation_s,
            (_, Phase::Pausing) => &mut spent.pausing_s,
            (_, Phase::Turning | Phase::Driving | Phase::BackingOff | Phase::Returning) => {
                &mut spent.waiting_for_motion_s
            }
        };
        *account += dt_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_second_is_booked_once() {
        let mut ledger = Ledger::default();
        let at = |x: f64, yaw: f64| Pose::new(x, 0.0, yaw);
        ledger.book(0.0, Some(&at(0.0, 0.0)), Phase::WaitingForMap);
        ledger.book(1.0, Some(&at(0.0, 0.0)), Phase::WaitingForMap);
        ledger.book(2.0, Some(&at(0.4, 0.0)), Phase::Driving);
        ledger.book(3.0, Some(&at(0.4, 0.9)), Phase::Turning);
        ledger.book(5.0, Some(&at(0.4, 0.9)), Phase::Driving);
        ledger.book(6.0, None, Phase::WaitingForPose);
        ledger.book(7.0, Some(&at(0.4, 0.9)), Phase::Pausing);
        let expected = TimeSpent {
            driving_s: 1.0,
            turning_s: 1.0,
            waiting_for_map_s: 1.0,
            waiting_for_motion_s: 2.0,
            waiting_for_pose_s: 1.0,
            pausing_s: 1.0,
            waiting_for_navigation_s: 0.0,
        };
        assert_eq!(*ledger.spent(), expected);
        assert_eq!((ledger.spent().total_s(), ledger.spent().idle_s()), (7.0, 5.0));
    }
}
