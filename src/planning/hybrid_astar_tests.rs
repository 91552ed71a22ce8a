//! Hybrid A* on rooms drawn by hand and at random: what it drives is free and turns no
//! tighter than the robot.

use super::*;
use crate::geometry::{Footprint, MotionLimits, shortest_angle};
use crate::grid::{Cell, Inflation, OccupancyGrid, Thresholds};
use crate::planning::PlannerConfig;
use proptest::prelude::*;

const LIMITS: MotionLimits =
    MotionLimits { max_linear_mps: 0.5, max_angular_rps: 1.9, max_linear_mps2: 2.0, max_angular_rps2: 2.0 };

fn disc() -> Body {
    Body { footprint: Footprint::RadiusM(0.18), limits: LIMITS }
}

fn rectangle() -> Body {
    let corners = vec![[-0.205, -0.155], [0.077, -0.155], [0.077, 0.155], [-0.205, 0.155]];
    Body { footprint: Footprint::PolygonM(corners), limits: LIMITS }
}

/// A room of 4 x 4 m with obstacles in the given cells of 0.05 m, inflated by the
/// largest disc inside the robot.
fn room(body: &Body, blocked: impl Fn(Cell) -> bool) -> Costmap {
    let info = GridInfo::new(80, 80, 0.05, Pose::new(-0.5, 0.25, 0.0)).unwrap();
    let mut grid = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    for index in 0..info.len() {
        if blocked(info.cell(index)) {
            grid.set(info.cell(index), OccupancyGrid::OCCUPIED);
        }
    }
    let inscribed_radius_m = body.footprint.inscribed_radius_m() + 0.01;
    let inflation =
        Inflation { inscribed_radius_m, clear_radius_m: 0.0, inflation_radius_m: 0.5, cost_scaling_factor: 5.0 };
    Costmap::inflate(&grid, &Thresholds::default(), &inflation)
}

/// Every pose between two of the path, on the arc or the straight line that joins
/// them, must be where the robot may be, but for a rounding of a quarter cell.
fn assert_free(path: &Path, costmap: &Costmap, body: &Body) {
    let swept = Swept::new(costmap, &body.footprint);
    let slack = 0.25 * costmap.info().resolution_m();
    let free = |pose: &Pose| {
        let around = [(0.0, 0.0), (slack, 0.0), (-slack, 0.0), (0.0, slack), (0.0, -slack)];
        around.iter().any(|(dx, dy)| swept.is_free(&Pose::new(pose.x + dx, pose.y + dy, pose.yaw)))
    };
    assert!(path.poses.iter().all(|pose| costmap.is_passable(costmap.info().cell_at(pose.position()))));
    // The last stretch is looked at for the centre alone.
    let goal = path.poses.last().unwrap().position();
    let driven: Vec<Pose> = path.poses.iter().copied().take_while(|pose| pose.distance_to(goal) > 0.3).collect();
    for pair in driven.windows(2) {
        let chord_m = pair[0].distance_to(pair[1].position());
        let turn = shortest_angle(pair[0].yaw, pair[1].yaw);
        let arc = Twist::new(if turn == 0.0 { chord_m } else { chord_m * 0.5 * turn / (0.5 * turn).sin() }, turn);
        for i in 0..=10 {
            let pose = arc.advance(&pair[0], f64::from(i) / 10.0);
            assert!(free(&pose), "{pose:?} between {:?} and {:?}", pair[0], pair[1]);
        }
    }
}

/// No pose follows another more tightly turned than the robot turns at full speed,
/// except at both ends, where it turns on the spot.
fn assert_drivable(path: &Path, goal: &Pose, threshold_m: f64) {
    let inner: Vec<&Pose> =
        path.poses.iter().take_while(|pose| pose.distance_to(goal.position()) > threshold_m).collect();
    for pair in inner.windows(2) {
        let chord_m = pair[0].distance_to(pair[1].position());
        let turn = shortest_angle(pair[0].yaw, pair[1].yaw).abs();
        let arc_m = if turn < 1e-9 { chord_m } else { chord_m * 0.5 * turn / (0.5 * turn).sin() };
        assert!(turn <= LIMITS.max_angular_rps / LIMITS.max_linear_mps * arc_m + 1e-6, "{pair:?}");
    }
}

fn planner(body: Body, heuristic: HybridHeuristic) -> HybridAstar {
    HybridAstar::new(HybridAstarConfig { heuristic, ..HybridAstarConfig::DEFAULT }, body)
}

#[test]
fn both_robots_pass_a_door() {
    for heuristic in [HybridHeuristic::Euclidean, HybridHeuristic::Grid] {
        for body in [disc(), rectangle()] {
            let costmap = room(&body, |c| c.x == 40 && !(50..64).contains(&c.y));
            let (start, goal) = (Pose::new(0.2, 0.8, -2.0), Pose::new(3.0, 1.0, 1.0));
            let path = planner(body.clone(), heuristic).plan(&costmap, &start, &goal).unwrap();
            assert_eq!((path.poses.first(), path.poses.last()), (Some(&start), Some(&goal)));
            assert!((path.length_m() - path.cost).abs() < 0.1, "{} m, cost {}", path.length_m(), path.cost);
            assert_free(&path, &costmap, &body);
            assert_drivable(&path, &goal, 0.3);
        }
    }
}

#[test]
fn a_robot_that_faces_a_wall_begins_with_another_heading() {
    // A niche that is open at the back only and too tight for a turn while driving.
    let body = disc();
    let niche =
        |c: Cell| (c.x == 40 && (32..48).contains(&c.y)) || ((20..40).contains(&c.x) && [32, 47].contains(&c.y));
    let costmap = room(&body, niche);
    let (start, goal) = (Pose::new(1.2, 2.26, 0.0), Pose::new(0.0, 2.26, 0.0));
    let path = planner(body, HybridHeuristic::Euclidean).plan(&costmap, &start, &goal).unwrap();
    let turn = shortest_angle(start.yaw, path.poses[0].yaw).abs();
    assert!((turn - std::f64::consts::PI).abs() < 1e-9, "{turn}");
    assert!((path.length_m() - 1.2).abs() < 0.1, "{}", path.length_m());
}

#[test]
fn gives_up_at_the_limit() {
    let body = disc();
    let costmap = room(&body, |c| c.x == 40 && c.y < 70);
    let config = HybridAstarConfig { max_expansions: 50, ..HybridAstarConfig::DEFAULT };
    let mut planner = HybridAstar::new(config, body);
    let error = planner.plan(&costmap, &Pose::new(0.2, 0.8, 0.0), &Pose::new(3.0, 0.8, 0.0)).unwrap_err();
    assert_eq!((error, planner.expansions()), (PlanError::IterationLimit { limit: 50 }, 50));
    let closed = room(&disc(), |c| c.x == 40);
    let error = planner.plan(&closed, &Pose::new(0.2, 0.8, 0.0), &Pose::new(3.0, 0.8, 0.0)).unwrap_err();
    assert!(matches!(error, PlanError::NoPath { .. }) && planner.expansions() == 0);
}

#[test]
fn parameters_out_of_range_are_refused() {
    let validate = |config| PlannerConfig::HybridAstar(config).validate();
    let bad = HybridAstarConfig { lattice_headings: 3, ..HybridAstarConfig::DEFAULT };
    assert_eq!(validate(bad).unwrap_err().to_string(), "planner.lattice_headings is 3: must be 4 to 360");
    let bad = HybridAstarConfig { primitive_s: 0.0, ..HybridAstarConfig::DEFAULT };
    assert!(validate(bad).is_err() && validate(HybridAstarConfig::DEFAULT).is_ok());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn paths_are_free_and_drivable(
        posts in proptest::collection::vec((0i32..80, 0i32..80), 0..12),
        x in 0.0f64..3.0, y in 0.75f64..3.75, yaw in -3.0f64..3.0,
        goal_x in 0.0f64..3.0, goal_y in 0.75f64..3.75,
        polygon in any::<bool>(), grid in any::<bool>(),
    ) {
        let body = if polygon { rectangle() } else { disc() };
        let costmap = room(&body, |c| posts.contains(&(c.x, c.y)));
        let (start, goal) = (Pose::new(x, y, yaw), Pose::new(goal_x, goal_y, 0.0));
        prop_assume!(Swept::new(&costmap, &body.footprint).is_free(&start));
        let heuristic = if grid { HybridHeuristic::Grid } else { HybridHeuristic::Euclidean };
        if let Ok(path) = planner(body.clone(), heuristic).plan(&costmap, &start, &goal) {
            prop_assert!(path.poses.first().is_some_and(|p| p.position() == start.position()));
            prop_assert_eq!(path.poses.last(), Some(&goal));
            assert_free(&path, &costmap, &body);
            assert_drivable(&path, &goal, 0.3);
        }
    }
}
