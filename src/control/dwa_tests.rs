//! The controller in a closed loop with a perfect body.

use super::*;
use crate::grid::{Cell, Costmap, GridInfo, Inflation, LETHAL_COST, OccupancyGrid, Thresholds};
use crate::planning::{Path, PlannerConfig};
use crate::scan::LaserScan;
use proptest::prelude::*;

const DT_S: f64 = 0.1;

const TURTLEBOT2: MotionLimits =
    MotionLimits { max_linear_mps: 0.5, max_angular_rps: 1.92, max_linear_mps2: 2.0, max_angular_rps2: 2.0 };

fn disc() -> Body {
    Body { footprint: Footprint::RadiusM(0.18), limits: TURTLEBOT2 }
}

fn waffle() -> Body {
    let corners = vec![[-0.205, -0.155], [0.077, -0.155], [0.077, 0.155], [-0.205, 0.155]];
    let limits =
        MotionLimits { max_linear_mps: 0.26, max_angular_rps: 1.82, max_linear_mps2: 2.5, max_angular_rps2: 3.2 };
    Body { footprint: Footprint::PolygonM(corners), limits }
}

/// 8 x 8 m in cells of 0.05 m.
fn costmap(body: &Body, blocked: impl Fn(Cell) -> bool) -> Costmap {
    let info = GridInfo::new(160, 160, 0.05, Pose::default()).unwrap();
    let mut grid = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    for cell in (0..info.len()).map(|i| info.cell(i)).filter(|&c| blocked(c)) {
        grid.set(cell, OccupancyGrid::OCCUPIED);
    }
    let inscribed_radius_m = body.footprint.circumscribed_radius_m() + 0.01;
    let inflation =
        Inflation { inscribed_radius_m, clear_radius_m: 0.0, inflation_radius_m: 0.5, cost_scaling_factor: 5.0 };
    Costmap::inflate(&grid, &Thresholds::default(), &inflation)
}

/// The obstacles of a costmap as points.
fn lethal(costmap: &Costmap) -> Vec<Point> {
    let info = costmap.info();
    let cells = (0..info.len()).filter(|&i| costmap.costs()[i] == LETHAL_COST);
    cells.map(|i| info.center(info.cell(i))).collect()
}

fn assert_clear(body: &Body, pose: &Pose, obstacles: &[Point], least_m: f64) {
    let outline = Outline::new(&body.footprint);
    for &obstacle in obstacles {
        let distance_m = outline.distance_m(pose.inverse().transform(obstacle));
        assert!(distance_m >= least_m, "{distance_m} m to {obstacle} at {pose:?}");
    }
}

/// Drives along A*'s path; returns how long it took.
fn drive(body: &Body, costmap: &Costmap, start: Pose, goal: Pose) -> f64 {
    let path = PlannerConfig::Astar {}.build(body).plan(costmap, &start, &goal).unwrap();
    let mut dwa = Dwa::new(DwaConfig::DEFAULT, body);
    let obstacles = lethal(costmap);
    let (mut pose, mut twist) = (start, Twist::ZERO);
    for tick in 0..600 {
        if pose.distance_to(goal.position()) < 0.15 {
            return f64::from(tick) * DT_S;
        }
        let input = ControlInput { pose_in_map: pose, twist, path: &path, costmap, scan: None, dt_s: DT_S };
        let wanted = dwa.control(&input).unwrap_or_else(|error| panic!("{error} at {pose:?}"));
        let reached = body.limits.reachable(&twist, &wanted, DT_S);
        assert!((reached.linear_mps - wanted.linear_mps).abs() < 1e-9, "out of the window");
        twist = reached;
        for i in 1..=10 {
            assert_clear(body, &twist.advance(&pose, DT_S * f64::from(i) / 10.0), &obstacles, 0.0);
        }
        pose = twist.advance(&pose, DT_S);
    }
    panic!("not there after 60 s: {pose:?}");
}

#[test]
fn drives_straight_at_nearly_full_speed() {
    let body = disc();
    let after_s = drive(&body, &costmap(&body, |_| false), Pose::new(1.0, 4.0, 0.0), Pose::new(7.0, 4.0, 0.0));
    assert!(after_s < 6.0 / 0.5 * 1.15, "{after_s}");
}

#[test]
fn passes_a_door_of_90_cm() {
    for body in [disc(), waffle()] {
        // Cells 71 to 88 are free: 18 cells of 5 cm.
        let costmap = costmap(&body, |c| (80..83).contains(&c.x) && !(71..89).contains(&c.y));
        for (start, goal) in [
            (Pose::new(1.0, 4.0, 0.0), Pose::new(7.0, 4.0, 0.0)),
            (Pose::new(3.6, 1.0, 3.0), Pose::new(4.6, 1.0, 0.0)),
            (Pose::new(3.0, 6.5, 1.5), Pose::new(6.0, 2.0, 0.0)),
        ] {
            let after_s = drive(&body, &costmap, start, goal);
            let least_s = start.distance_to(goal.position()) / body.limits.max_linear_mps;
            assert!(after_s < 12.0 + 2.0 * least_s.max(14.0), "{after_s} of at least {least_s}");
        }
    }
}

#[test]
fn turns_round_a_corridors_corner() {
    for body in [disc(), waffle()] {
        // A corridor 1.2 m wide along the bottom and then up along the right side.
        let inside = |c: Cell| {
            (10..34).contains(&c.y) && (10..150).contains(&c.x) || (126..150).contains(&c.x) && (10..150).contains(&c.y)
        };
        let costmap = costmap(&body, |c| !inside(c));
        let after_s = drive(&body, &costmap, Pose::new(1.0, 1.1, 0.0), Pose::new(6.9, 7.0, 0.0));
        let least_s = 11.8 / body.limits.max_linear_mps;
        assert!(after_s < 1.4 * least_s, "{after_s} of at least {least_s}");
    }
}

#[test]
fn a_path_behind_is_turned_to_first() {
    let body = disc();
    let after_s = drive(&body, &costmap(&body, |_| false), Pose::new(4.0, 4.0, 0.0), Pose::new(1.0, 4.0, 0.0));
    assert!(after_s < 12.0, "{after_s}");
}

fn straight_path() -> Path {
    Path { poses: (0..=60).map(|i| Pose::new(1.0 + 0.1 * f64::from(i), 4.0, 0.0)).collect(), cost: 0.0 }
}

#[test]
fn a_wall_in_the_way_ends_in_a_standstill_that_is_reported() {
    for body in [disc(), waffle()] {
        let costmap = costmap(&body, |_| false);
        let mut dwa = Dwa::new(DwaConfig::DEFAULT, &body);
        let path = straight_path();
        let (mut pose, mut twist) = (path.poses[0], Twist::ZERO);
        // A wall at x = 3 m that only the lidar sees.
        let wall: Vec<Point> = (0..160).map(|i| Point::new(3.0, 0.05 * f64::from(i))).collect();
        let mut blocked = None;
        for tick in 0..300 {
            let scan = scan(&pose, &wall);
            let input = ControlInput {
                pose_in_map: pose,
                twist,
                path: &path,
                costmap: &costmap,
                scan: Some((&pose, &scan)),
                dt_s: DT_S,
            };
            match dwa.control(&input) {
                Ok(wanted) => twist = body.limits.reachable(&twist, &wanted, DT_S),
                Err(error) => {
                    assert_eq!(error, ControlError::Blocked);
                    assert!(twist.is_still());
                    blocked = Some(tick);
                    break;
                }
            }
            pose = twist.advance(&pose, DT_S);
            assert_clear(&body, &pose, &wall, 0.0);
        }
        assert!(blocked.is_some(), "{pose:?}");
        assert!(pose.x > 2.0, "{pose:?}");
    }
}

#[test]
fn no_pose_at_all_is_blocked_and_no_path_is_an_error() {
    let body = disc();
    let costmap = costmap(&body, |_| false);
    let mut dwa = Dwa::new(DwaConfig::DEFAULT, &body);
    let (path, nowhere) = (straight_path(), Path::default());
    let input = ControlInput {
        pose_in_map: Pose::new(f64::NAN, 0.0, 0.0),
        twist: Twist::ZERO,
        path: &path,
        costmap: &costmap,
        scan: None,
        dt_s: DT_S,
    };
    assert_eq!(dwa.control(&input), Err(ControlError::Blocked));
    let input = ControlInput { pose_in_map: Pose::default(), path: &nowhere, ..input };
    assert_eq!(dwa.control(&input), Err(ControlError::EmptyPath));
}

/// A scan whose rays hit the points, to within a fraction of a millimetre.
fn scan(robot: &Pose, points: &[Point]) -> LaserScan {
    const RAYS: usize = 36_000;
    let increment = std::f64::consts::TAU / RAYS as f64;
    let mut ranges_m = vec![f32::NAN; RAYS];
    for point in points {
        let bearing = (Pose::facing(robot.position(), *point).yaw - robot.yaw).rem_euclid(std::f64::consts::TAU);
        let ray = (bearing / increment).round() as usize % RAYS;
        let range = robot.distance_to(*point) as f32;
        if ranges_m[ray].is_nan() || range < ranges_m[ray] {
            ranges_m[ray] = range;
        }
    }
    LaserScan { angle_increment_rad: increment, range_max_m: 30.0, ranges_m, ..LaserScan::default() }
}

/// Whether a robot that brakes now passes every one of these points by 2 cm.
fn could_stop(body: &Body, pose: &Pose, twist: Twist, obstacle: Point) -> bool {
    let outline = Outline::new(&body.footprint);
    let (mut pose, mut twist) = (*pose, twist);
    for _ in 0..30 {
        for i in 0..=10 {
            let at = twist.advance(&pose, DT_S * f64::from(i) / 10.0);
            if outline.distance_m(at.inverse().transform(obstacle)) < 0.02 {
                return false;
            }
        }
        pose = twist.advance(&pose, DT_S);
        twist = body.limits.reachable(&twist, &Twist::ZERO, DT_S);
    }
    true
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn never_touches_what_appears_in_time(
        polygon in any::<bool>(),
        posts in proptest::collection::vec((0usize..120, -2.5f64..2.5, 0.25f64..1.5, any::<bool>()), 0..40),
    ) {
        let body = if polygon { waffle() } else { disc() };
        let path = straight_path();
        let mut costs = costmap(&body, |_| false).costs().to_vec();
        let info = *costmap(&body, |_| false).info();
        let mut dwa = Dwa::new(DwaConfig::DEFAULT, &body);
        let (mut pose, mut twist) = (Pose::new(1.0, 4.0, 0.4), Twist::ZERO);
        let (mut seen, mut known): (Vec<Point>, Vec<Point>) = Default::default();
        for tick in 0..120 {
            for &(_, bearing, distance_m, by_lidar) in posts.iter().filter(|post| post.0 == tick) {
                let mut post = pose.transform(Point::new(distance_m * bearing.cos(), distance_m * bearing.sin()));
                let cell = info.cell_at(post);
                if !by_lidar {
                    post = info.center(cell);
                }
                // The command under way is braked from the speed that it has led to.
                let braked = body.limits.reachable(&twist, &Twist::ZERO, DT_S);
                if !could_stop(&body, &pose, braked, post) {
                    continue;
                }
                match info.index(cell) {
                    Some(index) if !by_lidar => {
                        costs[index] = LETHAL_COST;
                        known.push(post);
                    }
                    _ => seen.push(post),
                }
            }
            let map = Costmap::from_costs(info, costs.clone()).unwrap();
            let hits = scan(&pose, &seen);
            let input = ControlInput {
                pose_in_map: pose, twist, path: &path, costmap: &map, scan: Some((&pose, &hits)), dt_s: DT_S,
            };
            let wanted = dwa.control(&input).unwrap_or(Twist::ZERO);
            twist = body.limits.reachable(&twist, &wanted, DT_S);
            for i in 1..=10 {
                let at = twist.advance(&pose, DT_S * f64::from(i) / 10.0);
                assert_clear(&body, &at, &known, 0.0);
                // The rays of the scan hit to within half a millimetre.
                assert_clear(&body, &at, &seen, -5e-4);
            }
            pose = twist.advance(&pose, DT_S);
        }
    }
}
