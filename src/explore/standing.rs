//! Where to stand for a frontier.

use crate::geometry::{Point, Pose};
use crate::grid::{Cell, Costmap, LETHAL_COST, NARROW_COST, NEIGHBOURS_8, UNKNOWN_COST};
use crate::planning::PathField;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Which way the robot looks at its goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GoalHeading {
    /// Towards the frontier.
    #[default]
    TowardFrontier,
    /// As it comes from where it is now: no turn on arrival.
    AsApproached,
    /// As it comes where its lidar sees all round, and towards the frontier where it does not.
    AsNeeded,
}

impl GoalHeading {
    /// The heading of a robot that sees all round, or does not.
    #[must_use]
    pub const fn of_view(self, sees_all_round: bool) -> Self {
        match self {
            Self::AsNeeded if sees_all_round => Self::AsApproached,
            Self::AsNeeded => Self::TowardFrontier,
            Self::TowardFrontier | Self::AsApproached => self,
        }
    }
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

/// So far from what is unknown a place is best, metres: a wall that nobody has seen may stand
/// right there, and a map of a second later shows it.
const FROM_UNKNOWN_M: f64 = 0.25;
/// At most so many cells are looked at for that.
const MOST_KNOWN_CELLS: f64 = 10.0;

/// How good a place is, the more the better.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Quality {
    /// How many cells all round are clear of obstacles with the robot's radius and padding: none
    /// at the rim, two at most.
    clear: i32,
    /// How many cells all round are known, as far as that matters.
    known: i32,
}

impl Quality {
    /// The best that there is where so many known cells matter.
    const fn best(known: i32) -> Self {
        Self { clear: MARGIN_CELLS, known }
    }

    /// That of a cell; `None` where the robot cannot turn.
    fn of(costmap: &Costmap, cell: Cell, known_cells: i32) -> Option<Self> {
        let mut quality = Self::best(known_cells);
        for around in 0..=MARGIN_CELLS.max(known_cells) {
            let near = around - 1;
            for dy in -around..=around {
                // The cells inside were looked at in the rounds before.
                let step = if dy.abs() == around { 1 } else { (2 * around).max(1) };
                for dx in (-around..=around).step_by(step as usize) {
                    match costmap.cost(cell.offset((dx, dy))) {
                        UNKNOWN_COST => quality.known = quality.known.min(near),
                        cost if cost < NARROW_COST => {}
                        _ => quality.clear = quality.clear.min(near),
                    }
                }
            }
            let is_clear_settled = quality.clear < around || around >= MARGIN_CELLS;
            let is_known_settled = quality.known < around || around >= known_cells;
            if is_clear_settled && is_known_settled {
                break;
            }
        }
        (quality.clear >= 0).then_some(quality)
    }
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
    /// a wall. A place that keeps two cells from what the robot's centre cannot be in, and a
    /// quarter of a metre from what is unknown, is taken rather than one that does not, where
    /// it is little farther off: planners that compute with other roundings, or on a map of a
    /// second later, refuse the rim. Where
    /// the robot can stand and cannot turn there is no place to stand.
    /// `refused` are places that have failed. `None` when there is none within `radius_m`.
    pub fn goal(&mut self, field: &PathField, robot: &Pose, target: Point, search: &StandingGoal<'_>) -> Option<Pose> {
        let info = field.costmap().info();
        let place = info.goal_point(self.best_place(field, info.cell_at(target), search)?);
        let yaw = match search.heading {
            GoalHeading::TowardFrontier | GoalHeading::AsNeeded => Pose::facing(place, target).yaw,
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
        let known_cells = info.cells(FROM_UNKNOWN_M).ceil().min(MOST_KNOWN_CELLS) as i32;
        let mut best: Option<(Quality, Cell)> = None;
        let mut enough_cells = f64::INFINITY;
        let mut next = 0;
        while let Some(&(cell, slot)) = self.queue.get(next) {
            next += 1;
            let away_cells = (cell.distance_squared(center) as f64).sqrt();
            if away_cells <= enough_cells && field.reaches(cell) && !(search.refused)(info.center(cell)) {
                let quality = Quality::of(costmap, cell, known_cells);
                if quality.is_some() && best.is_none() {
                    enough_cells = away_cells + info.cells(DETOUR_M);
                }
                if let Some(quality) = quality
                    && best.is_none_or(|(highest, _)| quality > highest)
                {
                    best = Some((quality, cell));
                }
                if quality == Some(Quality::best(known_cells)) {
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
    use crate::grid::{GridInfo, INSCRIBED_COST, Inflation, OccupancyGrid, Thresholds};
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
    fn keeps_from_what_is_unknown_and_first_from_what_is_not_free() {
        let info = GridInfo::new(12, 5, 0.1, Pose::default()).unwrap();
        let place = |free: u8, rim: u8| {
            let costs = (0..60).map(|i| {
                if i % 12 >= 8 {
                    UNKNOWN_COST
                } else if i % 12 <= 2 {
                    rim
                } else {
                    free
                }
            });
            let costmap = Arc::new(Costmap::from_costs(info, costs.collect()).unwrap());
            let robot = Pose::new(0.35, 0.25, 0.0);
            let field = PathField::new(Arc::clone(&costmap), &robot).unwrap();
            let search = StandingGoal { radius_m: 1.0, heading: GoalHeading::TowardFrontier, refused: &|_| false };
            StandingSearch::default().goal(&field, &robot, Point::new(0.85, 0.25), &search)
        };
        let x = |pose: Option<Pose>| pose.map(|pose| info.cell_at(pose.position()).x);
        assert_eq!(x(place(10, 10)), Some(5), "two known cells all round: the grid is five high");
        assert_eq!(x(place(10, INSCRIBED_COST)), Some(5), "two cells from the rim and from the unknown");
        assert!(x(place(NARROW_COST, 10)).is_some_and(|x| x <= 2), "no place where it cannot turn");
    }

    #[test]
    fn keeps_the_inscribed_radius_from_walls_and_does_not_look_through_them() {
        assert_eq!(goal("....#??\n....#??\n....???\n....#??", (4.5, 1.5), 3.0), Some((3.5, 1.5)));
        assert_eq!(goal("...#???\n...#???\n...#???", (4.5, 1.5), 3.0), None);
        assert_eq!(goal("..?????\n..?????\n..?????", (6.5, 1.5), 3.0), None);
    }
}
