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
mod fence;
mod field;
mod global_planner;
mod ground;
#[cfg(test)]
mod growing_tests;
mod hybrid_astar;
mod hybrid_search;
mod lattice;
mod reach;
mod search;
mod swept;

pub use astar::Astar;
pub use breadth_first::{BreadthFirst, BreadthFirstConfig};
pub use coarse_ways::{CoarseWays, WaysFrom};
pub use d_star_lite::DStarLite;
pub use dijkstra::Dijkstra;
pub(crate) use driven::{Driven, Opened};
pub(crate) use fence::{Fence, Fenced, Whereabouts};
pub use field::PathField;
pub use global_planner::{GlobalPlanner, PlanError};
pub use hybrid_astar::{HybridAstar, HybridAstarConfig, HybridHeuristic};
pub use reach::Passable;

pub use crate::geometry::Path;

use crate::geometry::Body;
use crate::range::{OutOfRange, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
