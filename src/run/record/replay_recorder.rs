//! Watches a replay: decisions, pictures, and the recording's own goals.

use super::outcome::Outcome;
use super::{OutBag, RecordError, RunFolder, Trail};
use crate::config::{Preset, RobotConfig};
use crate::explore::{Decision, End, Explorer, STOPPED, Watcher};
use crate::frontier::FrontierDetector;
use crate::geometry::Pose;
use crate::grid::OccupancyGrid;
use crate::replay::{Agreement, BagRobot, Parting};
use crate::report::{Beside, BesideRow, FrameLog, RunRecord, Series, Theme};
use crate::robot::Observation;
use crate::run::MapDetection;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Remembers what the report tells.
pub struct ReplayRecorder<'a> {
    preset: &'a Preset,
    robot: &'a RobotConfig,
    detector: Box<dyn FrontierDetector>,
    stop: Arc<AtomicBool>,
    /// Time, known cells and way driven.
    growth: Vec<(f64, usize, f64)>,
    known: Option<(Arc<OccupancyGrid>, usize)>,
    start: Option<Pose>,
    /// Times at which pictures are still to be made, the last first.
    at: Vec<f64>,
    folder: RunFolder,
    out_bag: Option<OutBag>,
    failed: Option<RecordError>,
    pictures: Vec<PathBuf>,
    agreement: Agreement,
    trail: Trail,
}

impl<'a> ReplayRecorder<'a> {
    /// A recorder before the first tick, which ends the replay when `stop` is raised. The
    /// results go into the folder, pictures of the times `at_s` too, in seconds after the
    /// bag's begin.
    #[must_use]
    pub fn new(
        preset: &'a Preset,
        robot: &'a RobotConfig,
        folder: RunFolder,
        at_s: &[f64],
        out_bag: Option<OutBag>,
        stop: Arc<AtomicBool>,
    ) -> Self {
        let mut at = at_s.to_vec();
        at.sort_by(|a, b| b.total_cmp(a));
        Self {
            preset,
            robot,
            detector: preset.explorer.detector.name.build(&preset.explorer.detector_params()),
            stop,
            growth: Vec::new(),
            known: None,
            start: None,
            at,
            folder,
            out_bag,
            failed: None,
            pictures: Vec::new(),
            agreement: Agreement::default(),
            trail: Trail::new(),
        }
    }

    /// The replay as `run.json` holds it, under a name of its recording; it took `total_s`
    /// seconds of real time. Coverage is the share of what the recording had mapped at its end.
    /// Notices and decisions leave the trail.
    pub fn record(
        &mut self,
        recording: &str,
        robot: &BagRobot,
        explorer: &Explorer,
        end: &End,
        total_s: f64,
    ) -> RunRecord {
        self.agreement.finish(robot.recorded_goals(), robot.now_s());
        let map = robot.player().grid().map(|grid| (&**grid, grid.census(&self.preset.explorer.thresholds)));
        let known = map.as_ref().map_or(0, |(_, census)| census.known());
        let share = |cells: usize| if known > 0 { (cells as f64 / known as f64).min(1.0) } else { 0.0 };
        let mut series = Series::new();
        for &(time_s, cells, distance_m) in &self.growth {
            series.push(time_s, share(cells), distance_m);
        }
        let outcome = Outcome {
            world: recording,
            preset: &self.preset.preset,
            robot: &self.robot.name,
            start: self.start.unwrap_or_default(),
            coverage: share(known),
            sim_time_s: robot.now_s(),
            distance_m: robot.distance_m(),
            turned_rad: robot.turned_rad(),
            map,
            ..Outcome::default()
        };
        outcome.record(explorer, end, &series, &mut self.trail, total_s)
    }

    /// Writes the results and closes the bag; without a map there is only what was decided.
    /// The files that were written, the report first.
    ///
    /// # Errors
    /// [`RecordError`] with the file, also where a picture failed on the way.
    pub fn save(&mut self, record: &RunRecord, robot: &BagRobot) -> Result<Vec<PathBuf>, RecordError> {
        let comparison = self.folder.save("comparison.json", &serde_json::to_vec_pretty(&self.agreement)?)?;
        let mut written = match robot.player().grid() {
            Some(grid) => {
                let (settings, beside) = (&self.preset.explorer, beside(&self.agreement));
                self.folder.write(record, &self.trail, grid, robot.pose(), settings, Some(&beside))?
            }
            None => vec![self.folder.save("run.json", &record.to_json()?)?],
        };
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        self.out_bag.as_ref().map_or(Ok(()), OutBag::finish)?;
        written.push(comparison);
        written.append(&mut self.pictures);
        Ok(written)
    }

    /// Our decisions beside the recording's.
    #[must_use]
    pub const fn agreement(&self) -> &Agreement {
        &self.agreement
    }

    /// Whether any moment had a map to show in the animation.
    #[must_use]
    pub fn has_frames(&self) -> bool {
        self.trail.frames.as_ref().is_some_and(|frames| !FrameLog::is_empty(frames))
    }

    /// The times of pictures that the recording never came to, seconds after its begin.
    pub fn not_reached(&self) -> impl Iterator<Item = f64> {
        self.at.iter().rev().copied()
    }

    /// Makes the pictures whose times have come.
    fn picture(&mut self, robot: &BagRobot, observation: &Observation) -> Result<(), RecordError> {
        while let Some(&at_s) = self.at.last() {
            let (Some(map), Some(pose)) = (&observation.map, robot.pose()) else { return Ok(()) };
            if robot.now_s() < at_s {
                return Ok(());
            }
            self.at.pop();
            let seen = MapDetection { settings: &self.preset.explorer, grid: &map.grid, robot_in_map: pose };
            // A map on which nothing can be detected shows no frontier.
            let found = seen.detect(self.detector.as_mut(), self.robot).unwrap_or_default();
            self.pictures.push(self.folder.save(&format!("at_{at_s}.png"), &seen.draw(&found, Theme::Clear)?)?);
        }
        Ok(())
    }

    fn remember(&mut self, robot: &BagRobot, observation: &Observation) {
        if let Ok(pose) = &observation.pose_in_map {
            self.start.get_or_insert(*pose);
        }
        let Some(map) = &observation.map else { return };
        let cells = match &self.known {
            Some((grid, cells)) if Arc::ptr_eq(grid, &map.grid) => *cells,
            _ => {
                if let (Some(out_bag), Some(mapping)) = (&self.out_bag, robot.player().mapping()) {
                    out_bag.mapped(robot.now_s(), mapping, &map.grid);
                }
                map.grid.census(&self.preset.explorer.thresholds).known()
            }
        };
        self.known = Some((Arc::clone(&map.grid), cells));
        self.growth.push((robot.now_s(), cells, robot.distance_m()));
    }
}

impl Watcher<BagRobot> for ReplayRecorder<'_> {
    fn before_step(&mut self, robot: &BagRobot, explorer: &mut Explorer, observation: &Observation) {
        self.agreement.before_step(robot.recorded_goals(), explorer, observation);
        self.trail.before_step();
    }

    fn after_step(&mut self, robot: &BagRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        self.trail.after_step(explorer, observation, decision);
        self.agreement.after_step(robot.recorded_goals(), decision, observation.stamp_s);
        if let (Some(_), Some(out_bag), Some(map)) = (&decision.record, &self.out_bag, &observation.map) {
            out_bag.decided(robot.now_s(), decision, explorer.goal(), map.grid.info().resolution_m());
        }
        if let Err(error) = self.picture(robot, observation) {
            self.failed.get_or_insert(error);
        }
        self.remember(robot, observation);
    }

    fn stop_requested(&self) -> Option<String> {
        (self.stop.load(Ordering::Relaxed) || self.failed.is_some()).then(|| STOPPED.to_owned())
    }
}

/// Our decisions beside the recording's, for the page.
fn beside(agreement: &Agreement) -> Beside {
    let point = |goal: &Option<Pose>| goal.as_ref().map(|goal| [goal.x, goal.y]);
    let row = |parting: &Parting| BesideRow {
        time_s: parting.time_s,
        ours: point(&parting.our_goal),
        recorded: point(&parting.recorded_goal),
        cause: parting.full_cause(),
    };
    Beside {
        recorded_goals: agreement.recorded_goals.len(),
        at_frontiers: agreement.at_frontiers(),
        decisions: agreement.decisions,
        agreeing: agreement.agreeing,
        causes: agreement.causes.iter().map(|(cause, count)| (cause.clone(), *count)).collect(),
        partings: agreement.partings.iter().map(row).collect(),
    }
}
