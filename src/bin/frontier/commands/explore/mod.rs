//! `frontier explore`: a simulated robot that knows nothing explores a world.

mod progress;

use crate::exit::Outcome;
use crate::{inputs, output, stop, values};
use anyhow::Context;
use frontier_explorer::config::{Explained, Preset, RobotConfig};
use frontier_explorer::explore::{End, run as explore};
use frontier_explorer::geometry::Pose;
use frontier_explorer::io::{load_preset, load_robot, load_world};
use frontier_explorer::report::RunRecord;
use frontier_explorer::run::record::{RunFolder, SimBag, SimRecorder};
use frontier_explorer::run::{NamedWorld, Plan};
use frontier_explorer::sim::{DriverKind, MapStyle, SlamKind};
use progress::Progress;
use std::path::PathBuf;
use std::time::Instant;

/// Arguments of `frontier explore`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The world: office, museum, maze, warehouse, or a map_server YAML file.
    #[arg(default_value = "office")]
    world: String,
    /// How to explore: a YAML file, or the name of a built-in preset.
    #[arg(long, value_name = "PRESET", default_value = Preset::DEFAULT, long_help = inputs::preset_help())]
    config: String,
    /// The robot: a YAML file, or the name of a built-in robot.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2", long_help = inputs::robot_help())]
    robot: String,
    /// Where the robot begins: X,Y or X,Y,YAW in metres and radians. The most open spot
    /// when left out.
    #[arg(long, value_name = "X,Y", value_parser = values::pose, allow_hyphen_values = true)]
    start: Option<Pose>,
    /// How far the lidar sees, metres, instead of the robot's own range.
    #[arg(long, value_name = "M", value_parser = values::positive_metres, allow_negative_numbers = true)]
    lidar_range: Option<f64>,
    /// Standard deviation of the lidar's ranges, metres, instead of the robot's own.
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    lidar_noise: Option<f64>,
    /// The values of the map: gmapping (-1, 0, 100) or cartographer (-1, 0 to 100).
    #[arg(long, value_name = "STYLE", default_value = "gmapping", value_parser = parse_style)]
    map_style: MapStyle,
    /// perfect: the true pose and a map without errors, driven by our own navigator; or
    /// matched: odometry that slips, a map by scan matching, and a stand-in for move_base
    /// that refuses and fails as the real one does.
    #[arg(long, value_name = "SLAM", default_value = "perfect", value_parser = values::slam)]
    slam: SlamKind,
    /// Decides every random number of the run.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true)]
    seed: u64,
    /// End after this time of the simulation, seconds.
    #[arg(long, value_name = "S", value_parser = values::positive_seconds, allow_negative_numbers = true)]
    time_limit: Option<f64>,
    /// Drive back to the start before ending.
    #[arg(long)]
    return_to_start: bool,
    /// Where the results go.
    #[arg(long, value_name = "DIR", default_value = "exploration")]
    out: PathBuf,
    /// Record the run in a bag: map, transforms, scans, odometry, goals and results.
    #[arg(long, value_name = "BAG")]
    bag: Option<PathBuf>,
    /// Print the whole configuration, defaults included, each setting explained, and do nothing.
    #[arg(long)]
    print_config: bool,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

fn parse_style(text: &str) -> Result<MapStyle, String> {
    match text {
        "gmapping" => Ok(MapStyle::Gmapping),
        "cartographer" => Ok(MapStyle::Cartographer),
        _ => Err("must be gmapping or cartographer".to_owned()),
    }
}

/// Runs `frontier explore`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let (preset, robot) = (configured_preset(args)?, configured_robot(args)?);
    if args.print_config {
        output::line(format_args!("{}", Explained::preset(&preset)?.yaml().trim_end()))?;
        return Ok(Outcome::Done);
    }
    let began = Instant::now();
    let (truth, name) = load_world(&args.world)?;
    let world = NamedWorld::new(name, &truth)?;
    let start = args.start.unwrap_or_else(|| world.world.most_open_spot());
    let plan = Plan {
        preset,
        robot,
        world,
        start,
        seed: args.seed,
        map_style: args.map_style,
        lidar_noise_std_m: args.lidar_noise,
        odometry_noise: None,
        slam: args.slam,
        driver: DriverKind::beside(args.slam),
    };
    let (mut sim, mut explorer) = plan.prepare()?;
    // The folder is made before the run: nobody waits for a map that cannot be saved.
    let folder = RunFolder::create(&args.out, "exploration.gif")?;
    let progress = Progress::new(args.quiet, &plan.world.name, &plan.preset.preset);
    let stop = stop::flag()?;
    let bag = args.bag.as_ref().map(|path| SimBag::create(path, &plan.robot.lidar)).transpose()?;
    let mut watchers = (SimRecorder::new(stop, bag), progress);
    let end = explore(&mut sim, &mut explorer, &mut watchers);
    let (mut recorder, mut progress) = watchers;
    let record = recorder.record(&plan, &sim, &explorer, &end, began.elapsed().as_secs_f64());
    progress.finish(&sim.stats());
    let files = recorder.save(&folder, &record, &plan, &sim)?;
    if !args.quiet {
        summarize(&record, files.iter().chain(&args.bag))?;
    }
    Ok(outcome(&end))
}

/// The preset with what the command line overrides.
fn configured_preset(args: &Args) -> anyhow::Result<Preset> {
    let mut preset = load_preset(&args.config)?;
    preset.explorer.return_to_start |= args.return_to_start;
    if args.time_limit.is_some() {
        preset.explorer.patience.time_limit_s = args.time_limit;
    }
    Ok(preset)
}

/// The robot with what the command line overrides.
fn configured_robot(args: &Args) -> anyhow::Result<RobotConfig> {
    let mut robot = load_robot(&args.robot)?;
    if let Some(range_m) = args.lidar_range {
        robot.lidar.range_max_m = range_m;
    }
    robot.validate().with_context(|| format!("robot {}", robot.name))?;
    Ok(robot)
}

/// What the user reads when all is saved.
fn summarize<'a>(record: &RunRecord, files: impl Iterator<Item = &'a PathBuf>) -> anyhow::Result<()> {
    output::line(format_args!(
        "{}: {}; {:.1} % of the reachable area after {:.0} s and {:.1} m, {} goals, {} failed",
        record.end_reason.name(),
        record.end_message,
        100.0 * record.coverage,
        record.sim_time_s,
        record.distance_m,
        record.goals_sent,
        record.goals_failed,
    ))?;
    let speed = record.sim_time_s / record.wall.total_s.max(1e-9);
    output::line(format_args!("simulated in {:.1} s, {speed:.0} times as fast as real time", record.wall.total_s))?;
    for file in files {
        output::line(format_args!("  {}", file.display()))?;
    }
    Ok(())
}

const fn outcome(end: &End) -> Outcome {
    if end.reason.is_success() { Outcome::Done } else { Outcome::Incomplete }
}
