//! `explore_node`: autonomous frontier exploration behind ROS 1.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(frontier_explorer::nodes::explore_node())
}
