//! Looks on while the node explores: shows every decision and keeps the figures of the
//! status.

use super::areas::AreaInputs;
use super::explain::explain;
use super::live_params::LiveParams;
use super::operator::Operator;
use super::outputs::Outputs;
use super::session::{Activity, Session};
use crate::explore::{Areas, Counts, Decision, DecisionRecord, End, Explorer, Phase};
use crate::geometry::Pose;
use crate::grid::{AreaCensus, Thresholds};
use crate::robot::{Observation, Robot};
use crate::ros::display::{StatusInput, status};
use crate::ros::log::Level;
use crate::ros::msg::frontier_explorer::ExplorationStatus;
use crate::ros::{Node, RosRobot};

/// Steps shorter than this are noise of the localisation, metres.
const STEP_M: f64 = 0.02;

/// The watcher of one exploration.
pub struct NodeWatcher<'a> {
    node: &'a Node,
    outputs: &'a Outputs,
    inputs: &'a AreaInputs,
    began_s: Option<f64>,
    /// What earlier sessions took, seconds.
    earlier_s: f64,
    /// The goals that they sent.
    earlier_goals: usize,
    now_s: f64,
    last_pose: Option<Pose>,
    distance_m: f64,
    census: AreaCensus,
    known_area_m2: f64,
    free_area_m2: f64,
    frontiers: usize,
    frame: String,
    message: String,
    region_shown: bool,
    last_goal: Option<Pose>,
    /// The last decision.
    last: Option<DecisionRecord>,
    /// Goals that were really sent.
    goals_sent: usize,
}

impl<'a> NodeWatcher<'a> {
    /// A watcher of a run that begins now; areas are counted by these thresholds.
    pub fn new(
        node: &'a Node,
        outputs: &'a Outputs,
        inputs: &'a AreaInputs,
        areas: &Areas,
        thresholds: Thresholds,
    ) -> Self {
        let mut census = AreaCensus::new(thresholds);
        census.set_areas(areas);
        Self {
            node,
            outputs,
            inputs,
            began_s: None,
            earlier_s: 0.0,
            earlier_goals: 0,
            now_s: 0.0,
            last_pose: None,
            distance_m: 0.0,
            census,
            known_area_m2: 0.0,
            free_area_m2: 0.0,
            frontiers: 0,
            frame: "map".to_owned(),
            message: "waiting for the first map".to_owned(),
            region_shown: false,
            last_goal: None,
            last: None,
            goals_sent: 0,
        }
    }

    /// Goes on from what an earlier session drove.
    pub const fn go_on_from(&mut self, session: &Session) {
        (self.earlier_s, self.distance_m) = (session.elapsed_s, session.distance_m);
        self.earlier_goals = session.memory.counts.goals_sent;
    }

    /// Other areas are to be kept to.
    pub fn exchange_areas(&self, areas: Areas) {
        self.inputs.exchange(areas);
    }

    /// Has changes of parameters done.
    pub fn apply_news(&self, live: &LiveParams, operator: &Operator, explorer: &mut Explorer) {
        live.apply_news(operator, Some(explorer), self.outputs, self.inputs);
    }

    /// What is to be written down of the exploration.
    pub fn session(&self, explorer: &Explorer, activity: Activity) -> Session {
        Session {
            activity,
            preset: self.outputs.preset.clone(),
            map_frame: self.frame.clone(),
            elapsed_s: self.elapsed_s(),
            distance_m: self.distance_m,
            memory: explorer.memory(),
            areas: explorer.areas(),
            ..Session::default()
        }
    }

    fn elapsed_s(&self) -> f64 {
        self.earlier_s + self.began_s.map_or(0.0, |began_s| self.now_s - began_s)
    }

    /// The time of the exploration, seconds.
    pub const fn now_s(&self) -> f64 {
        self.now_s
    }

    /// What the exploration sees, chose and rejected, and why.
    pub fn explanation(&self) -> String {
        explain(&self.outputs.status(), self.last.as_ref(), &self.outputs.troubles())
    }

    /// Tells that it begins, or goes on.
    pub fn begin(&self, explorer: &Explorer) {
        self.outputs.set_status(self.status(Phase::WaitingForMap, explorer, None));
    }

    /// Tells the end, and returns the last status.
    pub fn finish(&mut self, robot: &RosRobot, explorer: &Explorer, end: &End) -> ExplorationStatus {
        self.goals_sent = robot.goals_sent();
        end.message.clone_into(&mut self.message);
        let last = self.status(Phase::Ended, explorer, Some(end));
        self.outputs.set_status(last.clone());
        self.outputs.tell_status();
        last
    }

    fn status(&self, phase: Phase, explorer: &Explorer, end: Option<&End>) -> ExplorationStatus {
        let counts = explorer.counts();
        status(&StatusInput {
            stamp_s: self.node.now_s(),
            frame: &self.frame,
            phase,
            paused: false,
            preset: &self.outputs.preset,
            message: &self.message,
            end,
            elapsed_s: self.elapsed_s(),
            distance_m: self.distance_m,
            known_area_m2: self.known_area_m2,
            free_area_m2: self.free_area_m2,
            frontiers: self.frontiers,
            // The explorer counts what it chose, also where nobody was there to drive.
            counts: &Counts { goals_sent: counts.goals_sent.min(self.earlier_goals + self.goals_sent), ..*counts },
            time_spent: explorer.time_spent(),
            map_age_s: f64::NAN,
        })
    }

    fn count_way(&mut self, observation: &Observation) {
        let Ok(pose) = observation.pose_in_map else { return };
        let step_m = self.last_pose.map_or(f64::INFINITY, |last| pose.distance_to(last.position()));
        if step_m >= STEP_M {
            // The first pose is no way.
            if step_m.is_finite() {
                self.distance_m += step_m;
            }
            self.last_pose = Some(pose);
        }
    }

    fn count_area(&mut self, robot: &RosRobot) {
        let Some(map) = robot.received_map() else { return };
        if map.frame != self.frame {
            map.frame.clone_into(&mut self.frame);
        }
        let census = self.census.update(&map.grid, &map.changes);
        let cell_m2 = map.grid.info().cell_area_m2();
        self.known_area_m2 = census.known() as f64 * cell_m2;
        self.free_area_m2 = census.free as f64 * cell_m2;
    }
}

/// One sentence about a phase in which nothing is decided.
const fn phase_sentence(phase: Phase) -> Option<&'static str> {
    match phase {
        Phase::WaitingForMap => Some("waiting for a map that shows the newest sights"),
        Phase::WaitingForPose => Some("waiting to know where the robot is"),
        Phase::WaitingForNavigation => Some("waiting for move_base"),
        Phase::Turning => Some("turning round to look about"),
        Phase::BackingOff => Some("backing off from what stands too near"),
        Phase::Pausing => Some("resting before what failed is tried again"),
        Phase::Returning => Some("driving back to the start"),
        Phase::Driving | Phase::Ended => None,
    }
}

impl NodeWatcher<'_> {
    /// Looks on before a step, or where none is made.
    pub fn look(&mut self, robot: &RosRobot, explorer: &mut Explorer, now_s: f64) {
        if robot.is_ready() {
            self.now_s = now_s;
            self.began_s.get_or_insert(now_s);
        }
        if let Some(areas) = self.inputs.take_new() {
            self.census.set_areas(&areas);
            robot.set_areas(&areas);
            explorer.set_areas(areas);
            self.region_shown = false;
        }
        if !self.region_shown {
            self.region_shown = true;
            self.outputs.show_region(explorer, &self.frame);
            self.inputs.show();
        }
    }

    /// Shows a step.
    pub fn show(&mut self, robot: &RosRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        self.count_way(observation);
        self.count_area(robot);
        self.goals_sent = robot.goals_sent();
        if let Some(notice) = &decision.notice {
            self.node.log().warn(notice);
        }
        if let Some(sentence) = phase_sentence(decision.phase) {
            sentence.clone_into(&mut self.message);
        }
        if let (Some(record), Some(map)) = (&decision.record, robot.received_map()) {
            self.frontiers = record.candidates.len();
            self.inputs.show_blacklist(explorer.blacklisted());
            record.why.clone_into(&mut self.message);
            // A goal that is kept is no news.
            if record.goal.is_none() || record.goal != self.last_goal {
                self.node.log().once(Level::Info, &record.why);
            }
            self.last_goal = record.goal;
            self.outputs.show_decision(decision, record, map.grid.info().resolution_m(), &map.frame);
            self.last = Some(record.clone());
        }
        if let Some(path) = robot.path() {
            self.outputs.show_path(&path, &self.frame);
        }
        if let Some(end) = &decision.end {
            end.message.clone_into(&mut self.message);
        }
        let new = self.status(decision.phase, explorer, decision.end.as_ref());
        self.outputs.set_status(new);
    }
}
