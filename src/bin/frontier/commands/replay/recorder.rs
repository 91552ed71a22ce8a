//! Watches a replay: decisions, pictures, and the recording's own goals.

use super::comparison::Comparison;
use super::out_bag::OutBag;
use super::{Args, FileRobot};
use crate::commands::explore::stop_flag;
use anyhow::Context;
use frontier_explorer::config::RobotConfig;
use frontier_explorer::explore::{CandidateStatus, Decision, DecisionRecord, End, Explorer, ExplorerSettings, Watcher};
use frontier_explorer::frontier::{DetectionInput, Frontier, FrontierDetector};
use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Costmap, Inflation, OccupancyGrid};
use frontier_explorer::io::write_atomic;
use frontier_explorer::report::{
    Frame, FrameLog, MedianMax, Overlay, OverlayFrontier, PictureGoal, RunRecord, SCHEMA_VERSION, Series, Theme, Wall,
};
use frontier_explorer::robot::Observation;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A new point of the trajectory is remembered after this way, metres.
const TRAJECTORY_STEP_M: f64 = 0.05;

/// Remembers what the report tells.
pub struct Recorder<'a> {
    settings: &'a ExplorerSettings,
    inflation: Inflation,
    detector: Box<dyn FrontierDetector>,
    stop: Arc<AtomicBool>,
    began: Instant,
    rate: Option<f64>,
    step_began: Instant,
    decision_ms: Vec<f64>,
    decisions: Vec<DecisionRecord>,
    /// Time, known cells and way driven.
    growth: Vec<(f64, usize, f64)>,
    known: Option<(Arc<OccupancyGrid>, usize)>,
    start: Option<Pose>,
    ours: Option<(Pose, String)>,
    goals_compared: usize,
    /// Times at which pictures are still to be made, the last first.
    at: Vec<f64>,
    out: PathBuf,
    out_bag: Option<OutBag>,
    failed: Option<anyhow::Error>,
    /// Pictures of moments.
    pub pictures: Vec<PathBuf>,
    /// Our goals beside the recording's.
    pub comparison: Comparison,
    /// The way driven.
    pub trajectory: Vec<Point>,
    /// Our goals.
    pub goals: Vec<PictureGoal>,
    /// The animation.
    pub frames: FrameLog,
}

impl<'a> Recorder<'a> {
    /// Before the first tick.
    pub fn new(
        settings: &'a ExplorerSettings,
        robot: &RobotConfig,
        args: &Args,
        out_bag: Option<OutBag>,
    ) -> anyhow::Result<Self> {
        let mut at = args.at.clone();
        at.sort_by(|a, b| b.total_cmp(a));
        Ok(Self {
            settings,
            inflation: robot.inflation(),
            detector: settings.detector.name.build(&settings.detector_params()),
            stop: stop_flag()?,
            began: Instant::now(),
            rate: args.rate,
            step_began: Instant::now(),
            decision_ms: Vec::new(),
            decisions: Vec::new(),
            growth: Vec::new(),
            known: None,
            start: None,
            ours: None,
            goals_compared: 0,
            at,
            out: args.out.clone(),
            out_bag,
            failed: None,
            pictures: Vec::new(),
            comparison: Comparison::default(),
            trajectory: Vec::new(),
            goals: Vec::new(),
            frames: FrameLog::default(),
        })
    }

    /// The replay as run.json holds it. Coverage is the share of what the recording had
    /// mapped at its end.
    pub fn record(
        &mut self,
        (world, preset, robot_name): (String, String, String),
        robot: &FileRobot,
        explorer: &Explorer,
        end: &End,
        total_s: f64,
    ) -> RunRecord {
        let counts = *explorer.counts();
        let census =
            robot.player().grid().map(|grid| (grid.census(&self.settings.thresholds), grid.info().cell_area_m2()));
        let (known, free, cell_m2) = census.map_or((0, 0, 0.0), |(census, m2)| (census.known(), census.free, m2));
        let share = |cells: usize| if known > 0 { (cells as f64 / known as f64).min(1.0) } else { 0.0 };
        let mut series = Series::new();
        for &(time_s, cells, distance_m) in &self.growth {
            series.push(time_s, share(cells), distance_m);
        }
        RunRecord {
            schema_version: SCHEMA_VERSION,
            world,
            preset,
            robot: robot_name,
            seed: None,
            start: self.start.unwrap_or_default(),
            end_reason: end.reason,
            end_message: end.message.clone(),
            coverage: share(known),
            sim_time_s: robot.elapsed_s(),
            distance_m: robot.distance_m(),
            turned_rad: robot.turned_rad(),
            goals_sent: counts.goals_sent,
            goals_failed: counts.goals_failed,
            collisions: 0,
            known_area_m2: known as f64 * cell_m2,
            free_area_m2: free as f64 * cell_m2,
            time_to_coverage_s: series.time_to_coverage_s(),
            distance_to_coverage_m: series.distance_to_coverage_m(),
            counts,
            left_behind: end.left_behind,
            decisions: std::mem::take(&mut self.decisions),
            series: series.points(),
            wall: Wall { total_s, decision_ms: MedianMax::of(&self.decision_ms) },
        }
    }

    /// Closes what is open, and tells what failed on the way.
    pub fn finish(&mut self) -> anyhow::Result<()> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        self.out_bag.as_ref().map_or(Ok(()), OutBag::finish)
    }

    fn detect(&mut self, grid: &OccupancyGrid, robot_in_map: Pose) -> Vec<Frontier> {
        let costmap = Costmap::inflate(grid, &self.settings.thresholds, &self.inflation);
        let input = DetectionInput { costmap: Some(&costmap), ..DetectionInput::new(grid, robot_in_map) };
        // A map on which nothing can be detected shows none.
        self.detector.detect(&input).unwrap_or_default()
    }

    /// Sets the recording's new goals beside ours.
    fn compare(&mut self, robot: &FileRobot, observation: &Observation) {
        let goals = robot.recorded_goals();
        if goals.len() == self.goals_compared {
            return;
        }
        let (Some(map), Some(pose)) = (&observation.map, robot.pose()) else { return };
        let info = *map.grid.info();
        let frontiers = self.detect(&map.grid, pose);
        let points: Vec<Point> = frontiers.iter().flat_map(|f| &f.cells).map(|&cell| info.center(cell)).collect();
        let begin_s = robot.now_s() - robot.elapsed_s();
        for goal in goals.iter().skip(self.goals_compared) {
            self.comparison.add(goal.time_s - begin_s, goal.goal_in_map, &points, self.ours.clone());
        }
        self.goals_compared = goals.len();
    }

    /// Makes the pictures whose times have come.
    fn picture(&mut self, robot: &FileRobot, observation: &Observation) -> anyhow::Result<()> {
        while let Some(&at_s) = self.at.last() {
            let (Some(map), Some(pose)) = (&observation.map, robot.pose()) else { return Ok(()) };
            if robot.elapsed_s() < at_s {
                return Ok(());
            }
            self.at.pop();
            let frontiers = self.detect(&map.grid, pose);
            let goal = |f: &Frontier| self.settings.goal.representative.of(f, map.grid.info(), pose.position());
            let shown: Vec<OverlayFrontier<'_>> = frontiers
                .iter()
                .map(|f| OverlayFrontier { cells: &f.cells, goal: Some(goal(f)), taboo: false })
                .collect();
            let overlay = Overlay {
                grid: &map.grid,
                thresholds: &self.settings.thresholds,
                frontiers: &shown,
                robot_in_map: Some(pose),
                region: self.settings.region.as_ref(),
                theme: Theme::Clear,
            };
            let path = self.out.join(format!("at_{at_s}.png"));
            write_atomic(&path, &overlay.to_png()?).with_context(|| format!("cannot write {}", path.display()))?;
            self.pictures.push(path);
        }
        Ok(())
    }

    fn remember(&mut self, robot: &FileRobot, explorer: &Explorer, observation: &Observation) {
        if let Ok(pose) = &observation.pose_in_map {
            self.start.get_or_insert(*pose);
            if self.trajectory.last().is_none_or(|&last| pose.distance_to(last) >= TRAJECTORY_STEP_M) {
                self.trajectory.push(pose.position());
            }
        }
        let Some(map) = &observation.map else { return };
        let cells = match &self.known {
            Some((grid, cells)) if Arc::ptr_eq(grid, &map.grid) => *cells,
            _ => map.grid.census(&self.settings.thresholds).known(),
        };
        self.known = Some((Arc::clone(&map.grid), cells));
        self.growth.push((robot.elapsed_s(), cells, robot.distance_m()));
        if self.frames.wants(observation.stamp_s) {
            self.frames.push(Frame {
                time_s: observation.stamp_s,
                grid: Arc::clone(&map.grid),
                pose_in_map: observation.pose_in_map.as_ref().ok().copied(),
                trajectory_len: self.trajectory.len(),
                frontier_points_in_map: explorer.frontiers().iter().flat_map(|f| &f.cells).copied().collect(),
                goal_in_map: explorer.goal().map(|goal| goal.position()),
            });
        }
    }
}

impl Watcher<FileRobot> for Recorder<'_> {
    fn before_step(&mut self, _: &mut Explorer, _: &Observation) {
        self.step_began = Instant::now();
    }

    fn after_step(&mut self, robot: &FileRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        let step_ms = self.step_began.elapsed().as_secs_f64() * 1e3;
        if let Some(record) = &decision.record {
            self.decision_ms.push(step_ms);
            let is_chosen = record.candidates.iter().any(|c| c.status == CandidateStatus::Chosen);
            self.ours = record.goal.map(|goal| (goal, record.why.clone()));
            if let (true, Some(goal)) = (is_chosen, record.goal) {
                self.goals.push(PictureGoal { point_in_map: goal.position(), failed: false });
            }
            self.decisions.push(record.clone());
            if let (Some(out_bag), Some(map)) = (&self.out_bag, &observation.map) {
                out_bag.decided(robot.now_s(), explorer, map.grid.info().resolution_m());
            }
        }
        self.compare(robot, observation);
        if let Err(error) = self.picture(robot, observation) {
            self.failed.get_or_insert(error);
        }
        self.remember(robot, explorer, observation);
        if let Some(rate) = self.rate {
            let due = Duration::from_secs_f64(robot.elapsed_s() / rate);
            std::thread::sleep(due.saturating_sub(self.began.elapsed()));
        }
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.failed.is_some()
    }
}
