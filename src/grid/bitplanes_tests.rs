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
        let found = [planes.free(), planes.unknown(), planes.occupied()].map(|plane| plane.contains(cell));
        let expected = [CellState::Free, CellState::Unknown, CellState::Occupied].map(|kind| kind == state);
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

#[test]
fn runs_are_cleared_to_the_cell() {
    for (start, end) in [(0, 0), (0, 1), (3, 3), (60, 64), (64, 65), (63, 129), (0, 200), (199, 200), (128, 192)] {
        let mut plane = BitPlane::new(200, 3);
        for x in 0..200 {
            plane.insert(Cell::new(x, 1));
        }
        plane.clear_run(1, start, end);
        for x in 0..200 {
            let inside = (start..end).contains(&(x as usize));
            assert_eq!(plane.contains(Cell::new(x, 1)), !inside, "{start}..{end} at {x}");
        }
        assert_eq!(plane.count(), 200 - (end - start));
    }
}

#[test]
fn runs_are_found_to_the_cell() {
    for (start, end) in [(0, 1), (3, 4), (60, 64), (64, 65), (63, 129), (0, 192), (191, 192), (128, 192), (0, 64)] {
        let mut plane = BitPlane::new(192, 2);
        for x in start..end {
            plane.insert(Cell::new(x as i32, 1));
        }
        assert_eq!(plane.run_around(1, start), start..end);
        assert_eq!(plane.run_around(1, end - 1), start..end);
        assert_eq!(plane.first_in(1, 0..192), Some(start));
        assert_eq!(plane.first_in(1, end - 1..192), Some(end - 1));
        assert_eq!(plane.first_in(1, 0..start), None);
        assert_eq!(plane.first_in(1, end..192), None);
        assert_eq!(plane.first_in(0, 0..192), None);
    }
}

#[test]
fn outside_nothing_is_set() {
    let mut plane = BitPlane::new(65, 2);
    for cell in [Cell::new(-1, 0), Cell::new(65, 0), Cell::new(0, 2), Cell::new(0, -1)] {
        plane.insert(cell);
        assert!(!plane.contains(cell));
    }
    assert_eq!(plane.count(), 0);
    assert_eq!((plane.row_words(), plane.last_word_mask()), (2, 1));
    assert_eq!(BitPlane::new(128, 1).last_word_mask(), u64::MAX);
}
