//! `frontier compare`: every preset in every world from every start with every seed.

mod progress;
mod shard;
mod starts;
mod tables;

use crate::exit::Outcome;
use crate::{inputs, output, stop, values};
use anyhow::Context;
use frontier_explorer::config::Preset;
use frontier_explorer::io::{BUILT_IN_WORLDS, load_preset, load_robot, read_bytes, write_atomic};
use frontier_explorer::report::{Comparison, ComparisonPlan};
use frontier_explorer::run::comparison::{Runner, Starts};
use frontier_explorer::sim::SlamKind;
use progress::Progress;
use shard::Shard;
use starts::StartsArg;
use std::path::{Path, PathBuf};

/// Arguments of `frontier compare`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Presets, by built-in name or YAML file, or `all` built-in ones.
    #[arg(long, value_name = "PRESET,...", value_parser = values::trimmed, value_delimiter = ',', default_value = "all")]
    presets: Vec<String>,
    /// Worlds: map_server YAML files, or built-in names (office, museum, maze, warehouse).
    #[arg(long, value_name = "WORLD,...", value_parser = values::trimmed, value_delimiter = ',', default_values_t = BUILT_IN_WORLDS.map(str::to_owned))]
    worlds: Vec<String>,
    /// Where runs begin: a CSV file with the columns map,x_m,y_m, or `auto:N` for N open
    /// spots far from each other. When left out: three places in each built-in world,
    /// the most open spot of any other.
    #[arg(long, value_name = "FILE.csv|auto:N", value_parser = starts::parse)]
    starts: Option<StartsArg>,
    /// Seeds: each decides every random number of a run.
    #[arg(long, value_name = "SEED,...", value_delimiter = ',', default_value = "1")]
    seeds: Vec<u64>,
    /// The robot: a YAML file, or the name of a built-in robot.
    #[arg(long, value_name = "ROBOT", default_value = "turtlebot2", long_help = inputs::robot_help())]
    robot: String,
    /// perfect: the true pose and a map without errors, driven by our own navigator; or
    /// matched: a SLAM that errs and a stand-in for move_base, as in `frontier explore`.
    #[arg(long, value_name = "SLAM", default_value = "perfect", value_parser = values::slam)]
    slam: SlamKind,
    /// End each run after this time of the simulation, seconds; it has then failed.
    #[arg(long, value_name = "S", value_parser = values::positive_seconds, allow_negative_numbers = true, default_value = "7200")]
    time_limit: f64,
    /// Measure the presets by an oracle too: for each world, start and seed a planner that knows
    /// the world drives the same robot to 99 % of coverage, as fast as the best of several
    /// routes that it finds. Each preset's T99 is then also given as a multiple of the oracle's.
    #[arg(long)]
    oracle: bool,
    /// Print all presets measured by this one as well: ratios of times, and where they came earlier.
    #[arg(long, value_name = "PRESET", value_parser = values::trimmed)]
    against: Option<String>,
    /// Runs at the same time. As many as there are processors when left out.
    #[arg(long, value_name = "N")]
    jobs: Option<std::num::NonZeroUsize>,
    /// Make only the I-th of N parts of the runs, from 1/N to N/N.
    #[arg(long, value_name = "I/N", default_value = "1/1", value_parser = shard::parse)]
    shard: Shard,
    /// Make no runs: put together the JSON files of parts.
    #[arg(
        long,
        value_name = "JSON",
        num_args = 1..,
        conflicts_with_all = ["presets", "worlds", "starts", "seeds", "robot", "slam", "time_limit", "oracle", "jobs", "shard"]
    )]
    merge: Vec<PathBuf>,
    /// Write all results as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Write a line for each run as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Write a report as one HTML file.
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print nothing but errors.
    #[arg(long, short)]
    quiet: bool,
}

/// Runs `frontier compare`.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let (comparison, expected) = if args.merge.is_empty() {
        compare(args)?
    } else {
        let merged = merge(&args.merge)?;
        unless_compared(args, &merged.plan)?;
        let all = merged.plan.runs().len();
        (merged, all)
    };
    write(args, &comparison)?;
    if !args.quiet {
        tables::print(&comparison, args.against.as_deref())?;
        let missing = expected.saturating_sub(comparison.runs.len());
        if missing > 0 {
            output::line(format_args!("{missing} of {expected} runs were not made"))?;
        }
    }
    Ok(if comparison.runs.len() < expected { Outcome::Incomplete } else { Outcome::Done })
}

/// Makes the runs of a part; also tells how many they should be.
fn compare(args: &Args) -> anyhow::Result<(Comparison, usize)> {
    let robot = load_robot(&args.robot)?;
    robot.validate().with_context(|| format!("robot {}", robot.name))?;
    let presets = presets(args)?;
    let starts = args.starts.as_ref().map_or_else(|| Ok(Starts::default()), StartsArg::load)?;
    let runner = Runner::new(presets, robot, &args.worlds, &starts, args.slam, args.time_limit)?;
    let runner = if args.oracle { runner.with_oracle()? } else { runner };
    let plan = runner.plan(&args.seeds)?;
    unless_compared(args, &plan)?;
    let runs: Vec<_> = plan.runs().into_iter().filter(|run| args.shard.holds(run.index)).collect();
    let progress = Progress::new(args.quiet, runs.len());
    let made = runner.make(&runs, args.jobs, &stop::flag()?, |run| progress.made(run));
    progress.finish();
    Ok((Comparison { plan, runs: made? }, runs.len()))
}

/// Refuses to measure by a preset that is not compared.
fn unless_compared(args: &Args, plan: &ComparisonPlan) -> anyhow::Result<()> {
    let names = || plan.presets.iter().map(|preset| preset.name.as_str());
    match &args.against {
        Some(name) if !names().any(|known| known == name) => {
            let valid = names().collect::<Vec<_>>().join(", ");
            anyhow::bail!("--against {name}: no such preset is compared: must be one of {valid}")
        }
        _ => Ok(()),
    }
}

/// The presets by their names.
fn presets(args: &Args) -> anyhow::Result<Vec<Preset>> {
    let mut presets: Vec<Preset> = Vec::new();
    for name in &args.presets {
        if name == "all" {
            presets.extend(Preset::names().map(Preset::built_in).collect::<Result<Vec<_>, _>>()?);
        } else {
            presets.push(load_preset(name)?);
        }
    }
    Ok(presets)
}

/// Reads parts and puts them together.
fn merge(files: &[PathBuf]) -> anyhow::Result<Comparison> {
    let mut merged: Option<Comparison> = None;
    for file in files {
        let bytes = read_bytes(file).with_context(|| format!("cannot read {}", file.display()))?;
        let part = Comparison::from_json(&bytes).with_context(|| file.display().to_string())?;
        match &mut merged {
            None => merged = Some(part),
            Some(merged) => merged.merge(part).with_context(|| file.display().to_string())?,
        }
    }
    merged.context("there is nothing to merge")
}

/// Writes the files that are asked for; the JSON first, as all others follow from it.
fn write(args: &Args, comparison: &Comparison) -> anyhow::Result<()> {
    let save = |file: &Path, bytes: &[u8]| {
        write_atomic(file, bytes).with_context(|| format!("cannot write {}", file.display()))
    };
    if let Some(file) = &args.json {
        save(file, &comparison.to_json()?)?;
    }
    if let Some(file) = &args.csv {
        save(file, comparison.to_csv().as_bytes())?;
    }
    if let Some(file) = &args.html {
        save(file, comparison.to_html()?.as_bytes())?;
    }
    Ok(())
}
