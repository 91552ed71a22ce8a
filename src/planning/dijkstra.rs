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
///
/// The cheapest way is not the shortest where that is close to obstacles:
///
/// ```
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Costmap, GridInfo};
/// use frontier_explorer::planning::{Dijkstra, GlobalPlanner};
///
/// let plan = |cost_beside_the_wall| {
///     let mut costs = vec![0; 21];
///     costs[1..6].fill(cost_beside_the_wall);
///     let costmap = Costmap::from_costs(GridInfo::new(7, 3, 1.0, Pose::default()).unwrap(), costs).unwrap();
///     Dijkstra::default().plan(&costmap, &Pose::new(0.5, 0.5, 0.0), &Pose::new(6.5, 0.5, 0.0))
/// };
/// assert_eq!(plan(0)?.length_m(), 6.0);
/// let around = plan(200)?;
/// assert!(around.length_m() > 6.5 && around.poses.iter().any(|pose| pose.y > 1.0));
/// # Ok::<(), frontier_explorer::planning::PlanError>(())
/// ```
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
