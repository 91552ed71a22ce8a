//! From a decision to what is done about it: a goal, a look round, a recovery, the end.

use super::super::decide::Decided;
use super::super::progress::ProgressMonitor;
use super::super::record::{DecisionRecord, End, EndReason};
use super::super::state::{Drive, State};
use super::Explorer;
use crate::geometry::{Point, Pose};
use crate::robot::{MapSnapshot, Observation};

impl Explorer {
    /// Goes on as if the robot had been sent to this goal by the explorer itself: a
    /// recording went there, and what is decided next shall be decided from there. A run
    /// that has ended keeps its end.
    pub fn adopt(&mut self, goal: Pose, observation: &Observation) {
        let (Some(map), Ok(pose)) = (&observation.map, &observation.pose_in_map) else { return };
        if matches!(self.state, State::Ended(_) | State::Returning { .. }) {
            return;
        }
        let distance_m = |point: &Point| goal.distance_to(*point);
        let cells = self.lookout.frontiers().iter().flat_map(|frontier| &frontier.cells);
        // The frontier that it was sent for is the nearest one.
        let target = cells.copied().min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
        self.state = State::Driving(Drive {
            id: self.next_id(),
            goal,
            target: target.unwrap_or_else(|| goal.position()),
            is_stage: false,
            since_s: observation.stamp_s,
            progress: ProgressMonitor::new(pose, observation.stamp_s),
            considered_s: map.stamp_s,
        });
    }

    /// Weighs the frontiers of a map and goes on accordingly.
    pub(super) fn decide(
        &mut self,
        observation: &Observation,
        map: &MapSnapshot,
        pose: Pose,
    ) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        self.counts.detections += 1;
        let decided = match self.lookout.decide(&self.settings, &self.blacklist, observation, map, pose) {
            Ok(decided) => decided,
            Err(error) => {
                self.wait_for_map(now_s, &error.to_string());
                return None;
            }
        };
        self.map_lost_since_s = None;
        self.left_behind = decided.left_behind;
        let mut record = decided.record.clone();
        self.follow(&decided, map, now_s, &mut record, pose);
        Some(record)
    }

    /// Turns what was decided into the next state.
    fn follow(&mut self, decided: &Decided, map: &MapSnapshot, now_s: f64, record: &mut DecisionRecord, pose: Pose) {
        if let Some(choice) = &decided.choice {
            self.empty_in_a_row = 0;
            if let State::Driving(drive) = &mut self.state
                && self.lookout.can_stand(map, drive.goal.position())
            {
                let goal = &self.settings.goal;
                let is_same = drive.goal.distance_to(choice.goal.position()) < goal.already_there_m;
                if is_same || decided.is_open_near(drive.target, goal.commit_radius_m) {
                    drive.considered_s = map.stamp_s;
                    record.goal = Some(drive.goal);
                    "the goal under way is kept".clone_into(&mut record.why);
                    return;
                }
            }
            self.counts.goals_sent += 1;
            let (id, progress) = (self.next_id(), ProgressMonitor::new(&pose, now_s));
            self.state = State::Driving(Drive {
                id,
                goal: choice.goal,
                target: choice.target,
                is_stage: choice.is_stage,
                since_s: now_s,
                progress,
                considered_s: map.stamp_s,
            });
            return;
        }
        if let Some(target) = decided.here {
            // Nothing else is left: look round once more from where the robot stands.
            self.blacklist.record_visit(target);
            record.why = "the robot already stands where the last frontier is seen from: look round".to_owned();
            self.look_round(now_s);
            return;
        }
        if decided.left_behind.frontiers == 0 {
            self.empty_in_a_row += 1;
            if self.empty_in_a_row >= 2 {
                self.finish(EndReason::Complete, now_s, "no frontier is left");
            } else {
                record.why = "no frontier is left: one more map shall confirm it".to_owned();
                self.settle(now_s, map.stamp_s + 1e-9);
            }
            return;
        }
        self.empty_in_a_row = 0;
        let blocked = decided.left_behind.unreachable + decided.left_behind.failed > 0;
        if blocked && self.recoveries_in_a_row < self.settings.turns.recoveries {
            self.recoveries_in_a_row += 1;
            self.counts.recoveries += 1;
            self.blacklist.forgive_failures();
            record.why = "frontiers remain and no way leads to them: recovery turn".to_owned();
            self.turn(now_s);
            return;
        }
        let (reason, message) = decided.why_nothing_is_left();
        self.finish(reason, now_s, &message);
    }

    /// The run is over but for the way back, if that is wanted.
    fn finish(&mut self, reason: EndReason, now_s: f64, message: &str) {
        let end = End { reason, time_s: now_s, left_behind: self.left_behind, message: message.to_owned() };
        self.state = match self.start_pose {
            Some(goal) if self.settings.return_to_start => {
                State::Returning { id: self.next_id(), goal, end, since_s: now_s }
            }
            _ => State::Ended(end),
        };
    }
}
