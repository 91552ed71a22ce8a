//! `frontier replay`: the explorer over a recording, and what it would have decided.

mod comparison;

use crate::exit::Outcome;
use crate::{bags, inputs, output, stop, values};
use anyhow::bail;
use frontier_explorer::bag::Summary;
use frontier_explorer::config::Preset;
use frontier_explorer::explore::{EndReason, Explorer, run as explore};
use frontier_explorer::io::{load_preset, load_robot};
use frontier_explorer::mapping::BuilderConfig;
use frontier_explorer::replay::{BagRobot, Inputs, Verdict, Wanted};
use frontier_explorer::report::RunRecord;
use frontier_explorer::run::Pace;
use frontier_explorer::run::record::{OutBag, ReplayRecorder, RunFolder};
use std::path::PathBuf;
use std::time::Instant;

/// Arguments of `frontier replay`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The bag.
    bag: PathBuf,
    /// How to explore: a YAML file, or the name of a built-in preset.
    #[arg(long, value_name = "PRESET", default_value = Preset::DEFAULT, long_help = inputs::preset_help())]
    config: String,
    /// The robot: a YAML file, or the name of a built-in robot.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2")]
    robot: String,
    /// The topic of the map, instead of the one that is guessed.
    #[arg(long, value_name = "TOPIC")]
    map_topic: Option<String>,
    /// The topic of the scans, instead of the one that is guessed; a map is made of them
    /// where the bag has none.
    #[arg(long, value_name = "TOPIC")]
    scan_topic: Option<String>,
    /// Make a map of the scans even where the bag has one.
    #[arg(long)]
    map_from_scans: bool,
    /// Edge length of a cell of a map that is made of scans, metres.
    #[arg(long, value_name = "M", default_value = "0.05", value_parser = values::positive_metres, allow_negative_numbers = true)]
    resolution: f64,
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
    #[arg(long, value_name = "S", value_parser = values::positive_seconds, allow_negative_numbers = true)]
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
    let (preset, robot_config) = (load_preset(&args.config)?, load_robot(&args.robot)?);
    let summary = bags::summary(&args.bag)?;
    let wanted = Wanted {
        map_topic: args.map_topic.clone(),
        scan_topic: args.scan_topic.clone(),
        map_frame: args.map_frame.clone(),
        pose_frame: args.pose_frame.clone(),
    };
    let mut found = Inputs::of(&summary, &wanted)?;
    if args.map_from_scans {
        found.forget_map();
    }
    let verdict = Verdict::of(&summary, &found);
    tell(args, &summary, &found, &verdict)?;
    if let Err(missing) = &verdict.replay {
        bail!("{}: frontier replay: no, {missing}", args.bag.display());
    }
    let folder = RunFolder::create(&args.out, "replay.gif")?;
    let mut player = bags::player(&args.bag, &summary, &found, BuilderConfig::with_resolution(args.resolution))?;
    let out_bag = args.out_bag.as_ref().map(|path| OutBag::create(path, &found, summary.start)).transpose()?;
    if let Some(out_bag) = &out_bag {
        player.set_tap(out_bag.tap());
    }
    let mut robot = BagRobot::new(player, &summary, args.until);
    let mut explorer = Explorer::new(preset.explorer.clone(), &robot_config.traits())?;
    let recorder = ReplayRecorder::new(&preset, &robot_config, folder, &args.at, out_bag, stop::flag()?);
    let mut watchers = (recorder, Pace::new(args.rate));
    let end = explore(&mut robot, &mut explorer, &mut watchers);
    let (mut recorder, _) = watchers;
    let name = args.bag.file_name().unwrap_or_default().to_string_lossy();
    let record = recorder.record(&name, &robot, &explorer, &end, began.elapsed().as_secs_f64());
    let files = recorder.save(&record, &robot)?;
    if !args.quiet {
        report(args, &record, &recorder, &robot, &files)?;
    }
    let is_stopped = matches!(end.reason, EndReason::Interrupted);
    if record.decisions.is_empty() && !is_stopped {
        bail!("{}: nothing was decided: {}", args.bag.display(), missing(&robot).join("; "));
    }
    Ok(if end.reason.is_success() { Outcome::Done } else { Outcome::Incomplete })
}

/// What was missing for a decision.
fn missing(robot: &BagRobot) -> Vec<String> {
    if robot.has_begun() {
        return vec![format!("the recording ended {:.1} s after its begin, before there was a need", robot.now_s())];
    }
    robot.missing()
}

/// What was guessed, and what is wrong with the bag.
fn tell(args: &Args, summary: &Summary, found: &Inputs, verdict: &Verdict) -> anyhow::Result<()> {
    if args.quiet {
        return Ok(());
    }
    bags::warn(summary, found)?;
    verdict.sentences().iter().try_for_each(|sentence| output::line(format_args!("{sentence}")))
}

fn report(
    args: &Args,
    record: &RunRecord,
    recorder: &ReplayRecorder<'_>,
    robot: &BagRobot,
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
    if !robot.has_begun() {
        output::line(format_args!("warning: there was never a map with the robot's place in it: nothing was decided"))?;
    } else if !recorder.has_frames() {
        output::line(format_args!("warning: no moment had a map to show: there is no animation"))?;
    }
    for at_s in recorder.not_reached() {
        output::line(format_args!(
            "warning: no picture at {at_s} s: the replay ended {:.1} s after the bag's begin",
            robot.now_s()
        ))?;
    }
    comparison::print(recorder.agreement())?;
    bags::tell_scans(robot.player())?;
    for sentence in robot.player().faults().sentences() {
        output::line(format_args!("warning: {sentence}"))?;
    }
    output::line(format_args!(
        "replayed in {:.1} s, {:.0} times as fast as recorded",
        record.wall.total_s,
        record.sim_time_s / record.wall.total_s.max(1e-9)
    ))?;
    for file in files.iter().chain(&args.out_bag) {
        output::line(format_args!("  {}", file.display()))?;
    }
    Ok(())
}
