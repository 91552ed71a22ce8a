//! `frontier map`: map_server maps.

use crate::exit::Outcome;
use clap::Subcommand;

/// What to do with maps.
#[derive(Debug, Subcommand)]
pub enum Command {}

/// Runs `frontier map`.
pub fn run(command: &Command) -> anyhow::Result<Outcome> {
    match *command {}
}
