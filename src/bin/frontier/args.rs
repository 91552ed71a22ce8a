//! The command line as clap sees it: one variant for each file in `commands`.

use crate::commands::{bag, bench, compare, ctl, demo, detect, doctor, explore, map, replay, shell};
use clap::{Parser, Subcommand};

/// Frontier exploration without a robot: worlds, maps and bags.
#[derive(Debug, Parser)]
#[command(name = "frontier", version, about, max_term_width = 100)]
pub struct Args {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Explore a world with a simulated robot that knows nothing, and save the map.
    Explore(explore::Args),
    /// Compare presets over worlds, starts and seeds.
    Compare(compare::Args),
    /// Show the ROS nodes at work, with a master of their own: no ROS is needed.
    Demo(demo::Args),
    /// Look at a running ROS graph: what keeps an exploration from running, and how to mend it.
    Doctor(doctor::Args),
    /// Ask a running explorer for something: start, pause, status and so on.
    Ctl(ctl::Args),
    /// Find the frontiers of a map as seen from a pose.
    Detect(detect::Args),
    /// Look at, convert and compare map_server maps.
    #[command(subcommand)]
    Map(map::Command),
    /// Explore a recording: what would have been decided, when and why.
    Replay(replay::Args),
    /// Look into ROS 1 bags.
    #[command(subcommand)]
    Bag(bag::Command),
    /// Time decisions on a map.
    #[command(subcommand)]
    Bench(bench::Command),
    /// Print completions for a shell.
    Completions(shell::CompletionsArgs),
    /// Write man pages.
    Man(shell::ManArgs),
}
