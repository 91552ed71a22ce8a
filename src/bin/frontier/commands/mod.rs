//! One file for each command.

pub mod map;

use crate::args::Command;
use crate::exit::Outcome;

/// Runs a parsed command.
pub fn run(command: Command) -> anyhow::Result<Outcome> {
    match command {
        Command::Map(command) => map::run(&command),
    }
}
