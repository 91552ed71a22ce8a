//! The state machine: look round, decide, drive, look round.
//!
//! Topiwala 2018, section III: first a full turn; then frontiers are detected, the
//! nearest one to which there is a way becomes the goal, a full turn follows on
//! arrival, and so on until no frontier is left. The settings switch the turns off,
//! reorder the goals, or reconsider them on the way, as the other papers ask.

mod follow;
mod pause;

use super::blacklist::Blacklist;
use super::decide::Lookout;
use super::record::{Counts, DecisionRecord, End, EndReason, LeftBehind, SeenFrontier};
use super::settings::{ExplorerSettings, SettingsError};
use super::state::{Decision, State, has_ended};
use crate::geometry::{Body, Path, Point, Polygon, Pose};
use crate::grid::Inflation;
use crate::planning::GlobalPlanner;
use crate::robot::{CommandId, MapSnapshot, NavigationState, Observation};

/// The longest that a turn may take, seconds; then the run goes on without it.
const TURN_TIMEOUT_S: f64 = 60.0;

/// Explores: hand it every observation, obey its decisions.
pub struct Explorer {
    settings: ExplorerSettings,
    lookout: Lookout,
    blacklist: Blacklist,
    state: State,
    commands: CommandId,
    counts: Counts,
    started_s: Option<f64>,
    start_pose: Option<Pose>,
    pose_lost_since_s: Option<f64>,
    navigation_lost_since_s: Option<f64>,
    map_lost_since_s: Option<f64>,
    recoveries_in_a_row: u32,
    empty_in_a_row: u32,
    left_behind: LeftBehind,
}

impl Explorer {
    /// An explorer that has seen nothing yet. `inflation` describes the robot for the
    /// costmaps that it makes where the robot's navigation provides none, `body` for
    /// planners that look at its outline and speeds.
    ///
    /// # Errors
    /// [`SettingsError`] when a setting cannot be.
    pub fn new(settings: ExplorerSettings, inflation: Inflation, body: &Body) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self {
            lookout: Lookout::new(&settings, inflation, body),
            blacklist: Blacklist::new(settings.taboo),
            settings,
            state: State::Begin,
            commands: 0,
            counts: Counts::default(),
            started_s: None,
            start_pose: None,
            pose_lost_since_s: None,
            navigation_lost_since_s: None,
            map_lost_since_s: None,
            recoveries_in_a_row: 0,
            empty_in_a_row: 0,
            left_behind: LeftBehind::default(),
        })
    }

    /// What was done so far.
    #[must_use]
    pub const fn counts(&self) -> &Counts {
        &self.counts
    }

    /// The frontiers of the last detection.
    #[must_use]
    pub fn frontiers(&self) -> &[SeenFrontier] {
        self.lookout.frontiers()
    }

    /// Where the robot is sent, if it drives.
    #[must_use]
    pub const fn goal(&self) -> Option<Pose> {
        match &self.state {
            State::Driving(drive) => Some(drive.goal),
            State::Returning { goal, .. } => Some(*goal),
            _ => None,
        }
    }

    /// The way to the goal that was chosen last, as planned then.
    #[must_use]
    pub const fn path(&self) -> Option<&Path> {
        self.lookout.path()
    }

    /// Explores only inside a region from now on, or everywhere again.
    pub fn set_region(&mut self, region: Option<Polygon>) {
        self.settings.region = region;
    }

    /// Only frontiers inside are explored, if there is one.
    #[must_use]
    pub const fn region(&self) -> Option<&Polygon> {
        self.settings.region.as_ref()
    }

    /// Asks another planner for the way to a candidate, such as move_base's own.
    pub fn set_planner(&mut self, planner: Box<dyn GlobalPlanner>) {
        self.lookout.set_planner(planner);
    }

    /// One tick: from what is known to what shall be done. After the end it goes on
    /// returning the end.
    pub fn step(&mut self, observation: &Observation) -> Decision {
        let now_s = observation.stamp_s;
        let started_s = *self.started_s.get_or_insert(now_s);
        let limit = self.settings.patience.time_limit_s;
        if limit.is_some_and(|limit_s| now_s - started_s >= limit_s) {
            self.end_now(EndReason::TimeLimit, now_s, "the time allowed is over");
        }
        let record = match &observation.pose_in_map {
            Ok(pose) => {
                self.pose_lost_since_s = None;
                self.start_pose.get_or_insert(*pose);
                if let Some(why) = self.unavailable(observation) {
                    return self.pause_without_navigation(now_s, &why);
                }
                self.navigation_lost_since_s = None;
                self.advance(observation, *pose)
            }
            Err(error) => return self.pause_without_pose(now_s, &error.to_string()),
        };
        self.state.decision(record)
    }

    /// Ends the run now, for a reason that the explorer itself cannot see. A run that
    /// has ended already keeps its end.
    pub fn end_now(&mut self, reason: EndReason, now_s: f64, message: &str) -> End {
        let end = match &self.state {
            State::Ended(end) => end.clone(),
            State::Returning { end, .. } => end.clone(),
            _ => End { reason, time_s: now_s, left_behind: self.left_behind, message: message.to_owned() },
        };
        self.state = State::Ended(end.clone());
        end
    }

    /// Moves the state on, at most a few times in one tick.
    fn advance(&mut self, observation: &Observation, pose: Pose) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        for _ in 0..3 {
            match &self.state {
                State::Begin if self.settings.turns.at_start => self.look_round(now_s),
                State::Begin => self.settle(now_s, f64::NEG_INFINITY),
                State::Turning { id, since_s } => {
                    let ended = has_ended(observation, *id) || now_s - since_s > TURN_TIMEOUT_S;
                    if !ended {
                        return None;
                    }
                    self.settle(now_s, now_s);
                }
                State::Settling { map_after_s, since_s } => {
                    let waited_s = now_s - since_s;
                    let Some(map) = &observation.map else {
                        self.wait_for_map(now_s, "no map has come");
                        return None;
                    };
                    if map.stamp_s < *map_after_s && waited_s < self.settings.patience.settle_s {
                        return None;
                    }
                    return self.decide(observation, map, pose);
                }
                State::Driving(_) => return self.drive(observation, pose),
                State::Returning { id, end, since_s, .. } => {
                    let late = now_s - since_s > self.settings.patience.goal_timeout_s;
                    if !(late || has_ended(observation, *id)) {
                        return None;
                    }
                    self.state = State::Ended(End { time_s: now_s, ..end.clone() });
                }
                State::Ended(_) => return None,
            }
        }
        None
    }

    /// A tick on the way to a goal.
    fn drive(&mut self, observation: &Observation, pose: Pose) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        let patience = self.settings.patience;
        let State::Driving(drive) = &mut self.state else { return None };
        let (target, is_stage) = (drive.target, drive.is_stage);
        let ours = observation.navigation.command == drive.id;
        match &observation.navigation.state {
            NavigationState::Succeeded if ours => {
                self.counts.goals_reached += 1;
                self.recoveries_in_a_row = 0;
                if is_stage {
                    self.settle(now_s, now_s);
                    return None;
                }
                self.blacklist.record_visit(target);
                if self.settings.turns.at_goal {
                    self.look_round(now_s);
                } else {
                    self.settle(now_s, now_s);
                }
            }
            NavigationState::Aborted(_) if ours => self.fail(target, now_s),
            NavigationState::Preempted if ours => self.settle(now_s, now_s),
            _ => {
                let stuck_s = drive.progress.stuck_for_s(&pose, now_s, patience.progress_distance_m);
                if stuck_s >= patience.progress_timeout_s || now_s - drive.since_s >= patience.goal_timeout_s {
                    self.fail(target, now_s);
                } else if let Some(map) = &observation.map {
                    return self.reconsider(observation, map, pose);
                }
            }
        }
        None
    }

    /// On the way: decide anew when the goal turned out to be blocked, or when the
    /// settings ask for it.
    fn reconsider(&mut self, observation: &Observation, map: &MapSnapshot, pose: Pose) -> Option<DecisionRecord> {
        let State::Driving(drive) = &mut self.state else { return None };
        if map.stamp_s <= drive.considered_s {
            return None;
        }
        let due = self
            .settings
            .goal
            .reconsider_period_s
            .is_some_and(|period_s| observation.stamp_s - drive.considered_s >= period_s);
        let blocked = !self.lookout.can_stand(map, drive.goal.position());
        if due || blocked {
            return self.decide(observation, map, pose);
        }
        None
    }

    fn fail(&mut self, target: Point, now_s: f64) {
        self.counts.goals_failed += 1;
        self.blacklist.record_failure(target, now_s);
        self.settle(now_s, now_s);
    }

    fn look_round(&mut self, now_s: f64) {
        self.counts.turns += 1;
        self.turn(now_s);
    }

    fn turn(&mut self, now_s: f64) {
        self.state = State::Turning { id: self.next_id(), since_s: now_s };
    }

    fn settle(&mut self, now_s: f64, map_after_s: f64) {
        self.state = State::Settling { map_after_s, since_s: now_s };
    }

    const fn next_id(&mut self) -> CommandId {
        self.commands += 1;
        self.commands
    }
}

#[cfg(test)]
#[path = "explorer_tests.rs"]
mod tests;
