//! Names across maps that change, grow, move and change their resolution.

use super::*;
use crate::frontier::CellSide;
use crate::geometry::Pose;
use proptest::prelude::*;
use std::collections::BTreeSet;

fn info(x_m: f64, y_m: f64) -> GridInfo {
    GridInfo::new(400, 400, 0.05, Pose::new(x_m, y_m, 0.0)).unwrap()
}

/// A frontier along a row: the columns given.
fn level(y: i32, columns: std::ops::Range<i32>) -> Frontier {
    let cells = columns.map(|x| Cell::new(x, y)).collect();
    Frontier { id: 0, cells, side: CellSide::Unknown, circle: None }
}

fn id(number: u64) -> FrontierId {
    FrontierId(number)
}

#[test]
fn names_stay_while_frontiers_overlap() {
    let mut tracker = FrontierTracker::new();
    let first = tracker.update(&[level(1, 0..9), level(7, 0..9)], &info(0.0, 0.0));
    assert_eq!(first, [id(0), id(1)]);
    // Another order of detection, other cells, one that is new and one that is gone.
    let second = tracker.update(&[level(0, 0..9), level(7, 8..30)], &info(0.0, 0.0));
    assert_eq!(second, [id(2), id(1)]);
    assert_eq!(tracker.update(&[], &info(0.0, 0.0)), []);
    // A name that is gone does not come back.
    assert_eq!(tracker.update(&[level(1, 0..9)], &info(0.0, 0.0)), [id(3)]);
}

#[test]
fn the_larger_part_of_a_split_keeps_the_name() {
    let mut tracker = FrontierTracker::new();
    tracker.update(&[level(1, 0..20)], &info(0.0, 0.0));
    let split = tracker.update(&[level(1, 0..6), level(1, 9..20)], &info(0.0, 0.0));
    assert_eq!(split, [id(1), id(0)]);
}

#[test]
fn the_larger_part_of_a_merger_gives_its_name() {
    let mut tracker = FrontierTracker::new();
    tracker.update(&[level(1, 0..6), level(1, 9..20)], &info(0.0, 0.0));
    let merged = tracker.update(&[level(1, 0..20)], &info(0.0, 0.0));
    assert_eq!(merged, [id(1)]);
}

#[test]
fn of_equal_parts_the_first_keeps_the_name() {
    let mut tracker = FrontierTracker::new();
    tracker.update(&[level(1, 0..20)], &info(0.0, 0.0));
    assert_eq!(tracker.update(&[level(1, 0..9), level(1, 10..19)], &info(0.0, 0.0)), [id(0), id(1)]);
}

#[test]
fn an_origin_that_moved_changes_no_name() {
    let mut tracker = FrontierTracker::new();
    tracker.update(&[level(1, 0..9), level(7, 0..9)], &info(-1.0, 2.0));
    // Ten columns and four rows more, with the rounding of an origin computed anew.
    let moved = tracker.update(&[level(5, 10..19), level(11, 10..19)], &info(-1.5 + 1e-7, 1.8 - 1e-7));
    assert_eq!(moved, [id(0), id(1)]);
}

#[test]
fn a_turned_or_finer_lattice_changes_no_name() {
    let coarse = GridInfo::new(40, 40, 0.1, Pose::default()).unwrap();
    let fine = GridInfo::new(200, 200, 0.05, Pose::default()).unwrap();
    // A fine row holds no centre of a coarse cell.
    let mut tracker = FrontierTracker::new();
    tracker.update(&[level(3, 2..9), level(8, 2..9)], &coarse);
    assert_eq!(tracker.update(&[level(17, 4..18), level(6, 4..18)], &fine), [id(1), id(0)]);
    assert_eq!(tracker.update(&[level(3, 2..9), level(8, 2..9)], &coarse), [id(0), id(1)]);
    let turned = GridInfo::new(40, 40, 0.1, Pose::new(4.0, 0.0, std::f64::consts::FRAC_PI_2)).unwrap();
    // In the turned grid, cell (a, b) has its centre at x = 4.0 - 0.1 (b + 0.5), y = 0.1 (a + 0.5).
    let along = |y: i32| Frontier { cells: (2..9).map(|x| Cell::new(y, 39 - x)).collect(), ..level(0, 0..1) };
    assert_eq!(tracker.update(&[along(8), along(3)], &turned), [id(1), id(0)]);
}

proptest! {
    /// Against the definitions: names are unique, stay with what overlaps, and never come back.
    #[test]
    fn names_stay_with_what_overlaps(
        maps in proptest::collection::vec(proptest::collection::vec((0i32..12, 0i32..30, 1i32..9), 0..10), 2..6),
    ) {
        let mut tracker = FrontierTracker::new();
        let mut before: Vec<(FrontierId, BTreeSet<Cell>)> = Vec::new();
        let mut used_names = BTreeSet::new();
        for stretches in maps {
            // Stretches of rows; of those that overlap the first counts.
            let mut used = BTreeSet::new();
            let frontiers: Vec<Frontier> = stretches
                .into_iter()
                .map(|(y, x, count)| level(y, x..x + count))
                .map(|f| Frontier { cells: f.cells.iter().copied().filter(|&c| used.insert(c)).collect(), ..f })
                .filter(|f| !f.cells.is_empty())
                .collect();
            let ids = tracker.update(&frontiers, &info(0.0, 0.0));
            let after: Vec<(FrontierId, BTreeSet<Cell>)> =
                ids.iter().copied().zip(frontiers.iter().map(|f| f.cells.iter().copied().collect())).collect();
            prop_assert_eq!(ids.iter().collect::<BTreeSet<_>>().len(), ids.len());
            let met = |cells: &BTreeSet<Cell>, others: &[(FrontierId, BTreeSet<Cell>)]| -> Vec<FrontierId> {
                others.iter().filter(|(_, c)| !c.is_disjoint(cells)).map(|(id, _)| *id).collect()
            };
            for (id, cells) in &after {
                let was = met(cells, &before);
                // A name of before is one of a frontier that it overlaps; another one is new.
                prop_assert!(was.contains(id) || !used_names.contains(id));
            }
            for (id, cells) in &before {
                // Whoever meets one only, and is met by it only, keeps its name.
                if let [only] = met(cells, &after)[..] {
                    let cells = &after.iter().find(|(id, _)| *id == only).unwrap().1;
                    prop_assert!(met(cells, &before).len() > 1 || only == *id);
                }
            }
            used_names.extend(ids);
            before = after;
        }
    }
}
