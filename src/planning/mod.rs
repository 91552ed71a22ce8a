//! Paths over a costmap (floor 1): one file for each planner.

mod astar;
mod bucket_queue;
mod endpoints;
mod field;
mod lattice;
mod search;

pub use astar::Astar;
pub use endpoints::{ESCAPE_RADIUS_M, flood};
pub use field::PathField;

pub use crate::geometry::Path;

use crate::geometry::{Point, Pose};
use crate::grid::Costmap;
use serde::{Deserialize, Serialize};

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

/// The planners by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PlannerKind {
    /// A* over the costmap's costs.
    #[default]
    Astar,
}

impl PlannerKind {
    /// All planners, for tables of tests and help.
    pub const ALL: &'static [Self] = &[Self::Astar];

    /// A planner of this kind.
    #[must_use]
    pub fn build(self) -> Box<dyn GlobalPlanner> {
        match self {
            Self::Astar => Box::new(Astar::default()),
        }
    }
}
