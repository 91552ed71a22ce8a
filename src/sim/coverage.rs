//! How much of what there is to see has been seen: the one definition of a run's
//! coverage.
//!
//! The target area are the ground truth's free cells to which free cells lead within
//! 0.35 m from a place where a disc as wide as the robot can stand, that place being
//! connected with the start by such places. Coverage is the share of them that the map
//! knows. Cells that are merely near to such a place through a wall, or on the other
//! side of a wall that has a crack somewhere, are no target: no sensor gets to see them.

use super::{CollisionShape, World, WorldError};
use crate::geometry::{Footprint, Point, Pose};
use crate::grid::{Cell, GridInfo, NEIGHBOURS_8, Neighbourhood, OccupancyGrid};

/// How far from where the robot can stand a free cell is still a target, metres.
const SENSED_MARGIN_M: f64 = 0.35;

/// The cells that an exploration shall get to know.
#[derive(Clone, Debug, PartialEq)]
pub struct TargetArea {
    info: GridInfo,
    /// Row-major indices into the ground truth, ascending.
    cells: Vec<u32>,
}

impl TargetArea {
    /// The target area of a robot that starts at a pose.
    ///
    /// # Errors
    /// [`WorldError`] when it cannot start there.
    pub fn new(world: &World, footprint: &Footprint, start: &Pose) -> Result<Self, WorldError> {
        CollisionShape::new(footprint, world.info().resolution_m()).check_start(world, start)?;
        let info = *world.info();
        let radius_m = footprint.passage_radius_m();
        let standable = connected(&info, start.position(), |cell| world.disc_fits(cell, radius_m));
        // The margin is itself a whole number of cells for the usual resolutions.
        let margin = (SENSED_MARGIN_M / info.resolution_m() + 1e-6) as f32;
        let near = within(&info, &standable, margin, |cell| !world.is_solid(cell));
        let cells = near.iter().enumerate().filter(|&(_, &near)| near).map(|(i, _)| i as u32).collect();
        Ok(Self { info, cells })
    }

    /// Row-major indices into the ground truth, ascending.
    #[must_use]
    pub fn cells(&self) -> &[u32] {
        &self.cells
    }

    /// Its area, square metres.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        self.cells.len() as f64 * self.info.cell_area_m2()
    }

    /// The share of the area that a map knows, 0 to 1, counted from scratch.
    #[must_use]
    pub fn coverage_of(&self, map: &OccupancyGrid) -> f64 {
        let mut coverage = Coverage::new(self);
        coverage.update(map);
        coverage.share()
    }
}

/// The cells that satisfy a condition and are connected with the start by their
/// sides.
fn connected(info: &GridInfo, start: Point, holds: impl Fn(Cell) -> bool) -> Vec<bool> {
    let mut reached = vec![false; info.len()];
    let mut open = vec![info.cell_at(start)];
    while let Some(cell) = open.pop() {
        let Some(index) = info.index(cell) else { continue };
        if !reached[index] && holds(cell) {
            reached[index] = true;
            open.extend(info.neighbours(cell, Neighbourhood::Four));
        }
    }
    reached
}

/// The cells to which cells that are `open` lead from the given ones, over sides and
/// corners, within a number of cells; the given ones are among them.
fn within(info: &GridInfo, from: &[bool], limit: f32, open: impl Fn(Cell) -> bool) -> Vec<bool> {
    let mut far: Vec<f32> = from.iter().map(|&is_start| if is_start { 0.0 } else { f32::INFINITY }).collect();
    let mut rim: Vec<usize> = (0..far.len()).filter(|&i| from[i]).collect();
    // Each round corrects what the one before reached by a longer way.
    while !rim.is_empty() {
        let mut next = Vec::new();
        for index in rim {
            let cell = info.cell(index);
            for (step, (dx, dy)) in NEIGHBOURS_8.into_iter().enumerate() {
                let beside = cell.offset((dx, dy));
                // No way squeezes between two obstacles that touch at a corner.
                let is_free = step < 4 || open(cell.offset((dx, 0))) && open(cell.offset((0, dy)));
                let length = far[index] + if step < 4 { 1.0 } else { std::f32::consts::SQRT_2 };
                let Some(there) = info.index(beside) else { continue };
                if is_free && length <= limit && length < far[there] && open(beside) {
                    far[there] = length;
                    next.push(there);
                }
            }
        }
        rim = next;
    }
    far.into_iter().map(f32::is_finite).collect()
}

/// Counts coverage from map to map: a cell once known is not looked at again.
#[derive(Clone, Debug)]
pub struct Coverage {
    info: GridInfo,
    remaining: Vec<u32>,
    total: usize,
}

impl Coverage {
    /// Nothing known yet.
    #[must_use]
    pub fn new(target: &TargetArea) -> Self {
        Self { info: target.info, remaining: target.cells.clone(), total: target.cells.len() }
    }

    /// Takes in a map: target cells whose centre lies in a known cell are covered.
    /// O(cells not covered yet).
    pub fn update(&mut self, map: &OccupancyGrid) {
        let known = |cell: Cell| map.get(cell).is_some_and(|value| value >= 0);
        let truth = self.info;
        if let Some(offset) = map.info().offset_of(&truth) {
            // Indices ascend: to count the rows up is faster than to divide for each.
            let width = truth.width() as u32;
            let (mut y, mut row) = (0, 0);
            self.remaining.retain(|&i| {
                while i - row >= width {
                    (y, row) = (y + 1, row + width);
                }
                !known(Cell::new((i - row) as i32, y).offset(offset))
            });
        } else {
            self.remaining.retain(|&i| !known(map.info().cell_at(truth.center(truth.cell(i as usize)))));
        }
    }

    /// The share covered so far, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f64 {
        // The start is free and standable, so that there is at least one cell.
        1.0 - self.remaining.len() as f64 / self.total.max(1) as f64
    }

    /// Target cells not known yet, as row-major indices into the ground truth.
    #[must_use]
    pub fn remaining(&self) -> &[u32] {
        &self.remaining
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Thresholds;

    /// A drawing in cells of 0.1 m.
    fn truth(drawing: &str, yaw: f64) -> OccupancyGrid {
        let ascii = OccupancyGrid::from_ascii(drawing).unwrap();
        let (width, height) = (ascii.info().width() as u32, ascii.info().height() as u32);
        let info = GridInfo::new(width, height, 0.1, Pose::new(1.0, -2.0, yaw)).unwrap();
        OccupancyGrid::new(info, ascii.data().to_vec()).unwrap()
    }

    fn target(grid: &OccupancyGrid, start: (i32, i32)) -> TargetArea {
        let world = World::new(grid, &Thresholds::default()).unwrap();
        let at = grid.info().center(Cell::new(start.0, start.1));
        TargetArea::new(&world, &Footprint::RadiusM(0.15), &Pose::new(at.x, at.y, 0.0)).unwrap()
    }

    /// A room, a niche too narrow to enter, a sealed closet behind a thin wall, and a
    /// second room behind the niche.
    const FLAT: &str = "
        #######################
        #.......#...#.........#
        #.......#...#.........#
        #.......#...#.........#
        #.......#####.........#
        #.....................#
        #.......#####.........#
        #.......#####.........#
        #######################";

    #[test]
    fn a_niche_counts_as_far_as_it_can_be_sensed_and_a_closet_does_not() {
        let grid = truth(FLAT, 0.0);
        let target = target(&grid, (3, 4));
        let seen: Vec<Cell> = target.cells().iter().map(|&i| grid.info().cell(i as usize)).collect();
        // The last place to stand is column 6: 0.3 m on is column 9, 0.4 m column 10.
        let niche: Vec<i32> = seen.iter().filter(|c| c.y == 3 && c.x > 7).map(|c| c.x).collect();
        assert_eq!(niche, [8, 9]);
        assert!(seen.contains(&Cell::new(1, 1)) && seen.contains(&Cell::new(7, 7)));
        assert!(!seen.iter().any(|c| c.x > 8 && c.x < 12 && c.y > 4), "the closet is sealed");
        assert!(!seen.iter().any(|c| c.x > 12), "the robot does not fit through the niche");
        assert_eq!(seen.len(), 7 * 7 + 2);
        assert!((target.area_m2() - 0.51).abs() < 1e-12);
    }

    #[test]
    fn coverage_follows_maps_that_grow() {
        let grid = truth(FLAT, 0.0);
        let target = target(&grid, (3, 4));
        let mut coverage = Coverage::new(&target);
        assert_eq!(coverage.share(), 0.0);
        // Columns 1 to 3 of all rows, on the same lattice.
        let part = GridInfo::new(3, 9, 0.1, Pose::new(1.1, -2.0, 0.0)).unwrap();
        coverage.update(&OccupancyGrid::filled(part, 0));
        assert!((coverage.share() - 21.0 / 51.0).abs() < 1e-12);
        coverage.update(&OccupancyGrid::filled(part, -1));
        assert!((coverage.share() - 21.0 / 51.0).abs() < 1e-12);
        let larger = GridInfo::new(40, 40, 0.1, Pose::new(0.0, -3.0, 0.0)).unwrap();
        coverage.update(&OccupancyGrid::filled(larger, 100));
        assert_eq!((coverage.share(), coverage.remaining().len()), (1.0, 0));
    }

    #[test]
    fn turned_worlds_and_other_resolutions_are_covered_by_cell_centres() {
        let grid = truth(FLAT, 0.6);
        let target = target(&grid, (3, 4));
        assert_eq!(target.cells().len(), 51);
        let map = GridInfo::new(200, 200, 0.03, Pose::new(-2.0, -3.0, 0.0)).unwrap();
        assert_eq!(target.coverage_of(&OccupancyGrid::filled(map, 0)), 1.0);
        assert_eq!(target.coverage_of(&grid), 1.0);
    }

    #[test]
    fn a_start_in_a_wall_has_no_target() {
        let world = World::new(&truth(FLAT, 0.0), &Thresholds::default()).unwrap();
        let error = TargetArea::new(&world, &Footprint::RadiusM(0.15), &Pose::new(1.05, -1.95, 0.0));
        assert!(matches!(error, Err(WorldError::StartBlocked { .. })));
    }
}
