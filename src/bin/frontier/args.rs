//! The command line as clap sees it: one variant for each file in `commands`.

use crate::commands::map;
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
    /// Look at, convert and compare map_server maps.
    #[command(subcommand)]
    Map(map::Command),
}
