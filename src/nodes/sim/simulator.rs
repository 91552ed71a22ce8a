//! The simulated robot behind topics: real time, commands and faults from outside.

use super::SimNodeError;
use super::move_base_server::MoveBaseServer;
use super::params::{Fault, SimParams};
use super::plan::plan;
use super::topics::Topics;
use crate::geometry::Twist;
use crate::ros::msg::geometry_msgs::Twist as TwistMessage;
use crate::ros::msg::std_msgs::String as StringMessage;
use crate::ros::{Feed, Node, convert};
use crate::sim::schedule::Periodic;
use crate::sim::{DriverKind, InflatedPlanner, Plant, SimStats};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A base stops when no command came for so long, seconds of simulated time.
const COMMAND_TIMEOUT_S: f64 = 0.6;
/// Simulated time begins here: 0 means "no clock yet" in ROS.
const EPOCH_S: f64 = 10.0;
/// From one tick of the clock and the transforms to the next, real time.
const CLOCK_PERIOD_S: f64 = 0.01;
const TF_PERIOD_S: f64 = 0.02;
/// The simulator never runs after more lost time than this, seconds of real time.
const LONGEST_LAG_S: f64 = 0.25;
/// Commands and faults may be silent: so often it is looked whether all who send them are met.
const LOOK: Duration = Duration::from_secs(60);

/// A command from outside, and when it came, simulated seconds.
#[derive(Clone, Copy, Debug, Default)]
struct Received {
    twist: Twist,
    count: u64,
}

/// A plant behind topics, in the pace of the clock on the wall.
pub struct Simulator {
    node: Node,
    plant: Plant,
    topics: Topics,
    server: Option<MoveBaseServer>,
    speed: f64,
    /// ROS time of simulated time 0, seconds.
    epoch_s: f64,
    control_period_s: f64,
    received: Arc<Mutex<Received>>,
    /// The last command that was seen, and the simulated time then.
    seen: (u64, f64),
    fault: Arc<Mutex<Fault>>,
    twist: Twist,
    _feeds: [Feed; 2],
}

impl Simulator {
    /// Puts the robot into its world and offers its topics.
    ///
    /// # Errors
    /// [`SimNodeError`] when a parameter or ROS does not let it.
    pub fn new(node: &Node, params: &SimParams) -> Result<Self, SimNodeError> {
        let plan = plan(params)?;
        let (plant, driver) = plan.plant()?;
        let with_clock = params.speed != 1.0 || node.is_simulated_time();
        let epoch_s = if with_clock { EPOCH_S } else { node.now_s() };
        let topics = Topics::offer(node, &plan.robot, &params.base_frame, with_clock)?;
        let config = plan.sim_config();
        let server = if params.move_base {
            let planner = match plan.driver {
                DriverKind::Navigator => plan.preset.explorer.planner.build(&plan.robot.body()),
                DriverKind::MoveBase => Box::new(InflatedPlanner::new(config.move_base.allow_unknown)),
            };
            Some(MoveBaseServer::offer(node, driver, planner, &plant)?)
        } else {
            None
        };
        let received = Arc::<Mutex<Received>>::default();
        let fault = Arc::new(Mutex::new(params.fault));
        let feeds = [listen_to_commands(node, &received), listen_to_faults(node, &fault)];
        Ok(Self {
            node: node.clone(),
            plant,
            topics,
            server,
            speed: params.speed,
            epoch_s,
            control_period_s: config.control_period_s,
            received,
            seen: (0, f64::NEG_INFINITY),
            fault,
            twist: Twist::ZERO,
            _feeds: feeds,
        })
    }

    /// What the run has come to so far.
    pub fn stats(&self) -> SimStats {
        self.plant.stats()
    }

    /// Simulates until the node is told to stop.
    ///
    /// # Errors
    /// [`SimNodeError::Mapper`] when the map cannot grow any more.
    pub fn run(&mut self) -> Result<(), SimNodeError> {
        // What is told to others is told as often in real time, however fast time flies.
        let fast = self.speed.max(1.0);
        let mut began = Instant::now();
        let mut clock = Periodic::every_s(CLOCK_PERIOD_S * fast);
        let mut tf = Periodic::every_s(TF_PERIOD_S * fast);
        let mut control = Periodic::every_s(self.control_period_s);
        self.tell_map();
        while self.node.is_ok() {
            let mut wanted_s = began.elapsed().as_secs_f64() * self.speed;
            let lost_s = wanted_s - self.plant.now_s() - LONGEST_LAG_S * self.speed;
            if lost_s > 0.0 {
                // A machine that cannot keep up simulates slower, and does not jump.
                began += Duration::from_secs_f64(lost_s / self.speed);
                wanted_s -= lost_s;
            }
            while self.plant.now_s() < wanted_s {
                let next = self.plant.next().min(control.next()).min(clock.next()).min(tf.next());
                self.plant.drive(&self.twist, next);
                let sensed = self.plant.sense()?;
                let (now, stamp_s, fault) = (self.plant.now(), self.stamp_s(), self.fault());
                if clock.is_due(now) {
                    self.topics.tell_clock(stamp_s);
                }
                if tf.is_due(now) {
                    self.topics.tell_odometry(&self.plant, stamp_s, fault != Fault::DropTf);
                }
                if sensed.scan {
                    self.topics.tell_scan(&self.plant, stamp_s);
                }
                if sensed.map && fault != Fault::StopMap {
                    self.tell_map();
                }
                if control.is_due(now) {
                    self.control(stamp_s, fault);
                }
            }
            let (stamp_s, fault) = (self.stamp_s(), self.fault());
            if let Some(server) = &mut self.server {
                server.tell(&self.plant, stamp_s, fault);
            }
            std::thread::sleep(Duration::from_millis(4));
        }
        Ok(())
    }

    fn tell_map(&mut self) {
        let stamp_s = self.stamp_s();
        self.topics.tell_map(&self.plant, stamp_s);
    }

    /// The velocity until the next control tick: move_base's where it drives, else the
    /// last command from outside, as long as it is fresh.
    fn control(&mut self, stamp_s: f64, fault: Fault) {
        let now_s = self.plant.now_s();
        let driven =
            self.server.as_mut().and_then(|server| server.control(&self.plant, self.control_period_s, stamp_s, fault));
        let received = *self.received.lock().unwrap_or_else(PoisonError::into_inner);
        if received.count != self.seen.0 {
            self.seen = (received.count, now_s);
        }
        let is_fresh = now_s - self.seen.1 <= COMMAND_TIMEOUT_S * self.speed.max(1.0).sqrt();
        self.twist = match driven {
            Some(twist) => {
                self.topics.tell_command(&twist);
                twist
            }
            None if is_fresh => received.twist,
            None => Twist::ZERO,
        };
    }

    fn stamp_s(&self) -> f64 {
        self.epoch_s + self.plant.now_s()
    }

    fn fault(&self) -> Fault {
        *self.fault.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

fn listen_to_commands(node: &Node, received: &Arc<Mutex<Received>>) -> Feed {
    let (received, own) = (Arc::clone(received), node.name().to_owned());
    Feed::listen_seldom(node, "cmd_vel", 5, LOOK, move |message: TwistMessage, caller| {
        // What we tell onlookers comes back to us.
        if caller != own {
            let mut received = received.lock().unwrap_or_else(PoisonError::into_inner);
            *received = Received { twist: convert::twist(&message), count: received.count + 1 };
        }
    })
}

fn listen_to_faults(node: &Node, fault: &Arc<Mutex<Fault>>) -> Feed {
    let (fault, log) = (Arc::clone(fault), node.log().clone());
    Feed::listen_seldom(node, "~fault", 5, LOOK, move |message: StringMessage, _| {
        match Fault::from_name(&message.data) {
            Some(new) => {
                log.warn(format_args!("fault: {}", message.data));
                *fault.lock().unwrap_or_else(PoisonError::into_inner) = new;
            }
            None => log.warn(format_args!("~fault is {:?}: must be one of {}", message.data, Fault::NAMES)),
        }
    })
}
