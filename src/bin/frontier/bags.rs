//! Bags that commands read: how they are opened, played, and what is said of them.

use crate::output;
use anyhow::Context;
use frontier_explorer::bag::{BagReader, Summary, open_bag};
use frontier_explorer::mapping::BuilderConfig;
use frontier_explorer::replay::{Clock, Inputs, Player};
use std::fs::File;
use std::path::Path;

/// Opens a bag.
fn open(path: &Path) -> anyhow::Result<Box<dyn BagReader>> {
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

/// A player at the begin of a bag, which makes a map of the scans where the inputs have none.
pub fn player(path: &Path, summary: &Summary, inputs: &Inputs, scans: BuilderConfig) -> anyhow::Result<Player> {
    let mut player = Player::new(open(path)?, summary, inputs.clone());
    if inputs.map_topic.is_none() {
        player.map_scans(scans, summary);
    }
    Ok(player)
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
