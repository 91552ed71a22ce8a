//! `frontier bench decide`: how long a decision takes on a map.

use super::timing::Times;
use crate::exit::Outcome;
use crate::{output, values};
use anyhow::{Context, bail};
use comfy_table::Table;
use frontier_explorer::config::{Preset, RobotConfig};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::OccupancyGrid;
use frontier_explorer::io::{load_map, load_preset, load_robot};
use frontier_explorer::robot::{MapSnapshot, Navigation, NavigationState, Observation};
use serde::Serialize;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// Arguments of `frontier bench decide`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The map's YAML file.
    map: PathBuf,
    /// Where the robot is: X,Y or X,Y,YAW in metres and radians of the map frame.
    #[arg(long, value_name = "X,Y", value_parser = values::pose, allow_hyphen_values = true)]
    at: Pose,
    /// Preset: a YAML file, a built-in name, or all.
    #[arg(long, value_name = "PRESET", default_value = "all")]
    config: String,
    /// The robot: a YAML file or a built-in name.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2")]
    robot: String,
    /// How often each one decides.
    #[arg(long, default_value_t = 21, value_parser = clap::value_parser!(u32).range(1..))]
    runs: u32,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// The times of one preset.
#[derive(Debug, Serialize)]
struct Timing {
    preset: String,
    frontiers: usize,
    #[serde(flatten)]
    times: Times,
}

/// Runs `frontier bench decide`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let grid = Arc::new(load_map(&args.map)?.grid);
    let robot = load_robot(&args.robot)?;
    let names: Vec<String> = match args.config.as_str() {
        "all" => Preset::names().map(str::to_owned).collect(),
        name => vec![name.to_owned()],
    };
    let mut timings = Vec::new();
    for name in names {
        let preset = load_preset(&name)?;
        timings.push(time_decisions(args, &preset, &robot, &grid).with_context(|| format!("preset {name}"))?);
    }
    if args.json {
        output::json(&timings)?;
        return Ok(Outcome::Done);
    }
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["preset", "frontiers", "median (ms)", "min (ms)", "90 % (ms)"]);
    for t in &timings {
        let ms = |value: f64| format!("{value:.1}");
        table.add_row([
            t.preset.clone(),
            t.frontiers.to_string(),
            ms(t.times.median_ms),
            ms(t.times.min_ms),
            ms(t.times.p90_ms),
        ]);
    }
    output::line(format_args!("{table}"))?;
    Ok(Outcome::Done)
}

/// Times the first decision of an explorer, and the same again with a map of its own
/// each time: nothing is kept from run to run but what the explorer itself keeps.
fn time_decisions(
    args: &Args,
    preset: &Preset,
    robot: &RobotConfig,
    grid: &Arc<OccupancyGrid>,
) -> anyhow::Result<Timing> {
    let mut settings = preset.explorer.clone();
    settings.turns.at_start = false;
    let mut times_ms = Vec::new();
    let mut frontiers = 0;
    for run in 0..=args.runs {
        let mut explorer = Explorer::new(settings.clone(), &robot.traits())?;
        let stamp_s = f64::from(run);
        let observation = Observation {
            stamp_s,
            pose_in_map: Ok(args.at),
            map: Some(MapSnapshot::alone(stamp_s, u64::from(run), Arc::clone(grid))),
            scan: None,
            navigation: Navigation { command: 0, state: NavigationState::Idle },
        };
        let began = Instant::now();
        let decision = explorer.step(&observation);
        let took_ms = began.elapsed().as_secs_f64() * 1e3;
        let Some(record) = decision.record else {
            bail!("no decision is possible at ({}, {}) m of {}", args.at.x, args.at.y, args.map.display());
        };
        frontiers = record.candidates.len();
        // The first one warms the caches.
        if run > 0 {
            times_ms.push(took_ms);
        }
    }
    Ok(Timing { preset: preset.preset.clone(), frontiers, times: Times::of(times_ms) })
}
