//! `frontier`: exploration of maps, worlds and bags without a ROS installation.

mod args;
mod bags;
mod commands;
mod exit;
mod inputs;
mod output;
mod ros_node;
mod stop;
mod values;

use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = args::Args::parse();
    exit::code(commands::run(args.command))
}
