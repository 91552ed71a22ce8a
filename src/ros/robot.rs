//! A robot behind ROS: maps, transforms and scans come in, goals and velocities go out.

mod inputs;
mod tasks;

use super::bell::Bell;
use super::clock::RunClock;
use super::clock_watch::ClockWatch;
use super::map_feed::ReceivedMap;
use super::move_base::MoveBase;
use super::node::Node;
use super::pilot::Pilot;
use super::robot_map::RobotMap;
use super::scan_feed::ScanFeed;
use super::transforms::Transforms;
use super::troubles::Troubles;
use super::tuning::Tuning;
use crate::geometry::{Areas, Pose};
use crate::robot::{Command, CommandId, Observation, Robot, RobotError};
use crate::scan::LaserScan;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex};
use std::time::Instant;
use tasks::Task;

/// How a robot is observed and driven.
pub struct RosRobotConfig {
    /// Its frame.
    pub base_frame: String,
    /// What may change while it drives.
    pub tuning: Tuning,
    /// Seconds between observations.
    pub tick_period_s: f64,
    /// Turns are made by goals of move_base.
    pub turn_by_goals: bool,
    /// Velocity commands may get the robot away from what stands too near.
    pub back_off: bool,
}

/// The parts of the robot that are connected already.
pub struct Connections {
    /// Its map and costmap.
    pub map: RobotMap,
    /// Its frames.
    pub transforms: Arc<Transforms>,
    /// Its scans, where they are needed.
    pub scans: Option<Arc<ScanFeed>>,
    /// Who drives it to goals; the pilot where there is none.
    pub move_base: Option<MoveBase>,
    /// Who turns it, and drives it where nobody else does.
    pub pilot: Pilot,
    /// Rung when something has come.
    pub bell: Arc<Bell>,
    /// The frame of the map, for those who need it too.
    pub map_frame: Arc<Mutex<String>>,
    /// Whether the exploration is to rest.
    pub paused: Arc<AtomicBool>,
    /// What is wrong now.
    pub troubles: Troubles,
}

/// The robot.
pub struct RosRobot {
    node: Node,
    config: RosRobotConfig,
    parts: Connections,
    clock: RunClock,
    next_tick_s: f64,
    clock_watch: ClockWatch,
    next_look: Instant,
    task: Task,
    /// The map is new in this observation.
    map_is_new: bool,
    latencies_ms: Vec<f64>,
    pose: Option<Pose>,
    /// Whether the robot's place was not known in the last observation.
    is_lost: bool,
    /// A map and the robot's place in it have been known.
    has_begun: bool,
    /// The last observation is one to decide on.
    is_ready: bool,
    /// The last goal that was sent, and how many different ones were.
    sent: (CommandId, usize),
}

impl RosRobot {
    /// A robot whose parts are connected.
    #[must_use]
    pub fn new(node: &Node, config: RosRobotConfig, parts: Connections) -> Self {
        Self {
            node: node.clone(),
            config,
            parts,
            clock: RunClock::default(),
            next_tick_s: f64::NEG_INFINITY,
            clock_watch: ClockWatch::new(),
            next_look: Instant::now(),
            task: Task::None,
            map_is_new: false,
            latencies_ms: Vec::new(),
            pose: None,
            is_lost: false,
            has_begun: false,
            is_ready: false,
            sent: (0, 0),
        }
    }

    /// The newest map, as it came.
    #[must_use]
    pub fn received_map(&self) -> Option<&ReceivedMap> {
        self.parts.map.received()
    }

    /// Milliseconds from a map's arrival to the goal that it led to.
    #[must_use]
    pub fn latencies_ms(&self) -> &[f64] {
        &self.latencies_ms
    }

    /// How many goals were really sent; one that is sent again counts once.
    #[must_use]
    pub const fn goals_sent(&self) -> usize {
        self.sent.1
    }

    /// Whether a map and the robot's place in it have been known.
    #[must_use]
    pub const fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// The path that is followed, where we drive ourselves.
    #[must_use]
    pub fn path(&self) -> Option<crate::geometry::Path> {
        self.parts.pilot.path()
    }

    /// Keeps to these areas from now on, where we drive ourselves.
    pub fn set_areas(&self, areas: &Areas) {
        self.parts.pilot.set_areas(areas.clone());
    }

    /// Takes the time since the last observation for a rest.
    pub fn go_on(&mut self) {
        self.clock.skip_to(self.node.now_s());
    }

    /// Stops the robot: cancels the goal under way and stands still.
    pub fn stop(&mut self) {
        if let Some(move_base) = &mut self.parts.move_base {
            move_base.cancel();
        }
        self.parts.pilot.command(&Command::Hold);
        self.task = Task::None;
    }

    fn scan(&self) -> Option<(Pose, Arc<LaserScan>)> {
        let (scans, received) = (self.parts.scans.as_ref()?, self.parts.map.received()?);
        let (pose, scan) = scans.newest_in(&received.frame, &self.parts.transforms)?;
        Some((pose, Arc::new(scan)))
    }
}

impl Robot for RosRobot {
    fn observe(&mut self) -> Result<Observation, RobotError> {
        let (ros_s, is_tick) = self.wait()?;
        self.take_map();
        let pose_in_map = self.locate(ros_s);
        self.has_begun |= self.parts.map.received().is_some() && pose_in_map.is_ok();
        self.is_ready = is_tick && self.has_begun;
        let navigation = self.navigation();
        self.recover(&navigation);
        Ok(Observation {
            stamp_s: self.clock.of(ros_s),
            pose_in_map,
            map: self.parts.map.snapshot().cloned(),
            scan: self.scan(),
            navigation,
        })
    }

    /// The first map and the robot's place in it are waited for however long it takes: nodes of
    /// a launch file begin in any order.
    fn is_ready(&self) -> bool {
        self.is_ready
    }

    fn command(&mut self, command: &Command) -> Result<(), RobotError> {
        match *command {
            Command::Hold => self.stop(),
            Command::Drive { id, ref goal_in_map } if self.parts.move_base.is_some() => self.drive(id, goal_in_map),
            Command::Turn { id, angle_rad } => self.turn(id, angle_rad),
            // Our own pilot drives here, and nobody else at the same time.
            Command::Drive { id, .. } => {
                self.parts.pilot.command(command);
                self.task = Task::Pilot;
                self.count_goal(id);
            }
            Command::BackOff { id } => self.back_off(command, id),
        }
        Ok(())
    }
}
