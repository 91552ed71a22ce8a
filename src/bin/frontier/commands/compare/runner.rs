//! Makes the runs of a comparison, several at a time.

use super::progress::Progress;
use super::worlds::LoadedWorld;
use crate::commands::explore::recorder::Recorder;
use crate::simulation::Plan;
use anyhow::Context;
use frontier_explorer::config::{Preset, RobotConfig};
use frontier_explorer::explore::{EndReason, run as explore};
use frontier_explorer::report::{ComparedRun, PlannedRun};
use frontier_explorer::sim::{MapStyle, SlamKind};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What all runs share.
pub struct Runner<'a> {
    /// The presets of the plan.
    pub presets: &'a [Preset],
    /// What explores.
    pub robot: &'a RobotConfig,
    /// The worlds of the plan.
    pub worlds: &'a [LoadedWorld],
    /// How the robot knows where it is.
    pub slam: SlamKind,
    /// Raised when the user wants to stop.
    pub stop: Arc<AtomicBool>,
    /// Told of every run.
    pub progress: &'a Progress,
}

impl Runner<'_> {
    /// Makes the runs in the current thread pool; the results stand in the order of
    /// `runs`. When the user stops, what was not finished is left out.
    pub fn make(&self, runs: &[PlannedRun]) -> anyhow::Result<Vec<ComparedRun>> {
        let made: Vec<Option<ComparedRun>> =
            runs.par_iter().with_max_len(1).map(|run| self.make_one(run)).collect::<anyhow::Result<_>>()?;
        Ok(made.into_iter().flatten().collect())
    }

    /// One run, `None` if the user stopped it.
    fn make_one(&self, run: &PlannedRun) -> anyhow::Result<Option<ComparedRun>> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let began = Instant::now();
        let plan = self.plan(run).with_context(|| format!("run {} is not in the plan", run.index))?;
        let (mut sim, mut explorer) = plan.prepare()?;
        let mut recorder = Recorder::of_figures(Arc::clone(&self.stop));
        let end = explore(&mut sim, &mut explorer, &mut recorder);
        if end.reason == EndReason::Interrupted {
            return Ok(None);
        }
        let record = recorder.record(&plan, &sim, &explorer, &end, began.elapsed().as_secs_f64());
        let made = ComparedRun::new(run, &record, &recorder.trail.trajectory);
        self.progress.made(&made);
        Ok(Some(made))
    }

    fn plan(&self, run: &PlannedRun) -> Option<Plan> {
        let world = self.worlds.get(run.world)?;
        Some(Plan {
            preset: self.presets.get(run.preset)?.clone(),
            robot: self.robot.clone(),
            world: world.named.clone(),
            start: *world.compared.starts.get(run.start)?,
            seed: run.seed,
            map_style: MapStyle::Gmapping,
            lidar_noise_std_m: None,
            slam: self.slam,
        })
    }
}
