//! `frontier map info`: what a map holds.

use crate::exit::Outcome;
use crate::output;
use frontier_explorer::grid::Thresholds;
use frontier_explorer::io::{LoadedMap, MapMode, load_map};
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of `frontier map info`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The map's YAML file.
    map: PathBuf,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What is printed; with `--json`, these are the keys.
#[derive(Debug, Serialize)]
struct Info {
    image: PathBuf,
    mode: MapMode,
    negate: bool,
    occupied_thresh: f64,
    free_thresh: f64,
    width_cells: usize,
    height_cells: usize,
    width_m: f64,
    height_m: f64,
    resolution_m: f64,
    origin_in_map: frontier_explorer::geometry::Pose,
    known_m2: f64,
    free_m2: f64,
    occupied_m2: f64,
    unknown_m2: f64,
}

impl Info {
    fn new(map: LoadedMap) -> Self {
        let grid = map.grid.info();
        let census = map.grid.census(&Thresholds::default());
        let area_m2 = |cells: usize| rounded(cells as f64 * grid.cell_area_m2());
        Self {
            mode: map.yaml.mode,
            negate: map.yaml.negate,
            occupied_thresh: map.yaml.occupied_thresh,
            free_thresh: map.yaml.free_thresh,
            width_cells: grid.width(),
            height_cells: grid.height(),
            width_m: rounded(grid.width() as f64 * grid.resolution_m()),
            height_m: rounded(grid.height() as f64 * grid.resolution_m()),
            resolution_m: grid.resolution_m(),
            origin_in_map: grid.origin_in_map(),
            known_m2: area_m2(census.known()),
            free_m2: area_m2(census.free),
            occupied_m2: area_m2(census.occupied),
            unknown_m2: area_m2(census.unknown),
            image: map.image_path,
        }
    }
}

/// To a millionth: sums of many cells show the dirt of binary fractions.
fn rounded(value: f64) -> f64 {
    (value * 1e6).round() / 1e6
}

/// Runs `frontier map info`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let info = Info::new(load_map(&args.map)?);
    if args.json {
        output::json(&info)?;
        return Ok(Outcome::Done);
    }
    let origin = info.origin_in_map;
    output::line(format_args!("image       {}", info.image.display()))?;
    output::line(format_args!("mode        {}{}", info.mode, if info.negate { ", negated" } else { "" }))?;
    output::line(format_args!("thresholds  free below {}, occupied above {}", info.free_thresh, info.occupied_thresh))?;
    output::line(format_args!(
        "size        {} x {} cells, {:.2} x {:.2} m",
        info.width_cells, info.height_cells, info.width_m, info.height_m
    ))?;
    output::line(format_args!("resolution  {} m per cell", info.resolution_m))?;
    output::line(format_args!("origin      x {} m, y {} m, yaw {} rad", origin.x, origin.y, origin.yaw))?;
    output::line(format_args!("known       {:.2} m2", info.known_m2))?;
    output::line(format_args!("  free      {:.2} m2", info.free_m2))?;
    output::line(format_args!("  occupied  {:.2} m2", info.occupied_m2))?;
    output::line(format_args!("unknown     {:.2} m2", info.unknown_m2))?;
    Ok(Outcome::Done)
}
