//! What the robot could have seen from where it was: whether a frontier is one in vain.
//!
//! A frontier that is still there on a map of later, though its cells lay near and in
//! plain sight of a place where the robot was, shows nothing more: a pane of glass, a gap
//! between two rays. A visit says less than this: the robot may have looked the other way,
//! or the map may be of before.

use crate::frontier::Frontier;
use crate::geometry::{Point, Pose, shortest_angle};
use crate::grid::{Cell, CellState, GridInfo, NEIGHBOURS_8, OccupancyGrid, Thresholds, traverse};
use crate::scan::Sight;
use std::collections::HashMap;

/// The longest distance that is sure, metres.
const SURE_M: f64 = 3.0;

/// Up to here what is seen is seen for sure: rays lie closer together than cells, and SLAM uses
/// them all. Metres.
#[must_use]
pub fn sure_m(sight: &Sight) -> f64 {
    (0.5 * sight.range_m).min(SURE_M)
}

/// So near to a cell, what a line meets belongs to the same wall, metres: gmapping smears one
/// over two or three cells, and erases it in part when it looks along it from afar.
const SMEAR_M: f64 = 0.15;
/// From one place that is remembered to the next, metres and radians.
const SPACING_M: f64 = 0.25;
const SPACING_RAD: f64 = 0.3;
/// From a sight to a map that shows it, at least, seconds.
const TAKEN_IN_S: f64 = 0.3;
/// Side of a square of the memory, metres: at least the longest sure distance.
const SQUARE_M: f64 = SURE_M;
/// So many of a frontier's cells are looked at.
const SAMPLES: usize = 16;
/// And so many places for each of them.
const PLACES: usize = 8;

/// A place where the robot was.
#[derive(Clone, Copy, Debug)]
struct Place {
    pose: Pose,
    /// When it came there first, seconds.
    since_s: f64,
}

/// The places where the robot was.
#[derive(Clone, Debug)]
pub struct Sights {
    sight: Sight,
    squares: HashMap<(i32, i32), Vec<Place>>,
}

/// How much of a frontier has been seen in vain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// All that was looked at.
    pub all: bool,
    /// The cell nearest to the robot that was not seen in vain, if there is one.
    pub nearest_open: Option<Point>,
}

impl Sights {
    /// No place so far.
    #[must_use]
    pub fn new(sight: Sight) -> Self {
        Self { sight, squares: HashMap::new() }
    }

    /// The robot is at a pose at a time in seconds.
    pub fn stand(&mut self, pose: &Pose, now_s: f64) {
        let all_round = self.sight.is_all_round();
        let is_here = |place: &Place| {
            place.pose.distance_to(pose.position()) < SPACING_M
                && (all_round || shortest_angle(place.pose.yaw, pose.yaw).abs() < SPACING_RAD)
        };
        let places = self.squares.entry(square_of(pose.position())).or_default();
        if !places.iter().any(is_here) {
            places.push(Place { pose: *pose, since_s: now_s });
        }
    }

    /// What the robot's lidar can see.
    #[must_use]
    pub const fn sight(&self) -> Sight {
        self.sight
    }

    /// Nothing that was seen before counts any more, as after a jump of the map under the
    /// robot.
    pub fn forget(&mut self) {
        self.squares.clear();
    }

    /// How much of a frontier was in plain sight of a place where the robot was at
    /// `until_s` or before, in seconds.
    #[must_use]
    pub fn of_frontier(
        &self,
        frontier: &Frontier,
        grid: &OccupancyGrid,
        thresholds: &Thresholds,
        robot: Point,
        until_s: f64,
    ) -> Seen {
        let info = grid.info();
        let step = frontier.cells.len().div_ceil(SAMPLES).max(1);
        let mut nearest: Option<(f64, Point)> = None;
        for &cell in frontier.cells.iter().step_by(step) {
            let point = info.center(cell);
            let distance_m = nalgebra::distance(&point, &robot);
            if nearest.is_some_and(|(nearest_m, _)| nearest_m <= distance_m) {
                continue;
            }
            if !self.has_seen(cell, grid, thresholds, until_s) {
                nearest = Some((distance_m, point));
            }
        }
        Seen { all: nearest.is_none(), nearest_open: nearest.map(|(_, point)| point) }
    }

    fn has_seen(&self, cell: Cell, grid: &OccupancyGrid, thresholds: &Thresholds, until_s: f64) -> bool {
        let info = grid.info();
        let (center, sure_m) = (info.center(cell), sure_m(&self.sight));
        let mut near: Vec<(f64, &Place)> = Vec::new();
        let (x, y) = square_of(center);
        for square in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (x + dx, y + dy))) {
            let places = self.squares.get(&square).into_iter().flatten();
            let seen =
                places.filter(|place| place.since_s + TAKEN_IN_S <= until_s && self.sight.covers(&place.pose, center));
            near.extend(seen.map(|place| (place.pose.distance_to(center), place)).filter(|(m, _)| *m <= sure_m));
        }
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        near.into_iter().take(PLACES).any(|(_, place)| is_in_sight(place.pose.position(), cell, grid, thresholds))
    }
}

/// Whether nothing but free cells lies between a point and a cell, or a free one beside it.
#[must_use]
pub fn is_in_sight(from: Point, cell: Cell, grid: &OccupancyGrid, thresholds: &Thresholds) -> bool {
    let info = grid.info();
    let is_free = |cell: Cell| grid.state(cell, thresholds) == CellState::Free;
    if is_free(cell) {
        return is_line_free(from, cell, info, is_free);
    }
    let mut beside: Vec<Cell> = NEIGHBOURS_8.iter().map(|&o| cell.offset(o)).filter(|&c| is_free(c)).collect();
    beside.sort_by(|a, b| {
        nalgebra::distance(&info.center(*a), &from).total_cmp(&nalgebra::distance(&info.center(*b), &from))
    });
    beside.into_iter().take(2).any(|cell| is_line_free(from, cell, info, is_free))
}

fn is_line_free(from: Point, to: Cell, info: &GridInfo, is_free: impl Fn(Cell) -> bool) -> bool {
    let own = info.cell_at(from);
    let line = info.center(to) - from;
    // The robot's own cell may hold anything: noise marks it now and then.
    let is_smear = |cell: Cell| nalgebra::distance(&info.center(cell), &info.center(to)) <= SMEAR_M;
    traverse(info, from, line.y.atan2(line.x), line.norm())
        .all(|(cell, _)| cell == own || is_free(cell) || is_smear(cell))
}

fn square_of(point: Point) -> (i32, i32) {
    ((point.x / SQUARE_M).floor() as i32, (point.y / SQUARE_M).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontier::CellSide;

    const ALL_ROUND: Sight = Sight { range_m: 8.0, field_of_view_rad: 6.3, heading_rad: 0.0 };
    const THRESHOLDS: Thresholds = Thresholds { free_max: 64, occupied_min: 65 };

    /// A room whose eastern side is unknown.
    const ROOM: &str = "#####\n#...?\n#.#.?\n#...?\n#####";

    fn seen(sights: &Sights, drawing: &str, cells: &[(i32, i32)], until_s: f64) -> Seen {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let cells: Vec<Cell> = cells.iter().map(|&(x, y)| Cell::new(x, y)).collect();
        let frontier = Frontier { id: 0, cells: cells.into(), side: CellSide::Unknown, circle: None };
        sights.of_frontier(&frontier, &grid, &THRESHOLDS, Point::new(1.5, 1.5), until_s)
    }

    #[test]
    fn only_what_was_near_in_sight_and_before_the_map_is_seen_in_vain() {
        let mut sights = Sights::new(ALL_ROUND);
        sights.stand(&Pose::new(3.5, 2.5, 0.0), 10.0);
        let cells = [(4, 1), (4, 2), (4, 3)];
        assert!(seen(&sights, ROOM, &cells, 10.5).all);
        let before = seen(&sights, ROOM, &cells, 9.0);
        assert_eq!((before.all, before.nearest_open), (false, Some(Point::new(4.5, 1.5))));
        // More than three metres off is no close look, and through the pillar nothing is seen.
        let mut far = Sights::new(ALL_ROUND);
        far.stand(&Pose::new(1.1, 1.1, 0.0), 1.0);
        assert!(!seen(&far, ROOM, &cells, 5.0).all);
        let mut behind = Sights::new(Sight { range_m: 80.0, ..ALL_ROUND });
        behind.stand(&Pose::new(1.5, 2.5, 0.0), 1.0);
        assert!(!seen(&behind, "#####\n#...#\n#.#?#\n#...#\n#####", &[(3, 2)], 5.0).all);
    }

    #[test]
    fn a_narrow_view_counts_where_it_points() {
        let narrow = Sight { field_of_view_rad: 1.0, ..ALL_ROUND };
        let mut sights = Sights::new(narrow);
        sights.stand(&Pose::new(3.5, 2.5, 3.0), 1.0);
        assert!(!seen(&sights, ROOM, &[(4, 2)], 5.0).all);
        sights.stand(&Pose::new(3.5, 2.5, 0.0), 2.0);
        assert!(seen(&sights, ROOM, &[(4, 2)], 5.0).all);
    }

    #[test]
    fn a_place_counts_from_the_first_time_on() {
        let mut sights = Sights::new(ALL_ROUND);
        sights.stand(&Pose::new(3.5, 2.5, 0.0), 1.0);
        sights.stand(&Pose::new(2.5, 1.5, 0.0), 2.0);
        sights.stand(&Pose::new(3.45, 2.5, 0.0), 9.0);
        assert!(seen(&sights, ROOM, &[(4, 2)], 1.5).all);
        sights.forget();
        assert!(!seen(&sights, ROOM, &[(4, 2)], 9.0).all);
    }
}
