//! The states of the explorer, and what each one tells the robot to do.

use super::progress::ProgressMonitor;
use super::record::{DecisionRecord, End};
use crate::geometry::{Point, Pose};
use crate::robot::{Command, CommandId, NavigationState, Observation};
use serde::Serialize;
use std::f64::consts::TAU;

/// What the explorer is about, for status displays.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Phase {
    /// Waits for a map that shows the newest sights.
    WaitingForMap,
    /// Waits to know where it is.
    WaitingForPose,
    /// Waits for somebody to carry its commands out.
    WaitingForNavigation,
    /// Turns round.
    Turning,
    /// Drives to a goal.
    Driving,
    /// Drives back to where it began.
    Returning,
    /// Is done.
    Ended,
}

/// The outcome of one step.
#[derive(Clone, Debug)]
pub struct Decision {
    /// What the robot shall do until the next tick.
    pub command: Command,
    /// What the explorer is about.
    pub phase: Phase,
    /// Present when frontiers were weighed in this step.
    pub record: Option<DecisionRecord>,
    /// Present once the run has ended.
    pub end: Option<End>,
}

/// Where the robot is driving.
#[derive(Clone, Debug)]
pub struct Drive {
    /// The command.
    pub id: CommandId,
    /// Where to.
    pub goal: Pose,
    /// The frontier's representative point.
    pub target: Point,
    /// Whether the goal is only a place on the way there.
    pub is_stage: bool,
    /// Since when, seconds.
    pub since_s: f64,
    /// Whether it gets anywhere.
    pub progress: ProgressMonitor,
    /// Stamp of the newest map that was considered on the way, seconds.
    pub considered_s: f64,
}

/// Where the explorer is in its round.
#[derive(Clone, Debug)]
pub enum State {
    Begin,
    Turning {
        id: CommandId,
        since_s: f64,
    },
    /// Waits for a map made at `map_after_s` or later.
    Settling {
        map_after_s: f64,
        since_s: f64,
    },
    Driving(Drive),
    Returning {
        id: CommandId,
        goal: Pose,
        end: End,
        since_s: f64,
    },
    Ended(End),
}

impl State {
    /// The command under way.
    pub const fn command_id(&self) -> Option<CommandId> {
        match self {
            Self::Turning { id, .. } | Self::Returning { id, .. } => Some(*id),
            Self::Driving(drive) => Some(drive.id),
            Self::Begin | Self::Settling { .. } | Self::Ended(_) => None,
        }
    }

    /// Lets the time allowed for the command under way begin anew.
    pub const fn restart_timers(&mut self, now_s: f64) {
        match self {
            Self::Turning { since_s, .. } | Self::Returning { since_s, .. } => *since_s = now_s,
            Self::Driving(drive) => {
                drive.since_s = now_s;
                drive.progress.pause(now_s);
            }
            Self::Begin | Self::Settling { .. } | Self::Ended(_) => {}
        }
    }

    /// What this state asks of the robot.
    pub fn decision(&self, record: Option<DecisionRecord>) -> Decision {
        let (phase, command) = match self {
            Self::Begin | Self::Settling { .. } => (Phase::WaitingForMap, Command::Hold),
            Self::Turning { id, .. } => (Phase::Turning, Command::Turn { id: *id, angle_rad: TAU }),
            Self::Driving(drive) => (Phase::Driving, Command::Drive { id: drive.id, goal_in_map: drive.goal }),
            Self::Returning { id, goal, .. } => (Phase::Returning, Command::Drive { id: *id, goal_in_map: *goal }),
            Self::Ended(_) => (Phase::Ended, Command::Hold),
        };
        let end = match self {
            Self::Ended(end) => Some(end.clone()),
            _ => None,
        };
        Decision { command, phase, record, end }
    }
}

/// Whether the command with this id is over, one way or another.
pub fn has_ended(observation: &Observation, id: CommandId) -> bool {
    observation.navigation.command == id
        && !matches!(observation.navigation.state, NavigationState::Active | NavigationState::Idle)
}
