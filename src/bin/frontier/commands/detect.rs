//! `frontier detect`: the frontiers of a map as seen from a pose.

use crate::exit::Outcome;
use crate::{output, values};
use anyhow::Context;
use comfy_table::Table;
use frontier_explorer::explore::Position;
use frontier_explorer::frontier::{DetectionInput, DetectorKind, Frontier, Reachability};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Costmap, GridInfo, Neighbourhood};
use frontier_explorer::io::{load_map, load_preset, load_robot, write_atomic};
use frontier_explorer::report::{Overlay, OverlayFrontier, Theme};
use serde::Serialize;
use std::path::PathBuf;

/// Arguments of `frontier detect`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The map's YAML file.
    map: PathBuf,
    /// Where the robot is: X,Y or X,Y,YAW in metres and radians of the map frame.
    #[arg(long, value_name = "X,Y", value_parser = values::pose, allow_hyphen_values = true)]
    at: Pose,
    /// Preset whose detector is used: a YAML file or a built-in name.
    #[arg(long, value_name = "PRESET", default_value = "wfd")]
    config: String,
    /// Detector, instead of the preset's.
    #[arg(long, value_name = "NAME", value_parser = parse_detector, long_help = detector_help())]
    detector: Option<DetectorKind>,
    /// Robot whose costmap the detectors that look at one see: a YAML file or a name.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2")]
    robot: String,
    /// What counts as reachable: walls_block, or textbook, which leaks through walls one
    /// or two cells thick.
    #[arg(long, value_parser = parse_reachability)]
    reachability: Option<Reachability>,
    /// Adjacent cells: 4 or 8.
    #[arg(long, value_parser = parse_neighbours)]
    neighbours: Option<Neighbourhood>,
    /// Drop frontiers smaller than this, metres.
    #[arg(long, value_name = "M")]
    min_size: Option<f64>,
    /// Print JSON.
    #[arg(long)]
    json: bool,
    /// Paint the frontiers on the map: a PNG file.
    #[arg(long, value_name = "PNG")]
    overlay: Option<PathBuf>,
    /// Colours of the overlay: clear, or paper (Topiwala 2018, Fig. 7).
    #[arg(long, default_value = "clear", value_parser = parse_theme)]
    theme: Theme,
}

fn parse_detector(name: &str) -> Result<DetectorKind, String> {
    let known = DetectorKind::ALL.iter().copied().find(|kind| kind.name() == name);
    known.ok_or_else(|| format!("must be one of {}", detector_names()))
}

fn detector_names() -> String {
    DetectorKind::ALL.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(", ")
}

fn detector_help() -> String {
    format!("Detector, instead of the preset's: {}", detector_names())
}

fn parse_reachability(text: &str) -> Result<Reachability, String> {
    match text {
        "walls_block" => Ok(Reachability::WallsBlock),
        "textbook" => Ok(Reachability::Textbook),
        _ => Err("must be walls_block or textbook".to_owned()),
    }
}

fn parse_neighbours(text: &str) -> Result<Neighbourhood, String> {
    text.parse::<u8>().map_err(|_| "must be 4 or 8".to_owned()).and_then(Neighbourhood::try_from)
}

fn parse_theme(text: &str) -> Result<Theme, String> {
    Theme::from_name(text).ok_or_else(|| "must be clear or paper".to_owned())
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Detection {
    grid: Grid,
    detector: &'static str,
    reachability: Reachability,
    frontiers: Vec<Row>,
}

#[derive(Debug, Serialize)]
struct Grid {
    width: usize,
    height: usize,
    resolution_m: f64,
    origin: Pose,
}

#[derive(Debug, Serialize)]
struct Row {
    id: u64,
    goal: Position,
    size_cells: usize,
    size_m: f64,
    distance_m: f64,
}

/// Runs `frontier detect`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let mut settings = load_preset(&args.config)?.explorer;
    let detector = &mut settings.detector;
    detector.name = args.detector.unwrap_or(detector.name);
    detector.reachability = args.reachability.unwrap_or(detector.reachability);
    detector.neighbours = args.neighbours.unwrap_or(detector.neighbours);
    detector.min_size_m = args.min_size.unwrap_or(detector.min_size_m);
    settings.validate()?;
    let grid = load_map(&args.map)?.grid;
    let costmap = Costmap::inflate(&grid, &settings.thresholds, &load_robot(&args.robot)?.inflation());
    let mut detector = settings.detector.name.build(&settings.detector_params());
    let frontiers = detector
        .detect(&DetectionInput { costmap: Some(&costmap), ..DetectionInput::new(&grid, args.at) })
        .with_context(|| args.map.display().to_string())?;
    let info = grid.info();
    let goals: Vec<_> =
        frontiers.iter().map(|f| settings.goal.representative.of(f, info, args.at.position())).collect();
    if let Some(file) = &args.overlay {
        let shown: Vec<OverlayFrontier<'_>> = frontiers
            .iter()
            .zip(&goals)
            .map(|(f, &goal)| OverlayFrontier { cells: &f.cells, goal: Some(goal), taboo: false })
            .collect();
        let overlay = Overlay {
            grid: &grid,
            thresholds: &settings.thresholds,
            frontiers: &shown,
            robot_in_map: Some(args.at),
            region: settings.region.as_ref(),
            theme: args.theme,
        };
        write_atomic(file, &overlay.to_png()?).with_context(|| format!("cannot write {}", file.display()))?;
    }
    let row = |(f, &goal): (&Frontier, &frontier_explorer::geometry::Point)| Row {
        id: f.id,
        goal: goal.into(),
        size_cells: f.cells.len(),
        size_m: f.size_m(info),
        distance_m: args.at.distance_to(goal),
    };
    let mut rows: Vec<Row> = frontiers.iter().zip(&goals).map(row).collect();
    rows.sort_by(|a, b| a.distance_m.total_cmp(&b.distance_m).then(a.id.cmp(&b.id)));
    print(args, info, detector.name(), settings.detector.reachability, rows)
}

fn print(
    args: &Args,
    info: &GridInfo,
    detector: &'static str,
    reachability: Reachability,
    frontiers: Vec<Row>,
) -> anyhow::Result<Outcome> {
    if args.json {
        let (width, height) = (info.width(), info.height());
        let grid = Grid { width, height, resolution_m: info.resolution_m(), origin: info.origin_in_map() };
        output::json(&Detection { grid, detector, reachability, frontiers })?;
        return Ok(Outcome::Done);
    }
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(["id", "goal x (m)", "goal y (m)", "cells", "size (m)", "distance (m)"]);
    for column in table.column_iter_mut() {
        column.set_cell_alignment(comfy_table::CellAlignment::Right);
    }
    for row in &frontiers {
        table.add_row([
            row.id.to_string(),
            format!("{:.2}", row.goal.x),
            format!("{:.2}", row.goal.y),
            row.size_cells.to_string(),
            format!("{:.2}", row.size_m),
            format!("{:.2}", row.distance_m),
        ]);
    }
    output::line(format_args!("{table}"))?;
    let count = frontiers.len();
    output::line(format_args!("{count} frontiers, nearest first ({detector}, reachability {})", name(reachability)))?;
    Ok(Outcome::Done)
}

const fn name(reachability: Reachability) -> &'static str {
    match reachability {
        Reachability::Textbook => "textbook",
        Reachability::WallsBlock => "walls_block",
    }
}
