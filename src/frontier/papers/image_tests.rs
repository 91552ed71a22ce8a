//! The image detector against the paper's equations, restated cell by cell.

use super::*;
use crate::frontier::Reachability;
use crate::frontier::papers::groups::group;
use crate::geometry::Pose;
use crate::grid::{OccupancyGrid, Thresholds};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn params(element_m: f64) -> DetectorParams {
    DetectorParams {
        image: ImageParams { element_m },
        reachability: Reachability::Textbook,
        thresholds: Thresholds { free_max: 65, occupied_min: 66 },
        ..DetectorParams::default()
    }
}

fn detect(grid: &OccupancyGrid, robot: Cell, params: DetectorParams) -> Vec<Frontier> {
    let at = grid.info().center(robot);
    ImageDetector::new(params).detect(&DetectionInput::new(grid, Pose::new(at.x, at.y, 0.0))).unwrap()
}

#[test]
fn a_step_lies_on_the_right_or_upper_cell() {
    let grid = OccupancyGrid::from_ascii("???\n?.?\n???").unwrap();
    let found = detect(&grid, Cell::new(1, 1), params(0.0));
    let cells: Vec<(i32, i32)> = found.iter().flat_map(|f| f.cells.iter().map(|c| (c.x, c.y))).collect();
    assert_eq!(cells, [(1, 1), (2, 1), (1, 2)]);
}

#[test]
fn the_circle_is_that_of_the_dilated_points() {
    let mut drawing = String::new();
    for _ in 0..9 {
        drawing.push_str(".....????\n");
    }
    let grid = OccupancyGrid::from_ascii(&drawing).unwrap();
    let found = detect(&grid, Cell::new(1, 1), params(2.0));
    // Points (5, 0..=8), dilated by one to 3 x 9 cells: 2 x 8 m between centres.
    let circle = found[0].circle.unwrap();
    assert_eq!((found.len(), found[0].cells.len()), (1, 9));
    assert!((circle.radius_m - 17f64.sqrt()).abs() < 1e-9);
    assert!((circle.center - Point::new(5.5, 4.5)).norm() < 1e-9);
}

#[test]
fn gaps_narrower_than_the_element_are_closed() {
    let grid = OccupancyGrid::from_ascii("?????\n##.##\n.....\n.....\n.....").unwrap();
    assert_eq!(detect(&grid, Cell::new(2, 0), params(0.0)).len(), 1);
    assert!(detect(&grid, Cell::new(2, 0), params(2.0)).is_empty());
}

/// The points of eqs. 1 to 5 and the groups of eq. 6, as written.
fn by_equations(grid: &OccupancyGrid, half: i32) -> BTreeSet<Vec<Cell>> {
    let info = *grid.info();
    let square = |c: Cell| (-half..=half).flat_map(move |dy| (-half..=half).map(move |dx| c.offset((dx, dy))));
    let m_e = |c: Cell| -> Option<i8> {
        let m = grid.get(c)?;
        if square(c).any(|n| grid.get(n).is_some_and(|v| v > 65)) { Some(100) } else { Some(m) }
    };
    let rule = |a: Option<i8>, b: Option<i8>| match (a, b) {
        (Some(a), Some(b)) => ((0..=65).contains(&a) && b < 0) || (a < 0 && (0..=65).contains(&b)),
        _ => false,
    };
    let all = (0..info.len()).map(|i| info.cell(i));
    let points: BTreeSet<Cell> =
        all.filter(|&c| rule(m_e(c.offset((-1, 0))), m_e(c)) || rule(m_e(c.offset((0, -1))), m_e(c))).collect();
    let dilated: BTreeSet<Cell> = points.iter().flat_map(|&c| square(c)).filter(|&c| info.contains(c)).collect();
    let dilated: Vec<Cell> = dilated.into_iter().collect();
    group(&info, &dilated, crate::grid::Neighbourhood::Eight)
        .into_iter()
        .map(|component| {
            let mut cells: Vec<Cell> = component.into_iter().filter(|c| points.contains(c)).collect();
            cells.sort_unstable_by_key(|c| (c.y, c.x));
            cells
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn equals_the_equations(
        (width, values) in (1usize..90, 1usize..14).prop_flat_map(|(w, h)| {
            let value = prop_oneof![6 => Just(-1i8), 6 => 0i8..=65, 1 => 66i8..=100];
            (Just(w), proptest::collection::vec(value, w * h))
        }),
        half in 0i32..4,
        robot: prop::sample::Index,
    ) {
        let height = values.len() / width;
        let info = GridInfo::new(width as u32, height as u32, 1.0, Pose::default()).unwrap();
        let mut grid = OccupancyGrid::new(info, values).unwrap();
        let robot = info.cell(robot.index(info.len()));
        grid.set(robot, 0);
        let found = detect(&grid, robot, params(f64::from(2 * half).min(5.0)));
        let cells: BTreeSet<Vec<Cell>> = found.iter().map(|f| f.cells.to_vec()).collect();
        prop_assert_eq!(cells, by_equations(&grid, half));
        for frontier in found {
            let circle = frontier.circle.unwrap();
            prop_assert!(frontier.cells.iter().all(|&c| circle.holds(info.center(c))));
        }
    }
}
