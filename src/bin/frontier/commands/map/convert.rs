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

/// Kinds of image.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum Format {
    /// Binary greymap, as map_saver writes it.
    Pgm,
    /// Grey PNG.
    Png,
}

impl From<Format> for MapImage {
    fn from(format: Format) -> Self {
        match format {
            Format::Pgm => Self::Pgm,
            Format::Png => Self::Png,
        }
    }
}

/// Checks the two thresholds against each other.
pub fn check_thresholds(free: i8, occ: i8) -> anyhow::Result<()> {
    ensure!(free < occ, "--free {free} and --occ {occ}: --free must be below --occ");
    Ok(())
}

/// Runs `frontier map convert`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    check_thresholds(args.free, args.occ)?;
    let map = load_map(&args.input)?;
    let options = SaveOptions {
        thresholds: Thresholds { free_max: args.free, occupied_min: args.occ },
        image: args.format.into(),
    };
    let saved = save_map(&args.output, &map.grid, &options)?;
    output::line(format_args!("{}", saved.yaml.display()))?;
    output::line(format_args!("{}", saved.image.display()))?;
    Ok(Outcome::Done)
}
