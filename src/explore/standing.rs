//! Where to stand for a frontier.

use crate::geometry::{Point, Pose};
use crate::grid::{Cell, LETHAL_COST, NEIGHBOURS_8};
use crate::planning::PathField;
use serde::{Deserialize, Serialize};

/// Which way the robot looks at its goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GoalHeading {
    /// Towards the frontier.
    #[default]
    TowardFrontier,
    /// As it comes from where it is now: no turn on arrival.
    AsApproached,
}

/// Looks for places to stand; kept for its memory, as a decision asks for hundreds.
#[derive(Clone, Debug, Default)]
pub struct StandingSearch {
    /// The square around the target, with a margin, that the memory is made for.
    side: usize,
    /// In which search each cell of the square was met last; those beyond the radius
    /// count as met in all.
    met: Vec<u32>,
    search: u32,
    queue: Vec<(Cell, usize)>,
}

/// Met in every search.
const ALWAYS: u32 = u32::MAX;

impl StandingSearch {
    /// The place nearest to `target` where the robot can stand and to which it can get,
    /// found by a flood that no obstacle lets through: never a place on the other side of
    /// a wall. `None` when there is none within `radius_m`.
    pub fn goal(
        &mut self,
        field: &PathField,
        robot: &Pose,
        target: Point,
        radius_m: f64,
        heading: GoalHeading,
    ) -> Option<Pose> {
        let info = field.costmap().info();
        let place = info.center(self.nearest_place(field, info.cell_at(target), radius_m)?);
        let yaw = match heading {
            GoalHeading::TowardFrontier => Pose::facing(place, target).yaw,
            GoalHeading::AsApproached => Pose::facing(robot.position(), place).yaw,
        };
        Some(Pose::new(place.x, place.y, yaw))
    }

    fn nearest_place(&mut self, field: &PathField, center: Cell, radius_m: f64) -> Option<Cell> {
        let costmap = field.costmap();
        let info = costmap.info();
        let reach = info.cells(radius_m).ceil().min(MAX_REACH_CELLS) as i32;
        if !field.reaches_near(center, reach.unsigned_abs()) {
            return None;
        }
        self.begin(reach);
        let side = self.side as isize;
        let middle = self.met.len() / 2;
        self.queue.push((center, middle));
        self.met[middle] = self.search;
        let mut next = 0;
        while let Some(&(cell, slot)) = self.queue.get(next) {
            next += 1;
            if field.reaches(cell) {
                return Some(cell);
            }
            for (dx, dy) in NEIGHBOURS_8 {
                let beside = slot.wrapping_add_signed(dy as isize * side + dx as isize);
                let met = &mut self.met[beside];
                if *met == self.search || *met == ALWAYS {
                    continue;
                }
                *met = self.search;
                let neighbour = cell.offset((dx, dy));
                if info.contains(neighbour) && costmap.cost(neighbour) != LETHAL_COST {
                    self.queue.push((neighbour, beside));
                }
            }
        }
        None
    }

    /// Makes ready for a search that goes this many cells far.
    fn begin(&mut self, reach: i32) {
        self.queue.clear();
        self.search += 1;
        let side = (2 * reach + 3) as usize;
        if self.side == side && self.search < ALWAYS {
            return;
        }
        let around = -reach - 1..=reach + 1;
        let cells = around.clone().flat_map(|y| around.clone().map(move |x| Cell::new(x, y)));
        let limit = i64::from(reach).pow(2);
        let is_beyond = |cell: Cell| cell.distance_squared(Cell::new(0, 0)) > limit;
        self.met = cells.map(|cell| if is_beyond(cell) { ALWAYS } else { 0 }).collect();
        self.side = side;
        self.search = 1;
    }
}

/// A radius of more cells than this is cut: the search stays small.
const MAX_REACH_CELLS: f64 = 1000.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Costmap, Inflation, OccupancyGrid, Thresholds};
    use std::sync::Arc;

    fn goal(drawing: &str, target: (f64, f64), radius_m: f64) -> Option<(f64, f64)> {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let inflation = Inflation { inscribed_radius_m: 1.0, inflation_radius_m: 1.0, cost_scaling_factor: 1.0 };
        let costmap = Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &inflation));
        let robot = Pose::new(1.5, 1.5, 0.0);
        let field = PathField::new(costmap, &robot).unwrap();
        let target = Point::new(target.0, target.1);
        StandingSearch::default()
            .goal(&field, &robot, target, radius_m, GoalHeading::TowardFrontier)
            .map(|p| (p.x, p.y))
    }

    #[test]
    fn stands_in_known_space_beside_the_unknown() {
        assert_eq!(goal("...??\n...??\n...??", (3.5, 1.5), 3.0), Some((2.5, 1.5)));
    }

    #[test]
    fn keeps_the_inscribed_radius_from_walls_and_does_not_look_through_them() {
        assert_eq!(goal("....#??\n....#??\n....???\n....#??", (4.5, 1.5), 3.0), Some((3.5, 1.5)));
        assert_eq!(goal("...#???\n...#???\n...#???", (4.5, 1.5), 3.0), None);
        assert_eq!(goal("..?????\n..?????\n..?????", (6.5, 1.5), 3.0), None);
    }
}
