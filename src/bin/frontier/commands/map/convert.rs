//! `frontier map convert`: any map that map_server reads, saved as map_saver saves.

use crate::exit::Outcome;
use crate::output;
use anyhow::ensure;
use clap::ValueEnum;
use frontier_explorer::grid::Thresholds;
use frontier_explorer::io::{MapImage, SaveOptions, load_map, save_map};
use std::path::PathBuf;

/// Arguments of `frontier map convert`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The YAML file of the map to read: any mode, thresholds, PGM or PNG.
    input: PathBuf,
    /// Where to write: OUTPUT.yaml and an image beside it.
    output: PathBuf,
    #[command(flatten)]
    saving: Saving,
}

/// How a map is written.
#[derive(Debug, clap::Args)]
pub struct Saving {
    /// A cell with at least this occupancy (percent) is written as occupied.
    #[arg(long, value_name = "PERCENT", default_value_t = 65, value_parser = clap::value_parser!(i8).range(1..=100))]
    occ: i8,
    /// A cell with at most this occupancy (percent) is written as free.
    #[arg(long, value_name = "PERCENT", default_value_t = 25, value_parser = clap::value_parser!(i8).range(0..=99))]
    free: i8,
    /// Kind of image to write.
    #[arg(long, value_enum, default_value_t = Format::Pgm)]
    format: Format,
}

impl Saving {
    /// The options, checked against each other.
    pub fn options(&self) -> anyhow::Result<SaveOptions> {
        let Self { occ, free, format } = *self;
        ensure!(free < occ, "--free {free} and --occ {occ}: --free must be below --occ");
        let image = match format {
            Format::Pgm => MapImage::Pgm,
            Format::Png => MapImage::Png,
        };
        Ok(SaveOptions { thresholds: Thresholds { free_max: free, occupied_min: occ }, image })
    }
}

/// Kinds of image.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// Binary greymap, as map_saver writes it.
    Pgm,
    /// Grey PNG.
    Png,
}

/// Runs `frontier map convert`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let options = args.saving.options()?;
    let map = load_map(&args.input)?;
    let saved = save_map(&args.output, &map.grid, &options)?;
    output::line(format_args!("{}", saved.yaml.display()))?;
    output::line(format_args!("{}", saved.image.display()))?;
    Ok(Outcome::Done)
}
