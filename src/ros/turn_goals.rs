//! Turning round with move_base: goals at the robot's own place, a third of a turn
//! apart, as for robots that nothing but move_base may drive.

use super::move_base::MoveBase;
use crate::geometry::{Pose, normalize_angle};
use crate::robot::NavigationState;
use std::collections::VecDeque;
use std::f64::consts::TAU;

/// The part of a turn from one goal to the next: less than half, so that there is a
/// shorter way round.
const PART_RAD: f64 = TAU / 3.0;

/// A turn under way.
#[derive(Clone, Debug)]
pub struct TurnGoals {
    ahead: VecDeque<Pose>,
    is_lost: bool,
}

impl TurnGoals {
    /// A turn from a pose by an angle.
    #[must_use]
    pub fn new(pose: &Pose, angle_rad: f64) -> Self {
        let parts = (angle_rad.abs() / PART_RAD).round().max(1.0);
        let goal = |part: u32| {
            let yaw = normalize_angle(pose.yaw + angle_rad * f64::from(part) / parts);
            Pose::new(pose.x, pose.y, yaw)
        };
        Self { ahead: (1..=parts as u32).map(goal).collect(), is_lost: false }
    }

    /// Sends the first goal.
    ///
    /// # Errors
    /// What is missing, when the server is not ready.
    pub fn begin(&mut self, move_base: &mut MoveBase, map_frame: &str) -> Result<(), String> {
        match self.ahead.front() {
            Some(goal) => move_base.send(goal, map_frame),
            None => Ok(()),
        }
    }

    /// Sends the next goal when one is reached; how the whole turn is doing.
    pub fn advance(&mut self, move_base: &mut MoveBase, map_frame: &str) -> NavigationState {
        let state = move_base.state();
        if state == NavigationState::Succeeded && self.ahead.len() > 1 {
            self.ahead.pop_front();
            return match self.begin(move_base, map_frame) {
                Ok(()) => NavigationState::Active,
                Err(why) => self.lose(why),
            };
        }
        match state {
            NavigationState::Unavailable(why) if move_base.is_lost() => self.lose(why),
            other => other,
        }
    }

    /// Whether move_base went away meanwhile.
    #[must_use]
    pub const fn is_lost(&self) -> bool {
        self.is_lost
    }

    fn lose(&mut self, why: String) -> NavigationState {
        self.is_lost = true;
        NavigationState::Unavailable(why)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_full_turn_ends_where_it_began_with_two_stops() {
        let turn = TurnGoals::new(&Pose::new(1.0, 2.0, 0.5), TAU);
        let yaws: Vec<f64> = turn.ahead.iter().map(|goal| goal.yaw).collect();
        assert_eq!(yaws.len(), 3);
        assert!((yaws[0] - (0.5 + PART_RAD)).abs() < 1e-9 && (yaws[2] - 0.5).abs() < 1e-9);
        assert!(turn.ahead.iter().all(|goal| (goal.x, goal.y) == (1.0, 2.0)));
        assert_eq!(TurnGoals::new(&Pose::default(), -1.0).ahead.len(), 1);
    }
}
