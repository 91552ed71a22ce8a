//! What a planner is asked and why it may find nothing: the contract of all that find paths.

use crate::geometry::{Path, Point, Pose};
use crate::grid::Costmap;

/// Why there is no path.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// The start lies beyond the map.
    #[error("the start ({x:.2}, {y:.2}) m lies outside the map")]
    StartOutsideMap {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// The robot stands where it cannot, and no free cell is near.
    #[error("the start ({x:.2}, {y:.2}) m is occupied, unknown or too near to an obstacle")]
    StartOccupied {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// The goal lies beyond the map.
    #[error("the goal ({x:.2}, {y:.2}) m lies outside the map")]
    GoalOutsideMap {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// The robot cannot stand at the goal.
    #[error("the goal ({x:.2}, {y:.2}) m is occupied, unknown or too near to an obstacle")]
    GoalOccupied {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// Start and goal are not connected.
    #[error("no path leads to the goal ({x:.2}, {y:.2}) m")]
    NoPath {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// Given up after a number of expansions.
    #[error("no path was found within {limit} expansions")]
    IterationLimit {
        /// The number allowed.
        limit: usize,
    },
}

impl PlanError {
    /// [`Self::NoPath`] to a goal.
    #[must_use]
    pub fn no_path(goal: Point) -> Self {
        Self::NoPath { x: goal.x, y: goal.y }
    }
}

/// Finds a way for the robot's centre over a costmap; unknown cells are blocked.
pub trait GlobalPlanner: Send {
    /// The planner's name in configuration files.
    fn name(&self) -> &'static str;

    /// A path from one pose to another. The path ends at the goal's position, with
    /// the goal's heading.
    ///
    /// # Errors
    /// [`PlanError`] that says why there is none.
    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError>;
}
