//! The port between the explorer and whatever it explores with: a simulated robot, a
//! robot behind ROS, a recorded bag (floor 2).

use crate::geometry::Pose;
use crate::grid::{Changes, Costmap, OccupancyGrid, Snapshot};
use crate::scan::LaserScan;
use serde::Serialize;
use std::sync::Arc;

/// A map and when it was true.
#[derive(Clone, Debug)]
pub struct MapSnapshot {
    /// Everything sensed up to this time, in seconds, is in the map.
    pub stamp_s: f64,
    /// The occupancy grid.
    pub grid: Arc<OccupancyGrid>,
    /// The map's version, and what changed since earlier ones. The version grows with every map
    /// that comes, also with one that looks like the last.
    pub changes: Changes,
    /// A costmap of the same map, if the robot's navigation already has one.
    pub costmap: Option<Snapshot<Costmap>>,
}

impl MapSnapshot {
    /// A map of which nothing earlier is known, without a costmap.
    #[must_use]
    pub fn alone(stamp_s: f64, version: u64, grid: Arc<OccupancyGrid>) -> Self {
        Self { stamp_s, grid, changes: Changes::beginning_at(version), costmap: None }
    }

    /// Grows with every map that comes, also with one that looks like the last.
    #[must_use]
    pub const fn version(&self) -> u64 {
        self.changes.version()
    }
}

/// Why the robot does not know where it is.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PoseError {
    /// No transform connects the two frames so far.
    #[error("no transform from {map_frame} to {base_frame} yet: {why}")]
    NotYet {
        /// The map's frame.
        map_frame: String,
        /// The robot's frame.
        base_frame: String,
        /// What is missing between them.
        why: String,
    },
    /// The newest transform is too old to be believed.
    #[error("the transform from {map_frame} to {base_frame} is {age_s:.1} s old: must be at most {limit_s} s")]
    Stale {
        /// The map's frame.
        map_frame: String,
        /// The robot's frame.
        base_frame: String,
        /// Its age in seconds.
        age_s: f64,
        /// The allowed age in seconds.
        limit_s: f64,
    },
    /// A transform bears a time that is still to come, as from a computer whose clock is
    /// wrong: how old it really is cannot be told.
    #[error(
        "clock skew: {parent} -> {child} is stamped {ahead_s:.1} s ahead of ROS time: must be at most {limit_s} s; \
         set the clocks of the robot's computers alike"
    )]
    Skewed {
        /// The upper frame of the link.
        parent: String,
        /// The frame that moves in it.
        child: String,
        /// By how much, seconds.
        ahead_s: f64,
        /// How much is allowed, seconds.
        limit_s: f64,
    },
    /// A transform that keeps coming is stamped long before it comes: a clock that is behind, or
    /// a sender that is very late.
    #[error(
        "clock skew: {parent} -> {child} comes stamped {behind_s:.1} s behind ROS time: must be at most {limit_s} s; \
         set the clocks of the robot's computers alike, or see why its sender is so late"
    )]
    Lagging {
        /// The upper frame of the link.
        parent: String,
        /// The frame that moves in it.
        child: String,
        /// By how much, seconds.
        behind_s: f64,
        /// How much is allowed, seconds.
        limit_s: f64,
    },
    /// A transform that was stamped ahead, as gmapping does, comes no more.
    #[error("{parent} -> {child} has not come for {silent_s:.1} s: must come every {limit_s} s")]
    Silent {
        /// The upper frame of the link.
        parent: String,
        /// The frame that moves in it.
        child: String,
        /// Since the last one came, seconds.
        silent_s: f64,
        /// How long that may be, seconds.
        limit_s: f64,
    },
}

/// Identifies one command among those of a run; a repeated id is the same command
/// going on.
pub type CommandId = u64;

/// What became of the last command.
#[derive(Clone, Debug, PartialEq)]
pub enum NavigationState {
    /// No command has been given, or the last one was to hold.
    Idle,
    /// Under way.
    Active,
    /// Arrived, or turned all the way.
    Succeeded,
    /// Given up by the robot's navigation, with its reason.
    Aborted(String),
    /// Nobody is there to carry it out, with what is missing: not a failure of the goal.
    Unavailable(String),
    /// Taken away by somebody else, such as a person clicking a goal in RViz: not a
    /// failure of the goal.
    Preempted,
}

/// The state of a command, by its id.
#[derive(Clone, Debug, PartialEq)]
pub struct Navigation {
    /// Which command this is about.
    pub command: CommandId,
    /// What became of it.
    pub state: NavigationState,
}

/// All that the explorer may know at one tick.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Now, in seconds of the source's own time (simulated, recorded or real).
    pub stamp_s: f64,
    /// Where the base frame is in the map frame, or why that is not known.
    pub pose_in_map: Result<Pose, PoseError>,
    /// The newest map, if any came.
    pub map: Option<MapSnapshot>,
    /// The newest scan with the lidar's pose in the map frame, if the source has one.
    pub scan: Option<(Pose, Arc<LaserScan>)>,
    /// How the last command is doing.
    pub navigation: Navigation,
}

/// What the robot shall do. Given anew at every tick: the same id goes on.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Command {
    /// Stay where it is; a command under way is cancelled.
    Hold,
    /// Drive to a pose of the map frame.
    Drive {
        /// Of this command.
        id: CommandId,
        /// Where to.
        goal_in_map: Pose,
    },
    /// Get away from what stands too near: slowly straight ahead or back, as far as that
    /// increases the distance, and never without sight of it.
    BackOff {
        /// Of this command.
        id: CommandId,
    },
    /// Turn on the spot by an angle.
    Turn {
        /// Of this command.
        id: CommandId,
        /// How far, counter-clockwise positive; more than a full turn is allowed.
        angle_rad: f64,
    },
}

/// Why a robot cannot be observed or commanded any more.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RobotError {
    /// The recording is over.
    #[error("the recording ended")]
    Ended,
    /// Somebody asked the program to stop.
    #[error("interrupted")]
    Interrupted,
    /// The robot or its middleware is gone.
    #[error("the connection to the robot is lost: {0}")]
    Disconnected(String),
}

/// A robot, or what plays its part.
pub trait Robot {
    /// Waits for the next tick and tells what is known then.
    ///
    /// # Errors
    /// [`RobotError`] when there will be no next tick.
    fn observe(&mut self) -> Result<Observation, RobotError>;

    /// Whether the last observation is one to decide on. It is none before the first map and the
    /// first pose have come, or while the exploration rests: whoever looks on sees it all the same.
    fn is_ready(&self) -> bool {
        true
    }

    /// Hands over the command for the time until the next tick.
    ///
    /// # Errors
    /// [`RobotError`] when nobody is left to obey.
    fn command(&mut self, command: &Command) -> Result<(), RobotError>;
}
