//! `sim_node`: the simulator behind ROS, in the place of a robot with gmapping and
//! move_base.
//!
//! By default it is as unkind as they are, as far as is known: the pose and the map err as
//! gmapping's do (`~slam`, [`crate::sim::SlamKind`]), and a stand-in for move_base refuses,
//! waits and fails ([`crate::sim::MoveBase`]). `docs/simulator.md` tells how both were
//! compared and in what they are still kinder. `~slam` perfect and `~driver` navigator make
//! it kind, for what needs exactness.

mod goal_book;
mod move_base;
mod params;
mod topics;

pub use params::{Fault, SimParams, SimParamsError};

use super::Feed;
use super::convert;
use super::msg::geometry_msgs::Twist as TwistMessage;
use super::msg::std_msgs::String as StringMessage;
use super::node::{Node, NodeError};
use super::program::{has_helped, run_program};
use crate::geometry::Twist;
use crate::io::{MapError, SettingsFileError, load_preset, load_robot, load_world};
use crate::navigation::Navigator;
use crate::sim::{
    Driver, DriverKind, InflatedPlanner, MapperError, OdometryNoise, Plant, SimConfig, SimError, World, WorldError,
};
use move_base::MoveBaseServer;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};
use topics::Topics;

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

/// Why the simulator cannot run.
#[derive(Debug, thiserror::Error)]
pub enum SimNodeError {
    /// ROS refuses.
    #[error(transparent)]
    Node(#[from] NodeError),
    /// A parameter is wrong.
    #[error(transparent)]
    Params(#[from] SimParamsError),
    /// A robot or a preset cannot be had.
    #[error(transparent)]
    Settings(#[from] SettingsFileError),
    /// The world cannot be read.
    #[error("parameter ~world: {0}")]
    WorldFile(#[from] MapError),
    /// The map is no world.
    #[error("parameter ~world: {0}")]
    World(#[from] WorldError),
    /// The simulation cannot begin.
    #[error(transparent)]
    Sim(#[from] SimError),
    /// The map cannot grow any more.
    #[error(transparent)]
    Mapper(#[from] MapperError),
}

const HELP: &str = "\
sim_node: a simulated robot with a mapper and a stand-in for move_base

Usage: sim_node [_PARAMETER:=VALUE]... [TOPIC:=OTHER]... [__name:=NAME] [__ns:=NAMESPACE]

  _world:=office         office, museum, maze, warehouse, or a map_server YAML file
  _robot:=turtlebot2     a robot or a YAML file
  _start:=[X, Y, YAW]    where it begins, metres and radians
  _speed:=1.0            times as fast as real time; needs /use_sim_time unless 1
  _slam:=matched         or perfect: the true pose, a map without errors once a second
  _move_base:=true       play the part of move_base

docs/ros.md has all of them.
";

/// Runs the simulator until it is told to stop; returns the exit code.
#[must_use]
pub fn sim_node() -> u8 {
    if has_helped(|| HELP.to_owned()) {
        return 0;
    }
    run_program("sim", |node| simulate_with(node).map(|()| 0))
}

/// Simulates with a node that has begun, as [`sim_node`] does.
///
/// # Errors
/// [`SimNodeError`] when its parameters or ROS do not let it.
pub fn simulate_with(node: &Node) -> Result<(), SimNodeError> {
    let params = SimParams::from_tree(node.private_params()?)?;
    let mut simulator = Simulator::new(node, &params)?;
    node.log().info(format_args!(
        "simulating {} in {}, {} times as fast as real time; {}",
        params.robot,
        params.world,
        params.speed,
        match (params.move_base, params.driver) {
            (false, _) => "without a move_base",
            (true, DriverKind::MoveBase) => "with a stand-in for move_base",
            (true, DriverKind::Navigator) => "move_base is played by our own navigator",
        }
    ));
    simulator.run()?;
    let stats = simulator.plant.stats();
    node.log().info(format_args!(
        "{:.0} s simulated, {:.1} m driven, {} collisions, {:.2} % of the reachable area seen",
        stats.sim_time_s,
        stats.distance_m,
        stats.collisions,
        100.0 * stats.coverage
    ));
    Ok(())
}

/// A command from outside, and when it came, simulated seconds.
#[derive(Clone, Copy, Debug, Default)]
struct Received {
    twist: Twist,
    count: u64,
}

/// Something that happens again and again in simulated time.
struct Every {
    period_s: f64,
    next_s: f64,
}

impl Every {
    const fn new(period_s: f64) -> Self {
        Self { period_s, next_s: 0.0 }
    }

    /// Whether it happens now; if so, the time after is set. The plant counts whole
    /// microseconds.
    fn is_due(&mut self, now_s: f64) -> bool {
        let is_due = self.next_s <= now_s + 1e-6;
        if is_due {
            self.next_s = now_s + self.period_s;
        }
        is_due
    }
}

struct Simulator {
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
    fn new(node: &Node, params: &SimParams) -> Result<Self, SimNodeError> {
        let (robot, preset) = (load_robot(&params.robot)?, load_preset(&params.config)?);
        let (truth, _) = load_world(&params.world)?;
        let navigation = &preset.navigation;
        let noise = |[turn_by_turn, turn_by_drive, drive_by_drive, drive_by_turn]: [f64; 4]| OdometryNoise {
            turn_by_turn,
            turn_by_drive,
            drive_by_drive,
            drive_by_turn,
        };
        let mut config = SimConfig {
            seed: params.seed,
            lidar_noise_std_m: params.lidar_noise,
            control_period_s: navigation.navigator.control_period_s,
            thresholds: preset.explorer.thresholds,
            odometry_noise: params.odometry_noise.map(noise),
            driver: params.driver,
            ..SimConfig::default()
        };
        config.mapper.style = params.map_style;
        config.slam.kind = params.slam;
        config.mapper.resolution_m = truth.info().resolution_m();
        // As map_server reads it, whatever the preset makes of the map that comes of it.
        let world = Arc::new(World::new(&truth, &SimConfig::default().thresholds)?);
        let start = params.start_pose()?.unwrap_or_else(|| world.most_open_spot());
        let plant = Plant::new(world, &robot, config, start)?;
        let with_clock = params.speed != 1.0 || node.is_simulated_time();
        let epoch_s = if with_clock { EPOCH_S } else { node.now_s() };
        let topics = Topics::offer(node, &robot, &params.base_frame, with_clock)?;
        let body = robot.body();
        let planner = || preset.explorer.planner.build(&body);
        let server = if params.move_base {
            let own = Navigator::new(navigation.navigator, planner(), navigation.controller.build(&body), &body);
            let driver = Driver::new(params.driver, config.move_base, &robot, params.seed, own);
            let planner = match params.driver {
                DriverKind::Navigator => planner(),
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

    fn run(&mut self) -> Result<(), SimNodeError> {
        // What is told to others is told as often in real time, however fast time flies.
        let fast = self.speed.max(1.0);
        let mut began = Instant::now();
        let mut clock = Every::new(CLOCK_PERIOD_S * fast);
        let mut tf = Every::new(TF_PERIOD_S * fast);
        let mut control = Every::new(self.control_period_s);
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
                let next_s = self.plant.next_s().min(control.next_s).min(clock.next_s).min(tf.next_s);
                self.plant.drive_until_s(&self.twist, next_s);
                let sensed = self.plant.sense()?;
                let (now_s, stamp_s, fault) = (self.plant.now_s(), self.stamp_s(), self.fault());
                if clock.is_due(now_s) {
                    self.topics.tell_clock(stamp_s);
                }
                if tf.is_due(now_s) {
                    self.topics.tell_odometry(&self.plant, stamp_s, fault != Fault::DropTf);
                }
                if sensed.scan {
                    self.topics.tell_scan(&self.plant, stamp_s);
                }
                if sensed.map && fault != Fault::StopMap {
                    self.tell_map();
                }
                if control.is_due(now_s) {
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
    node.listen_seldom("cmd_vel", 5, LOOK, move |message: TwistMessage, caller| {
        // What we tell onlookers comes back to us.
        if caller != own {
            let mut received = received.lock().unwrap_or_else(PoisonError::into_inner);
            *received = Received { twist: convert::twist(&message), count: received.count + 1 };
        }
    })
}

fn listen_to_faults(node: &Node, fault: &Arc<Mutex<Fault>>) -> Feed {
    let (fault, log) = (Arc::clone(fault), node.log().clone());
    node.listen_seldom("~fault", 5, LOOK, move |message: StringMessage, _| match Fault::from_name(&message.data) {
        Some(new) => {
            log.warn(format_args!("fault: {}", message.data));
            *fault.lock().unwrap_or_else(PoisonError::into_inner) = new;
        }
        None => log.warn(format_args!("~fault is {:?}: must be one of {}", message.data, Fault::NAMES)),
    })
}
