//! The simulated robot behind the port: when it observes what, how it drives, and that a seed decides all.

use super::*;
use crate::config::builtin_robot;
use crate::control::{FollowerConfig, PathFollower};
use crate::grid::{GridInfo, Thresholds};
use crate::navigation::NavigatorConfig;
use crate::planning::Astar;
use crate::sim::WorldError;

/// Two rooms of 6 m x 5 m side by side with a door of 1 m, in cells of 0.05 m.
fn two_rooms() -> Arc<World> {
    let info = GridInfo::new(244, 104, 0.05, Pose::new(-2.0, -1.0, 0.0)).unwrap();
    let mut truth = OccupancyGrid::filled(info, 100);
    for index in 0..info.len() {
        let cell = info.cell(index);
        let inside = (2..102).contains(&cell.y) && (2..242).contains(&cell.x);
        let door = (40..60).contains(&cell.y);
        if inside && (door || !(120..124).contains(&cell.x)) {
            truth.set(cell, 0);
        }
    }
    Arc::new(World::new(&truth, &Thresholds::default()).unwrap())
}

fn robot(config: SimConfig) -> SimRobot {
    let burger = builtin_robot("turtlebot3_burger").unwrap();
    let body = burger.body();
    let follower = PathFollower::new(FollowerConfig::default(), body.clone());
    let navigator = Navigator::new(NavigatorConfig::default(), Box::<Astar>::default(), Box::new(follower), &body);
    SimRobot::new(two_rooms(), &burger, config, navigator, Pose::new(0.0, 0.0, 0.0)).unwrap()
}

/// Drives to the other room, then turns about.
fn tour(robot: &mut SimRobot) -> Vec<Observation> {
    let drive = Command::Drive { id: 1, goal_in_map: Pose::new(3.0, 1.5, 0.0) };
    let through = Command::Drive { id: 2, goal_in_map: Pose::new(5.2, 1.5, 0.0) };
    let turn = Command::Turn { id: 3, angle_rad: 3.0 };
    let mut seen = Vec::new();
    for command in [drive, through, turn] {
        robot.command(&command).unwrap();
        for _ in 0..400 {
            seen.push(robot.observe().unwrap());
            robot.command(&command).unwrap();
            let navigation = &seen.last().unwrap().navigation;
            let (Command::Drive { id, .. } | Command::Turn { id, .. }) = command else { unreachable!() };
            if navigation.command == id && navigation.state != NavigationState::Active {
                assert_eq!(navigation.state, NavigationState::Succeeded);
                break;
            }
        }
    }
    seen
}

#[test]
fn the_first_observation_is_at_time_zero_and_has_a_map() {
    let mut sim = robot(SimConfig::default());
    let first = sim.observe().unwrap();
    assert_eq!((first.stamp_s, first.navigation.state), (0.0, NavigationState::Idle));
    let map = first.map.unwrap();
    assert!(map.stamp_s == 0.0 && map.grid.census(&Thresholds::default()).free > 1000);
    assert_eq!(map.costmap.unwrap().cells.info(), map.grid.info());
    assert_eq!(first.scan.unwrap().1.stamp_s, 0.0);
}

#[test]
fn time_passes_by_ticks_and_maps_come_each_second() {
    let mut sim = robot(SimConfig::default());
    let stamps: Vec<(f64, f64)> =
        (0..16).map(|_| sim.observe().unwrap()).map(|o| (o.stamp_s, o.map.unwrap().stamp_s)).collect();
    for (index, &(now_s, map_s)) in stamps.iter().enumerate() {
        assert!((now_s - 0.2 * index as f64).abs() < 1e-9);
        assert!((map_s - now_s.floor()).abs() < 1e-9);
    }
}

#[test]
fn it_drives_through_the_door_without_a_touch_and_covers_what_it_sees() {
    let mut sim = robot(SimConfig::default());
    let before = sim.stats();
    tour(&mut sim);
    let after = sim.stats();
    assert!(sim.pose().distance_to(crate::geometry::Point::new(5.2, 1.5)) < 0.2);
    assert_eq!(after.collisions, 0);
    assert!(before.coverage > 0.2 && after.coverage > before.coverage + 0.2, "{before:?} {after:?}");
    assert!(after.distance_m > 5.0 && after.distance_m < 7.5 && after.turned_rad > 3.0);
    // Two rooms of 30 m2, a door of 0.2 m2.
    assert!((after.target_area_m2 - 59.2).abs() < 0.5, "{}", after.target_area_m2);
    let share = sim.target().coverage_of(sim.map());
    assert_eq!(share, after.coverage);
}

#[test]
fn the_same_seed_gives_the_same_run_byte_for_byte() {
    let config = SimConfig {
        seed: 5,
        lidar_noise_std_m: Some(0.01),
        odometry_noise: Some(crate::sim::OdometryNoise {
            turn_by_turn: 0.1,
            drive_by_drive: 0.1,
            ..Default::default()
        }),
        ..SimConfig::default()
    };
    let run = |config| {
        let mut sim = robot(config);
        let mut seen = String::new();
        for Observation { stamp_s, pose_in_map, scan, navigation, .. } in tour(&mut sim) {
            seen += &format!("{stamp_s} {pose_in_map:?} {scan:?} {navigation:?}");
        }
        format!("{seen} {:?} {:?} {:?}", sim.map(), sim.stats(), sim.pose_in_odom())
    };
    let first = run(config);
    assert!(first == run(config));
    assert!(first != run(SimConfig { seed: 6, ..config }));
}

#[test]
fn a_start_in_a_wall_is_refused_with_its_room() {
    let burger = builtin_robot("turtlebot3_burger").unwrap();
    let body = burger.body();
    let follower = Box::new(PathFollower::new(FollowerConfig::default(), body.clone()));
    let navigator = Navigator::new(NavigatorConfig::default(), Box::<Astar>::default(), follower, &body);
    let start = Pose::new(-1.98, 0.0, 0.0);
    let error = SimRobot::new(two_rooms(), &burger, SimConfig::default(), navigator, start).err().unwrap();
    assert!(matches!(error, SimError::World(WorldError::StartBlocked { clearance_m, .. }) if clearance_m == 0.0));
}
