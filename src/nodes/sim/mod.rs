//! `sim_node`: the simulator behind ROS, in the place of a robot with gmapping and
//! move_base.
//!
//! By default it is as unkind as they are, as far as is known: the pose and the map err as
//! gmapping's do (`~slam`, [`crate::sim::SlamKind`]), and a stand-in for move_base refuses,
//! waits and fails ([`crate::sim::MoveBase`]). `docs/simulator.md` tells how both were
//! compared and in what they are still kinder. `~slam` perfect and `~driver` navigator make
//! it kind, for what needs exactness.

mod error;
mod make_plan;
mod move_base_server;
mod params;
mod plan;
mod simulator;
mod topics;

pub use error::SimNodeError;

use crate::ros::Node;
use crate::ros::program::{has_helped, run_program};
use crate::sim::DriverKind;
use params::SimParams;
use simulator::Simulator;

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
    let stats = simulator.stats();
    node.log().info(format_args!(
        "{:.0} s simulated, {:.1} m driven, {} collisions, {:.2} % of the reachable area seen",
        stats.sim_time_s,
        stats.distance_m,
        stats.collisions,
        100.0 * stats.coverage
    ));
    Ok(())
}
