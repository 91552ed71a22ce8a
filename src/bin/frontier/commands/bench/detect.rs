//! `frontier bench detect`: how long a detection takes on a map, without reading its file.

use super::timing::Times;
use crate::exit::Outcome;
use crate::{output, values};
use anyhow::{Context, bail};
use comfy_table::{CellAlignment, Table};
use frontier_explorer::frontier::{DetectionInput, DetectorKind};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::Costmap;
use frontier_explorer::io::{load_map, load_preset, load_robot};
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of `frontier bench detect`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The map's YAML file.
    map: PathBuf,
    /// Where the robot is: X,Y or X,Y,YAW in metres and radians of the map frame.
    #[arg(long, value_name = "X,Y", value_parser = values::pose, allow_hyphen_values = true)]
    at: Pose,
    /// Detector: a name, or all.
    #[arg(long, value_name = "NAME", default_value = "all")]
    detector: String,
    /// Preset whose settings the detectors have: a YAML file or a built-in name.
    #[arg(long, value_name = "PRESET", default_value = "wfd")]
    config: String,
    /// Robot whose costmap the detectors that look at one see: a YAML file or a name.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2")]
    robot: String,
    /// How often each one detects.
    #[arg(long, default_value_t = 51, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Bench {
    cells: usize,
    runs: u32,
    /// One pass over the map that sums its bytes.
    byte_sum: Times,
    detectors: Vec<Timing>,
}

/// The times of one detector, built anew for each map, so that nothing is known before.
#[derive(Debug, Serialize)]
struct Timing {
    detector: &'static str,
    frontiers: usize,
    #[serde(flatten)]
    times: Times,
    /// The median as a multiple of the byte sum's.
    byte_sums: f64,
}

/// Runs `frontier bench detect`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let kinds = detectors(&args.detector)?;
    let settings = load_preset(&args.config)?.explorer;
    let params = settings.detector_params();
    let grid = load_map(&args.map)?.grid;
    let costmap = Costmap::inflate(&grid, &settings.thresholds, &load_robot(&args.robot)?.inflation());
    let input = DetectionInput { costmap: Some(&costmap), ..DetectionInput::new(&grid, args.at) };
    let byte_sum = Times::measure(args.runs, || grid.data().iter().map(|&value| i64::from(value)).sum::<i64>());
    let mut timings = Vec::new();
    for kind in kinds {
        let mut detector = kind.build(&params);
        let frontiers = detector.detect(&input).with_context(|| args.map.display().to_string())?.len();
        let times = Times::measure(args.runs, || {
            // On the same map again a detector that remembers it would have nothing to do.
            detector.forget();
            detector.detect(&input)
        });
        let byte_sums = times.median_ms / byte_sum.median_ms.max(f64::MIN_POSITIVE);
        timings.push(Timing { detector: kind.name(), frontiers, times, byte_sums });
    }
    print(args, &Bench { cells: grid.data().len(), runs: args.runs, byte_sum, detectors: timings })
}

/// The detectors that a name stands for.
fn detectors(name: &str) -> anyhow::Result<Vec<DetectorKind>> {
    let all = DetectorKind::ALL.iter().copied();
    let found: Vec<_> = all.clone().filter(|kind| name == "all" || kind.name() == name).collect();
    if found.is_empty() {
        let names: Vec<_> = all.map(DetectorKind::name).collect();
        bail!("detector {name:?}: must be all or one of {}", names.join(", "));
    }
    Ok(found)
}

fn print(args: &Args, bench: &Bench) -> anyhow::Result<Outcome> {
    if args.json {
        output::json(bench)?;
        return Ok(Outcome::Done);
    }
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["detector", "frontiers", "median (ms)", "min (ms)", "90 % (ms)", "byte sums"]);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    let mut row = |name: &str, frontiers: String, times: Times, byte_sums: f64| {
        let ms = |value: f64| format!("{value:.3}");
        let times = [times.median_ms, times.min_ms, times.p90_ms].map(ms);
        let [median, min, p90] = times;
        table.add_row([name.to_owned(), frontiers, median, min, p90, format!("{byte_sums:.1}")]);
    };
    row("byte sum", String::new(), bench.byte_sum, 1.0);
    for t in &bench.detectors {
        row(t.detector, t.frontiers.to_string(), t.times, t.byte_sums);
    }
    output::line(format_args!("{table}"))?;
    output::line(format_args!("{} cells, {} runs each", bench.cells, bench.runs))?;
    Ok(Outcome::Done)
}
