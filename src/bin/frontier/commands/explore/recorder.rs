//! Watches a run and remembers what its report tells.

use super::progress::Progress;
use crate::simulation::Plan;
use frontier_explorer::explore::{CandidateStatus, Decision, DecisionRecord, End, Explorer, Watcher};
use frontier_explorer::geometry::Point;
use frontier_explorer::grid::Thresholds;
use frontier_explorer::report::{Frame, FrameLog, MedianMax, PictureGoal, RunRecord, SCHEMA_VERSION, Series, Wall};
use frontier_explorer::robot::Observation;
use frontier_explorer::sim::SimRobot;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// A new point of the trajectory is remembered after this way, metres.
const TRAJECTORY_STEP_M: f64 = 0.05;

/// Remembers coverage, trajectory and goals, and for one's own report decisions and
/// frames.
pub struct Recorder {
    progress: Progress,
    stop: Arc<AtomicBool>,
    step_began: Instant,
    decision_ms: Vec<f64>,
    /// All decisions.
    pub decisions: Vec<DecisionRecord>,
    /// Coverage and distance over time.
    pub series: Series,
    /// The way driven.
    pub trajectory: Vec<Point>,
    /// The goals, and whether they failed.
    pub goals: Vec<PictureGoal>,
    /// The animation's frames, if they are wanted.
    pub frames: Option<FrameLog>,
    failed_before: usize,
}

impl Recorder {
    /// A recorder that ends the run when `stop` is raised.
    pub fn new(progress: Progress, stop: Arc<AtomicBool>) -> Self {
        Self {
            progress,
            stop,
            step_began: Instant::now(),
            decision_ms: Vec::new(),
            decisions: Vec::new(),
            series: Series::new(),
            trajectory: Vec::new(),
            goals: Vec::new(),
            frames: Some(FrameLog::default()),
            failed_before: 0,
        }
    }

    /// A silent one that counts decisions but keeps neither them nor frames: many runs
    /// at once need little memory.
    pub fn of_figures(stop: Arc<AtomicBool>) -> Self {
        Self { frames: None, ..Self::new(Progress::Quiet, stop) }
    }

    /// The run as run.json holds it; it took `total_s` seconds of real time.
    pub fn record(&mut self, plan: &Plan, sim: &SimRobot, explorer: &Explorer, end: &End, total_s: f64) -> RunRecord {
        let stats = sim.stats();
        self.progress.finish(&stats);
        let counts = *explorer.counts();
        let map = sim.map();
        let census = map.census(&Thresholds::default());
        let cell_m2 = map.info().cell_area_m2();
        RunRecord {
            schema_version: SCHEMA_VERSION,
            world: plan.world.name.clone(),
            preset: plan.preset.preset.clone(),
            robot: plan.robot.name.clone(),
            seed: Some(plan.seed),
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
            left_behind: end.left_behind,
            decisions: std::mem::take(&mut self.decisions),
            series: self.series.points(),
            wall: Wall { total_s, decision_ms: MedianMax::of(&self.decision_ms) },
        }
    }

    fn remember_pose(&mut self, observation: &Observation) {
        let Ok(pose) = &observation.pose_in_map else { return };
        if self.trajectory.last().is_none_or(|&last| pose.distance_to(last) >= TRAJECTORY_STEP_M) {
            self.trajectory.push(pose.position());
        }
    }

    fn remember_frame(&mut self, explorer: &Explorer, observation: &Observation) {
        let (Some(frames), Some(map)) = (&mut self.frames, &observation.map) else { return };
        if !frames.wants(observation.stamp_s) {
            return;
        }
        frames.push(Frame {
            time_s: observation.stamp_s,
            grid: Arc::clone(&map.grid),
            pose_in_map: observation.pose_in_map.as_ref().ok().copied(),
            trajectory_len: self.trajectory.len(),
            frontier_points_in_map: explorer.frontiers().iter().flat_map(|f| &f.cells).copied().collect(),
            goal_in_map: explorer.goal().map(|goal| goal.position()),
        });
    }
}

impl Watcher<SimRobot> for Recorder {
    fn before_step(&mut self, _: &mut Explorer, _: &Observation) {
        self.step_began = Instant::now();
    }

    fn after_step(&mut self, sim: &SimRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        let step_ms = self.step_began.elapsed().as_secs_f64() * 1e3;
        let stats = sim.stats();
        self.series.push(stats.sim_time_s, stats.coverage, stats.distance_m);
        self.remember_pose(observation);
        let failed = explorer.counts().goals_failed;
        if failed > self.failed_before
            && let Some(goal) = self.goals.last_mut()
        {
            goal.failed = true;
        }
        self.failed_before = failed;
        if let Some(record) = &decision.record {
            self.decision_ms.push(step_ms);
            let chosen = record.candidates.iter().any(|c| c.status == CandidateStatus::Chosen);
            if let (true, Some(goal)) = (chosen, record.goal) {
                self.goals.push(PictureGoal { point_in_map: goal.position(), failed: false });
            }
            if self.frames.is_some() {
                self.decisions.push(record.clone());
            }
        }
        self.remember_frame(explorer, observation);
        self.progress.show(&stats);
    }

    fn stop_requested(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}
