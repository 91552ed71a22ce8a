//! One table of cases that every detector must pass, over `DetectorKind::ALL`.

#![allow(clippy::unwrap_used)] // the helpers below serve tests alone

use frontier_explorer::frontier::{
    CellSide, DetectError, DetectionInput, DetectorKind, DetectorParams, Frontier, FrontierDetector, Reachability,
    Representative,
};
use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Cell, CellState, Costmap, GridInfo, Inflation, OccupancyGrid, Thresholds};
use frontier_explorer::scan::LaserScan;
use std::f64::consts::TAU;

const FREE: i8 = OccupancyGrid::FREE;
const WALL: i8 = OccupancyGrid::OCCUPIED;
const UNKNOWN: i8 = OccupancyGrid::UNKNOWN;
const RESOLUTION_M: f64 = 0.05;

/// Runs a case with every detector under both rules of reachability.
fn for_each(check: impl Fn(&str, &mut dyn Fn() -> Box<dyn FrontierDetector>)) {
    for &kind in DetectorKind::ALL {
        for reachability in [Reachability::WallsBlock, Reachability::Textbook] {
            let params = DetectorParams { reachability, ..DetectorParams::default() };
            check(&format!("{} {reachability:?}", kind.name()), &mut || kind.build(&params));
        }
    }
}

/// A lidar that turns once round and hits nothing.
fn scan() -> LaserScan {
    LaserScan {
        angle_increment_rad: TAU / 720.0,
        range_min_m: 0.1,
        range_max_m: 30.0,
        ranges_m: vec![f32::INFINITY; 720],
        ..LaserScan::default()
    }
}

/// Detects with a costmap and a scan, and checks what holds for every detection.
fn detect(
    name: &str,
    detector: &mut dyn FrontierDetector,
    grid: &OccupancyGrid,
    robot: Pose,
) -> Result<Vec<Frontier>, DetectError> {
    let thresholds = Thresholds::default();
    let inflation =
        Inflation { inscribed_radius_m: 0.1, clear_radius_m: 0.0, inflation_radius_m: 0.3, cost_scaling_factor: 5.0 };
    let costmap = Costmap::inflate(grid, &thresholds, &inflation);
    let scan = scan();
    let scan = Some((&robot, &scan));
    let input = DetectionInput { grid, robot_in_map: robot, costmap: Some(&costmap), scan, changes: None };
    let found = detector.detect(&input)?;
    let info = grid.info();
    let row_major = |cell: &Cell| (cell.y, cell.x);
    assert!(found.is_sorted_by_key(|f| f.cells.first().map(row_major)), "{name}: frontiers out of order");
    let ids: Vec<u64> = found.iter().map(|f| f.id).collect();
    assert_eq!(ids, (0..found.len() as u64).collect::<Vec<_>>(), "{name}");
    let mut all: Vec<Cell> = found.iter().flat_map(|f| f.cells.to_vec()).collect();
    let count = all.len();
    all.sort_unstable();
    all.dedup();
    assert_eq!(all.len(), count, "{name}: a cell in two frontiers");
    for frontier in &found {
        assert!(!frontier.cells.is_empty(), "{name}: a frontier without cells");
        assert!(frontier.cells.is_sorted_by_key(row_major), "{name}: cells out of order");
        for &cell in &frontier.cells {
            assert!(info.contains(cell), "{name}: {cell:?} outside the grid");
            let state = grid.state(cell, &thresholds);
            match frontier.side {
                CellSide::Unknown => assert_eq!(state, CellState::Unknown, "{name}: {cell:?}"),
                CellSide::Free => assert_eq!(state, CellState::Free, "{name}: {cell:?}"),
                CellSide::Either => {}
            }
        }
    }
    Ok(found)
}

fn info(width: u32, height: u32, origin: Pose) -> GridInfo {
    GridInfo::new(width, height, RESOLUTION_M, origin).unwrap()
}

fn fill(grid: &mut OccupancyGrid, columns: std::ops::Range<i32>, rows: std::ops::Range<i32>, value: i8) {
    for y in rows {
        for x in columns.clone() {
            grid.set(Cell::new(x, y), value);
        }
    }
}

/// A room of 2 x 2 m within walls, with a door of 0.8 m in the middle of its right
/// side, in the unknown; the door's cells are (50, 32..48).
fn room(origin: Pose, free: i8) -> OccupancyGrid {
    let mut grid = OccupancyGrid::filled(info(90, 80, origin), UNKNOWN);
    fill(&mut grid, 9..51, 19..61, WALL);
    fill(&mut grid, 10..50, 20..60, free);
    fill(&mut grid, 50..51, 32..48, free);
    grid
}

const IN_THE_ROOM: Pose = Pose::new(1.5, 2.0, 0.3);

/// Exactly one frontier, and it is at the door: 2.55 m, 2 m in the grid's own frame.
fn assert_at_the_door(name: &str, found: &[Frontier], info: &GridInfo) {
    assert_eq!(found.len(), 1, "{name}: {found:?}");
    let door = info.from_grid_units(51.0, 40.0);
    let robot = info.from_grid_units(30.0, 40.0);
    for representative in [
        Representative::Median,
        Representative::Centroid,
        Representative::NearestMember,
        Representative::CentralMember,
        Representative::CircleCenter,
    ] {
        let point = representative.of(&found[0], info, robot);
        let off_m = nalgebra::distance(&point, &door);
        assert!(off_m < 0.2, "{name}: {representative:?} is {off_m} m from the door");
    }
    let span = found[0].cells.iter().map(|c| c.y).fold((i32::MAX, i32::MIN), |(a, b), y| (a.min(y), b.max(y)));
    assert!(span.0 >= 30 && span.1 <= 49 && span.1 - span.0 >= 8, "{name}: rows {span:?}");
}

#[test]
fn one_room_with_one_door_has_one_frontier() {
    for_each(|name, build| {
        let grid = room(Pose::default(), FREE);
        let found = detect(name, &mut *build(), &grid, IN_THE_ROOM).unwrap();
        assert_at_the_door(name, &found, grid.info());
    });
}

#[test]
fn greys_of_cartographer_are_free() {
    for_each(|name, build| {
        let mut grid = room(Pose::default(), 47);
        fill(&mut grid, 15..25, 25..35, 64);
        let found = detect(name, &mut *build(), &grid, IN_THE_ROOM).unwrap();
        assert_at_the_door(name, &found, grid.info());
    });
}

#[test]
fn a_turned_map_has_its_frontier_at_the_same_place_of_the_world() {
    for_each(|name, build| {
        let origin = Pose::new(-3.0, 7.0, 2.2);
        let grid = room(origin, FREE);
        let robot = origin.compose(&IN_THE_ROOM);
        let found = detect(name, &mut *build(), &grid, robot).unwrap();
        assert_at_the_door(name, &found, grid.info());
        let door = Representative::Centroid.of(&found[0], grid.info(), robot.position());
        assert!((door - origin.transform(Point::new(2.55, 2.0))).norm() < 0.15, "{name}: {door}");
    });
}

#[test]
fn a_map_that_grew_to_the_lower_left_keeps_its_frontier() {
    for_each(|name, build| {
        let mut detector = build();
        let small = room(Pose::default(), FREE);
        let before = detect(name, &mut *detector, &small, IN_THE_ROOM).unwrap();
        let mut large = OccupancyGrid::filled(info(130, 100, Pose::new(-1.5, -0.5, 0.0)), UNKNOWN);
        for index in 0..small.info().len() {
            let cell = small.info().cell(index);
            large.set(cell.offset((30, 10)), small.data()[index]);
        }
        let after = detect(name, &mut *detector, &large, IN_THE_ROOM).unwrap();
        let moved: Vec<Vec<Cell>> =
            before.iter().map(|f| f.cells.iter().map(|c| c.offset((30, 10))).collect()).collect();
        assert_eq!(after.iter().map(|f| f.cells.to_vec()).collect::<Vec<_>>(), moved, "{name}");
        // And back: maps of Cartographer shrink as well.
        assert_eq!(detect(name, &mut *detector, &small, IN_THE_ROOM).unwrap(), before, "{name}");
    });
}

#[test]
fn what_was_explored_is_a_frontier_no_longer() {
    for_each(|name, build| {
        let mut detector = build();
        let mut grid = room(Pose::default(), FREE);
        assert_eq!(detect(name, &mut *detector, &grid, IN_THE_ROOM).unwrap().len(), 1, "{name}");
        fill(&mut grid, 51..52, 19..61, WALL);
        assert_eq!(detect(name, &mut *detector, &grid, IN_THE_ROOM).unwrap(), [], "{name}");
    });
}

#[test]
fn where_all_is_free_there_is_no_frontier() {
    for_each(|name, build| {
        let grid = OccupancyGrid::filled(info(60, 40, Pose::default()), FREE);
        assert_eq!(detect(name, &mut *build(), &grid, Pose::new(1.0, 1.0, 0.0)).unwrap(), [], "{name}");
        let one = OccupancyGrid::filled(info(1, 1, Pose::default()), FREE);
        assert_eq!(detect(name, &mut *build(), &one, Pose::new(0.02, 0.02, 0.0)).unwrap(), [], "{name}");
    });
}

#[test]
fn one_known_cell_has_its_frontier_around_it_or_none() {
    for_each(|name, build| {
        let mut grid = OccupancyGrid::filled(info(60, 40, Pose::default()), UNKNOWN);
        let cell = Cell::new(20, 20);
        grid.set(cell, FREE);
        let at = grid.info().center(cell);
        let found = detect(name, &mut *build(), &grid, Pose::new(at.x, at.y, 0.0)).unwrap();
        assert!(found.len() <= 1, "{name}");
        assert!(found.iter().flat_map(|f| &f.cells).all(|c| c.distance_squared(cell) <= 2), "{name}: {found:?}");
        // One cell is noise to DBSCAN and lost in Canny's blur.
        let small_is_nothing = name.starts_with("dbscan") || name.starts_with("canny");
        assert!(small_is_nothing || found.len() == 1, "{name}");
    });
}

#[test]
fn nothing_known_around_the_robot_is_an_error() {
    for_each(|name, build| {
        let grid = OccupancyGrid::filled(info(60, 40, Pose::default()), UNKNOWN);
        let found = detect(name, &mut *build(), &grid, Pose::new(1.0, 1.0, 0.0));
        assert!(matches!(found, Err(DetectError::NoFreeCellNear { .. })), "{name}: {found:?}");
        let far = detect(name, &mut *build(), &room(Pose::default(), FREE), Pose::new(4.4, 2.0, 0.0));
        assert!(matches!(far, Err(DetectError::NoFreeCellNear { .. })), "{name}: {far:?}");
    });
}

#[test]
fn a_robot_off_the_map_is_an_error() {
    for_each(|name, build| {
        for (x, y) in [(-0.01, 1.0), (1.0, 4.01), (1e9, 0.0), (f64::NAN, f64::INFINITY)] {
            let found = detect(name, &mut *build(), &room(Pose::default(), FREE), Pose::new(x, y, 0.0));
            assert!(matches!(found, Err(DetectError::RobotOutsideMap { .. })), "{name} ({x}, {y}): {found:?}");
        }
    });
}

#[test]
fn a_robot_in_a_wall_starts_at_the_nearest_free_cell() {
    for_each(|name, build| {
        let mut grid = room(Pose::default(), FREE);
        fill(&mut grid, 28..33, 38..43, WALL);
        let found = detect(name, &mut *build(), &grid, IN_THE_ROOM).unwrap();
        assert_at_the_door(name, &found, grid.info());
    });
}

#[test]
fn small_frontiers_are_dropped() {
    for &kind in DetectorKind::ALL {
        let grid = room(Pose::default(), FREE);
        let found = |min_size_m| {
            let params = DetectorParams { min_size_m, ..DetectorParams::default() };
            detect(kind.name(), &mut *kind.build(&params), &grid, IN_THE_ROOM).unwrap()
        };
        let size_m = found(0.0)[0].size_m(grid.info());
        assert_eq!(found(size_m).len(), 1, "{}", kind.name());
        assert_eq!(found(size_m + 0.01), [], "{}", kind.name());
    }
}

#[test]
fn walls_block() {
    for &kind in DetectorKind::ALL {
        // Behind the room's left wall another space opens into the unknown.
        let mut grid = room(Pose::default(), FREE);
        fill(&mut grid, 2..9, 25..55, FREE);
        let found = detect(kind.name(), &mut *kind.build(&DetectorParams::default()), &grid, IN_THE_ROOM).unwrap();
        assert_at_the_door(kind.name(), &found, grid.info());
        let textbook = DetectorParams { reachability: Reachability::Textbook, ..DetectorParams::default() };
        let found = detect(kind.name(), &mut *kind.build(&textbook), &grid, IN_THE_ROOM).unwrap();
        assert!(found.len() >= 2, "{}", kind.name());
    }
}

#[test]
fn beside_what_is_seen_and_not_settled_there_is_no_frontier() {
    let thresholds = Thresholds { free_max: 25, occupied_min: 65 };
    let params = DetectorParams { thresholds, ..DetectorParams::default() };
    for &kind in DetectorKind::ALL {
        // A door of greys, as Cartographer has them where it has looked once.
        let mut grid = room(Pose::default(), FREE);
        fill(&mut grid, 50..51, 32..48, 45);
        let found = detect(kind.name(), &mut *kind.build(&params), &grid, IN_THE_ROOM).unwrap();
        assert_eq!(found, [], "{}", kind.name());
        fill(&mut grid, 50..51, 36..44, FREE);
        let found = detect(kind.name(), &mut *kind.build(&params), &grid, IN_THE_ROOM).unwrap();
        assert_eq!(found.len(), 1, "{}: what is free of the door is one", kind.name());
    }
}

#[test]
fn the_same_question_has_the_same_answer() {
    for_each(|name, build| {
        // Patches of all kinds, always the same ones.
        let mut grid = OccupancyGrid::filled(info(120, 90, Pose::new(1.0, -2.0, 0.4)), UNKNOWN);
        let mut random: u32 = 7;
        let mut next = |below: i32| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 16) as i32 % below
        };
        for _ in 0..60 {
            let (x, y) = (next(110), next(80));
            let value = [FREE, FREE, FREE, WALL, UNKNOWN][next(5) as usize];
            let (wide, high) = (4 + next(20), 4 + next(20));
            fill(&mut grid, x..x + wide, y..y + high, value);
        }
        let robot = grid.info().center(Cell::new(60, 45));
        fill(&mut grid, 55..66, 40..51, FREE);
        let pose = Pose::new(robot.x, robot.y, 1.0);
        let mut detector = build();
        let first = detect(name, &mut *detector, &grid, pose).unwrap();
        assert!(!first.is_empty(), "{name}");
        assert_eq!(detect(name, &mut *detector, &grid, pose).unwrap(), first, "{name}");
        assert_eq!(detect(name, &mut *build(), &grid, pose).unwrap(), first, "{name}");
    });
}

#[test]
fn names_are_those_of_the_configuration() {
    for &kind in DetectorKind::ALL {
        assert_eq!(kind.build(&DetectorParams::default()).name(), kind.name());
        assert_eq!(serde_json::to_string(&kind).unwrap(), format!("\"{}\"", kind.name()));
        assert_eq!(serde_json::from_str::<DetectorKind>(&format!("\"{}\"", kind.name())).unwrap(), kind);
    }
}
