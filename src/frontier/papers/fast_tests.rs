//! The fast detector against a scan of the whole grid, over maps that grow and move.

use super::*;
use crate::frontier::Yamauchi;
use crate::geometry::{Point, Pose};
use crate::scan::LaserScan;
use proptest::prelude::*;
use std::f64::consts::TAU;

fn params(changed_cells: bool) -> DetectorParams {
    let fast = FastParams { changed_cells };
    DetectorParams { fast, reachability: Reachability::Textbook, ..DetectorParams::default() }
}

/// A lidar with 180 rays that saw nothing.
fn all_clear() -> LaserScan {
    LaserScan {
        angle_increment_rad: TAU / 180.0,
        range_min_m: 0.1,
        range_max_m: 100.0,
        ranges_m: vec![f32::INFINITY; 180],
        ..LaserScan::default()
    }
}

/// A disc of free cells around a place, in a map of its own origin.
fn seen_from(center: Point, radius_m: f64, info: GridInfo, before: Option<&OccupancyGrid>) -> OccupancyGrid {
    let mut grid = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
    for index in 0..info.len() {
        let cell = info.cell(index);
        let point = info.center(cell);
        let old = before.and_then(|grid| grid.get(grid.info().cell_at(point))).unwrap_or(OccupancyGrid::UNKNOWN);
        grid.set(cell, if nalgebra::distance(&point, &center) <= radius_m { OccupancyGrid::FREE } else { old });
    }
    grid
}

fn info(width: u32, height: u32, x: f64, y: f64) -> GridInfo {
    GridInfo::new(width, height, 0.5, Pose::new(x, y, 0.0)).unwrap()
}

#[test]
fn the_contour_alone_follows_a_map_that_every_scan_extends() {
    let mut fast = Fast::new(params(false));
    let scan = all_clear();
    let mut map = None;
    for (step, x) in [0.0, 2.0, 4.0, 5.0].into_iter().enumerate() {
        // The map grows to all sides, so that the same place has another index.
        let grown = step as u32;
        let size = info(60 + 4 * grown, 40 + 2 * grown, -10.0 - f64::from(grown), -10.0 - 0.5 * f64::from(grown));
        let pose = Pose::new(x, 0.3, 0.2);
        let grid = seen_from(pose.position(), 6.0, size, map.as_ref());
        let input = DetectionInput { scan: Some((&pose, &scan)), ..DetectionInput::new(&grid, pose) };
        let found = fast.detect(&input).unwrap();
        assert_eq!(found, Yamauchi::new(params(false)).detect(&input).unwrap(), "step {step}");
        assert!(!found.is_empty());
        map = Some(grid);
    }
}

#[test]
fn what_changed_out_of_sight_is_found_unless_the_paper_is_followed() {
    let size = info(80, 40, -10.0, -10.0);
    let (here, far) = (Pose::new(0.0, 0.0, 0.0), Point::new(24.0, 0.0));
    let before = seen_from(here.position(), 4.0, size, None);
    let after = seen_from(far, 3.0, size, Some(&before));
    let scan = all_clear();
    for (changed_cells, expected) in [(true, 2), (false, 1)] {
        let mut fast = Fast::new(params(changed_cells));
        for (grid, frontiers) in [(&before, 1), (&after, expected)] {
            let input = DetectionInput { scan: Some((&here, &scan)), ..DetectionInput::new(grid, here) };
            assert_eq!(fast.detect(&input).unwrap().len(), frontiers);
        }
        // Without a scan all is looked at.
        assert_eq!(fast.detect(&DetectionInput::new(&after, here)).unwrap().len(), 2);
    }
}

#[test]
fn a_map_of_other_cells_is_looked_at_anew() {
    let scan = all_clear();
    let pose = Pose::new(0.0, 0.0, 0.0);
    let mut fast = Fast::new(params(false));
    for (resolution_m, x, yaw) in [(0.5, -10.0, 0.0), (0.25, -10.0, 0.0), (0.25, -10.1, 0.0), (0.25, -10.1, 0.1)] {
        let size = GridInfo::new(80, 80, resolution_m, Pose::new(x, -9.0, yaw)).unwrap();
        let grid = seen_from(pose.position(), 2.0, size, None);
        let input = DetectionInput { scan: Some((&pose, &scan)), ..DetectionInput::new(&grid, pose) };
        assert_eq!(fast.detect(&input).unwrap(), Yamauchi::new(params(false)).detect(&input).unwrap());
    }
}

#[test]
fn a_map_without_an_answer_leaves_the_state_alone() {
    let scan = all_clear();
    let (here, nowhere) = (Pose::new(0.0, 0.0, 0.0), Pose::new(500.0, 0.0, 0.0));
    let grid = seen_from(here.position(), 4.0, info(40, 40, -10.0, -10.0), None);
    let mut fast = Fast::new(params(false));
    let at = |pose| DetectionInput { scan: Some((&here, &scan)), ..DetectionInput::new(&grid, pose) };
    let first = fast.detect(&at(here)).unwrap();
    assert!(fast.detect(&at(nowhere)).is_err());
    assert_eq!(fast.detect(&at(here)).unwrap(), first);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Any maps, one after another, at any whole shift: what a full scan finds.
    #[test]
    fn equals_a_full_scan(
        maps in proptest::collection::vec(
            (1u32..16, 1u32..16, -6i32..6, -6i32..6, proptest::collection::vec(prop_oneof![Just(-1i8), Just(0), Just(100)], 256)),
            1..5,
        ),
        textbook: bool,
        ranges_m in proptest::collection::vec(prop_oneof![0.0f32..9.0, Just(f32::INFINITY), Just(f32::NAN)], 0..40),
    ) {
        let reachability = if textbook { Reachability::Textbook } else { Reachability::WallsBlock };
        let params = DetectorParams { reachability, ..params(true) };
        let scan = LaserScan { ranges_m, ..all_clear() };
        let mut fast = Fast::new(params);
        for (width, height, x, y, values) in maps {
            let info = info(width, height, 0.5 * f64::from(x), 0.5 * f64::from(y));
            let grid = OccupancyGrid::new(info, values[..info.len()].to_vec()).unwrap();
            let middle = info.center(Cell::new(width as i32 / 2, height as i32 / 2));
            let pose = Pose::new(middle.x, middle.y, 0.4);
            let input = DetectionInput { scan: Some((&pose, &scan)), ..DetectionInput::new(&grid, pose) };
            prop_assert_eq!(fast.detect(&input), Yamauchi::new(params).detect(&input));
        }
    }
}
