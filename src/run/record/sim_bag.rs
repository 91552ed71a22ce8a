//! A simulated run as a bag with the topics that a robot with move_base has, five times a
//! second: what `rosbag record` would have got from `sim_node`.

use super::RecordError;
use super::bag_file::BagFile;
use crate::bag::{
    Header, MessageType, clock_message, goal_message, map_message, nanos, odometry_message, result_message,
    scan_message, tf_message,
};
use crate::config::LidarConfig;
use crate::explore::Decision;
use crate::geometry::{Pose, Twist};
use crate::robot::{Command, CommandId, NavigationState, Observation};
use crate::sim::SimRobot;
use crate::tf::TransformSample;
use std::path::Path;

/// The second of the bag at which the simulation begins: ROS takes time 0 for none.
const BEGIN_S: f64 = 1.0;
/// The frames, named as REP 105 has them.
const MAP: &str = "map";
const ODOM: &str = "odom";
const BASE: &str = "base_footprint";
const LIDAR: &str = "base_scan";

/// The bag while the run goes on.
pub struct SimBag {
    file: BagFile,
    topics: Topics,
    mount: Pose,
    scan_period_s: f64,
    seq: u32,
    map_stamp_s: Option<f64>,
    /// The goal under way.
    goal: Option<CommandId>,
}

/// The numbers of the topics.
struct Topics {
    clock: u32,
    tf: u32,
    tf_static: u32,
    odom: u32,
    scan: u32,
    map: u32,
    goal: u32,
    result: u32,
}

impl SimBag {
    /// Begins the bag of a robot with this lidar.
    ///
    /// # Errors
    /// [`RecordError::Write`] with the file.
    pub fn create(path: &Path, lidar: &LidarConfig) -> Result<Self, RecordError> {
        let (mount, scan_period_s) = (lidar.mount, 1.0 / lidar.rate_hz);
        let mut file = BagFile::create(path)?;
        let topics = Topics {
            clock: file.topic("/clock", MessageType::Clock, false),
            tf: file.topic("/tf", MessageType::Transforms, false),
            tf_static: file.topic("/tf_static", MessageType::Transforms, true),
            odom: file.topic("/odom", MessageType::Odometry, false),
            scan: file.topic("/scan", MessageType::Scan, false),
            map: file.topic("/map", MessageType::Map, true),
            goal: file.topic("/move_base/goal", MessageType::Goal, false),
            result: file.topic("/move_base/result", MessageType::Result, false),
        };
        Ok(Self { file, topics, mount, scan_period_s, seq: 0, map_stamp_s: None, goal: None })
    }

    /// Writes what was observed in a tick, and what was decided.
    pub(super) fn tick(&mut self, sim: &SimRobot, observation: &Observation, decision: &Decision) {
        let now_s = observation.stamp_s;
        let at = nanos(BEGIN_S + now_s);
        self.file.put(self.topics.clock, at, &clock_message(at));
        if self.seq == 0 {
            let mount = TransformSample::planar(BEGIN_S + now_s, BASE, LIDAR, &self.mount);
            self.file.put(self.topics.tf_static, at, &tf_message(&[mount]));
        }
        self.seq = self.seq.wrapping_add(1);
        let (odom_in_map, in_odom) = (sim.map_from_odom(), sim.pose_in_odom());
        let chain = [
            TransformSample::planar(BEGIN_S + now_s, MAP, ODOM, &odom_in_map),
            TransformSample::planar(BEGIN_S + now_s, ODOM, BASE, &in_odom),
        ];
        self.file.put(self.topics.tf, at, &tf_message(&chain));
        let odometry = odometry_message(&self.header(now_s, ODOM), BASE, &in_odom, &Twist::ZERO);
        self.file.put(self.topics.odom, at, &odometry);
        if let Some((_, scan)) = &observation.scan {
            let message = scan_message(&self.header(scan.stamp_s, LIDAR), scan, self.scan_period_s);
            self.file.put(self.topics.scan, at, &message);
        }
        if let Some(map) = &observation.map
            && self.map_stamp_s != Some(map.stamp_s)
        {
            self.map_stamp_s = Some(map.stamp_s);
            let message = map_message(&self.header(map.stamp_s, MAP), &map.grid);
            self.file.put(self.topics.map, at, &message);
        }
        self.navigate(observation, decision);
    }

    /// Closes the bag.
    pub(super) fn finish(&mut self) -> Result<(), RecordError> {
        self.file.finish()
    }

    /// Goals and results as an action server tells them.
    fn navigate(&mut self, observation: &Observation, decision: &Decision) {
        let now_s = observation.stamp_s;
        if let Some(id) = self.goal
            && observation.navigation.command == id
        {
            match &observation.navigation.state {
                NavigationState::Succeeded => self.end_goal(now_s, 3, "Goal reached."),
                NavigationState::Aborted(why) => self.end_goal(now_s, 4, why),
                NavigationState::Preempted => self.end_goal(now_s, 2, ""),
                NavigationState::Active | NavigationState::Idle | NavigationState::Unavailable(_) => {}
            }
        }
        match &decision.command {
            Command::Drive { id, goal_in_map } if self.goal != Some(*id) => {
                self.end_goal(now_s, 2, "another goal took its place");
                self.goal = Some(*id);
                let message = goal_message(&self.header(now_s, MAP), &name(*id), goal_in_map);
                self.file.put(self.topics.goal, nanos(BEGIN_S + now_s), &message);
            }
            Command::Drive { .. } => {}
            Command::Hold | Command::Turn { .. } | Command::BackOff { .. } => self.end_goal(now_s, 2, "cancelled"),
        }
    }

    fn end_goal(&mut self, now_s: f64, status: u8, text: &str) {
        if let Some(id) = self.goal.take() {
            let message = result_message(&self.header(now_s, MAP), &name(id), status, text);
            self.file.put(self.topics.result, nanos(BEGIN_S + now_s), &message);
        }
    }

    fn header(&self, stamp_s: f64, frame: &str) -> Header {
        Header { seq: self.seq, stamp: nanos(BEGIN_S + stamp_s), frame: frame.to_owned() }
    }
}

fn name(id: CommandId) -> String {
    format!("/explore-{id}")
}
