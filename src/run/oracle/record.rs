//! What is recorded of an oracle's drive: the same figures as of every run.

use crate::explore::{Counts, EndReason, LeftBehind, TimeSpent};
use crate::geometry::Point;
use crate::report::{MedianMax, RunRecord, SCHEMA_VERSION, Series, Wall};
use crate::run::Plan;
use crate::sim::SimStats;

/// The name of the oracle in reports.
pub const ORACLE: &str = "oracle";

/// The share of coverage at which the oracle is done.
pub(super) const DONE: f64 = 0.99;

/// The best drive that was found.
pub struct OracleRun {
    /// What is recorded of it; there are no decisions.
    pub record: RunRecord<()>,
    /// The way driven, metres of the map frame.
    pub trajectory: Vec<Point>,
}

/// A drive that is over.
pub(super) struct Driven {
    /// Why it ended: [`EndReason::TimeLimit`] also where it was of no more use.
    pub end: EndReason,
    /// Coverage over time.
    pub series: Series,
    /// The way driven.
    pub trajectory: Vec<Point>,
    /// What the run came to.
    pub stats: SimStats,
    /// The goals, counted.
    pub counts: Counts,
}

impl Driven {
    /// A drive that has not begun.
    pub fn nowhere(stats: SimStats) -> Self {
        let mut series = Series::new();
        series.push(stats.sim_time_s, stats.coverage, stats.distance_m);
        let end = if stats.coverage >= DONE { EndReason::Complete } else { EndReason::Stuck };
        Self { end, series, trajectory: Vec::new(), stats, counts: Counts::default() }
    }

    /// Whether it has seen enough.
    pub fn is_done(&self) -> bool {
        self.stats.coverage >= DONE
    }

    /// The drive as reports keep it; with all planning it took `total_s` seconds of real time.
    pub(super) fn record(self, plan: &Plan, total_s: f64) -> OracleRun {
        let Self { end, series, trajectory, stats, counts } = self;
        let record = RunRecord {
            schema_version: SCHEMA_VERSION,
            world: plan.world.name.clone(),
            preset: ORACLE.to_owned(),
            robot: plan.robot.name.clone(),
            seed: Some(plan.seed),
            slam: plan.slam.told(),
            start: plan.start,
            end_reason: end,
            end_message: end.name().replace('_', " "),
            coverage: stats.coverage,
            sim_time_s: stats.sim_time_s,
            distance_m: stats.distance_m,
            turned_rad: stats.turned_rad,
            goals_sent: counts.goals_sent,
            goals_failed: counts.goals_failed,
            collisions: stats.collisions,
            known_area_m2: stats.known_area_m2,
            free_area_m2: stats.coverage * stats.target_area_m2,
            time_to_coverage_s: series.time_to_coverage_s(),
            distance_to_coverage_m: series.distance_to_coverage_m(),
            counts,
            time_spent: TimeSpent::default(),
            notices: Vec::new(),
            left_behind: LeftBehind::default(),
            decisions: Vec::new(),
            series: series.points(),
            wall: Wall { total_s, decision_ms: MedianMax::default() },
        };
        OracleRun { record, trajectory }
    }

    /// How long it took until enough was seen, seconds.
    pub(super) fn done_s(&self) -> Option<f64> {
        self.is_done().then_some(self.stats.sim_time_s)
    }

    /// Whether it saw enough sooner, or more where neither saw enough.
    pub(super) fn is_better_than(&self, other: &Self) -> bool {
        match (self.done_s(), other.done_s()) {
            (Some(mine), Some(theirs)) => mine < theirs,
            (None, None) => self.stats.coverage > other.stats.coverage,
            (mine, _) => mine.is_some(),
        }
    }
}
