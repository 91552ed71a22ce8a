//! `frontier map`: map_server maps.

mod build;
mod convert;
mod diff;
mod info;
mod picture;
mod save;

use crate::exit::Outcome;
use clap::Subcommand;

/// What to do with maps.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Print size, resolution, origin and the areas known and unknown.
    Info(info::Args),
    /// Make a map from the scans and the odometry of a bag.
    Build(build::Args),
    /// Write a map anew, as map_saver would save it.
    Convert(convert::Args),
    /// Wait for a map on a ROS topic and save it, as map_saver does.
    Save(save::Args),
    /// Compare two maps place by place; exit code 1 when they differ.
    Diff(diff::Args),
}

/// Runs `frontier map`.
pub fn run(command: &Command) -> anyhow::Result<Outcome> {
    match command {
        Command::Info(args) => info::run(args),
        Command::Build(args) => build::run(args),
        Command::Convert(args) => convert::run(args),
        Command::Save(args) => save::run(args),
        Command::Diff(args) => diff::run(args),
    }
}
