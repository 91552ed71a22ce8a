//! What is waited for, and for how long: the robot's place, somebody to drive it, a map.

use super::super::record::EndReason;
use super::super::state::{Decision, Phase, State};
use super::Explorer;
use crate::robot::{Command, NavigationState, Observation};

impl Explorer {
    /// Holds while the robot does not know where it is: no pose is made up. A transform
    /// that is late for an instant leaves the goal under way.
    pub(super) fn pause_without_pose(&mut self, now_s: f64, error: &str) -> Decision {
        let since_s = *self.pose_lost_since_s.get_or_insert(now_s);
        let lost_s = now_s - since_s;
        if lost_s >= self.settings.patience.pose_timeout_s {
            self.end_now(EndReason::NoPose, now_s, error);
        }
        if let State::Driving(drive) = &mut self.state {
            drive.progress.pause(now_s);
        }
        let mut decision = self.state.decision(None);
        let has_begun = self.start_pose.is_some();
        if decision.end.is_none() && !(has_begun && lost_s < self.settings.patience.pose_grace_s) {
            decision.phase = Phase::WaitingForPose;
            decision.command = Command::Hold;
        }
        decision
    }

    /// Why nobody carries out the command under way, if that is so.
    pub(super) fn unavailable(&self, observation: &Observation) -> Option<String> {
        let ours = self.state.command_id() == Some(observation.navigation.command);
        match &observation.navigation.state {
            NavigationState::Unavailable(why) if ours => Some(why.clone()),
            _ => None,
        }
    }

    /// Goes on asking while nobody is there to carry the command out: the goal is not
    /// to blame, and its time stands still.
    pub(super) fn pause_without_navigation(&mut self, now_s: f64, why: &str) -> Decision {
        let since_s = *self.navigation_lost_since_s.get_or_insert(now_s);
        if now_s - since_s >= self.settings.patience.navigation_timeout_s {
            self.end_now(EndReason::NoNavigation, now_s, why);
        }
        self.state.restart_timers(now_s);
        self.watch.pause(now_s);
        let mut decision = self.state.decision(None);
        if decision.end.is_none() {
            decision.phase = Phase::WaitingForNavigation;
        }
        decision
    }

    /// No map, or none that can be used: ends the run when that lasts.
    pub(super) fn wait_for_map(&mut self, now_s: f64, why: &str) {
        let since_s = *self.map_lost_since_s.get_or_insert(now_s);
        if now_s - since_s >= self.settings.patience.map_timeout_s {
            self.end_now(EndReason::NoMap, now_s, why);
        } else {
            if now_s - since_s >= self.settings.patience.map_timeout_s / 12.0 {
                self.notice_useless_map(why, now_s);
            }
            self.state = State::Settling { since_s: now_s };
        }
    }

    /// A mapper that owes a map: a word with its age after a while, and in the end the end.
    pub(super) fn watch_for_maps(&mut self, now_s: f64) {
        let limit_s = self.settings.patience.map_timeout_s;
        let overdue_s = self.watch.overdue_s(now_s);
        if overdue_s >= limit_s {
            let message =
                format!("no newer map has come for {overdue_s:.0} s though the robot moved: is the mapper alive?");
            self.end_now(EndReason::NoMap, now_s, &message);
        } else if overdue_s >= limit_s / 4.0 {
            self.notice_stale_map(overdue_s, now_s);
        }
    }
}
