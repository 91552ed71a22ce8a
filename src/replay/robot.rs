//! The recorded robot. It cannot be told where to drive: its commands are taken down, and
//! their outcome is what the recording did by itself.
//!
//! A goal is reached when the recorded robot comes near it. It is taken away (as by a
//! person who clicks another one) when the recording got another goal, or went its own way
//! for a while; so decisions keep being made, and no goal is blamed. A turn is done at once:
//! the recording either turned or it did not.

use super::player::{Player, RecordedGoal};
use crate::bag::{Summary, seconds};
use crate::geometry::{Pose, shortest_angle};
use crate::robot::{Command, Navigation, NavigationState, Observation, Robot, RobotError};
use std::io::{Read, Seek};

/// From one look to the next, seconds, as `explore_node` has it.
const TICK_S: f64 = 0.2;
/// A goal counts as reached within this distance, metres.
const ARRIVED_M: f64 = 0.5;
/// A goal is given back after this time, seconds: shorter than any patience.
const OWN_WAY_S: f64 = 10.0;

/// A command under way.
#[derive(Clone, Copy, Debug)]
struct Task {
    id: u64,
    goal: Option<Pose>,
    since_s: f64,
    /// How many goals the recording had had by then.
    goals_before: usize,
}

/// A bag behind the port.
pub struct BagRobot<R> {
    player: Player<R>,
    start_s: f64,
    end_s: f64,
    ticks: u64,
    now_s: f64,
    task: Option<Task>,
    pose: Option<Pose>,
    distance_m: f64,
    turned_rad: f64,
}

impl<R: Read + Seek> BagRobot<R> {
    /// A recording from its begin to `until_s` seconds after it, or to its end.
    #[must_use]
    pub fn new(player: Player<R>, summary: &Summary, until_s: Option<f64>) -> Self {
        let start_s = seconds(summary.start);
        let end_s = until_s.map_or(seconds(summary.end), |until_s| (start_s + until_s).min(seconds(summary.end)));
        Self {
            player,
            start_s,
            end_s,
            ticks: 0,
            now_s: start_s,
            task: None,
            pose: None,
            distance_m: 0.0,
            turned_rad: 0.0,
        }
    }

    /// What plays the bag.
    #[must_use]
    pub const fn player(&self) -> &Player<R> {
        &self.player
    }

    /// Time of the bag, seconds.
    #[must_use]
    pub const fn now_s(&self) -> f64 {
        self.now_s
    }

    /// Time since the bag's begin, seconds.
    #[must_use]
    pub fn elapsed_s(&self) -> f64 {
        self.now_s - self.start_s
    }

    /// The whole time, seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.end_s - self.start_s
    }

    /// Where the robot was when that was last known.
    #[must_use]
    pub const fn pose(&self) -> Option<Pose> {
        self.pose
    }

    /// The way that was driven so far, metres.
    #[must_use]
    pub const fn distance_m(&self) -> f64 {
        self.distance_m
    }

    /// All turning so far, radians.
    #[must_use]
    pub const fn turned_rad(&self) -> f64 {
        self.turned_rad
    }

    /// The goals of the recording so far.
    #[must_use]
    pub fn recorded_goals(&self) -> &[RecordedGoal] {
        self.player.goals()
    }

    fn follow(&mut self, pose: &Pose) {
        if let Some(last) = self.pose {
            let step_m = pose.distance_to(last.position());
            // Tremor of a SLAM is no driving; a jump is none either, but a correction.
            if step_m < 1.0 {
                self.distance_m += step_m;
                self.turned_rad += shortest_angle(last.yaw, pose.yaw).abs();
            }
        }
        self.pose = Some(*pose);
    }

    /// How the recording did by the command under way.
    fn navigation(&self) -> Navigation {
        let Some(Task { id, goal, since_s, goals_before }) = self.task else {
            return Navigation { command: 0, state: NavigationState::Idle };
        };
        let is_there = |goal: Pose| self.pose.is_some_and(|pose| pose.distance_to(goal.position()) <= ARRIVED_M);
        let state = match goal {
            None => NavigationState::Succeeded,
            Some(goal) if is_there(goal) => NavigationState::Succeeded,
            Some(_) if self.recorded_goals().len() > goals_before || self.now_s - since_s > OWN_WAY_S => {
                NavigationState::Preempted
            }
            Some(_) => NavigationState::Active,
        };
        Navigation { command: id, state }
    }
}

impl<R: Read + Seek> Robot for BagRobot<R> {
    fn observe(&mut self) -> Result<Observation, RobotError> {
        self.ticks += 1;
        let now_s = self.start_s + TICK_S * self.ticks as f64;
        if now_s > self.end_s {
            return Err(RobotError::Ended);
        }
        self.now_s = now_s;
        self.player.play_to(now_s).map_err(|error| RobotError::Disconnected(error.to_string()))?;
        let pose_in_map = self.player.pose(now_s);
        if let Ok(pose) = &pose_in_map {
            self.follow(pose);
        }
        let scan = pose_in_map.as_ref().ok().and_then(|pose| self.player.scan(pose));
        Ok(Observation {
            stamp_s: now_s,
            pose_in_map,
            map: self.player.map().cloned(),
            scan,
            navigation: self.navigation(),
        })
    }

    fn command(&mut self, command: &Command) -> Result<(), RobotError> {
        let (id, goal) = match *command {
            Command::Hold => {
                self.task = None;
                return Ok(());
            }
            Command::Drive { id, goal_in_map } => (id, Some(goal_in_map)),
            Command::Turn { id, .. } => (id, None),
        };
        if self.task.is_none_or(|task| task.id != id) {
            let goals_before = self.recorded_goals().len();
            self.task = Some(Task { id, goal, since_s: self.now_s, goals_before });
        }
        Ok(())
    }
}
