//! A* over the costmap's costs, as navfn with `use_dijkstra: false`.
//!
//! Hart, Nilsson and Raphael, "A Formal Basis for the Heuristic Determination of
//! Minimum Cost Paths" (1968); cell costs weigh as in navfn ([`super::lattice`]).

use super::search::Search;
use super::{GlobalPlanner, Path, PlanError};
use crate::geometry::Pose;
use crate::grid::Costmap;

/// The planner; it keeps its memory between plans.
///
/// A path costs what [`Dijkstra`](super::Dijkstra)'s costs, and no corner is cut on the way:
///
/// ```
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Costmap, Inflation, OccupancyGrid, Thresholds};
/// use frontier_explorer::planning::{Astar, Dijkstra, GlobalPlanner, PlanError};
///
/// let grid = OccupancyGrid::from_ascii(
///     ".....
///      .###.
///      ...#.",
/// ).unwrap();
/// let point_robot =
///     Inflation { inscribed_radius_m: 0.0, clear_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };
/// let costmap = Costmap::inflate(&grid, &Thresholds::default(), &point_robot);
/// let (start, goal) = (Pose::new(2.5, 0.5, 0.0), Pose::new(4.5, 0.5, 1.0));
/// let path = Astar::default().plan(&costmap, &start, &goal)?;
/// assert_eq!((path.length_m(), path.poses.last()), (10.0, Some(&goal)));
/// assert_eq!(path.cost, Dijkstra::default().plan(&costmap, &start, &goal)?.cost);
/// # Ok::<(), PlanError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Astar {
    search: Search,
}

impl GlobalPlanner for Astar {
    fn name(&self) -> &'static str {
        "astar"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        self.search.plan(costmap, start_in_map, goal_in_map, true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Cell, Inflation, OccupancyGrid, Thresholds};

    const BARE: Inflation =
        Inflation { inscribed_radius_m: 0.0, clear_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };

    fn costmap(drawing: &str) -> Costmap {
        Costmap::inflate(&OccupancyGrid::from_ascii(drawing).unwrap(), &Thresholds::default(), &BARE)
    }

    #[test]
    fn goes_round_a_wall_and_ends_with_the_goals_heading() {
        let map = costmap(
            ".....
             .###.
             .....",
        );
        let goal = Pose::new(2.5, 2.5, 1.0);
        let path = Astar::default().plan(&map, &Pose::new(2.5, 0.5, 0.0), &goal).unwrap();
        assert_eq!(path.poses.last(), Some(&goal));
        assert_eq!(path.cost, 6.0 * 12.0);
        assert!(path.poses.iter().all(|p| map.is_passable(map.info().cell_at(p.position()))));
        assert!((path.length_m() - 6.0).abs() < 1e-9);
    }

    #[test]
    fn a_robot_too_near_to_a_wall_steps_away_first() {
        let info = *costmap("....\n....").info();
        let costs = vec![253, 0, 0, 0, 253, 0, 0, 0];
        let fine = crate::grid::GridInfo::new(4, 2, 0.2, Pose::default()).unwrap();
        assert_eq!(info.len(), fine.len());
        let map = Costmap::from_costs(fine, costs).unwrap();
        let path = Astar::default().plan(&map, &Pose::new(0.05, 0.1, 0.0), &Pose::new(0.7, 0.1, 0.0)).unwrap();
        assert_eq!(map.info().cell_at(path.poses[0].position()), Cell::new(0, 0));
    }

    #[test]
    fn failures_have_names() {
        let map = costmap("..#.?\n..#..");
        let start = Pose::new(0.5, 0.5, 0.0);
        let plan = |x: f64, y: f64| Astar::default().plan(&map, &start, &Pose::new(x, y, 0.0)).unwrap_err();
        assert!(matches!(plan(3.5, 0.5), PlanError::NoPath { .. }));
        assert!(matches!(plan(4.5, 1.5), PlanError::GoalOccupied { .. }));
        assert!(matches!(plan(9.5, 0.5), PlanError::GoalOutsideMap { .. }));
        let outside = Astar::default().plan(&map, &Pose::new(-1.0, 0.5, 0.0), &start).unwrap_err();
        assert!(matches!(outside, PlanError::StartOutsideMap { .. }));
        let inside_a_wall = Astar::default().plan(&map, &Pose::new(2.5, 0.5, 0.0), &start).unwrap_err();
        assert!(matches!(inside_a_wall, PlanError::StartOccupied { .. }));
    }
}
