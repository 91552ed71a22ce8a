//! Makes the runs of a comparison, several at a time.

use super::worlds::{LoadedWorld, load_worlds};
use super::{CompareError, Starts};
use crate::config::{Preset, RobotConfig};
use crate::explore::{EndReason, run as explore};
use crate::report::{ComparedPreset, ComparedRun, ComparisonPlan, PlannedRun};
use crate::run::Plan;
use crate::run::oracle::{ORACLE, oracle_preset, run_oracle};
use crate::run::record::SimRecorder;
use crate::sim::{DriverKind, MapStyle, SlamKind};
use rayon::iter::{IndexedParallelIterator, IntoParallelRefIterator, ParallelIterator};
use std::collections::BTreeSet;
use std::num::NonZeroUsize;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// What all runs share.
pub struct Runner {
    presets: Vec<Preset>,
    robot: RobotConfig,
    worlds: Vec<LoadedWorld>,
    slam: SlamKind,
    time_limit_s: f64,
    /// The settings of the oracle, where it takes part.
    oracle: Option<Preset>,
}

impl Runner {
    /// Makes ready to compare presets with a validated robot in worlds, given by name or by
    /// file. Each run ends after `time_limit_s` seconds of the simulation.
    ///
    /// # Errors
    /// [`CompareError`] for presets or worlds of the same name, a world that cannot be had, and
    /// starts where the robot does not fit.
    pub fn new(
        mut presets: Vec<Preset>,
        robot: RobotConfig,
        worlds: &[String],
        starts: &Starts,
        slam: SlamKind,
        time_limit_s: f64,
    ) -> Result<Self, CompareError> {
        for preset in &mut presets {
            preset.explorer.patience.time_limit_s = Some(time_limit_s);
        }
        unless_twice("preset", presets.iter().map(|preset| preset.preset.as_str()))?;
        let worlds = load_worlds(worlds, starts, &robot)?;
        unless_twice("world", worlds.iter().map(|world| world.named.name.as_str()))?;
        Ok(Self { presets, robot, worlds, slam, time_limit_s, oracle: None })
    }

    /// The same with runs of the oracle ([`crate::run::oracle`]) beside those of the presets.
    ///
    /// # Errors
    /// [`CompareError::NameTwice`] for a preset that has its name.
    pub fn with_oracle(self) -> Result<Self, CompareError> {
        let names = self.presets.iter().map(|preset| preset.preset.as_str());
        unless_twice("preset", names.chain([ORACLE]))?;
        let mut oracle = oracle_preset();
        oracle.explorer.patience.time_limit_s = Some(self.time_limit_s);
        Ok(Self { oracle: Some(oracle), ..self })
    }

    /// Every preset in every world from every start with every seed.
    ///
    /// # Errors
    /// [`CompareError`] for a seed that is given twice.
    pub fn plan(&self, seeds: &[u64]) -> Result<ComparisonPlan, CompareError> {
        let mut seen = BTreeSet::new();
        if let Some(&seed) = seeds.iter().find(|seed| !seen.insert(**seed)) {
            return Err(CompareError::SeedTwice(seed));
        }
        let compared = |(preset, is_oracle): (&Preset, bool)| {
            let (name, settings) = (preset.preset.clone(), serde_json::to_value(preset)?);
            Ok(ComparedPreset { name, settings, is_oracle })
        };
        let all =
            self.presets.iter().map(|preset| (preset, false)).chain(self.oracle.iter().map(|oracle| (oracle, true)));
        let presets = all.map(compared).collect::<Result<_, CompareError>>()?;
        Ok(ComparisonPlan {
            robot: self.robot.name.clone(),
            slam: self.slam.told(),
            time_limit_s: Some(self.time_limit_s),
            presets,
            worlds: self.worlds.iter().map(|world| world.compared.clone()).collect(),
            seeds: seeds.to_vec(),
        })
    }

    /// Makes runs of the plan, `jobs` at a time or as many as there are processors, and tells
    /// of each. The results stand in the order of `runs`. When `stop` is raised, what was not
    /// finished is left out.
    ///
    /// # Errors
    /// [`CompareError`] of the first run that cannot begin.
    pub fn make(
        &self,
        runs: &[PlannedRun],
        jobs: Option<NonZeroUsize>,
        stop: &Arc<AtomicBool>,
        tell: impl Fn(&ComparedRun) + Sync,
    ) -> Result<Vec<ComparedRun>, CompareError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(jobs.map_or(0, NonZeroUsize::get)).build()?;
        let make_one = |run| {
            let made = self.make_one(run, stop)?;
            made.iter().for_each(&tell);
            Ok(made)
        };
        let made: Vec<Option<ComparedRun>> =
            pool.install(|| runs.par_iter().with_max_len(1).map(make_one).collect::<Result<_, CompareError>>())?;
        Ok(made.into_iter().flatten().collect())
    }

    /// One run, `None` if it was stopped.
    fn make_one(&self, run: &PlannedRun, stop: &Arc<AtomicBool>) -> Result<Option<ComparedRun>, CompareError> {
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let began = Instant::now();
        let plan = self.plan_of(run).ok_or(CompareError::NotPlanned(run.index))?;
        if run.preset >= self.presets.len() {
            let made = run_oracle(&plan, stop)?;
            return Ok(made.map(|made| ComparedRun::new(run, &made.record, &made.trajectory)));
        }
        let (mut sim, mut explorer) = plan.prepare()?;
        let mut recorder = SimRecorder::of_figures(Arc::clone(stop));
        let end = explore(&mut sim, &mut explorer, &mut recorder);
        if end.reason == EndReason::Interrupted {
            return Ok(None);
        }
        let record = recorder.record(&plan, &sim, &explorer, &end, began.elapsed().as_secs_f64());
        Ok(Some(ComparedRun::new(run, &record, &recorder.trail.trajectory)))
    }

    fn plan_of(&self, run: &PlannedRun) -> Option<Plan> {
        let world = self.worlds.get(run.world)?;
        Some(Plan {
            preset: self.presets.iter().chain(&self.oracle).nth(run.preset)?.clone(),
            robot: self.robot.clone(),
            world: world.named.clone(),
            start: *world.compared.starts.get(run.start)?,
            seed: run.seed,
            map_style: MapStyle::Gmapping,
            lidar_noise_std_m: None,
            odometry_noise: None,
            slam: self.slam,
            driver: DriverKind::beside(self.slam),
        })
    }
}

/// Refuses names that are given twice: tables could not tell them apart.
fn unless_twice<'a>(what: &'static str, names: impl Iterator<Item = &'a str>) -> Result<(), CompareError> {
    let mut seen = BTreeSet::new();
    for name in names {
        if !seen.insert(name) {
            return Err(CompareError::NameTwice { what, name: name.to_owned() });
        }
    }
    Ok(())
}
