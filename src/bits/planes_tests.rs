//! The planes against the plain grid, cell by cell.

use super::*;
use crate::geometry::Pose;
use crate::grid::CellState;

/// A grid with a value for each index.
fn grid(width: usize, height: usize, value: impl FnMut(usize) -> i8) -> OccupancyGrid {
    let info = GridInfo::new(width as u32, height as u32, 1.0, Pose::default()).unwrap();
    OccupancyGrid::new(info, (0..info.len()).map(value).collect()).unwrap()
}

/// Every cell is in the plane of its state and in no other, and the padding is zero.
fn check(planes: &BitPlanes, grid: &OccupancyGrid, thresholds: &Thresholds) {
    let info = grid.info();
    for cell in (0..info.len()).map(|i| info.cell(i)) {
        let state = grid.state(cell, thresholds);
        let found = [planes.free(), planes.unknown(), &planes.occupied()].map(|plane| plane.contains(cell));
        // What is not settled is in the robot's way like an obstacle.
        let is_in_the_way = matches!(state, CellState::Occupied | CellState::Unsettled);
        let expected = [state == CellState::Free, state == CellState::Unknown, is_in_the_way];
        assert_eq!(found, expected, "{cell:?} is {:?} in a grid {} wide", grid.get(cell), info.width());
    }
    let counts = planes.free().count() + planes.unknown().count() + planes.occupied().count();
    assert_eq!(counts, info.len());
}

#[test]
fn every_width_packs_as_the_plain_grid_says() {
    let mut planes = BitPlanes::default();
    let thresholds = Thresholds::default();
    for width in 1..=200 {
        // Steps of a generator without pattern in the low widths.
        let map = grid(width, 3, |i| (i.wrapping_mul(2_654_435_761) >> 7) as i8);
        planes.pack(&map, &thresholds);
        check(&planes, &map, &thresholds);
    }
}

#[test]
fn every_value_meets_every_pair_of_thresholds() {
    let mut planes = BitPlanes::default();
    let map = grid(257, 1, |i| i as i8);
    for free_max in 0..100 {
        for occupied_min in [free_max + 1, (free_max + 20).min(100), 100] {
            let thresholds = Thresholds { free_max, occupied_min };
            planes.pack(&map, &thresholds);
            check(&planes, &map, &thresholds);
        }
    }
}

#[test]
fn planes_are_reused_without_a_trace_of_the_last_grid() {
    let mut planes = BitPlanes::default();
    let thresholds = Thresholds::default();
    for (width, height, value) in [(70, 9, 0), (70, 9, 100), (70, 9, -1), (5, 2, 0), (130, 3, 100)] {
        let map = grid(width, height, |_| value);
        planes.pack(&map, &thresholds);
        check(&planes, &map, &thresholds);
    }
    let before = planes.free().words().as_ptr();
    planes.pack(&grid(130, 3, |_| 0), &thresholds);
    assert_eq!(planes.free().words().as_ptr(), before);
}
