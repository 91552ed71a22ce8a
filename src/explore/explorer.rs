//! The state machine: look round, decide, drive, look round.
//!
//! Topiwala 2018, section III: first a full turn; then frontiers are detected, the
//! nearest one to which there is a way becomes the goal, a full turn follows on
//! arrival, and so on until no frontier is left. The settings switch the turns off,
//! reorder the goals, or reconsider them on the way, as the other papers ask. What no paper
//! says is what to do when something fails, and when a run may call itself complete:
//! `follow.rs`, `recover.rs` and `audit.rs`.

mod adjust;
mod drive;
mod follow;
mod home;
mod notices;
mod pause;
mod recall;
mod recover;

use super::blacklist::Blacklist;
use super::ledger::{Ledger, TimeSpent};
use super::lookout::Lookout;
use super::map_watch::MapWatch;
use super::record::{Counts, DecisionRecord, End, EndReason, LeftBehind, SeenFrontiers};
use super::settings::{ExplorerSettings, SettingsError};
use super::sight::Sights;
use super::state::{AfterTurn, Decision, State, has_ended};
use super::traits::RobotTraits;
use super::trouble::Trouble;
use crate::geometry::Pose;
use crate::planning::Driven;
use crate::robot::{CommandId, MapSnapshot, Observation};
use follow::Arrival;
pub use recall::Memory;
use std::f64::consts::TAU;
use std::sync::Arc;

/// The longest that a turn may take, seconds; then the run goes on without it.
const TURN_TIMEOUT_S: f64 = 60.0;
/// The longest that backing off may take, seconds.
const BACK_OFF_TIMEOUT_S: f64 = 15.0;

/// Explores: hand it every observation, obey its decisions.
pub struct Explorer {
    settings: ExplorerSettings,
    lookout: Lookout,
    blacklist: Blacklist,
    watch: MapWatch,
    sights: Sights,
    driven: Driven,
    trouble: Trouble,
    ledger: Ledger,
    state: State,
    commands: CommandId,
    counts: Counts,
    started_s: Option<f64>,
    start_pose: Option<Pose>,
    pose_lost_since_s: Option<f64>,
    navigation_lost_since_s: Option<f64>,
    map_lost_since_s: Option<f64>,
    /// Goals that were reached, until a newer map shows what became of their frontiers.
    arrivals: Vec<Arrival>,
    recoveries_in_a_row: u32,
    /// The version of the map that was there when the robot was last sent nowhere any more.
    at_rest_since: Option<u64>,
    left_behind: LeftBehind,
    notice: Option<String>,
    /// Whether it was told that the robot stands outside of its areas.
    outside_told: bool,
    /// When the age of a stale map was last told, seconds.
    stale_told_s: f64,
    last_pose: Option<(f64, Pose)>,
    top_speed_mps: f64,
}

impl Explorer {
    /// An explorer that has seen nothing yet, for a robot.
    ///
    /// # Errors
    /// [`SettingsError`] when a setting cannot be.
    pub fn new(settings: ExplorerSettings, robot: &RobotTraits) -> Result<Self, SettingsError> {
        settings.validate()?;
        Ok(Self {
            lookout: Lookout::new(&settings, robot),
            blacklist: Blacklist::new(settings.taboo, settings.thresholds),
            settings,
            watch: MapWatch::new(&robot.sight),
            sights: Sights::new(robot.sight),
            driven: Driven::default(),
            trouble: Trouble::default(),
            ledger: Ledger::default(),
            state: State::Begin,
            commands: 0,
            counts: Counts::default(),
            started_s: None,
            start_pose: None,
            pose_lost_since_s: None,
            navigation_lost_since_s: None,
            map_lost_since_s: None,
            arrivals: Vec::new(),
            recoveries_in_a_row: 0,
            at_rest_since: None,
            left_behind: LeftBehind::default(),
            notice: None,
            outside_told: false,
            stale_told_s: f64::NEG_INFINITY,
            last_pose: None,
            top_speed_mps: robot.body.limits.max_linear_mps,
        })
    }

    /// What was done so far.
    #[must_use]
    pub const fn counts(&self) -> &Counts {
        &self.counts
    }

    /// Where the time went so far.
    #[must_use]
    pub const fn time_spent(&self) -> &TimeSpent {
        self.ledger.spent()
    }

    /// The frontiers of the last detection.
    #[must_use]
    pub fn frontiers(&self) -> &SeenFrontiers {
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

    /// One tick: from what is known to what shall be done. After the end it goes on
    /// returning the end.
    pub fn step(&mut self, observation: &Observation) -> Decision {
        let now_s = observation.stamp_s;
        let mut decision = self.tick(observation);
        decision.notice = decision.notice.take().or_else(|| self.notice.take());
        if decision.record.is_some() {
            decision.frontiers = Arc::clone(self.lookout.frontiers());
            decision.path = self.lookout.path().cloned();
        }
        self.ledger.book(now_s, observation.pose_in_map.as_ref().ok(), decision.phase);
        decision
    }

    /// Ends the run now, for a reason that the explorer itself cannot see. A run that
    /// has ended already keeps its end.
    pub fn end_now(&mut self, reason: EndReason, now_s: f64, message: &str) -> End {
        let end = match &self.state {
            State::Ended(end) => end.clone(),
            State::Returning { end, .. } => {
                End { message: format!("{}; the way back was left: {message}", end.message), ..end.clone() }
            }
            _ => End { reason, time_s: now_s, left_behind: self.left_behind, message: message.to_owned() },
        };
        self.state = State::Ended(end.clone());
        end
    }

    fn tick(&mut self, observation: &Observation) -> Decision {
        let now_s = observation.stamp_s;
        let started_s = *self.started_s.get_or_insert(now_s);
        let limit = self.settings.patience.time_limit_s;
        let is_over = matches!(self.state, State::Ended(_) | State::Returning { .. });
        if !is_over && limit.is_some_and(|limit_s| now_s - started_s >= limit_s) {
            self.finish(EndReason::TimeLimit, now_s, "the time allowed is over");
        }
        if let Some(notice) = self.watch.update(observation.map.as_ref(), observation.pose_in_map.as_ref().ok(), now_s)
        {
            self.notice = Some(notice);
        }
        let pose = match &observation.pose_in_map {
            Ok(pose) => *pose,
            Err(error) => return self.pause_without_pose(now_s, &error.to_string()),
        };
        self.pose_lost_since_s = None;
        self.start_pose.get_or_insert(pose);
        self.notice_jump(&pose, now_s);
        self.sights.stand(&pose, now_s);
        self.driven.note(&pose);
        self.trouble.follow(&pose);
        if let Some(why) = self.unavailable(observation) {
            return self.pause_without_navigation(now_s, &why);
        }
        self.navigation_lost_since_s = None;
        self.watch_for_maps(now_s);
        self.end_without_news(now_s);
        let record = self.advance(observation, pose);
        let is_sent = matches!(self.state, State::Driving(_) | State::BackingOff { .. } | State::Returning { .. });
        self.at_rest_since = (!is_sent).then(|| self.at_rest_since.unwrap_or(self.watch.version()));
        self.state.decision(record)
    }

    /// Moves the state on, at most a few times in one tick.
    fn advance(&mut self, observation: &Observation, pose: Pose) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        for _ in 0..3 {
            match &self.state {
                State::Begin if self.settings.turns.at_start => self.look_round(now_s, AfterTurn::Settle),
                State::Begin => self.state = State::Ready,
                State::Turning { id, since_s, then, .. } => {
                    let (id, then) = (*id, *then);
                    if !(has_ended(observation, id) || now_s - since_s > TURN_TIMEOUT_S) {
                        return None;
                    }
                    if let AfterTurn::LookedAt(target) = then {
                        self.look_is_over(target, pose, observation, id);
                    }
                    self.state = match then {
                        AfterTurn::Settle | AfterTurn::LookedAt(_) => State::Settling { since_s: now_s },
                        // Maps that came on the way have been decided on below.
                        AfterTurn::Confirm(turns) => State::Confirming { since_s: now_s, turns, version: 0 },
                    };
                }
                State::Ready => {
                    let map = self.usable_map(now_s)?;
                    return self.decide(observation, &map, pose);
                }
                State::Settling { since_s } => {
                    let waited_s = now_s - since_s;
                    let map = self.usable_map(now_s)?;
                    if !self.shows_all() && waited_s < self.settings.patience.settle_s {
                        return None;
                    }
                    return self.decide(observation, &map, pose);
                }
                State::Confirming { .. } => return self.confirm(observation, pose),
                State::Driving(_) => {
                    let record = self.drive(observation, pose);
                    if record.is_some() || !matches!(self.state, State::Ready) {
                        return record;
                    }
                }
                State::BackingOff { id, from, since_s } => {
                    if !(has_ended(observation, *id) || now_s - since_s > BACK_OFF_TIMEOUT_S) {
                        return None;
                    }
                    let from = *from;
                    self.end_of_back_off(pose, from);
                    self.state = State::Ready;
                }
                State::Pausing { until_s } => {
                    if now_s < *until_s {
                        return None;
                    }
                    self.state = State::Ready;
                }
                State::Returning { .. } => {
                    self.way_home(observation);
                    return None;
                }
                State::Ended(_) => return None,
            }
        }
        None
    }

    /// The map that is believed; without one, the wait for it.
    fn usable_map(&mut self, now_s: f64) -> Option<MapSnapshot> {
        let map = self.watch.map().cloned();
        if map.is_none() {
            self.wait_for_map(now_s, "no map has come");
        }
        map
    }

    fn look_round(&mut self, now_s: f64, then: AfterTurn) {
        self.counts.turns += 1;
        self.turn(now_s, TAU, then);
    }

    fn turn(&mut self, now_s: f64, angle_rad: f64, then: AfterTurn) {
        self.state = State::Turning { id: self.next_id(), angle_rad, since_s: now_s, then };
    }

    const fn next_id(&mut self) -> CommandId {
        self.commands += 1;
        self.commands
    }
}

#[cfg(test)]
#[path = "explorer_tests.rs"]
mod tests;
