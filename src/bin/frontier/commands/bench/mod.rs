//! `frontier bench`: how long things take on a map.

mod decide;
mod detect;
mod timing;

use crate::exit::Outcome;
use clap::Subcommand;

/// What to time.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Whole decisions: costmap, detection, ways, goal choice, plan.
    Decide(decide::Args),
    /// Detections alone, beside one pass over the map that sums its bytes.
    Detect(detect::Args),
}

/// Runs `frontier bench`.
pub fn run(command: &Command) -> anyhow::Result<Outcome> {
    match command {
        Command::Decide(args) => decide::run(args),
        Command::Detect(args) => detect::run(args),
    }
}
