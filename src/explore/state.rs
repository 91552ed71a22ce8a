//! The states of the explorer, and what each one tells the robot to do.

use super::progress_monitor::ProgressMonitor;
use super::record::{DecisionRecord, End, SeenFrontiers};
use crate::geometry::{Path, Point, Pose};
use crate::robot::{Command, CommandId, NavigationState, Observation};
use serde::Serialize;
use std::sync::Arc;

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
    /// Gets away from what it touches.
    BackingOff,
    /// Rests before it tries again what has failed.
    Pausing,
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
    /// The frontiers that were weighed, none where nothing was.
    pub frontiers: Arc<SeenFrontiers>,
    /// The way to the goal that was chosen last, as planned then; `None` where nothing was weighed.
    pub path: Option<Arc<Path>>,
    /// Something that the user should know of: what is waited for, what was passed over.
    pub notice: Option<String>,
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
    /// Whether it is a frontier beside the way to another one.
    pub is_beside: bool,
    /// Since when, seconds.
    pub since_s: f64,
    /// Whether it gets anywhere.
    pub progress: ProgressMonitor,
    /// Stamp of the newest map that was considered on the way, seconds.
    pub considered_s: f64,
    /// Its version.
    pub considered_version: u64,
    /// The version of the map on which nothing was left to choose, if the last one was such.
    pub done_at: Option<u64>,
}

/// Where the explorer is in its round.
#[derive(Clone, Debug)]
pub enum State {
    Begin,
    Turning {
        id: CommandId,
        angle_rad: f64,
        since_s: f64,
        /// Where to go on afterwards.
        then: AfterTurn,
    },
    /// Decides on the map that is there.
    Ready,
    /// Decides on a map that came after the last motion, or on the last one after a while.
    Settling {
        since_s: f64,
    },
    /// Nothing is left to choose on this map: only one that came after the last motion may
    /// end the run. Decides on every map that comes.
    Confirming {
        since_s: f64,
        /// Small turns made to bring a map.
        turns: u32,
        /// The map that was decided on last.
        version: u64,
    },
    Driving(Drive),
    BackingOff {
        id: CommandId,
        from: Point,
        since_s: f64,
    },
    Pausing {
        until_s: f64,
    },
    Returning {
        id: CommandId,
        goal: Pose,
        end: End,
        since_s: f64,
        /// Goals there that failed so far.
        failures: u32,
    },
    Ended(End),
}

/// How the explorer goes on after a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AfterTurn {
    /// It looked about: a map that shows it is waited for.
    Settle,
    /// The same, and it was all that was left to do for a target. Where the turn was made, it was
    /// looked at; where not, seeing it has failed.
    LookedAt(Point),
    /// It moved to bring a map; how often so far.
    Confirm(u32),
}

impl State {
    /// The command under way.
    pub const fn command_id(&self) -> Option<CommandId> {
        match self {
            Self::Turning { id, .. } | Self::Returning { id, .. } | Self::BackingOff { id, .. } => Some(*id),
            Self::Driving(drive) => Some(drive.id),
            _ => None,
        }
    }

    /// Lets the time allowed for the command under way begin anew.
    pub const fn restart_timers(&mut self, now_s: f64) {
        match self {
            Self::Turning { since_s, .. }
            | Self::Returning { since_s, .. }
            | Self::BackingOff { since_s, .. }
            | Self::Settling { since_s }
            | Self::Confirming { since_s, .. } => *since_s = now_s,
            Self::Driving(drive) => {
                drive.since_s = now_s;
                drive.progress.pause(now_s);
            }
            Self::Begin | Self::Ready | Self::Pausing { .. } | Self::Ended(_) => {}
        }
    }

    /// What this state asks of the robot.
    pub fn decision(&self, record: Option<DecisionRecord>) -> Decision {
        let (phase, command) = match self {
            Self::Begin | Self::Ready | Self::Settling { .. } | Self::Confirming { .. } => {
                (Phase::WaitingForMap, Command::Hold)
            }
            Self::Turning { id, angle_rad, .. } => (Phase::Turning, Command::Turn { id: *id, angle_rad: *angle_rad }),
            Self::Driving(drive) => (Phase::Driving, Command::Drive { id: drive.id, goal_in_map: drive.goal }),
            Self::BackingOff { id, .. } => (Phase::BackingOff, Command::BackOff { id: *id }),
            Self::Pausing { .. } => (Phase::Pausing, Command::Hold),
            Self::Returning { id, goal, .. } => (Phase::Returning, Command::Drive { id: *id, goal_in_map: *goal }),
            Self::Ended(_) => (Phase::Ended, Command::Hold),
        };
        let end = match self {
            Self::Ended(end) => Some(end.clone()),
            _ => None,
        };
        Decision { command, phase, record, frontiers: Arc::default(), path: None, notice: None, end }
    }
}

/// Whether the command with this id is over, one way or another.
pub fn has_ended(observation: &Observation, id: CommandId) -> bool {
    observation.navigation.command == id
        && !matches!(observation.navigation.state, NavigationState::Active | NavigationState::Idle)
}
