//! `frontier map`: map_server maps.

mod build;
mod convert;
mod diff;
mod info;
mod picture;
mod save;

use crate::exit::Outcome;
use crate::output;
use clap::Subcommand;
use frontier_explorer::replay::Player;

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

/// What became of the scans of a bag.
pub fn tell_scans(player: &Player) -> anyhow::Result<()> {
    let Some(mapping) = player.mapping() else { return Ok(()) };
    let (taken, unmatched) = mapping.taken();
    let without = mapping.without_pose();
    output::line(format_args!(
        "{taken} scans taken in, {unmatched} of them placed by odometry alone, {without} without a place in tf"
    ))?;
    for left_out in mapping.left_out() {
        output::line(format_args!("warning: {left_out}"))?;
    }
    Ok(())
}
