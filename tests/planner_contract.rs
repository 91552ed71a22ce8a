//! One table of cases for all planners: what a path is, and what each failure is called.

#![allow(clippy::unwrap_used)] // the helpers below serve tests alone

use frontier_explorer::geometry::{Body, Footprint, MotionLimits, Pose, shortest_angle};
use frontier_explorer::grid::{Costmap, GridInfo, Inflation, OccupancyGrid, Thresholds};
use frontier_explorer::planning::{GlobalPlanner, Path, PlanError, PlannerConfig};
use proptest::prelude::*;

/// Cells of the drawings below, metres.
const CELL_M: f64 = 0.2;

fn body() -> Body {
    Body {
        footprint: Footprint::RadiusM(0.18),
        limits: MotionLimits { max_linear_mps: 0.5, max_angular_rps: 1.9, max_linear_mps2: 2.0, max_angular_rps2: 2.0 },
    }
}

fn planners() -> impl Iterator<Item = Box<dyn GlobalPlanner>> {
    PlannerConfig::ALL.iter().map(|config| config.build(&body()))
}

/// A drawing at a place, inflated for [`body`].
fn costmap(drawing: &str, origin: Pose) -> Costmap {
    let drawn = OccupancyGrid::from_ascii(drawing).unwrap();
    let (width, height) = (drawn.info().width() as u32, drawn.info().height() as u32);
    let info = GridInfo::new(width, height, CELL_M, origin).unwrap();
    let grid = OccupancyGrid::new(info, drawn.data().to_vec()).unwrap();
    let inflation =
        Inflation { inscribed_radius_m: 0.21, clear_radius_m: 0.0, inflation_radius_m: 0.6, cost_scaling_factor: 5.0 };
    Costmap::inflate(&grid, &Thresholds::default(), &inflation)
}

/// The centre of a cell by its place in the drawing: column, and row from below.
fn at(costmap: &Costmap, x: f64, y: f64, yaw: f64) -> Pose {
    let point = costmap.info().from_grid_units(x + 0.5, y + 0.5);
    Pose::new(point.x, point.y, yaw)
}

/// What every path is: from start to goal in small steps over passable cells.
fn assert_path(name: &str, path: &Path, costmap: &Costmap, start: &Pose, goal: &Pose) {
    let info = costmap.info();
    assert_eq!(path.poses.first().unwrap().position(), start.position(), "{name}");
    assert_eq!(path.poses.last(), Some(goal), "{name}");
    for pose in &path.poses[1..] {
        assert!(costmap.is_passable(info.cell_at(pose.position())), "{name}: {pose:?}");
    }
    for pair in path.poses.windows(2) {
        assert!(pair[0].distance_to(pair[1].position()) <= 3.0 * CELL_M, "{name}: {pair:?}");
    }
    let beeline_m = start.distance_to(goal.position());
    assert!(path.length_m() >= beeline_m - 1e-9 && path.cost >= 0.0, "{name}");
}

const FIELD: &str = "
    ....................
    ....................
    ....................
    ....................
    ....................
    ....................
    ....................
    ....................";

const WALL: &str = "
    ..........#.........
    ..........#.........
    ....................
    ....................
    ....................
    ..........#.........
    ..........#.........
    ..........#.........
    ..........#.........
    ..........#.........
    ..........#.........";

const ROOMS: &str = "
    ....................
    .............#######
    .............#.....#
    .............#.....#
    .............#.....#
    .............#.....#
    ????.........#######
    ????................
    ????................";

#[test]
fn paths_lead_from_start_to_goal() {
    let yawed = Pose::new(-3.0, 2.0, 2.2);
    for origin in [Pose::default(), yawed] {
        let cases = [
            ("open field", FIELD, (1.0, 1.0), (18.0, 6.0), 1.15),
            ("backwards", FIELD, (17.0, 6.0), (2.0, 6.0), 1.5),
            ("wall with a gap", WALL, (5.0, 2.0), (15.0, 2.0), 1.9),
            ("start in an inflated zone", WALL, (9.0, 1.0), (3.0, 5.0), 1.5),
        ];
        for (case, drawing, start, goal, most) in cases {
            let costmap = costmap(drawing, origin);
            let (start, goal) = (at(&costmap, start.0, start.1, 0.3), at(&costmap, goal.0, goal.1, -1.0));
            for mut planner in planners() {
                let name = format!("{}, {case}", planner.name());
                let path = planner.plan(&costmap, &start, &goal).unwrap_or_else(|error| panic!("{name}: {error}"));
                assert_path(&name, &path, &costmap, &start, &goal);
                let share = path.length_m() / start.distance_to(goal.position());
                assert!(share < most, "{name}: {share} times the straight line");
            }
        }
    }
}

#[test]
fn a_goal_where_the_robot_is_takes_no_way() {
    let costmap = costmap(FIELD, Pose::default());
    let (start, goal) = (at(&costmap, 4.0, 4.0, 0.0), at(&costmap, 4.0, 4.0, 2.0));
    for mut planner in planners() {
        let path = planner.plan(&costmap, &start, &goal).unwrap();
        assert!(path.length_m() < 1e-9 && path.cost < 1e-9, "{}: {path:?}", planner.name());
        assert!(shortest_angle(path.poses.last().unwrap().yaw, 2.0).abs() < 1e-12);
    }
}

#[test]
fn failures_have_names() {
    let costmap = costmap(ROOMS, Pose::default());
    let inside = (2.0, 6.0);
    let name_of = |error: PlanError| match error {
        PlanError::StartOutsideMap { .. } => "start outside",
        PlanError::StartOccupied { .. } => "start occupied",
        PlanError::GoalOutsideMap { .. } => "goal outside",
        PlanError::GoalOccupied { .. } => "goal occupied",
        PlanError::NoPath { .. } => "no path",
        PlanError::IterationLimit { .. } => "limit",
    };
    for (start, goal, expected) in [
        ((-5.0, 1.0), inside, "start outside"),
        ((0.0, 0.0), inside, "start occupied"),
        (inside, (16.0, 90.0), "goal outside"),
        (inside, (13.0, 4.0), "goal occupied"),
        (inside, (12.0, 4.0), "goal occupied"),
        (inside, (1.0, 1.0), "goal occupied"),
        (inside, (16.0, 4.0), "no path"),
    ] {
        let (start, goal) = (at(&costmap, start.0, start.1, 0.0), at(&costmap, goal.0, goal.1, 0.0));
        for mut planner in planners() {
            let error = planner.plan(&costmap, &start, &goal).unwrap_err();
            assert_eq!(name_of(error), expected, "{} from {start:?} to {goal:?}", planner.name());
        }
    }
}

#[test]
fn a_grown_map_with_another_origin_changes_nothing_in_the_world() {
    let small = costmap(WALL, Pose::new(1.0, 1.0, 0.0));
    let wider: String =
        WALL.lines().map(str::trim).filter(|l| !l.is_empty()).map(|l| format!("?????{l}??\n")).collect();
    let grown = costmap(&wider, Pose::new(0.0, 1.0, 0.0));
    let (start, goal) = (at(&small, 4.0, 2.0, 0.0), at(&small, 15.0, 3.0, 0.0));
    for mut planner in planners() {
        let before = planner.plan(&small, &start, &goal).unwrap();
        let after = planner.plan(&grown, &start, &goal).unwrap();
        assert_path(planner.name(), &after, &grown, &start, &goal);
        assert!((before.cost - after.cost).abs() < 1e-6, "{}: {} then {}", planner.name(), before.cost, after.cost);
        let back = planner.plan(&small, &start, &goal).unwrap();
        assert!((before.cost - back.cost).abs() < 1e-6, "{}", planner.name());
    }
}

#[test]
fn the_configuration_names_are_the_planners_names() {
    for config in PlannerConfig::ALL {
        let name = config.build(&body()).name();
        let yaml = format!("{{name: {name}}}");
        assert_eq!(serde_saphyr::from_str::<PlannerConfig>(&yaml).unwrap(), *config);
        let unknown = format!("{{name: {name}, colour: 3}}");
        let error = serde_saphyr::from_str::<PlannerConfig>(&unknown).unwrap_err().to_string();
        assert!(error.contains("colour"), "{error}");
        config.validate().unwrap();
    }
    let error = serde_saphyr::from_str::<PlannerConfig>("{name: d_star}").unwrap_err().to_string();
    assert!(error.contains("d_star_lite") && error.contains("hybrid_astar"), "{error}");
}

proptest! {
    #[test]
    fn the_optimal_planners_agree_on_the_cost(
        width in 1u32..40,
        costs in proptest::collection::vec(prop_oneof![3 => Just(0_u8), 2 => 1_u8..=252, 1 => 253_u8..=255], 600),
        ends in (0usize..600, 0usize..600),
    ) {
        let info = GridInfo::new(width, 600 / width, CELL_M, Pose::new(-1.0, 0.5, 0.4)).unwrap();
        let map = Costmap::from_costs(info, costs[..info.len()].to_vec()).unwrap();
        let pose = |index: usize| {
            let center = info.center(info.cell(index % info.len()));
            Pose::new(center.x, center.y, 0.0)
        };
        let plan = |config: PlannerConfig| config.build(&body()).plan(&map, &pose(ends.0), &pose(ends.1));
        let expected = plan(PlannerConfig::Dijkstra {});
        for config in [PlannerConfig::Astar {}, PlannerConfig::DStarLite {}] {
            let found = plan(config);
            prop_assert_eq!(found.clone().map(|p| p.cost), expected.clone().map(|p| p.cost));
            if let Ok(path) = found {
                assert_path("optimal", &path, &map, &pose(ends.0), &pose(ends.1));
            }
        }
    }
}
