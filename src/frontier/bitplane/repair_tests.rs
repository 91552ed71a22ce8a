//! A sequence of updates against a detection from scratch at each step.

use super::*;
use crate::frontier::{FromScratch, Frontier, FrontierDetector};
use crate::geometry::Pose;
use crate::grid::OccupancyGrid;
use proptest::prelude::*;
use std::sync::Arc;

/// One step: what is done to the map, and where the robot is then.
#[derive(Clone, Debug)]
enum Change {
    /// A rectangle is filled with a value, with walls around it or not.
    Fill { rect: CellRect, value: i8, walled: bool },
    /// Cells of a rectangle get values of a pattern.
    Noise { rect: CellRect, seed: u32 },
    /// Nothing changes but the robot's place.
    Move,
    /// The map grows on the sides where this is not negative, and is cut on the others; then a
    /// rectangle is filled.
    Reframe { left: i32, low: i32, right: i32, high: i32, rect: CellRect, value: i8 },
    /// The map is another, of another resolution.
    Rescale { resolution_m: f64 },
}

/// A place near a seam of tiles or words, or before all.
fn near_seam(length: usize) -> impl Strategy<Value = usize> {
    let seam = prop_oneof![Just(0), Just(length), Just(2 * length), (1usize..9).prop_map(|word| word * 64)];
    (seam, -2isize..3).prop_map(|(seam, off)| seam.saturating_add_signed(off))
}

/// Rectangles anywhere, and such with their sides at the seams of tiles and words.
fn rect() -> impl Strategy<Value = CellRect> {
    let anywhere = (0usize..620, 0usize..150, 1usize..300, 1usize..90);
    let between = |a: usize, b: usize| (a.min(b), a.abs_diff(b).max(1));
    let at_seams = (near_seam(256), near_seam(256), near_seam(64), near_seam(64)).prop_map(move |(x0, x1, y0, y1)| {
        let ((x, width), (y, height)) = (between(x0, x1), between(y0, y1));
        (x, y, width, height)
    });
    prop_oneof![anywhere, at_seams].prop_map(|(x, y, width, height)| CellRect { x, y, width, height })
}

/// By how much a side grows: not at all, a little, across tiles, or less than nothing.
fn side() -> impl Strategy<Value = i32> {
    prop_oneof![4 => Just(0), 2 => 1i32..=300, 1 => 1i32..70, 1 => (1i32..5).prop_map(|words| 64 * words), 1 => -90i32..0]
}

fn reframe() -> impl Strategy<Value = Change> {
    let value = prop_oneof![Just(0i8), Just(100i8), Just(-1i8)];
    (side(), side(), side(), side(), rect(), value).prop_map(|(left, low, right, high, rect, value)| Change::Reframe {
        left,
        low,
        right,
        high,
        rect,
        value,
    })
}

fn change() -> impl Strategy<Value = Change> {
    let value = prop_oneof![Just(0i8), Just(0i8), Just(100i8), Just(-1i8)];
    prop_oneof![
        6 => (rect(), value, any::<bool>()).prop_map(|(rect, value, walled)| Change::Fill { rect, value, walled }),
        3 => (rect(), any::<u32>()).prop_map(|(rect, seed)| Change::Noise { rect, seed }),
        1 => Just(Change::Move),
        3 => reframe(),
        1 => (0.5f64..3.0).prop_map(|resolution_m| Change::Rescale { resolution_m }),
    ]
}

/// The map after a change, and the rectangle that it changed where there is one.
fn apply(grid: &mut OccupancyGrid, change: &Change) -> Option<CellRect> {
    match *change {
        Change::Fill { rect, value, walled } => {
            for y in rect.y..rect.y + rect.height {
                for x in rect.x..rect.x + rect.width {
                    let rim =
                        x == rect.x || y == rect.y || x + 1 == rect.x + rect.width || y + 1 == rect.y + rect.height;
                    grid.set(Cell::new(x as i32, y as i32), if walled && rim { 100 } else { value });
                }
            }
            Some(rect)
        }
        Change::Noise { rect, mut seed } => {
            for y in rect.y..rect.y + rect.height {
                for x in rect.x..rect.x + rect.width {
                    seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                    grid.set(Cell::new(x as i32, y as i32), [0, 0, 0, -1, 100][(seed >> 16) as usize % 5]);
                }
            }
            Some(rect)
        }
        Change::Move => Some(CellRect { x: 0, y: 0, width: 0, height: 0 }),
        Change::Reframe { left, low, right, high, rect, value } => {
            let old = *grid.info();
            let length = |old: usize, more: i32| (old as i32 + more).max(1) as u32;
            let (width, height) = (length(old.width(), left + right), length(old.height(), low + high));
            let corner = old.from_grid_units(-f64::from(left), -f64::from(low));
            let info = GridInfo::new(width, height, old.resolution_m(), Pose::new(corner.x, corner.y, 0.0)).unwrap();
            let mut next = OccupancyGrid::filled(info, if (left + low) % 3 == 0 { 100 } else { -1 });
            for index in 0..old.len() {
                next.set(old.cell(index).offset((left, low)), grid.data()[index]);
            }
            *grid = next;
            apply(grid, &Change::Fill { rect, value, walled: false })
        }
        Change::Rescale { resolution_m } => {
            let old = *grid.info();
            let info =
                GridInfo::new(old.width() as u32, old.height() as u32, resolution_m, old.origin_in_map()).unwrap();
            *grid = OccupancyGrid::new(info, grid.data().to_vec()).unwrap();
            Some(CellRect { x: 0, y: 0, width: 0, height: 0 })
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

    #[test]
    fn each_update_gives_what_detection_from_scratch_gives(
        (width, height) in prop_oneof![(1u32..600, 1u32..140), (300u32..600, 70u32..140)],
        first in prop_oneof![Just(-1i8), Just(0i8)],
        steps in proptest::collection::vec((change(), any::<prop::sample::Index>(), any::<bool>()), 1..16),
        textbook: bool, eight: bool, min_size_m in 0.0f64..4.0,
    ) {
        let params = DetectorParams {
            reachability: if textbook { Reachability::Textbook } else { Reachability::WallsBlock },
            neighbours: if eight { Neighbourhood::Eight } else { Neighbourhood::Four },
            min_size_m,
            ..DetectorParams::default()
        };
        let mut grid = OccupancyGrid::filled(GridInfo::new(width, height, 1.0, Pose::default()).unwrap(), first);
        let mut kept = Repair::new(params);
        for (change, robot, tell) in steps {
            let rect = apply(&mut grid, &change);
            let info = *grid.info();
            // The robot stands in free space, in another component now and then, or errs.
            let free: Vec<usize> = (0..info.len()).filter(|&i| grid.data()[i] == 0).collect();
            let cell = if free.is_empty() { info.cell(robot.index(info.len())) } else { info.cell(free[robot.index(free.len())]) };
            let at = info.center(cell);
            let input = DetectionInput::new(&grid, Pose::new(at.x, at.y, 0.0));
            let told = if tell { rect } else { None };
            let expected = FromScratch::new(params).detect(&input);
            let found = kept.update(&input, told).map(|lists| Frontier::all_of(&Arc::new(lists.clone())));
            prop_assert_eq!(found, expected, "after {:?} told {:?}", change, told);
        }
    }
}

#[test]
fn what_changed_while_there_was_no_answer_is_not_forgotten() {
    let params = DetectorParams::default();
    let mut grid = OccupancyGrid::filled(GridInfo::new(300, 100, 1.0, Pose::default()).unwrap(), -1);
    let mut kept = Repair::new(params);
    let fill = |grid: &mut OccupancyGrid, x: i32| {
        (10..20).for_each(|y| (x..x + 20).for_each(|x| grid.set(Cell::new(x, y), 0)));
        Some(CellRect { x: x as usize, y: 10, width: 20, height: 10 })
    };
    let rect = fill(&mut grid, 10);
    let at = |x| Pose::new(x, 15.0, 0.0);
    assert_eq!(kept.update(&DetectionInput::new(&grid, at(15.0)), rect).unwrap().len(), 1);
    let rect = fill(&mut grid, 30);
    assert!(kept.update(&DetectionInput::new(&grid, at(-15.0)), rect).is_err());
    let nothing = Some(CellRect { x: 0, y: 0, width: 0, height: 0 });
    let input = DetectionInput::new(&grid, at(15.0));
    let found = Frontier::all_of(&Arc::new(kept.update(&input, nothing).unwrap().clone()));
    assert_eq!(Ok(found), FromScratch::new(params).detect(&input));
}

#[test]
fn a_map_that_grows_is_looked_at_where_it_is_new_alone() {
    let params = DetectorParams::default();
    let mut grid = OccupancyGrid::filled(GridInfo::new(500, 150, 1.0, Pose::default()).unwrap(), 0);
    let mut kept = Repair::new(params);
    let robot = Pose::new(200.5, 50.5, 0.0);
    assert_eq!(kept.update(&DetectionInput::new(&grid, robot), None).unwrap().len(), 0);
    for (left, low, right, high) in [(4, 0, 0, 0), (0, 70, 0, 0), (301, 0, 5, 2), (1, 1, 300, 100), (41, 20, 0, 0)] {
        // An unknown cell within the first map, of which nothing is told at first.
        let unseen = Cell::new(400, 100);
        let rect = CellRect { x: 400, y: 100, width: 1, height: 1 };
        let _ = apply(&mut grid, &Change::Reframe { left, low, right, high, rect, value: -1 });
        let input = DetectionInput::new(&grid, robot);
        let told = kept.update(&input, Some(CellRect::default())).unwrap();
        assert!(!told.is_empty() && told.iter().flatten().all(|&cell| cell != unseen));
        let told = Frontier::all_of(&Arc::new(kept.update(&input, Some(rect)).unwrap().clone()));
        assert!(told.iter().any(|frontier| *frontier.cells == [unseen]));
        assert_eq!(Ok(told), FromScratch::new(params).detect(&input));
        grid.set(unseen, 0);
        assert!(kept.update(&DetectionInput::new(&grid, robot), Some(rect)).is_ok());
    }
}
