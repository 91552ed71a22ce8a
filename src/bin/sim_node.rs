//! `sim_node`: a simulated robot with a mapper and a stand-in for move_base, behind
//! ROS 1.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(frontier_explorer::nodes::sim_node())
}
