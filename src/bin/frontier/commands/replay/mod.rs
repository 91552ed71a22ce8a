//! `frontier replay`: the explorer over a recording, and what it would have decided.

mod comparison;
mod out_bag;
mod recorder;

use super::bag;
use crate::exit::Outcome;
use crate::{inputs, output, values};
use anyhow::{Context, bail};
use frontier_explorer::bag::Summary;
use frontier_explorer::explore::{Explorer, run as explore};
use frontier_explorer::io::{SaveOptions, save_map, write_atomic};
use frontier_explorer::replay::{BagRobot, Inputs, Player, Wanted};
use frontier_explorer::report::{Animation, HtmlReport, Picture, RunRecord, Theme};
use out_bag::OutBag;
use recorder::Recorder;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Arguments of `frontier replay`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The bag.
    bag: PathBuf,
    /// How to explore: a YAML file, or the name of a built-in preset.
    #[arg(long, value_name = "PRESET", default_value = "wfd")]
    config: String,
    /// The robot: a YAML file, or the name of a built-in robot.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2")]
    robot: String,
    /// The topic of the map, instead of the one that is guessed.
    #[arg(long, value_name = "TOPIC")]
    map_topic: Option<String>,
    /// The robot's frame, instead of the one that is guessed.
    #[arg(long, value_name = "FRAME")]
    pose_frame: Option<String>,
    /// The map's frame, instead of the one in the map's headers.
    #[arg(long, value_name = "FRAME")]
    map_frame: Option<String>,
    /// As many times as fast as it was recorded; as fast as possible when left out.
    #[arg(long, value_name = "R", value_parser = positive)]
    rate: Option<f64>,
    /// Save a picture of the frontiers at this time after the bag's begin, seconds.
    #[arg(long, value_name = "S")]
    at: Vec<f64>,
    /// End at this time after the bag's begin, seconds.
    #[arg(long, value_name = "S", value_parser = values::positive_seconds)]
    until: Option<f64>,
    /// Where the results go.
    #[arg(long, value_name = "DIR", default_value = "replay")]
    out: PathBuf,
    /// Write a bag with the recorded map and transforms, our frontiers, goals and paths.
    #[arg(long, value_name = "BAG")]
    out_bag: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

fn positive(text: &str) -> Result<f64, String> {
    let rate = text.parse::<f64>().ok().filter(|rate| rate.is_finite() && *rate > 0.0);
    rate.ok_or_else(|| format!("{text:?}: must be a number > 0"))
}

/// Runs `frontier replay`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let began = Instant::now();
    let (preset, robot_config) = (inputs::preset(&args.config)?, inputs::robot(&args.robot)?);
    let summary = bag::summary(&args.bag)?;
    let wanted = Wanted {
        map_topic: args.map_topic.clone(),
        map_frame: args.map_frame.clone(),
        pose_frame: args.pose_frame.clone(),
        ..Wanted::default()
    };
    let found = Inputs::of(&summary, &wanted)?;
    tell(args, &summary, &found)?;
    if found.map_topic.is_none() || found.base_frame.is_none() {
        bail!("{}: {}", args.bag.display(), found.verdict().first().map_or("", String::as_str));
    }
    std::fs::create_dir_all(&args.out).with_context(|| format!("cannot make the folder {}", args.out.display()))?;
    let mut player = Player::new(bag::open(&args.bag)?, &summary, found.clone())?;
    let out_bag = match &args.out_bag {
        Some(path) => Some(OutBag::create(path, &found)?),
        None => None,
    };
    if let Some(out_bag) = &out_bag {
        player.set_tap(out_bag.tap());
    }
    let mut robot = BagRobot::new(player, &summary, args.until);
    let mut explorer = Explorer::new(preset.explorer.clone(), robot_config.inflation(), &robot_config.body())?;
    let mut recorder = Recorder::new(&preset.explorer, &robot_config, args, out_bag)?;
    let end = explore(&mut robot, &mut explorer, &mut recorder);
    let name = args.bag.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let names = (name, preset.preset.clone(), robot_config.name);
    let record = recorder.record(names, &robot, &explorer, &end, began.elapsed().as_secs_f64());
    let files = save(args, &record, &recorder, &robot, &preset.explorer)?;
    recorder.finish()?;
    if !args.quiet {
        report(args, &record, &recorder, &robot, &files)?;
    }
    Ok(if end.reason.is_success() { Outcome::Done } else { Outcome::Incomplete })
}

/// What was guessed, and what is wrong with the bag.
fn tell(args: &Args, summary: &Summary, found: &Inputs) -> anyhow::Result<()> {
    if args.quiet {
        return Ok(());
    }
    for problem in &summary.problems {
        output::line(format_args!("warning: {problem}"))?;
    }
    found.verdict().iter().try_for_each(|sentence| output::line(format_args!("{sentence}")))
}

type FileRobot = BagRobot<std::fs::File>;

fn save(
    args: &Args,
    record: &RunRecord,
    recorder: &Recorder<'_>,
    robot: &FileRobot,
    settings: &frontier_explorer::explore::ExplorerSettings,
) -> anyhow::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut put = |name: &str, bytes: &[u8]| -> anyhow::Result<()> {
        let path = args.out.join(name);
        write_atomic(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
        files.push(path);
        Ok(())
    };
    put("run.json", &record.to_json()?)?;
    put("comparison.json", &serde_json::to_vec_pretty(&recorder.comparison)?)?;
    let Some(grid) = robot.player().grid() else { return Ok(files) };
    save_map(&args.out.join("map.yaml"), grid, &SaveOptions::default())?;
    let picture = Picture {
        grid,
        thresholds: &settings.thresholds,
        trajectory: &recorder.trajectory,
        start_in_map: Some(record.start),
        end_in_map: robot.pose(),
        goals: &recorder.goals,
        region: settings.region.as_ref(),
        theme: Theme::Clear,
    };
    let map_png = picture.to_png()?;
    put("map.png", &map_png)?;
    let animation =
        Animation { thresholds: &settings.thresholds, trajectory: &recorder.trajectory, theme: Theme::Clear };
    let gif = animation.to_gif(recorder.frames.frames());
    let gif = gif.ok();
    if let Some(gif) = &gif {
        put("replay.gif", gif)?;
    }
    let html = HtmlReport { run: record, map_png: &map_png, animation_gif: gif.as_deref(), theme: Theme::Clear };
    put("report.html", html.to_html()?.as_bytes())?;
    files.push(args.out.join("map.yaml"));
    Ok(files)
}

fn report(
    args: &Args,
    record: &RunRecord,
    recorder: &Recorder<'_>,
    robot: &FileRobot,
    files: &[PathBuf],
) -> anyhow::Result<()> {
    output::line(format_args!(
        "{}: {}; {} decisions in {:.0} s, {:.1} m driven, {:.1} m2 mapped",
        record.end_reason.name(),
        record.end_message,
        record.decisions.len(),
        record.sim_time_s,
        record.distance_m,
        record.known_area_m2,
    ))?;
    recorder.comparison.print()?;
    if robot.player().malformed() > 0 {
        output::line(format_args!("warning: {} messages could not be understood", robot.player().malformed()))?;
    }
    output::line(format_args!(
        "replayed in {:.1} s, {:.0} times as fast as recorded",
        record.wall.total_s,
        record.sim_time_s / record.wall.total_s.max(1e-9)
    ))?;
    let also: Vec<&Path> = recorder.pictures.iter().map(PathBuf::as_path).chain(args.out_bag.as_deref()).collect();
    for file in files.iter().map(PathBuf::as_path).chain(also) {
        output::line(format_args!("  {}", file.display()))?;
    }
    Ok(())
}
