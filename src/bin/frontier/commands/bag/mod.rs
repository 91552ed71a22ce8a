//! `frontier bag`: ROS 1 bags.

mod info;

use crate::exit::Outcome;
use crate::output;
use anyhow::Context;
use clap::Subcommand;
use frontier_explorer::bag::{BagReader, Summary, open_bag};
use frontier_explorer::replay::{Clock, Inputs};
use std::fs::File;
use std::path::Path;

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

/// Opens a bag.
pub fn open(path: &Path) -> anyhow::Result<Box<dyn BagReader>> {
    let file = File::open(path).with_context(|| format!("cannot read {}", path.display()))?;
    let is_file = file.metadata().with_context(|| format!("cannot read {}", path.display()))?.is_file();
    anyhow::ensure!(is_file, "{} is no file: must be a bag", path.display());
    open_bag(path, file).with_context(|| path.display().to_string())
}

/// Looks through a bag.
pub fn summary(path: &Path) -> anyhow::Result<Summary> {
    Summary::of(open(path)?.as_mut()).with_context(|| path.display().to_string())
}

/// Prints what is wrong with a bag, and odd about it.
pub fn warn(summary: &Summary, inputs: &Inputs) -> anyhow::Result<()> {
    let clock = Clock::of(summary, inputs).notes();
    let mut warnings = summary.warnings().chain(&clock);
    warnings.try_for_each(|warning| output::line(format_args!("warning: {warning}")))
}
