//! Many runs beside each other: presets compared over worlds, starts and seeds.
//!
//! A [`Comparison`] is a [`ComparisonPlan`] and the runs of it that were made. All of
//! it goes through one JSON file (`file.rs`), so that parts made on several computers
//! can be merged; tables and pages are made from that and need no simulator.

mod csv;
mod curves;
mod file;
mod liang;
mod measure;
mod page;
mod paired;
mod rounding;
mod statistics;
mod summary;
mod world;

pub use file::ComparisonError;
pub use liang::{LiangRow, LiangTable};
pub use measure::Measure;
pub use paired::{PAIRED, Paired};
pub use statistics::Spread;
pub use summary::Summary;
pub use world::{ComparedWorld, WorldPicture};

use super::run_json::{RunRecord, Wall};
use super::series::ByShare;
use crate::explore::EndReason;
use crate::geometry::{Point, Pose};
use rounding::{centi, rounded, thinned};
use serde::{Deserialize, Serialize};

/// A run that covered less than this share has failed, however it ended.
const SUCCESS_COVERAGE: f64 = 0.99;

/// The most points of a run's coverage that are kept.
const MAX_COVERAGE_POINTS: usize = 200;

/// The most points of a run's trajectory that are kept.
const MAX_TRAJECTORY_POINTS: usize = 500;

/// A preset that is compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedPreset {
    /// What reports call it; no other preset of the plan has this name.
    pub name: String,
    /// All of its settings.
    pub settings: serde_json::Value,
    /// Whether it is no preset but a planner that knows the world, which others are measured by.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub is_oracle: bool,
}

/// What is compared: every preset in every world from every start with every seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparisonPlan {
    /// The robot's name.
    pub robot: String,
    /// How the simulated robot knew where it was, if that was not the perfect SLAM.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slam: Option<String>,
    /// When runs are ended, seconds of the simulation.
    pub time_limit_s: Option<f64>,
    /// How to explore.
    pub presets: Vec<ComparedPreset>,
    /// Where, and from where.
    pub worlds: Vec<ComparedWorld>,
    /// The seeds.
    pub seeds: Vec<u64>,
}

/// One run of a plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedRun {
    /// Its place in the list of all runs, from 0.
    pub index: usize,
    /// Its world, as an index.
    pub world: usize,
    /// Its start among those of its world, as an index.
    pub start: usize,
    /// Its preset, as an index.
    pub preset: usize,
    /// Its seed.
    pub seed: u64,
}

impl ComparisonPlan {
    /// The oracle among the presets, if it takes part.
    #[must_use]
    pub fn oracle(&self) -> Option<&ComparedPreset> {
        self.presets.iter().find(|preset| preset.is_oracle)
    }

    /// All runs. Presets change fastest, so that the first runs of a list that is cut
    /// short compare as many presets as possible.
    #[must_use]
    pub fn runs(&self) -> Vec<PlannedRun> {
        let mut runs = Vec::new();
        for (world, compared) in self.worlds.iter().enumerate() {
            for start in 0..compared.starts.len() {
                for &seed in &self.seeds {
                    for preset in 0..self.presets.len() {
                        runs.push(PlannedRun { index: runs.len(), world, start, preset, seed });
                    }
                }
            }
        }
        runs
    }
}

/// What is kept of a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedRun {
    /// Its place in the list of all runs of the plan, from 0.
    pub index: usize,
    /// Name of the preset.
    pub preset: String,
    /// Name of the world.
    pub world: String,
    /// Which of the world's starts, from 1.
    pub start_number: usize,
    /// That start, metres and radians in the map frame.
    pub start: Pose,
    /// The seed.
    pub seed: u64,
    /// Why it ended.
    pub end_reason: EndReason,
    /// Share of the world that was covered, 0..=1.
    pub coverage: f64,
    /// Duration in simulated time, seconds.
    pub sim_time_s: f64,
    /// Way driven, metres.
    pub distance_m: f64,
    /// Goals the robot was sent to.
    pub goals_sent: usize,
    /// Goals that were given up.
    pub goals_failed: usize,
    /// Ticks at which the robot touched an obstacle.
    pub collisions: usize,
    /// Seconds until a share of coverage was first reached.
    pub time_to_coverage_s: ByShare,
    /// Metres driven until a share of coverage was first reached.
    pub distance_to_coverage_m: ByShare,
    /// Pairs of seconds and covered share, thinned.
    pub coverage_over_time: Vec<[f64; 2]>,
    /// Pairs of metres in the map frame, thinned.
    pub trajectory: Vec<[f64; 2]>,
    /// What the computer took; in files it stands apart from the runs.
    #[serde(skip)]
    pub wall: Wall,
}

impl ComparedRun {
    /// What is kept of a run that has been made. Numbers are rounded as in its file.
    #[must_use]
    pub fn new<D>(planned: &PlannedRun, record: &RunRecord<D>, trajectory: &[Point]) -> Self {
        let Pose { x, y, yaw } = record.start;
        let shares = |shares: &ByShare| shares.iter().map(|(name, v)| (name.clone(), v.map(rounded))).collect();
        Self {
            index: planned.index,
            preset: record.preset.clone(),
            world: record.world.clone(),
            start_number: planned.start + 1,
            start: Pose::new(rounded(x), rounded(y), rounded(yaw)),
            seed: planned.seed,
            end_reason: record.end_reason,
            coverage: rounded(record.coverage),
            sim_time_s: rounded(record.sim_time_s),
            distance_m: rounded(record.distance_m),
            goals_sent: record.goals_sent,
            goals_failed: record.goals_failed,
            collisions: record.collisions,
            time_to_coverage_s: shares(&record.time_to_coverage_s),
            distance_to_coverage_m: shares(&record.distance_to_coverage_m),
            coverage_over_time: thinned(&record.series, MAX_COVERAGE_POINTS)
                .map(|p| [centi(p.time_s), rounded(p.coverage)])
                .collect(),
            trajectory: thinned(trajectory, MAX_TRAJECTORY_POINTS).map(|p| [centi(p.x), centi(p.y)]).collect(),
            wall: record.wall,
        }
    }

    /// Whether it explored its world: it ended complete and covered 99 %.
    #[must_use]
    pub fn succeeded(&self) -> bool {
        self.end_reason == EndReason::Complete && self.coverage >= SUCCESS_COVERAGE
    }

    /// The name of its end, as files write it.
    #[must_use]
    pub fn end_name(&self) -> String {
        serde_json::to_value(self.end_reason).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
    }
}

/// A plan and the runs of it that were made, in the order of the plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// What is compared.
    pub plan: ComparisonPlan,
    /// The runs made, by their place in the plan.
    pub runs: Vec<ComparedRun>,
}

impl Comparison {
    /// The runs of a preset, in one world or in all.
    pub fn runs_of<'a>(&'a self, preset: &'a str, world: Option<&'a str>) -> impl Iterator<Item = &'a ComparedRun> {
        self.runs.iter().filter(move |run| run.preset == preset && world.is_none_or(|world| run.world == world))
    }

    /// How many runs of the plan are not there.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.plan.runs().len().saturating_sub(self.runs.len())
    }
}

#[cfg(test)]
mod sample;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_combination_is_planned_once() {
        let plan = sample::plan(&["a", "b"], &["one", "two"], &[1, 2, 3]);
        let runs = plan.runs();
        assert_eq!(runs.len(), 2 * 2 * 3);
        assert!(runs.iter().enumerate().all(|(i, run)| run.index == i));
        assert_eq!((runs[0].preset, runs[1].preset, runs[2].seed), (0, 1, 2));
    }

    #[test]
    fn an_early_end_is_a_failure_even_when_it_calls_itself_complete() {
        let mut run = sample::run(0, "a", "one", 100.0);
        assert!(run.succeeded());
        run.coverage = 0.98;
        assert!(!run.succeeded());
        run = ComparedRun { end_reason: EndReason::TimeLimit, ..sample::run(0, "a", "one", 100.0) };
        assert!(!run.succeeded());
        assert_eq!(run.end_name(), "time_limit");
    }
}
