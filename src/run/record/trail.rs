//! What is remembered of any exploration, simulated or recorded: decisions, goals, the way
//! and the growing map.

use crate::explore::{CandidateStatus, Decision, DecisionRecord, Explorer};
use crate::geometry::Point;
use crate::report::{Frame, FrameLog, MedianMax, Notice, PictureGoal, Wall};
use crate::robot::Observation;
use std::sync::Arc;
use std::time::Instant;

/// A new point of the trajectory is remembered after this way, metres.
const TRAJECTORY_STEP_M: f64 = 0.05;

/// The trail of one exploration.
pub(crate) struct Trail {
    step_began: Instant,
    decision_ms: Vec<f64>,
    failed_before: usize,
    /// All decisions, if they are wanted.
    pub decisions: Vec<DecisionRecord>,
    /// What was told on the way.
    pub notices: Vec<Notice>,
    /// The way driven.
    pub trajectory: Vec<Point>,
    /// The goals, and whether they failed.
    pub goals: Vec<PictureGoal>,
    /// The animation's frames, if they are wanted.
    pub frames: Option<FrameLog>,
}

impl Trail {
    /// One that keeps all.
    pub fn new() -> Self {
        Self { frames: Some(FrameLog::default()), ..Self::of_figures() }
    }

    /// One that counts decisions but keeps neither them nor frames: many runs at once need
    /// little memory.
    pub fn of_figures() -> Self {
        Self {
            step_began: Instant::now(),
            decision_ms: Vec::new(),
            failed_before: 0,
            decisions: Vec::new(),
            notices: Vec::new(),
            trajectory: Vec::new(),
            goals: Vec::new(),
            frames: None,
        }
    }

    /// A step begins.
    pub fn before_step(&mut self) {
        self.step_began = Instant::now();
    }

    /// A step is over.
    pub fn after_step(&mut self, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        let step_ms = self.step_began.elapsed().as_secs_f64() * 1e3;
        let failed = explorer.counts().goals_failed;
        if failed > self.failed_before
            && let Some(goal) = self.goals.last_mut()
        {
            goal.failed = true;
        }
        self.failed_before = failed;
        if let Some(text) = &decision.notice {
            self.notices.push(Notice { time_s: observation.stamp_s, text: text.clone() });
        }
        if let Some(record) = &decision.record {
            self.decision_ms.push(step_ms);
            let is_chosen = record.candidates.iter().any(|c| c.status == CandidateStatus::Chosen);
            if let (true, Some(goal)) = (is_chosen, record.goal) {
                self.goals.push(PictureGoal { point_in_map: goal.position(), failed: false });
            }
            if self.frames.is_some() {
                self.decisions.push(record.clone());
            }
        }
        if let Ok(pose) = &observation.pose_in_map
            && self.trajectory.last().is_none_or(|&last| pose.distance_to(last) >= TRAJECTORY_STEP_M)
        {
            self.trajectory.push(pose.position());
        }
        self.remember_frame(explorer, observation);
    }

    /// Real time: all of it, seconds, and that of the decisions.
    pub fn wall(&self, total_s: f64) -> Wall {
        Wall { total_s, decision_ms: MedianMax::of(&self.decision_ms) }
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
            frontier_points_in_map: explorer.frontiers().cells().collect(),
            goal_in_map: explorer.goal().map(|goal| goal.position()),
        });
    }
}
