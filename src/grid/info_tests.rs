//! Cells and points in both directions, at corners and borders, and grids of one lattice.

use super::*;
use proptest::prelude::*;

fn info(width: u32, height: u32, resolution_m: f64, origin: Pose) -> GridInfo {
    GridInfo::new(width, height, resolution_m, origin).unwrap()
}

#[test]
fn corners_of_a_plain_grid() {
    let grid = info(4, 3, 0.5, Pose::new(-1.0, 2.0, 0.0));
    assert_eq!(grid.cell_at(Point::new(-1.0, 2.0)), Cell::new(0, 0));
    assert_eq!(grid.cell_at(Point::new(0.999, 3.499)), Cell::new(3, 2));
    assert_eq!(grid.cell_at(Point::new(1.0, 3.5)), Cell::new(4, 3));
    assert_eq!(grid.cell_at(Point::new(-1.001, 1.999)), Cell::new(-1, -1));
    assert_eq!(grid.center(Cell::new(0, 0)), Point::new(-0.75, 2.25));
    assert_eq!(grid.index(Cell::new(3, 2)), Some(11));
    assert_eq!(grid.cell(11), Cell::new(3, 2));
    assert_eq!(grid.index(Cell::new(4, 0)), None);
}

#[test]
fn a_quarter_turned_grid_grows_to_the_left() {
    let grid = info(4, 3, 1.0, Pose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2));
    assert_eq!(grid.cell_at(Point::new(-0.5, 3.5)), Cell::new(3, 0));
    let center = grid.center(Cell::new(3, 0));
    assert!((center - Point::new(-0.5, 3.5)).norm() < 1e-12);
}

#[test]
fn impossible_grids_are_refused() {
    assert!(matches!(GridInfo::new(0, 5, 0.05, Pose::default()), Err(GridInfoError::Size { .. })));
    assert!(matches!(GridInfo::new(1 << 20, 1 << 20, 0.05, Pose::default()), Err(GridInfoError::Size { .. })));
    for resolution in [0.0, -0.05, f64::NAN, f64::INFINITY] {
        assert!(matches!(GridInfo::new(5, 5, resolution, Pose::default()), Err(GridInfoError::Resolution(_))));
    }
    assert!(matches!(GridInfo::new(5, 5, 0.05, Pose::new(f64::NAN, 0.0, 0.0)), Err(GridInfoError::Origin(..))));
}

proptest! {
    #[test]
    fn cell_and_world_are_inverse(
        width in 1u32..300, height in 1u32..300, resolution in 0.01f64..1.0,
        x in -50.0f64..50.0, y in -50.0f64..50.0, yaw in -4.0f64..4.0,
        u in 0.0f64..1.0, v in 0.0f64..1.0,
    ) {
        let grid = info(width, height, resolution, Pose::new(x, y, yaw));
        let far = Cell::new(width as i32 - 1, height as i32 - 1);
        let any = Cell::new((u * f64::from(width)) as i32, (v * f64::from(height)) as i32);
        for cell in [Cell::new(0, 0), Cell::new(far.x, 0), Cell::new(0, far.y), far, any, Cell::new(-3, -7)] {
            prop_assert_eq!(grid.cell_at(grid.center(cell)), cell);
        }
        let point = grid.from_grid_units(u * f64::from(width), v * f64::from(height));
        let (gx, gy) = grid.to_grid_units(point);
        prop_assert!((gx - u * f64::from(width)).abs() < 1e-6 && (gy - v * f64::from(height)).abs() < 1e-6);
    }
}

/// Against the formulas of move_base's planners: costmap_2d's `worldToMap`, and
/// GlobalPlanner's, which takes half a cell off and truncates.
#[test]
fn goals_lie_in_the_same_cell_for_every_planner() {
    for (resolution, origin) in [(0.05_f32, -12.0), (0.05, -100.0), (0.025, 0.0), (0.1, -51.224_998), (0.02, 3.3)] {
        let resolution_m = f64::from(resolution);
        let info = GridInfo::new(10_000, 1, resolution_m, Pose::new(origin, origin, 0.0)).unwrap();
        for x in 0..10_000 {
            let goal = info.goal_point(Cell::new(x, 0));
            let cells = (goal.x - origin) / resolution_m;
            assert_eq!(cells as i32, x, "costmap_2d, {resolution} m from {origin}");
            assert_eq!((cells - 0.5) as i32, x, "GlobalPlanner, {resolution} m from {origin}");
            assert_eq!(info.cell_at(goal), Cell::new(x, 0));
        }
    }
}
