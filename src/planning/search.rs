//! Best-first search over the lattice, shared by Dijkstra, A* and the path field.
//!
//! Dijkstra 1959; Hart, Nilsson and Raphael 1968. The octile distance is a consistent
//! heuristic, so no cell is expanded twice with different costs, and the keys grow by
//! at most two steps: a bucket queue orders them. O(cells), no allocation once warm.

use super::bucket_queue::BucketQueue;
use super::endpoints::{goal_index, path_along, start_index};
use super::ground::ONWARD_ROUGH;
use super::lattice::{ALL_DIRECTIONS, Lattice, MAX_STEP};
use super::{Path, PlanError};
use crate::geometry::Pose;
use crate::grid::Costmap;

/// Cost of a cell that was not reached.
pub const UNREACHED: u32 = u32::MAX;

/// Direction entry of a cell that was not reached, or is the start.
const NO_DIRECTION: u8 = 0xff;

/// The costs and ways that a search found; kept between searches for its memory.
#[derive(Clone, Debug)]
pub struct Search {
    queue: BucketQueue,
    cost: Vec<u32>,
    came_by: Vec<u8>,
    /// The cells that were reached, to be cleared before the next search: a short way on a large
    /// map costs what it passes and not what the map has.
    reached: Vec<u32>,
}

impl Default for Search {
    fn default() -> Self {
        Self { queue: BucketQueue::new(2 * MAX_STEP), cost: Vec::new(), came_by: Vec::new(), reached: Vec::new() }
    }
}

impl Search {
    /// The cheapest way over a costmap's costs, found with a heuristic (A*) or without one
    /// (Dijkstra).
    ///
    /// # Errors
    /// [`PlanError`] that says why there is none.
    pub fn plan(
        &mut self,
        costmap: &Costmap,
        start_in_map: &Pose,
        goal_in_map: &Pose,
        heuristic: bool,
    ) -> Result<Path, PlanError> {
        let start = start_index(costmap, start_in_map)?;
        let goal = goal_index(costmap, goal_in_map)?;
        let lattice = Lattice::new(costmap);
        if !self.run(&lattice, start, Some(goal), heuristic) {
            return Err(PlanError::no_path(goal_in_map.position()));
        }
        let cost = f64::from(self.cost(goal).unwrap_or_default());
        Ok(path_along(costmap.info(), &self.way(&lattice, goal), start_in_map, goal_in_map, cost))
    }

    /// Searches from `start` until `goal` is settled, or everywhere without one.
    /// Returns whether the goal was reached (true without one).
    pub fn run(&mut self, lattice: &Lattice<'_>, start: usize, goal: Option<usize>, heuristic: bool) -> bool {
        self.queue.clear();
        self.clear(lattice.len());
        let estimate = |index: usize| match goal {
            Some(goal) if heuristic => lattice.octile(index, goal),
            _ => 0,
        };
        self.cost[start] = 0;
        self.reached.push(start as u32);
        self.queue.push(estimate(start), start as u32);
        while let Some((key, item)) = self.queue.pop() {
            let index = item as usize;
            let cost = self.cost[index];
            // An older entry of a cell that has been reached more cheaply since.
            if key > cost + estimate(index) {
                continue;
            }
            if goal == Some(index) {
                return true;
            }
            let Self { cost: costs, came_by, queue, reached } = self;
            // The cells beside the step just taken are nearer to the cell before.
            let onward = ONWARD_ROUGH.get(usize::from(came_by[index])).copied().unwrap_or(ALL_DIRECTIONS);
            lattice.for_each_step_among(onward, index, |step| {
                let through_here = cost + step.cost;
                if through_here < costs[step.to] {
                    if costs[step.to] == UNREACHED {
                        reached.push(step.to as u32);
                    }
                    costs[step.to] = through_here;
                    came_by[step.to] = step.direction;
                    queue.push(through_here + estimate(step.to), step.to as u32);
                }
            });
        }
        goal.is_none()
    }

    /// Nothing is reached, of so many cells.
    fn clear(&mut self, cells: usize) {
        for index in self.reached.drain(..).map(|index| index as usize) {
            (self.cost[index], self.came_by[index]) = (UNREACHED, NO_DIRECTION);
        }
        self.cost.resize(cells, UNREACHED);
        self.came_by.resize(cells, NO_DIRECTION);
    }

    /// Cost of the cheapest way to a cell in lattice units, `None` when not reached.
    #[must_use]
    pub fn cost(&self, index: usize) -> Option<u32> {
        self.cost.get(index).copied().filter(|&cost| cost != UNREACHED)
    }

    /// The cells from the start to `goal`, both included; empty when not reached.
    #[must_use]
    pub fn way(&self, lattice: &Lattice<'_>, goal: usize) -> Vec<usize> {
        if self.cost(goal).is_none() {
            return Vec::new();
        }
        let mut way = vec![goal];
        let mut here = goal;
        while self.came_by[here] != NO_DIRECTION {
            here = lattice.before(here, self.came_by[here]);
            way.push(here);
        }
        way.reverse();
        way
    }
}
