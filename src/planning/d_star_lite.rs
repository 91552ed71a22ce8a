//! D* Lite: A* from the goal, kept between plans and repaired where the map changed.
//!
//! S. Koenig and M. Likhachev, "D* Lite" (AAAI 2002), the optimised version (Fig. 4 of
//! their "Fast Replanning for Navigation in Unknown Terrain", 2005). It stands for the
//! D* of Stentz (1994), which Liang, Wang and Li drive with: the same paths, less to
//! repair. Steps and their costs are [`super::lattice`]'s, so a path costs what A*'s
//! costs. No parameters.
//!
//! The search is kept while the goal stays in its cell. A moved start adds to `km`; a
//! map that grew by whole cells is indexed anew; the changed cells are found by
//! comparing the costmap with the last one. Another goal, a map that shrank or turned,
//! or more changed cells than the last search had looked at begin a new search.
//! O(cells log cells) at first, then O(log) for each cell whose distance to the goal
//! changed where it matters. 16 bytes a cell. Limit: a goal without a path costs a
//! flood of all that is connected to the goal, once.

mod node;

use super::change::{changed_cells, growth, moved};
use super::endpoints::{goal_index, path_along, start_index};
use super::lattice::{Lattice, Step};
use super::{GlobalPlanner, Path, PlanError};
use crate::geometry::Pose;
use crate::grid::{Costmap, GridInfo, Neighbourhood, UNKNOWN_COST};
use node::{INFINITE, NOT_MET, NOT_QUEUED, Node};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The sum of the start's moves is reset long before the keys overflow.
const MAX_KM: u32 = 1 << 30;

/// What the search belongs to.
#[derive(Clone, Debug)]
struct Problem {
    info: GridInfo,
    costs: Vec<u8>,
    start: usize,
    goal: usize,
    km: u32,
}

/// The planner and its search.
///
/// When the map changes, the search is repaired, and gives what [`Astar`](super::Astar) gives anew:
///
/// ```
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Cell, Costmap, GridInfo, LETHAL_COST};
/// use frontier_explorer::planning::{Astar, DStarLite, GlobalPlanner};
/// use std::collections::HashMap;
///
/// let open = Costmap::from_costs(GridInfo::new(40, 40, 1.0, Pose::default())?, vec![0; 1600]).unwrap();
/// let wall = open.with_costs(&(5..35).map(|y| (Cell::new(20, y), LETHAL_COST)).collect());
/// let (start, goal) = (Pose::new(0.5, 20.5, 0.0), Pose::new(39.5, 20.5, 0.0));
/// let mut planner = DStarLite::default();
/// assert_eq!(planner.plan(&wall, &start, &goal)?.cost, Astar::default().plan(&wall, &start, &goal)?.cost);
/// let at_first = planner.expansions();
/// // On its way up the robot meets an obstacle.
/// let obstacle = wall.with_costs(&HashMap::from([(Cell::new(1, 21), LETHAL_COST)]));
/// assert_eq!(planner.plan(&obstacle, &start, &goal)?.cost, Astar::default().plan(&obstacle, &start, &goal)?.cost);
/// assert!(10 * planner.expansions() < at_first, "{} of {at_first}", planner.expansions());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct DStarLite {
    problem: Option<Problem>,
    nodes: Vec<Node>,
    /// Every cell that is not [`Node::NEW`], once.
    met: Vec<u32>,
    /// By key; an entry whose key is not its cell's any more is void.
    queue: BinaryHeap<Reverse<(u64, u32)>>,
    expansions: usize,
}

impl DStarLite {
    /// Cells expanded by the last plan.
    #[must_use]
    pub const fn expansions(&self) -> usize {
        self.expansions
    }

    /// Makes the search fit the costmap and the start; what it needs is computed later.
    fn prepare(&mut self, costmap: &Costmap, lattice: &Lattice<'_>, start: usize, goal: usize) -> Problem {
        let Some(mut problem) = self.problem.take() else {
            return self.begin(costmap, start, goal);
        };
        let Some(shift) = growth(&problem.info, costmap.info()) else {
            return self.begin(costmap, start, goal);
        };
        if moved(problem.goal, &problem.info, costmap.info(), shift) != goal {
            return self.begin(costmap, start, goal);
        }
        if problem.info != *costmap.info() {
            self.index_anew(&mut problem, costmap.info(), shift);
        }
        let changed = changed_cells(&problem.costs, costmap.costs());
        problem.km = problem.km.saturating_add(lattice.octile(problem.start, start));
        if changed.len() > self.met.len() || problem.km > MAX_KM {
            return self.begin(costmap, start, goal);
        }
        problem.start = start;
        problem.costs.copy_from_slice(costmap.costs());
        self.repair(&problem, lattice, &changed);
        problem
    }

    /// Forgets everything and puts the goal into the queue.
    fn begin(&mut self, costmap: &Costmap, start: usize, goal: usize) -> Problem {
        for &index in &self.met {
            self.nodes[index as usize] = Node::NEW;
        }
        self.met.clear();
        self.queue.clear();
        if self.nodes.len() != costmap.info().len() {
            self.nodes.clear();
            self.nodes.resize(costmap.info().len(), Node::NEW);
        }
        let problem = Problem { info: *costmap.info(), costs: costmap.costs().to_vec(), start, goal, km: 0 };
        self.nodes[goal].rhs = 0;
        self.update(&Lattice::new(costmap), &problem, goal);
        problem
    }

    /// Carries nodes and costs over to a map that grew.
    fn index_anew(&mut self, problem: &mut Problem, info: &GridInfo, shift: (i32, i32)) {
        let to_new = |index: usize| moved(index, &problem.info, info, shift);
        let mut nodes = vec![Node::NEW; info.len()];
        self.queue.clear();
        for index in &mut self.met {
            let node = self.nodes[*index as usize];
            *index = to_new(*index as usize) as u32;
            nodes[*index as usize] = node;
            if node.key < NOT_QUEUED {
                self.queue.push(Reverse((node.key, *index)));
            }
        }
        let mut costs = vec![UNKNOWN_COST; info.len()];
        for (row, old) in problem.costs.chunks_exact(problem.info.width()).enumerate() {
            let first = to_new(row * problem.info.width());
            costs[first..first + old.len()].copy_from_slice(old);
        }
        self.nodes = nodes;
        problem.start = to_new(problem.start);
        problem.goal = to_new(problem.goal);
        problem.costs = costs;
        problem.info = *info;
    }

    /// Looks again at every cell with a step whose cost may have changed.
    fn repair(&mut self, problem: &Problem, lattice: &Lattice<'_>, changed: &[usize]) {
        // A changed cell changes the steps beside it too: they may cut its corner now.
        let mut affected = changed.to_vec();
        for &index in changed {
            let around = problem.info.neighbours(problem.info.cell(index), Neighbourhood::Eight);
            affected.extend(around.filter_map(|cell| problem.info.index(cell)));
        }
        affected.sort_unstable();
        affected.dedup();
        for index in affected {
            self.recompute(lattice, problem, index);
        }
    }

    /// The key under which a cell waits now.
    fn key(&self, lattice: &Lattice<'_>, problem: &Problem, index: usize) -> u64 {
        let node = self.nodes[index];
        let low = node.g.min(node.rhs);
        let high = low.saturating_add(lattice.octile(problem.start, index)).saturating_add(problem.km);
        (u64::from(high) << 32) | u64::from(low)
    }

    /// The paper's UpdateVertex: a cell waits in the queue when g and rhs differ.
    fn update(&mut self, lattice: &Lattice<'_>, problem: &Problem, index: usize) {
        let node = self.nodes[index];
        let key = if node.g == node.rhs { NOT_QUEUED } else { self.key(lattice, problem, index) };
        if node.key == NOT_MET {
            if key == NOT_QUEUED {
                return;
            }
            self.met.push(index as u32);
        }
        if key != node.key {
            self.nodes[index].key = key;
            if key != NOT_QUEUED {
                self.queue.push(Reverse((key, index as u32)));
            }
        }
    }

    /// Derives a cell's rhs from its neighbours.
    fn recompute(&mut self, lattice: &Lattice<'_>, problem: &Problem, index: usize) {
        if index != problem.goal {
            let mut rhs = INFINITE;
            if lattice.is_open(index) {
                lattice.for_each_step(index, |step| rhs = rhs.min(self.nodes[step.to].g.saturating_add(step.cost)));
            }
            self.nodes[index].rhs = rhs;
        }
        self.update(lattice, problem, index);
    }

    /// The paper's ComputeShortestPath.
    fn search(&mut self, lattice: &Lattice<'_>, problem: &Problem) {
        while let Some(&Reverse((key, item))) = self.queue.peek() {
            let index = item as usize;
            let node = self.nodes[index];
            if node.key != key {
                self.queue.pop();
                continue;
            }
            let start = self.nodes[problem.start];
            if key >= self.key(lattice, problem, problem.start) && start.rhs <= start.g {
                return;
            }
            self.queue.pop();
            let now = self.key(lattice, problem, index);
            self.nodes[index].key = NOT_QUEUED;
            if key < now {
                self.update(lattice, problem, index);
                continue;
            }
            self.expansions += 1;
            if node.g > node.rhs {
                self.lower(lattice, problem, index);
            } else {
                self.raise(lattice, problem, index);
            }
        }
    }

    /// A cell came nearer to the goal: its neighbours may go through it.
    fn lower(&mut self, lattice: &Lattice<'_>, problem: &Problem, index: usize) {
        let g = self.nodes[index].rhs;
        self.nodes[index].g = g;
        lattice.for_each_step(index, |Step { to, cost, .. }| {
            if g.saturating_add(cost) < self.nodes[to].rhs {
                self.nodes[to].rhs = g.saturating_add(cost);
                self.update(lattice, problem, to);
            }
        });
    }

    /// A cell is farther from the goal than thought: who went through it looks again.
    fn raise(&mut self, lattice: &Lattice<'_>, problem: &Problem, index: usize) {
        let old = self.nodes[index].g;
        self.nodes[index].g = INFINITE;
        lattice.for_each_step(index, |Step { to, cost, .. }| {
            if self.nodes[to].rhs == old.saturating_add(cost) {
                self.recompute(lattice, problem, to);
            }
        });
        self.update(lattice, problem, index);
    }

    /// From the start always on to the neighbour over which the goal is cheapest.
    fn way(&self, lattice: &Lattice<'_>, problem: &Problem) -> Vec<usize> {
        let mut way = vec![problem.start];
        let mut here = problem.start;
        // Every step costs something, so that g falls from cell to cell; the bound
        // keeps even a broken search from going round for ever.
        while here != problem.goal && way.len() <= lattice.len() {
            let mut best = (INFINITE, here);
            lattice.for_each_step(here, |step| {
                best = best.min((self.nodes[step.to].g.saturating_add(step.cost), step.to));
            });
            here = best.1;
            way.push(here);
        }
        way
    }
}

impl GlobalPlanner for DStarLite {
    fn name(&self) -> &'static str {
        "d_star_lite"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        self.expansions = 0;
        let start = start_index(costmap, start_in_map)?;
        let goal = goal_index(costmap, goal_in_map)?;
        let lattice = Lattice::new(costmap);
        let problem = self.prepare(costmap, &lattice, start, goal);
        self.search(&lattice, &problem);
        let cost = self.nodes[start].rhs;
        let path = if cost == INFINITE {
            Err(PlanError::no_path(goal_in_map.position()))
        } else {
            let way = self.way(&lattice, &problem);
            Ok(path_along(costmap.info(), &way, start_in_map, goal_in_map, f64::from(cost)))
        };
        self.problem = Some(problem);
        path
    }
}

#[cfg(test)]
#[path = "d_star_lite_tests.rs"]
mod tests;
