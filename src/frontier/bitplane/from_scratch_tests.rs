//! The bit planes against the textbook: the same frontiers, cells, order and numbers.

use super::*;
use crate::frontier::Wavefront;
use crate::frontier::random_maps::{noise, with_robot};
use crate::geometry::{Point, Pose};
use crate::grid::OccupancyGrid;
use crate::io::load_map;
use proptest::prelude::*;
use std::path::Path;

fn detect(detector: &mut impl FrontierDetector, grid: &OccupancyGrid, robot: Point) -> Vec<Frontier> {
    let input = DetectionInput::new(grid, Pose::new(robot.x, robot.y, 0.0));
    detector.detect(&input).unwrap()
}

/// All modes and neighbourhoods.
fn all_params(min_size_m: f64) -> Vec<DetectorParams> {
    let mut all = Vec::new();
    for reachability in [Reachability::Textbook, Reachability::WallsBlock] {
        for neighbours in [Neighbourhood::Four, Neighbourhood::Eight] {
            all.push(DetectorParams { reachability, neighbours, min_size_m, ..DetectorParams::default() });
        }
    }
    all
}

/// Number of frontiers found, which must be the textbook's in every respect.
fn check(grid: &OccupancyGrid, robot: Point, min_size_m: f64) -> usize {
    let mut count = 0;
    for params in all_params(min_size_m) {
        let expected = detect(&mut Wavefront::new(params), grid, robot);
        let found = detect(&mut FromScratch::new(params), grid, robot);
        assert_eq!(found, expected, "{params:?} from {robot:?}");
        count += found.len();
    }
    count
}

/// The robot in the middle of its cell.
fn placed((grid, robot): (OccupancyGrid, Cell)) -> (OccupancyGrid, Point) {
    let robot = grid.info().center(robot);
    (grid, robot)
}

/// Rectangles painted over the unknown: rooms with walls a cell thick, doors, patches of
/// territory of any kind.
fn rooms() -> impl Strategy<Value = (OccupancyGrid, Point)> {
    let rectangle = (0u32..200, 0u32..60, 1u32..90, 1u32..30, 0usize..4);
    (1u32..=200, 1u32..=60, proptest::collection::vec(rectangle, 1..24), any::<prop::sample::Index>()).prop_map(
        |(width, height, rectangles, robot)| {
            let mut values = vec![OccupancyGrid::UNKNOWN; (width * height) as usize];
            for (x, y, w, h, kind) in rectangles {
                let (x, y) = (x % width, y % height);
                for cy in y..(y + h).min(height) {
                    for cx in x..(x + w).min(width) {
                        let rim = cx == x || cy == y || cx + 1 == x + w || cy + 1 == y + h;
                        let inside = [OccupancyGrid::FREE, OccupancyGrid::UNKNOWN, 30, OccupancyGrid::FREE][kind];
                        let wall = rim && kind == 0;
                        values[(cy * width + cx) as usize] = if wall { OccupancyGrid::OCCUPIED } else { inside };
                    }
                }
            }
            let robot = robot.index(values.len());
            placed(with_robot(width, height, values, robot))
        },
    )
}

proptest! {
    #[test]
    fn equals_the_textbook_on_noise((grid, robot) in noise(200, 40).prop_map(placed), min_size_m in 0.0f64..4.0) {
        check(&grid, robot, min_size_m);
    }

    #[test]
    fn equals_the_textbook_on_rooms((grid, robot) in rooms(), min_size_m in 0.0f64..20.0) {
        check(&grid, robot, min_size_m);
    }

    #[test]
    fn nothing_is_left_over_from_the_last_map(maps in proptest::collection::vec(noise(200, 40).prop_map(placed), 2..5)) {
        for params in all_params(0.0) {
            let mut reused = FromScratch::new(params);
            for (grid, robot) in &maps {
                let expected = detect(&mut Wavefront::new(params), grid, *robot);
                prop_assert_eq!(detect(&mut reused, grid, *robot), expected);
            }
        }
    }
}

#[test]
fn equals_the_textbook_in_every_world() {
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps");
    for (world, x, y) in [("office", 1.5, 7.9), ("museum", 12.0, 11.8), ("maze", 6.0, 6.0), ("warehouse", 24.0, 22.0)] {
        let whole = load_map(&maps.join(format!("{world}.yaml"))).unwrap().grid;
        let robot = Point::new(x, y);
        for (radius_m, min_size_m) in [(1.5, 0.0), (6.0, 0.3), (15.0, 0.0)] {
            let info = *whole.info();
            let mut known = whole.clone();
            for (i, value) in known.data_mut().iter_mut().enumerate() {
                if (info.center(info.cell(i)) - robot).norm() > radius_m {
                    *value = OccupancyGrid::UNKNOWN;
                }
            }
            let count = check(&known, robot, min_size_m);
            assert!(count > 0 || radius_m > 10.0, "no frontier in {world} within {radius_m} m");
        }
    }
}

#[test]
fn a_lone_free_cell_is_a_seed() {
    let grid = OccupancyGrid::from_ascii("?#?\n#.#\n?#?").unwrap();
    check(&grid, Point::new(1.5, 1.5), 0.0);
    let grid = OccupancyGrid::from_ascii(".").unwrap();
    assert_eq!(check(&grid, Point::new(0.5, 0.5), 0.0), 0);
}

#[test]
fn a_robot_off_the_map_is_an_error_as_in_the_textbook() {
    let grid = OccupancyGrid::from_ascii("..\n..").unwrap();
    let input = DetectionInput::new(&grid, Pose::new(9.0, 0.5, 0.0));
    let params = DetectorParams::default();
    assert_eq!(FromScratch::new(params).detect(&input), Wavefront::new(params).detect(&input));
}
