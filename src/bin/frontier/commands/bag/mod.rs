//! `frontier bag`: ROS 1 bags.

mod info;

use crate::exit::Outcome;
use clap::Subcommand;

/// What to do with bags.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Print topics, rates, gaps and frames, and what a replay can do with them.
    Info(info::Args),
}

/// Runs `frontier bag`.
pub fn run(command: &Command) -> anyhow::Result<Outcome> {
    match command {
        Command::Info(args) => info::run(args),
    }
}
