//! Watches a run and remembers what its report tells.

use super::progress::Progress;
use super::recording::Recording;
use crate::simulation::Plan;
use crate::trail::Trail;
use frontier_explorer::explore::{Decision, End, Explorer, Watcher};
use frontier_explorer::report::{RunRecord, SCHEMA_VERSION, Series};
use frontier_explorer::robot::Observation;
use frontier_explorer::sim::SimRobot;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Remembers coverage, and the trail.
pub struct Recorder {
    progress: Progress,
    stop: Arc<AtomicBool>,
    /// Coverage and distance over time.
    pub series: Series,
    /// Decisions, goals, the way.
    pub trail: Trail,
    /// The bag, if the run is recorded.
    pub bag: Option<Recording>,
}

impl Recorder {
    /// A recorder that ends the run when `stop` is raised.
    pub fn new(progress: Progress, stop: Arc<AtomicBool>) -> Self {
        Self { progress, stop, series: Series::new(), trail: Trail::new(), bag: None }
    }

    /// A silent one that keeps figures alone.
    pub fn of_figures(stop: Arc<AtomicBool>) -> Self {
        Self { trail: Trail::of_figures(), ..Self::new(Progress::Quiet, stop) }
    }

    /// The run as run.json holds it; it took `total_s` seconds of real time.
    pub fn record(&mut self, plan: &Plan, sim: &SimRobot, explorer: &Explorer, end: &End, total_s: f64) -> RunRecord {
        let stats = sim.stats();
        self.progress.finish(&stats);
        let counts = *explorer.counts();
        let map = sim.map();
        let census = map.census(&plan.preset.explorer.thresholds);
        let cell_m2 = map.info().cell_area_m2();
        RunRecord {
            schema_version: SCHEMA_VERSION,
            world: plan.world.name.clone(),
            preset: plan.preset.preset.clone(),
            robot: plan.robot.name.clone(),
            seed: Some(plan.seed),
            slam: plan.slam.told(),
            start: plan.start,
            end_reason: end.reason,
            end_message: end.message.clone(),
            coverage: stats.coverage,
            sim_time_s: stats.sim_time_s,
            distance_m: stats.distance_m,
            turned_rad: stats.turned_rad,
            goals_sent: counts.goals_sent,
            goals_failed: counts.goals_failed,
            collisions: stats.collisions,
            known_area_m2: census.known() as f64 * cell_m2,
            free_area_m2: census.free as f64 * cell_m2,
            time_to_coverage_s: self.series.time_to_coverage_s(),
            distance_to_coverage_m: self.series.distance_to_coverage_m(),
            counts,
            time_spent: *explorer.time_spent(),
            notices: std::mem::take(&mut self.trail.notices),
            left_behind: end.left_behind,
            decisions: std::mem::take(&mut self.trail.decisions),
            series: self.series.points(),
            wall: self.trail.wall(total_s),
        }
    }
}

impl Watcher<SimRobot> for Recorder {
    fn before_step(&mut self, _: &SimRobot, _: &mut Explorer, _: &Observation) {
        self.trail.before_step();
    }

    fn after_step(&mut self, sim: &SimRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        self.trail.after_step(explorer, observation, decision);
        let stats = sim.stats();
        self.series.push(stats.sim_time_s, stats.coverage, stats.distance_m);
        if let Some(text) = &decision.notice {
            self.progress.tell(observation.stamp_s, text);
        }
        self.progress.show(&stats);
        if let Some(bag) = &mut self.bag {
            bag.tick(sim, observation, decision);
        }
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
