//! The way back to where the exploration began.

use super::super::record::{End, EndReason};
use super::super::state::State;
use super::Explorer;
use crate::geometry::Pose;
use crate::robot::{NavigationState, Observation};

/// So many goals at the start may fail before the way back is given up.
const ATTEMPTS: u32 = 3;

impl Explorer {
    /// Where the robot drives when it goes home: where it was first seen, unless it was told.
    #[must_use]
    pub const fn start_pose(&self) -> Option<Pose> {
        self.start_pose
    }

    /// Calls another place home, such as where an earlier run began.
    pub const fn set_start_pose(&mut self, home: Pose) {
        self.start_pose = Some(home);
    }

    /// Whether the exploration is over and the robot on its way home.
    #[must_use]
    pub const fn is_returning(&self) -> bool {
        matches!(self.state, State::Returning { .. })
    }

    /// Ends the exploration and drives home; a run that has ended keeps its end. Returns where
    /// to, or nothing where that is not known yet.
    pub fn return_home(&mut self, now_s: f64, why: &str) -> Option<Pose> {
        let goal = self.start_pose?;
        let end = match &self.state {
            State::Ended(end) => end.clone(),
            State::Returning { .. } => return Some(goal),
            _ => End {
                reason: EndReason::Interrupted,
                time_s: now_s,
                left_behind: self.left_behind,
                message: why.to_owned(),
            },
        };
        self.drive_home(goal, end, now_s, 0);
        Some(goal)
    }

    pub(super) fn drive_home(&mut self, goal: Pose, end: End, now_s: f64, failures: u32) {
        self.state = State::Returning { id: self.next_id(), goal, end, since_s: now_s, failures };
    }

    /// A tick on the way home. The end says whether the robot got there.
    pub(super) fn way_home(&mut self, observation: &Observation) {
        let now_s = observation.stamp_s;
        let State::Returning { id, goal, end, since_s, failures } = &self.state else { return };
        let (goal, mut end, failures) = (*goal, end.clone(), *failures);
        let limit_s = self.settings.patience.goal_timeout_s;
        let ours = observation.navigation.command == *id;
        let outcome = match &observation.navigation.state {
            NavigationState::Succeeded if ours => "back at the start".to_owned(),
            NavigationState::Preempted if ours => return self.drive_home(goal, end, now_s, failures),
            NavigationState::Aborted(_) if ours && failures + 1 < ATTEMPTS => {
                return self.drive_home(goal, end, now_s, failures + 1);
            }
            NavigationState::Aborted(why) if ours => format!("the way back to the start failed: {why}"),
            _ if now_s - since_s > limit_s => format!("the start was not reached within {limit_s:.0} s"),
            _ => return,
        };
        end.message = format!("{}; {outcome}", end.message);
        self.state = State::Ended(End { time_s: now_s, ..end });
    }
}
