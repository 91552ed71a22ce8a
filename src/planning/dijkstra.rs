//! Dijkstra's search over the costmap's costs, navfn's default.
//!
//! E. W. Dijkstra, "A note on two problems in connexion with graphs" (1959); cell costs
//! weigh as in navfn ([`super::lattice`]). No parameters. O(cells) with a bucket queue:
//! it looks at every cell that costs no more than the goal, in all directions, and so
//! at more than [`super::Astar`] for the same path cost.

use super::search::Search;
use super::{GlobalPlanner, Path, PlanError};
use crate::geometry::Pose;
use crate::grid::Costmap;

/// The planner; it keeps its memory between plans.
#[derive(Clone, Debug, Default)]
pub struct Dijkstra {
    search: Search,
}

impl GlobalPlanner for Dijkstra {
    fn name(&self) -> &'static str {
        "dijkstra"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        self.search.plan(costmap, start_in_map, goal_in_map, false)
    }
}
