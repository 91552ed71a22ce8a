//! Where to stand for a frontier.

use crate::geometry::{Point, Pose};
use crate::grid::{Cell, Costmap, LETHAL_COST, NARROW_COST, NEIGHBOURS_8, UNKNOWN_COST};
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

/// What kind of place is looked for.
pub struct StandingGoal<'a> {
    /// At most this far from the target, metres.
    pub radius_m: f64,
    /// Which way the robot looks there.
    pub heading: GoalHeading,
    /// Whether a place is not to be tried.
    pub refused: &'a dyn Fn(Point) -> bool,
}

/// A place keeps this many cells from what the robot's centre cannot be in.
const MARGIN_CELLS: i32 = 2;
/// For that it may lie this much farther from the target, metres.
const DETOUR_M: f64 = 0.5;

/// What is better than a margin of two cells: one without unknown cells.
const ALL_KNOWN: i32 = MARGIN_CELLS + 1;

/// How good a place a cell is. -1 where the robot cannot turn; else how many cells all round
/// it are clear of obstacles with the robot's radius and padding, two at most; one more where
/// all of these are known, for behind an unknown cell there may be a wall that the next map
/// shows.
fn quality(costmap: &Costmap, cell: Cell) -> i32 {
    let mut knows_all = true;
    for around in 0..=MARGIN_CELLS {
        for dy in -around..=around {
            // The cells inside were looked at in the rounds before.
            let step = if dy.abs() == around { 1 } else { (2 * around).max(1) };
            for dx in (-around..=around).step_by(step as usize) {
                match costmap.cost(cell.offset((dx, dy))) {
                    UNKNOWN_COST => knows_all = false,
                    cost if cost < NARROW_COST => {}
                    _ => return around - 1,
                }
            }
        }
    }
    if knows_all { ALL_KNOWN } else { MARGIN_CELLS }
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
    /// a wall. A place that keeps two cells from what the robot's centre cannot be in, and
    /// from what is unknown, is taken rather than one that does not, where it is little farther off: planners that
    /// compute with other roundings, or on a map of a second later, refuse the rim. Where
    /// the robot can stand and cannot turn there is no place to stand.
    /// `refused` are places that have failed. `None` when there is none within `radius_m`.
    pub fn goal(&mut self, field: &PathField, robot: &Pose, target: Point, search: &StandingGoal<'_>) -> Option<Pose> {
        let info = field.costmap().info();
        let place = info.goal_point(self.best_place(field, info.cell_at(target), search)?);
        let yaw = match search.heading {
            GoalHeading::TowardFrontier => Pose::facing(place, target).yaw,
            GoalHeading::AsApproached => Pose::facing(robot.position(), place).yaw,
        };
        Some(Pose::new(place.x, place.y, yaw))
    }

    fn best_place(&mut self, field: &PathField, center: Cell, search: &StandingGoal<'_>) -> Option<Cell> {
        let costmap = field.costmap();
        let info = costmap.info();
        let reach = info.cells(search.radius_m).ceil().min(MAX_REACH_CELLS) as i32;
        if !field.reaches_near(center, reach.unsigned_abs()) {
            return None;
        }
        self.begin(reach);
        let side = self.side as isize;
        let middle = self.met.len() / 2;
        self.queue.push((center, middle));
        self.met[middle] = self.search;
        let mut best: Option<(i32, Cell)> = None;
        let mut enough_cells = f64::INFINITY;
        let mut next = 0;
        while let Some(&(cell, slot)) = self.queue.get(next) {
            next += 1;
            let away_cells = (cell.distance_squared(center) as f64).sqrt();
            if away_cells <= enough_cells && field.reaches(cell) && !(search.refused)(info.center(cell)) {
                let quality = quality(costmap, cell);
                if quality >= 0 && best.is_none() {
                    enough_cells = away_cells + info.cells(DETOUR_M);
                }
                if quality >= 0 && best.is_none_or(|(highest, _)| quality > highest) {
                    best = Some((quality, cell));
                }
                if quality >= ALL_KNOWN {
                    break;
                }
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
        best.map(|(_, cell)| cell)
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
    use crate::grid::{Inflation, OccupancyGrid, Thresholds};
    use std::sync::Arc;

    fn goal(drawing: &str, target: (f64, f64), radius_m: f64) -> Option<(f64, f64)> {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let inflation = Inflation {
            inscribed_radius_m: 1.0,
            clear_radius_m: 0.0,
            inflation_radius_m: 1.0,
            cost_scaling_factor: 1.0,
        };
        let costmap = Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &inflation));
        let robot = Pose::new(1.5, 1.5, 0.0);
        let field = PathField::new(costmap, &robot).unwrap();
        let target = Point::new(target.0, target.1);
        StandingSearch::default()
            .goal(
                &field,
                &robot,
                target,
                &StandingGoal { radius_m, heading: GoalHeading::TowardFrontier, refused: &|_| false },
            )
            .map(|p| field.costmap().info().cell_at(p.position()))
            .map(|cell| (f64::from(cell.x) + 0.5, f64::from(cell.y) + 0.5))
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
