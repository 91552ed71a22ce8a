//! What is left alone, for how long, and what is said of it.

use super::*;
use crate::geometry::Pose;
use crate::grid::{Cell, GridInfo, GridPatch, Live, OccupancyGrid};
use std::sync::Arc;

const HERE: Point = Point::new(9.0, 9.0);

fn list(config: TabooConfig) -> Blacklist {
    Blacklist::new(config, Thresholds::default())
}

impl Blacklist {
    fn fail(&mut self, target: Point, place: Point, from: Point) {
        self.record_failure(&Failure { target, place, from, why: "no way" }, None);
    }
}

#[test]
fn failures_add_up_for_the_round_and_are_forgiven_after_it() {
    let mut failed = list(TabooConfig { max_failures: 2, ..TabooConfig::default() });
    let (target, near) = (Point::new(1.0, 1.0), Point::new(1.2, 1.0));
    let stand = Point::new(0.5, 1.0);
    failed.fail(target, stand, HERE);
    assert_eq!((failed.has_failed(target), failed.refuses(stand)), (false, true));
    failed.fail(near, Point::new(0.5, 2.0), HERE);
    assert!(failed.has_failed(near));
    assert!(!failed.has_failed(Point::new(2.0, 2.0)));
    failed.forgive_failures();
    assert_eq!((failed.has_failed(near), failed.refuses(stand)), (false, false), "one more chance");
    failed.fail(near, stand, HERE);
    assert!(failed.has_failed(near));
    let mut for_good = list(TabooConfig { max_failures: 1, is_final: true, ..TabooConfig::default() });
    for_good.fail(target, stand, HERE);
    for_good.forgive_failures();
    assert!(for_good.has_failed(target));
    assert_eq!(for_good.listed()[0].forgiven, Forgiven::Never);
}

#[test]
fn what_failed_from_where_the_robot_was_wedged_is_not_to_blame() {
    let mut failed = list(TabooConfig { max_failures: 1, ..TabooConfig::default() });
    let (target, other) = (Point::new(1.0, 1.0), Point::new(5.0, 5.0));
    failed.fail(target, target, HERE);
    failed.fail(other, other, Point::new(0.0, 0.0));
    failed.forgive_from(Point::new(9.1, 9.0), 0.3);
    assert_eq!((failed.has_failed(target), failed.refuses(target)), (false, false));
    assert_eq!((failed.has_failed(other), failed.refuses(other)), (true, true));
    assert_eq!(failed.listed().len(), 1);
}

#[test]
fn vain_visits_do_not_expire() {
    let mut visited = list(TabooConfig::default());
    let stand = Point::new(1.0, 0.0);
    visited.record_visit(Point::new(0.0, 0.0), stand);
    visited.record_visit(Point::new(0.1, 0.0), stand);
    visited.forgive_failures();
    let target = Point::new(0.0, 0.1);
    assert!(visited.is_spent(stand, target, false));
    assert!(visited.is_spent(Point::new(-1.5, 0.0), target, false), "no closer");
    assert!(!visited.is_spent(Point::new(0.5, 0.0), target, false), "a closer look");
    let other = Point::new(2.0, 0.0);
    assert!(!visited.is_spent(stand, other, false) && visited.is_spent(stand, other, true));
}

#[test]
fn the_circle_of_what_fails_round_after_round_grows_over_what_fails_too() {
    let mut failed = list(TabooConfig { max_failures: 2, ..TabooConfig::default() });
    let (target, beside) = (Point::new(0.0, 0.0), Point::new(0.7, 0.0));
    for _ in 0..2 {
        failed.fail(target, target, HERE);
        failed.fail(target, target, HERE);
        assert!(!failed.has_failed(beside));
        failed.forgive_failures();
    }
    failed.fail(target, target, HERE);
    assert!(!failed.has_failed(beside), "it has its turn in every round");
    failed.fail(beside, beside, HERE);
    assert!(failed.has_failed(beside), "and is left with the other one then");
    assert!((failed.listed()[0].radius_m - 0.8).abs() < 1e-9);
    (0..20).for_each(|_| {
        failed.fail(target, target, HERE);
        failed.forgive_failures();
    });
    failed.fail(target, target, HERE);
    assert!((failed.listed()[0].radius_m - 1.2).abs() < 1e-9, "three times at most");
}

/// A wall of 5 m at x = 2 m, in cells of 0.1 m.
fn walled() -> Live<OccupancyGrid> {
    let info = GridInfo::new(50, 50, 0.1, Pose::default()).unwrap();
    let mut grid = OccupancyGrid::filled(info, 0);
    (0..50).for_each(|y| grid.set(Cell::new(20, y), 100));
    Live::new(Arc::new(grid))
}

fn snapshot(live: &Live<OccupancyGrid>) -> MapSnapshot {
    let (grid, changes) = (Arc::clone(live.newest()), live.changes().clone());
    MapSnapshot { stamp_s: 0.0, grid, changes, costmap: None }
}

fn set(live: &mut Live<OccupancyGrid>, x: i32, y: i32, height: u32, value: i8) -> MapSnapshot {
    let patch = GridPatch { corner: Cell::new(x, y), width: 1, height, data: vec![value; height as usize] };
    live.apply(&patch).unwrap();
    snapshot(live)
}

#[test]
fn a_door_that_opens_is_tried_again_in_the_same_round() {
    let mut live = walled();
    let mut failed = list(TabooConfig { max_failures: 1, ..TabooConfig::default() });
    let (target, other) = (Point::new(2.5, 2.5), Point::new(2.5, 4.5));
    for target in [target, other] {
        let failure = Failure { target, place: Point::new(1.5, target.y), from: HERE, why: "a shut door" };
        failed.record_failure(&failure, Some(&snapshot(&live)));
    }
    assert!(failed.look_again(&snapshot(&live)).is_empty());
    assert!(failed.look_again(&set(&mut live, 20, 2, 1, 0)).is_empty(), "far away");
    assert!(failed.look_again(&set(&mut live, 5, 25, 9, 100)).is_empty(), "it has shut");
    assert!(failed.look_again(&set(&mut live, 20, 25, 1, 0)).is_empty(), "a map that trembles");
    assert_eq!(failed.look_again(&set(&mut live, 20, 21, 9, 0)), [target]);
    assert_eq!((failed.has_failed(target), failed.has_failed(other)), (false, true));
    assert!(!failed.refuses(Point::new(1.5, 2.5)));
    let why: Vec<String> = failed.listed().into_iter().map(|one| one.why).collect();
    assert_eq!(why, ["a shut door"]);
}

#[test]
fn each_time_it_must_open_farther() {
    let mut live = walled();
    let mut failed = list(TabooConfig { max_failures: 1, ..TabooConfig::default() });
    let target = Point::new(2.5, 2.5);
    let mut opens = |height: u32| {
        let shut = set(&mut live, 20, 20, 10, 100);
        failed.record_failure(&Failure { target, place: target, from: HERE, why: "" }, Some(&shut));
        failed.look_again(&shut);
        let is_open = !failed.look_again(&set(&mut live, 20, 20, height, 0)).is_empty();
        failed.forgive_failures();
        is_open
    };
    assert_eq!([opens(5), opens(5), opens(10), opens(10)], [true, false, true, false]);
}

#[test]
fn what_is_final_stays_until_it_is_cleared() {
    let mut live = walled();
    let mut failed = list(TabooConfig { max_failures: 1, is_final: true, ..TabooConfig::default() });
    let target = Point::new(2.5, 2.5);
    failed.record_failure(&Failure { target, place: target, from: HERE, why: "" }, Some(&snapshot(&live)));
    failed.record_visit(HERE, HERE);
    assert!(failed.look_again(&set(&mut live, 20, 10, 30, 0)).is_empty() && failed.has_failed(target));
    assert_eq!(failed.clear(), 1);
    assert!(!failed.has_failed(target) && !failed.refuses(target) && failed.listed().is_empty());
    assert_eq!(failed.clear(), 0);
}
