//! Watches a replay: decisions, pictures, and the recording's own goals.

use super::Args;
use super::out_bag::OutBag;
use crate::stop;
use crate::trail::Trail;
use anyhow::Context;
use frontier_explorer::config::RobotConfig;
use frontier_explorer::explore::{Decision, End, Explorer, ExplorerSettings, Watcher};
use frontier_explorer::frontier::{DetectionInput, Frontier, FrontierDetector};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Costmap, Inflation, OccupancyGrid};
use frontier_explorer::io::write_atomic;
use frontier_explorer::replay::{Agreement, BagRobot};
use frontier_explorer::report::{Overlay, OverlayFrontier, RunRecord, SCHEMA_VERSION, Series, Theme};
use frontier_explorer::robot::Observation;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Remembers what the report tells.
pub struct Recorder<'a> {
    settings: &'a ExplorerSettings,
    inflation: Inflation,
    detector: Box<dyn FrontierDetector>,
    stop: Arc<AtomicBool>,
    began: Instant,
    rate: Option<f64>,
    /// Time, known cells and way driven.
    growth: Vec<(f64, usize, f64)>,
    known: Option<(Arc<OccupancyGrid>, usize)>,
    start: Option<Pose>,
    /// Times at which pictures are still to be made, the last first.
    at: Vec<f64>,
    out: PathBuf,
    out_bag: Option<OutBag>,
    failed: Option<anyhow::Error>,
    /// Pictures of moments.
    pub pictures: Vec<PathBuf>,
    /// Our decisions beside the recording's.
    pub agreement: Agreement,
    /// Decisions, goals, the way.
    pub trail: Trail,
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
            stop: stop::flag()?,
            began: Instant::now(),
            rate: args.rate,
            growth: Vec::new(),
            known: None,
            start: None,
            at,
            out: args.out.clone(),
            out_bag,
            failed: None,
            pictures: Vec::new(),
            agreement: Agreement::default(),
            trail: Trail::new(),
        })
    }

    /// The replay as run.json holds it. Coverage is the share of what the recording had
    /// mapped at its end.
    pub fn record(
        &mut self,
        (world, preset, robot_name): (String, String, String),
        robot: &BagRobot,
        explorer: &Explorer,
        end: &End,
        total_s: f64,
    ) -> RunRecord {
        self.agreement.finish(robot.recorded_goals(), robot.now_s());
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
            slam: None,
            start: self.start.unwrap_or_default(),
            end_reason: end.reason,
            end_message: end.message.clone(),
            coverage: share(known),
            sim_time_s: robot.now_s(),
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
            time_spent: *explorer.time_spent(),
            notices: std::mem::take(&mut self.trail.notices),
            left_behind: end.left_behind,
            decisions: std::mem::take(&mut self.trail.decisions),
            series: series.points(),
            wall: self.trail.wall(total_s),
        }
    }

    /// The times of pictures that the recording never came to, seconds after its begin.
    pub fn not_reached(&self) -> impl Iterator<Item = f64> {
        self.at.iter().rev().copied()
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

    /// Makes the pictures whose times have come.
    fn picture(&mut self, robot: &BagRobot, observation: &Observation) -> anyhow::Result<()> {
        while let Some(&at_s) = self.at.last() {
            let (Some(map), Some(pose)) = (&observation.map, robot.pose()) else { return Ok(()) };
            if robot.now_s() < at_s {
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
                map.grid.census(&self.settings.thresholds).known()
            }
        };
        self.known = Some((Arc::clone(&map.grid), cells));
        self.growth.push((robot.now_s(), cells, robot.distance_m()));
    }
}

impl Watcher<BagRobot> for Recorder<'_> {
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
        if let Some(rate) = self.rate {
            // Silence that was passed over is not waited for either.
            let due = Duration::try_from_secs_f64((robot.now_s() - robot.skipped_s()) / rate).unwrap_or(Duration::MAX);
            std::thread::sleep(due.saturating_sub(self.began.elapsed()));
        }
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.failed.is_some()
    }
}
