//! Paths over a costmap (floor 1): one file for each planner.

mod astar;
mod breadth_first;
mod bucket_queue;
mod canonical;
mod change;
mod coarse_ways;
mod d_star_lite;
mod dijkstra;
mod driven;
mod endpoints;
mod field;
mod ground;
mod hybrid_astar;
mod hybrid_search;
mod lattice;
mod reach;
mod search;
mod swept;

pub use astar::Astar;
pub use breadth_first::{BreadthFirst, BreadthFirstConfig};
pub use coarse_ways::CoarseWays;
pub use d_star_lite::DStarLite;
pub use dijkstra::Dijkstra;
pub use driven::{Driven, Opened};
pub use endpoints::ESCAPE_RADIUS_M;
pub use field::PathField;
pub use hybrid_astar::{HybridAstar, HybridAstarConfig, HybridHeuristic};
pub use reach::Passable;

pub use crate::geometry::Path;

use crate::geometry::{Body, Point, Pose};
use crate::grid::Costmap;
use crate::range::{OutOfRange, Ranged};
use schemars::JsonSchema;
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

/// The planners with their parameters, by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
pub enum PlannerConfig {
    /// The fewest cells, all passable ones alike (Yamauchi 1997).
    BreadthFirst(BreadthFirstConfig),
    /// The cheapest way over the costmap's costs, as navfn finds it.
    Dijkstra {},
    /// The same way, found with a heuristic.
    Astar {},
    /// The same way, repaired when the map changes (Koenig and Likhachev 2002).
    DStarLite {},
    /// Arcs that the robot can drive (Alghfeli, Alhosani and Almheiri).
    HybridAstar(HybridAstarConfig),
}

impl Default for PlannerConfig {
    fn default() -> Self {
        Self::Astar {}
    }
}

impl PlannerConfig {
    /// All planners with their default parameters, for tables of tests and help.
    pub const ALL: &'static [Self] = &[
        Self::BreadthFirst(BreadthFirstConfig::DEFAULT),
        Self::Dijkstra {},
        Self::Astar {},
        Self::DStarLite {},
        Self::HybridAstar(HybridAstarConfig::DEFAULT),
    ];

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        Ranged::check_all(self.numbers())
    }

    /// The numbers with their ranges.
    pub(crate) fn numbers(&self) -> Vec<Ranged> {
        match self {
            Self::BreadthFirst(_) | Self::Dijkstra {} | Self::Astar {} | Self::DStarLite {} => Vec::new(),
            Self::HybridAstar(config) => config.numbers(),
        }
    }

    /// A planner with these parameters for a robot.
    #[must_use]
    pub fn build(&self, body: &Body) -> Box<dyn GlobalPlanner> {
        match self {
            Self::BreadthFirst(config) => Box::new(BreadthFirst::new(*config)),
            Self::Dijkstra {} => Box::new(Dijkstra::default()),
            Self::Astar {} => Box::new(Astar::default()),
            Self::DStarLite {} => Box::new(DStarLite::default()),
            Self::HybridAstar(config) => Box::new(HybridAstar::new(*config, body.clone())),
        }
    }
}
