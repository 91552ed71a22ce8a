//! A robot behind ROS: maps, transforms and scans come in, goals and velocities go out.

use super::bell::Bell;
use super::clock::RunClock;
use super::log::Level;
use super::map_feed::ReceivedMap;
use super::move_base::MoveBase;
use super::node::Node;
use super::pilot::Pilot;
use super::robot_map::RobotMap;
use super::scan_feed::ScanFeed;
use super::transforms::Transforms;
use super::turn_goals::TurnGoals;
use crate::geometry::Pose;
use crate::robot::{Command, CommandId, Navigation, NavigationState, Observation, PoseError, Robot, RobotError};
use crate::scan::LaserScan;
use std::mem::Discriminant;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// From one look at the time to the next, seconds of real time at the most.
const SLICE: Duration = Duration::from_millis(20);
/// A clock that stands for this long is worth a word.
const CLOCK_PATIENCE: Duration = Duration::from_secs(10);

/// How a robot is observed and driven.
pub struct RosRobotConfig {
    /// Its frame.
    pub base_frame: String,
    /// How old its transform may be, seconds.
    pub transform_tolerance_s: f64,
    /// Seconds between observations.
    pub tick_period_s: f64,
    /// Turns are made by goals of move_base.
    pub turn_by_goals: bool,
    /// Ask move_base to clear its costmaps when a goal failed.
    pub clear_costmaps: bool,
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
}

/// Which command is under way, and who carries it out.
enum Task {
    None,
    /// A goal that move_base has not been sent yet, with the reason.
    Unsent {
        id: CommandId,
        why: String,
    },
    Goal(CommandId),
    Turn(CommandId, TurnGoals),
    Pilot,
}

/// The robot.
pub struct RosRobot {
    node: Node,
    config: RosRobotConfig,
    parts: Connections,
    clock: RunClock,
    next_tick_s: f64,
    clock_moved: Instant,
    task: Task,
    /// The map is new in this observation.
    map_is_new: bool,
    latencies_ms: Vec<f64>,
    pose: Option<Pose>,
    /// Why the robot's place was not known in the last observation.
    trouble: Option<Discriminant<PoseError>>,
    /// A map and the robot's place in it have been known.
    has_begun: bool,
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
            clock_moved: Instant::now(),
            task: Task::None,
            map_is_new: false,
            latencies_ms: Vec::new(),
            pose: None,
            trouble: None,
            has_begun: false,
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

    /// The path that is followed, where we drive ourselves.
    #[must_use]
    pub fn path(&self) -> Option<crate::geometry::Path> {
        self.parts.pilot.path()
    }

    /// Stops the robot: cancels the goal under way and stands still.
    pub fn stop(&mut self) {
        if let Some(move_base) = &mut self.parts.move_base {
            move_base.cancel();
        }
        self.parts.pilot.command(&Command::Hold);
        self.task = Task::None;
    }

    /// Waits for the next tick, or for something that has come.
    fn wait(&mut self) -> Result<f64, RobotError> {
        loop {
            if self.node.has_failed() {
                return Err(RobotError::Disconnected("a part of the node failed".to_owned()));
            }
            if !self.node.is_ok() {
                return Err(RobotError::Interrupted);
            }
            let rung = self.parts.bell.wait(SLICE);
            let ros_s = self.node.now_s();
            self.watch_clock(ros_s);
            if ros_s <= 0.0 {
                continue;
            }
            if self.parts.paused.load(Ordering::Relaxed) {
                self.stop();
                self.clock.skip_to(ros_s);
                continue;
            }
            self.parts.transforms.notice_time(self.clock.last_ros_s().unwrap_or(ros_s), ros_s);
            let now_s = self.clock.at(ros_s);
            if rung || now_s >= self.next_tick_s {
                self.next_tick_s = now_s + self.config.tick_period_s;
                return Ok(ros_s);
            }
        }
    }

    /// Says so when `/clock` has not begun, or stands.
    fn watch_clock(&mut self, ros_s: f64) {
        if self.clock.last_ros_s() != Some(ros_s) {
            self.clock_moved = Instant::now();
            if ros_s > 0.0 {
                return;
            }
            self.node.log().once(Level::Warn, "use_sim_time is set and no /clock has come yet: waiting for it");
        } else if self.clock_moved.elapsed() >= CLOCK_PATIENCE {
            self.node.log().once(Level::Warn, format_args!("/clock stands at {ros_s:.1} s: waiting for it to go on"));
        }
    }

    /// Takes in the newest map and costmap, and tells who else needs them.
    fn take_map(&mut self) {
        self.map_is_new = self.parts.map.take_newest(&self.node, &self.clock);
        let (Some(received), Some(snapshot)) = (self.parts.map.received(), self.parts.map.snapshot()) else { return };
        if let (true, Some(costmap)) = (self.map_is_new, &snapshot.costmap) {
            self.parts.pilot.set_costmap(&received.frame, Arc::clone(costmap), received.stamp_s);
            received.frame.clone_into(&mut self.parts.map_frame.lock().unwrap_or_else(PoisonError::into_inner));
        }
    }

    fn locate(&mut self, ros_s: f64) -> Result<Pose, PoseError> {
        let frame = self.parts.map.frame();
        let RosRobotConfig { base_frame, transform_tolerance_s, .. } = &self.config;
        let pose = self.parts.transforms.robot(frame, base_frame, ros_s, *transform_tolerance_s);
        let trouble = pose.as_ref().err().map(std::mem::discriminant);
        match &pose {
            Ok(pose) => self.pose = Some(*pose),
            // An age changes with every look: each kind of trouble is told once.
            Err(error) if self.trouble != trouble => self.node.log().warn(error),
            Err(_) => {}
        }
        if self.trouble.is_some() && trouble.is_none() {
            self.node.log().info("the robot's place is known again");
        }
        self.trouble = trouble;
        pose
    }

    fn scan(&self) -> Option<(Pose, Arc<LaserScan>)> {
        let (scans, received) = (self.parts.scans.as_ref()?, self.parts.map.received()?);
        let (pose, scan) = scans.newest_in(&received.frame, &self.parts.transforms)?;
        Some((pose, Arc::new(scan)))
    }

    /// How the command under way is doing.
    fn navigation(&mut self) -> Navigation {
        let (Some(move_base), frame) = (&mut self.parts.move_base, self.parts.map.frame()) else {
            return self.parts.pilot.navigation();
        };
        match &mut self.task {
            Task::None => Navigation { command: 0, state: NavigationState::Idle },
            Task::Unsent { id, why } => Navigation { command: *id, state: NavigationState::Unavailable(why.clone()) },
            Task::Goal(id) => Navigation { command: *id, state: move_base.state() },
            Task::Turn(id, turn) => Navigation { command: *id, state: turn.advance(move_base, frame) },
            Task::Pilot => self.parts.pilot.navigation(),
        }
    }

    /// Sends a goal to move_base, unless it is under way there.
    fn drive(&mut self, id: CommandId, goal_in_map: &Pose) {
        let Some(move_base) = &mut self.parts.move_base else { return };
        if matches!(self.task, Task::Goal(under_way) if under_way == id) {
            let lost = matches!(move_base.state(), NavigationState::Unavailable(_));
            if !lost {
                return;
            }
        }
        self.parts.pilot.command(&Command::Hold);
        self.task = match move_base.send(goal_in_map, self.parts.map.frame()) {
            Ok(()) => Task::Goal(id),
            Err(why) => Task::Unsent { id, why },
        };
        self.note_latency();
    }

    /// A goal that the newest map led to has just been sent.
    fn note_latency(&mut self) {
        if let (Task::Goal(_), true, Some(received)) = (&self.task, self.map_is_new, self.parts.map.received()) {
            self.latencies_ms.push(1e3 * received.arrived.elapsed().as_secs_f64());
        }
    }

    fn turn(&mut self, id: CommandId, angle_rad: f64) {
        let by_goals = self.config.turn_by_goals;
        let (Some(move_base), true, Some(pose)) = (&mut self.parts.move_base, by_goals, self.pose) else {
            if let Some(move_base) = &mut self.parts.move_base {
                move_base.cancel();
            }
            self.parts.pilot.command(&Command::Turn { id, angle_rad });
            self.task = Task::Pilot;
            return;
        };
        let under_way = match &self.task {
            Task::Turn(current, turn) => *current == id && !turn.is_lost(),
            _ => false,
        };
        if under_way {
            return;
        }
        let mut turn = TurnGoals::new(&pose, angle_rad);
        self.task = match turn.begin(move_base, self.parts.map.frame()) {
            Ok(()) => Task::Turn(id, turn),
            Err(why) => Task::Unsent { id, why },
        };
    }

    /// Asks move_base to forget obstacles that are no more, when it gave a goal up.
    fn recover(&self, navigation: &Navigation) {
        let (Some(move_base), true) = (&self.parts.move_base, self.config.clear_costmaps) else { return };
        if let NavigationState::Aborted(why) = &navigation.state {
            self.node.log().warn(format_args!("move_base gave the goal up: {why}"));
            move_base.clear_costmaps();
        }
    }
}

impl Robot for RosRobot {
    /// The first observation waits for a map and for the robot's place in it, however
    /// long it takes: nodes of a launch file begin in any order.
    fn observe(&mut self) -> Result<Observation, RobotError> {
        let (mut ros_s, mut pose_in_map);
        loop {
            ros_s = self.wait()?;
            self.take_map();
            pose_in_map = self.locate(ros_s);
            self.has_begun |= self.parts.map.received().is_some() && pose_in_map.is_ok();
            if self.has_begun {
                break;
            }
        }
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

    fn command(&mut self, command: &Command) -> Result<(), RobotError> {
        match *command {
            Command::Hold => self.stop(),
            Command::Drive { id, ref goal_in_map } if self.parts.move_base.is_some() => self.drive(id, goal_in_map),
            Command::Turn { id, angle_rad } => self.turn(id, angle_rad),
            Command::Drive { .. } | Command::BackOff { .. } => {
                if let Some(move_base) = &mut self.parts.move_base {
                    move_base.cancel();
                }
                self.parts.pilot.command(command);
                self.task = Task::Pilot;
            }
        }
        Ok(())
    }
}
