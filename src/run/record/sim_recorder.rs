//! Watches a simulated run and remembers what its report tells.

use super::outcome::Outcome;
use super::{RecordError, RunFolder, SimBag, Trail};
use crate::explore::{Decision, End, Explorer, STOPPED, Watcher};
use crate::report::{RunRecord, Series};
use crate::robot::Observation;
use crate::run::Plan;
use crate::sim::SimRobot;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Remembers coverage, and the trail.
pub struct SimRecorder {
    stop: Arc<AtomicBool>,
    series: Series,
    bag: Option<SimBag>,
    /// Decisions, goals, the way.
    pub(crate) trail: Trail,
}

impl SimRecorder {
    /// A recorder that ends the run when `stop` is raised, and records it in a bag too if one
    /// is given.
    #[must_use]
    pub fn new(stop: Arc<AtomicBool>, bag: Option<SimBag>) -> Self {
        Self { stop, series: Series::new(), bag, trail: Trail::new() }
    }

    /// One that keeps figures alone.
    pub(crate) fn of_figures(stop: Arc<AtomicBool>) -> Self {
        Self { trail: Trail::of_figures(), ..Self::new(stop, None) }
    }

    /// The run as `run.json` holds it; it took `total_s` seconds of real time. Notices and
    /// decisions leave the trail.
    pub fn record(&mut self, plan: &Plan, sim: &SimRobot, explorer: &Explorer, end: &End, total_s: f64) -> RunRecord {
        let (stats, map) = (sim.stats(), sim.map());
        let outcome = Outcome {
            world: &plan.world.name,
            preset: &plan.preset.preset,
            robot: &plan.robot.name,
            seed: Some(plan.seed),
            slam: plan.slam.told(),
            start: plan.start,
            coverage: stats.coverage,
            sim_time_s: stats.sim_time_s,
            distance_m: stats.distance_m,
            turned_rad: stats.turned_rad,
            collisions: stats.collisions,
            map: Some((map, map.census(&plan.preset.explorer.thresholds))),
        };
        outcome.record(explorer, end, &self.series, &mut self.trail, total_s)
    }

    /// Writes the results and closes the bag, if there is one. The files that were written,
    /// the report first.
    ///
    /// # Errors
    /// [`RecordError`] with the file.
    pub fn save(
        &mut self,
        folder: &RunFolder,
        record: &RunRecord,
        plan: &Plan,
        sim: &SimRobot,
    ) -> Result<Vec<PathBuf>, RecordError> {
        let (settings, end) = (&plan.preset.explorer, sim.pose_in_map());
        let written = folder.write(record, &self.trail, sim.map(), Some(end), settings, None)?;
        self.bag.as_mut().map_or(Ok(()), SimBag::finish)?;
        Ok(written)
    }
}

impl Watcher<SimRobot> for SimRecorder {
    fn before_step(&mut self, _: &SimRobot, _: &mut Explorer, _: &Observation) {
        self.trail.before_step();
    }

    fn after_step(&mut self, sim: &SimRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        self.trail.after_step(explorer, observation, decision);
        let stats = sim.stats();
        self.series.push(stats.sim_time_s, stats.coverage, stats.distance_m);
        if let Some(bag) = &mut self.bag {
            bag.tick(sim, observation, decision);
        }
    }

    fn stop_requested(&self) -> Option<String> {
        self.stop.load(Ordering::Relaxed).then(|| STOPPED.to_owned())
    }
}
