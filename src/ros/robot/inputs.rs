//! What comes in: the next tick, the map, the robot's place; and what is said while one of
//! them does not.

use super::RosRobot;
use crate::geometry::Pose;
use crate::robot::{PoseError, RobotError};
use crate::ros::log::Level;
use crate::ros::move_base::{MoveBase, Stranger};
use crate::ros::troubles::Trouble;
use std::sync::atomic::Ordering;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

/// After so long without a tick those who look on are told all the same, real time.
const IDLE: Duration = Duration::from_millis(250);
/// From one look at the time to the next, seconds of real time at the most.
const SLICE: Duration = Duration::from_millis(20);
/// A clock that stands for this long is worth a word.
const CLOCK_PATIENCE: Duration = Duration::from_secs(2);
/// From one look at what is missing to the next.
const LOOK_PERIOD: Duration = Duration::from_secs(1);
/// Nodes of a launch file begin in any order: what is missing earlier is no trouble yet,
/// seconds of real time.
const GRACE_S: f64 = 2.0;
/// A transform that is late for a moment is waited for this long, real time.
const LATE_TRANSFORM: Duration = Duration::from_millis(250);

impl RosRobot {
    /// Waits for the next tick, or for something that has come; in vain for a while where there
    /// is no time, or while the exploration rests. Returns ROS time, and whether it is a tick.
    pub(super) fn wait(&mut self) -> Result<(f64, bool), RobotError> {
        let began = Instant::now();
        loop {
            self.check_running()?;
            let rung = self.parts.bell.wait(SLICE);
            let ros_s = self.node.now_s();
            self.watch_clock(ros_s);
            self.watch_inputs();
            if ros_s > 0.0 {
                self.parts.transforms.notice_time(self.clock.last_ros_s().unwrap_or(ros_s), ros_s);
            }
            if self.rests(ros_s) {
                self.stop();
                self.clock.skip_to(ros_s);
            } else if ros_s > 0.0 {
                let now_s = self.clock.at(ros_s, self.node.wall_s());
                if let Some(ahead_s) = self.clock.take_jump_ahead() {
                    let text =
                        format_args!("ROS time jumped ahead by {ahead_s:.0} s: to the exploration that is no time");
                    self.node.log().warn(text);
                }
                if rung || now_s >= self.next_tick_s {
                    self.next_tick_s = now_s + self.config.tick_period_s;
                    return Ok((ros_s, true));
                }
            }
            if rung || began.elapsed() >= IDLE {
                return Ok((ros_s, false));
            }
        }
    }

    /// Whether the exploration rests: its user asked for it, or somebody else's goal is under way.
    fn rests(&mut self, ros_s: f64) -> bool {
        let yields = self.yields(ros_s);
        self.parts.paused.load(Ordering::Relaxed) || yields
    }

    /// Whether a goal of somebody else, such as one that a person clicked, is left to its end.
    fn yields(&mut self, ros_s: f64) -> bool {
        let Some(move_base) = &self.parts.move_base else { return false };
        let troubles = &self.parts.troubles;
        let yield_s = self.config.tuning.now().yield_s;
        match move_base.stranger(ros_s, yield_s) {
            Stranger::None => {
                if troubles.clear(Trouble::Stranger) {
                    self.node.log().info("the goal of somebody else is over: going on");
                }
                false
            }
            Stranger::Drives { goal } => {
                let text = format!(
                    "a goal of somebody else is under way ({goal}): resting until it ends, at most {yield_s} s"
                );
                troubles.report(Trouble::Stranger, Level::Info, text);
                true
            }
            Stranger::TakesTooLong { goal } => {
                if troubles.clear(Trouble::Stranger) {
                    let text = format!(
                        "the goal of somebody else ({goal}) takes longer than {yield_s} s: going on all the same"
                    );
                    self.node.log().warn(text);
                }
                false
            }
        }
    }

    fn check_running(&self) -> Result<(), RobotError> {
        if self.node.has_failed() {
            return Err(RobotError::Disconnected("a part of the node failed".to_owned()));
        }
        if self.node.is_ok() { Ok(()) } else { Err(RobotError::Interrupted) }
    }

    /// Says so when `/clock` has not begun, or stands.
    fn watch_clock(&mut self, ros_s: f64) {
        let stands = self.clock_watch.stands_for(ros_s);
        let troubles = &self.parts.troubles;
        if ros_s <= 0.0 && self.node.wall_s() > GRACE_S {
            let text = "use_sim_time is set and no /clock has come yet: waiting for it; start the simulator or \
                        `rosbag play --clock`, or `rosparam set /use_sim_time false` and start all nodes again";
            troubles.report(Trouble::Clock, Level::Warn, text);
        } else if ros_s > 0.0 && stands >= CLOCK_PATIENCE {
            let text = format!("/clock stands at {ros_s:.1} s: waiting for it to go on");
            troubles.report(Trouble::Clock, Level::Warn, text);
        } else if ros_s > 0.0 && stands < CLOCK_PATIENCE && troubles.clear(Trouble::Clock) {
            self.node.log().info("/clock goes on");
        }
    }

    /// Says what is missing, as far as the master knows it.
    fn watch_inputs(&mut self) {
        if Instant::now() < self.next_look || self.node.wall_s() < GRACE_S {
            return;
        }
        self.next_look = Instant::now() + LOOK_PERIOD;
        let waited_s = self.node.wall_s();
        let troubles = &self.parts.troubles;
        let tell = |trouble: Trouble, text: Option<String>| match text {
            Some(text) => troubles.report(trouble, Level::Warn, text),
            None => {
                troubles.clear(trouble);
            }
        };
        tell(Trouble::Map, self.parts.map.missing_map(&self.node, waited_s));
        tell(Trouble::Costmap, self.parts.map.missing_costmap(&self.node, waited_s));
        tell(Trouble::CostmapUnknown, self.parts.map.without_unknown(&self.node));
        tell(Trouble::MoveBase, self.parts.move_base.as_ref().and_then(MoveBase::trouble));
    }

    /// Takes in the newest map and costmap, and tells who else needs them.
    pub(super) fn take_map(&mut self) {
        self.map_is_new = self.parts.map.take_newest(&self.clock);
        let (Some(received), Some(snapshot)) = (self.parts.map.received(), self.parts.map.snapshot()) else { return };
        if let (true, Some(costmap)) = (self.map_is_new, &snapshot.costmap) {
            self.parts.pilot.set_costmap(&received.frame, Arc::clone(&costmap.cells), received.stamp_s);
            received.frame.clone_into(&mut self.parts.map_frame.lock().unwrap_or_else(PoisonError::into_inner));
        }
    }

    /// Where the robot is now, in seconds of ROS time.
    pub(super) fn locate(&mut self, ros_s: f64) -> Result<Pose, PoseError> {
        let mut pose = self.look_up(ros_s);
        if ros_s <= 0.0 {
            // Without a clock nothing is late.
            return pose;
        }
        let began = Instant::now();
        // One that was there a moment ago is on its way; the pilot stands still meanwhile.
        while pose.is_err() && !self.is_lost && self.has_begun && began.elapsed() < LATE_TRANSFORM {
            if self.check_running().is_err() {
                break;
            }
            std::thread::sleep(SLICE);
            pose = self.look_up(self.node.now_s());
        }
        match &pose {
            Ok(pose) => {
                self.pose = Some(*pose);
                if self.parts.troubles.clear(Trouble::Pose) {
                    self.node.log().info("the robot's place is known again");
                }
            }
            Err(error) if self.has_begun || self.node.wall_s() > GRACE_S => {
                self.parts.troubles.report(Trouble::Pose, Level::Warn, error);
            }
            Err(_) => {}
        }
        self.is_lost = pose.is_err();
        pose
    }

    fn look_up(&self, ros_s: f64) -> Result<Pose, PoseError> {
        let super::RosRobotConfig { base_frame, tuning, .. } = &self.config;
        let tolerance_s = tuning.now().transform_tolerance_s;
        self.parts.transforms.robot(self.parts.map.frame(), base_frame, ros_s, tolerance_s)
    }
}
