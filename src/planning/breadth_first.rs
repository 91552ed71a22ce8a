//! Breadth-first search: the shortest obstacle-free way, all passable cells alike.
//!
//! B. Yamauchi, "A Frontier-Based Approach for Autonomous Exploration" (CIRA 1997):
//! the planner knows obstacles and free cells and no costs between them. A step to any
//! of the eight neighbours counts 1, as a cell is what the paper's grid knows of
//! length, and no corner is cut. The path's cost is its number of steps. The paper makes sure that the
//! space around the way is free: a way over cells that cost at most `max_cost` is
//! preferred to one that passes obstacles more closely. O(cells). Limit: a diagonal step
//! is longer in metres than it counts.

use super::endpoints::{goal_index, path_along, start_index};
use super::lattice::Lattice;
use super::{GlobalPlanner, Path, PlanError};
use crate::geometry::Pose;
use crate::grid::{Costmap, INSCRIBED_COST};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Entry of a cell that the search has not reached.
const NOT_REACHED: u8 = 0xff;
/// Entry of the cell where it began.
const START: u8 = 0xfe;

/// Parameters of the planner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BreadthFirstConfig {
    /// The cost of the costmap up to which a cell leaves room enough beside the way. From 252 on
    /// all passable cells do.
    pub max_cost: u8,
}

impl BreadthFirstConfig {
    /// All passable cells.
    pub const DEFAULT: Self = Self { max_cost: INSCRIBED_COST - 1 };
}

impl Default for BreadthFirstConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The planner; it keeps its memory between plans.
///
/// A diagonal step counts 1, as any other, and costs count only for `max_cost`:
///
/// ```
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Costmap, GridInfo};
/// use frontier_explorer::planning::{BreadthFirst, BreadthFirstConfig, GlobalPlanner};
///
/// let info = GridInfo::new(5, 3, 1.0, Pose::default())?;
/// #[rustfmt::skip]
/// let costmap = Costmap::from_costs(info, vec![
///     0,   0,   0,   0, 0,
///     0, 200, 200, 200, 0,
///     0, 200, 200, 200, 0,
/// ]).unwrap();
/// let (start, goal) = (Pose::new(0.5, 2.5, 0.0), Pose::new(4.5, 2.5, 0.0));
/// assert_eq!(BreadthFirst::default().plan(&costmap, &start, &goal)?.cost, 4.0);
/// let mut with_room = BreadthFirst::new(BreadthFirstConfig { max_cost: 160 });
/// assert_eq!(with_room.plan(&costmap, &start, &goal)?.cost, 6.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct BreadthFirst {
    config: BreadthFirstConfig,
    /// In which direction each cell was entered.
    came_by: Vec<u8>,
    /// The cells in the order in which they were reached.
    reached: Vec<u32>,
}

impl BreadthFirst {
    /// A planner with these parameters.
    #[must_use]
    pub fn new(config: BreadthFirstConfig) -> Self {
        Self { config, ..Self::default() }
    }

    /// Whether the flood from `start` over cells with room comes to `goal`.
    fn flood(&mut self, lattice: &Lattice<'_>, start: usize, goal: usize, has_room: impl Fn(usize) -> bool) -> bool {
        let Self { came_by, reached, .. } = self;
        came_by.clear();
        came_by.resize(lattice.len(), NOT_REACHED);
        reached.clear();
        reached.push(start as u32);
        came_by[start] = START;
        let mut next = 0;
        while let Some(&here) = reached.get(next) {
            if here as usize == goal {
                return true;
            }
            next += 1;
            lattice.for_each_step(here as usize, |step| {
                if came_by[step.to] == NOT_REACHED && (step.to == goal || has_room(step.to)) {
                    came_by[step.to] = step.direction;
                    reached.push(step.to as u32);
                }
            });
        }
        false
    }

    /// The cells from the start to a cell that was reached.
    fn way(&self, lattice: &Lattice<'_>, goal: usize) -> Vec<usize> {
        let mut way = vec![goal];
        let mut here = goal;
        while self.came_by[here] != START {
            here = lattice.before(here, self.came_by[here]);
            way.push(here);
        }
        way.reverse();
        way
    }
}

impl GlobalPlanner for BreadthFirst {
    fn name(&self) -> &'static str {
        "breadth_first"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        let start = start_index(costmap, start_in_map)?;
        let goal = goal_index(costmap, goal_in_map)?;
        let lattice = Lattice::new(costmap);
        let (costs, max_cost) = (costmap.costs(), self.config.max_cost);
        let roomy = self.flood(&lattice, start, goal, |cell| costs[cell] <= max_cost);
        if !roomy && !self.flood(&lattice, start, goal, |_| true) {
            return Err(PlanError::no_path(goal_in_map.position()));
        }
        let way = self.way(&lattice, goal);
        let cost = (way.len() - 1) as f64;
        Ok(path_along(costmap.info(), &way, start_in_map, goal_in_map, cost))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridInfo;
    use proptest::prelude::*;
    use std::collections::VecDeque;

    /// The number of steps by definition, with a queue of distances.
    fn steps(costmap: &Costmap, start: usize, goal: usize) -> Option<u32> {
        let lattice = Lattice::new(costmap);
        let mut distance = vec![None; lattice.len()];
        distance[start] = Some(0);
        let mut queue = VecDeque::from([start]);
        while let Some(here) = queue.pop_front() {
            let next = distance[here].map(|d| d + 1);
            lattice.for_each_step(here, |step| {
                if distance[step.to].is_none() {
                    distance[step.to] = next;
                    queue.push_back(step.to);
                }
            });
        }
        distance[goal]
    }

    proptest! {
        #[test]
        fn the_cost_is_the_number_of_steps(
            width in 2u32..20,
            costs in proptest::collection::vec(prop_oneof![3 => 0u8..253, 1 => 253u8..=255], 400),
            from in 0usize..400, to in 0usize..400,
        ) {
            let info = GridInfo::new(width, 400 / width, 1.0, Pose::default()).unwrap();
            let costs = costs[..info.len()].to_vec();
            let (from, to) = (from % info.len(), to % info.len());
            prop_assume!(costs[from] < 253 && costs[to] < 253);
            let costmap = Costmap::from_costs(info, costs).unwrap();
            let pose = |index: usize| Pose::facing(info.center(info.cell(index)), info.center(info.cell(index)));
            let path = BreadthFirst::default().plan(&costmap, &pose(from), &pose(to));
            prop_assert_eq!(path.ok().map(|p| p.cost as u32), steps(&costmap, from, to));
        }
    }

    #[test]
    fn costs_do_not_matter_and_a_straight_way_is_straight() {
        let info = GridInfo::new(9, 3, 1.0, Pose::default()).unwrap();
        let mut costs = vec![0; 27];
        costs[9..18].fill(252);
        let costmap = Costmap::from_costs(info, costs).unwrap();
        let path = BreadthFirst::default().plan(&costmap, &Pose::new(0.5, 1.5, 0.0), &Pose::new(8.5, 1.5, 0.0));
        let path = path.unwrap();
        assert_eq!(path.cost, 8.0);
        assert!(path.poses.iter().all(|p| p.y == 1.5), "{path:?}");
    }
}
