//! `frontier map build`: a map from the scans and the odometry of a bag.

use crate::exit::Outcome;
use crate::{bags, output, values};
use anyhow::{Context, bail};
use frontier_explorer::geometry::Point;
use frontier_explorer::grid::Thresholds;
use frontier_explorer::io::{SaveOptions, save_map, write_atomic};
use frontier_explorer::mapping::BuilderConfig;
use frontier_explorer::replay::{Inputs, Verdict, Wanted};
use frontier_explorer::report::{Picture, Theme};
use std::path::PathBuf;

/// The way is looked at this often, seconds.
const LOOK_S: f64 = 0.1;

/// Arguments of `frontier map build`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The bag, with scans and the transforms of odometry.
    bag: PathBuf,
    /// Where to write: FILE.yaml, the image and a picture with the way beside it.
    #[arg(short, value_name = "FILE", default_value = "map")]
    output: PathBuf,
    /// The topic of the scans, instead of the one that is guessed.
    #[arg(long, value_name = "TOPIC")]
    scan_topic: Option<String>,
    /// The robot's frame, instead of the one that is guessed.
    #[arg(long, value_name = "FRAME")]
    pose_frame: Option<String>,
    /// Edge length of a cell, metres.
    #[arg(long, value_name = "M", default_value = "0.05", value_parser = values::positive_metres, allow_negative_numbers = true)]
    resolution: f64,
    /// Readings beyond this only clear what lies before it, metres; the lidar's own limit,
    /// or 100 m, when left out.
    #[arg(long, value_name = "M", value_parser = values::positive_metres, allow_negative_numbers = true)]
    max_range: Option<f64>,
    /// Believe odometry and match nothing: the picture before.
    #[arg(long)]
    odometry_only: bool,
}

/// Runs `frontier map build`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let summary = bags::summary(&args.bag)?;
    let wanted =
        Wanted { scan_topic: args.scan_topic.clone(), pose_frame: args.pose_frame.clone(), ..Wanted::default() };
    let mut inputs = Inputs::of(&summary, &wanted)?;
    inputs.forget_map();
    bags::warn(&summary, &inputs)?;
    let verdict = Verdict::of(&summary, &inputs).map_build;
    let missing = verdict.err().unwrap_or_default();
    let (Some(scans), Some(odom), Some(base), true) =
        (&inputs.scan_topic, &inputs.odom_frame, &inputs.base_frame, missing.is_empty())
    else {
        bail!("{}: frontier map build: no, {missing}", args.bag.display());
    };
    output::line(format_args!("scans on {scans}, odometry from {odom} to {base}"))?;
    let config = BuilderConfig {
        is_matching: !args.odometry_only,
        max_range_m: args.max_range.unwrap_or(f64::INFINITY),
        ..BuilderConfig::with_resolution(args.resolution)
    };
    let mut player = bags::player(&args.bag, &summary, &inputs, config)?;
    let mut way: Vec<Point> = Vec::new();
    let (mut now_s, mut last) = (0.0, None);
    while let Some(next_s) = player.next_time_s()? {
        now_s = player.play_to(next_s.max(now_s + LOOK_S))?;
        if let Ok(pose) = player.pose(now_s) {
            last = Some(pose);
            if way.last().is_none_or(|&last| pose.distance_to(last) > 0.05) {
                way.push(pose.position());
            }
        }
    }
    let Some((mapping, grid)) = player.mapping().and_then(|mapping| Some((mapping, mapping.map()?))) else {
        bail!("{}: {}", args.bag.display(), player.why_no_map());
    };
    let saved = save_map(&args.output, &grid, &SaveOptions::default())?;
    let picture = Picture {
        grid: &grid,
        thresholds: &Thresholds::default(),
        trajectory: &way,
        start_in_map: None,
        end_in_map: last,
        goals: &[],
        region: None,
        no_go: &[],
        theme: Theme::Clear,
    };
    let png = saved.yaml.with_extension("way.png");
    write_atomic(&png, &picture.to_png()?).with_context(|| format!("cannot write {}", png.display()))?;
    bags::tell_scans(&player)?;
    for file in [&saved.yaml, &saved.image, &png] {
        output::line(format_args!("  {}", file.display()))?;
    }
    // A map of less than half of the scans is not what was asked for.
    Ok(if 2 * mapping.without_pose() > mapping.seen() { Outcome::Incomplete } else { Outcome::Done })
}
