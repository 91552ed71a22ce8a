//! The SLAM that errs: when maps come, what they show, and how far the pose is off.

use crate::config::{RobotConfig, builtin_robot};
use crate::geometry::{Pose, Twist, shortest_angle};
use crate::grid::{Cell, GridInfo, OccupancyGrid, Thresholds};
use crate::sim::schedule::micros;
use crate::sim::{Plant, SimConfig, SlamConfig, SlamKind, World};
use std::sync::Arc;

/// A hall of 8 m x 6 m with pillars, in cells of 0.05 m.
fn hall() -> Arc<World> {
    let info = GridInfo::new(168, 128, 0.05, Pose::new(-4.2, -3.2, 0.0)).unwrap();
    let mut truth = OccupancyGrid::filled(info, 0);
    for index in 0..info.len() {
        let cell = info.cell(index);
        let is_wall = cell.x < 4 || cell.y < 4 || cell.x >= 164 || cell.y >= 124;
        let is_pillar = (30..34).contains(&(cell.x % 60)) && (20..26).contains(&(cell.y % 50));
        if is_wall || is_pillar {
            truth.set(cell, 100);
        }
    }
    Arc::new(World::new(&truth, &Thresholds::default()).unwrap())
}

fn burger() -> RobotConfig {
    builtin_robot("turtlebot3_burger").unwrap()
}

fn plant(kind: SlamKind, seed: u64) -> Plant {
    plant_with(kind, seed, None)
}

fn plant_with(kind: SlamKind, seed: u64, lidar_noise_std_m: Option<f64>) -> Plant {
    let slam = SlamConfig { kind, ..SlamConfig::default() };
    let config = SimConfig { seed, slam, lidar_noise_std_m, ..SimConfig::default() };
    Plant::new(hall(), &burger(), config, Pose::new(1.6, -1.0, 0.3)).unwrap()
}

/// Drives for a while and looks at the plant whenever something has sensed.
fn drive(plant: &mut Plant, twist: &Twist, duration_s: f64, mut look: impl FnMut(&Plant, bool)) {
    let end = micros(plant.now_s() + duration_s);
    while plant.now() < end {
        plant.drive(twist, plant.next().min(end));
        let sensed = plant.sense().unwrap();
        look(plant, sensed.map);
    }
}

/// A round through the hall.
fn round(plant: &mut Plant, mut look: impl FnMut(&Plant, bool)) {
    for _ in 0..8 {
        drive(plant, &Twist::new(0.2, 0.0), 5.0, &mut look);
        drive(plant, &Twist::new(0.05, 0.6), 3.0, &mut look);
    }
}

#[test]
fn at_rest_no_map_comes() {
    let mut sim = plant(SlamKind::Matched, 1);
    let mut maps = 0;
    drive(&mut sim, &Twist::ZERO, 60.0, |_, is_map| maps += usize::from(is_map));
    assert_eq!((maps, sim.map_version()), (0, 1), "but the first, none");
    drive(&mut sim, &Twist::new(0.2, 0.0), 3.0, |_, is_map| maps += usize::from(is_map));
    assert!(maps >= 1);
    let mut perfect = plant(SlamKind::Perfect, 1);
    drive(&mut perfect, &Twist::ZERO, 60.0, |_, _| {});
    assert_eq!(perfect.map_version(), 61);
}

#[test]
fn maps_come_seldom_while_it_drives_and_late() {
    let mut sim = plant(SlamKind::Matched, 2);
    let mut times = Vec::new();
    round(&mut sim, |plant, is_map| {
        if is_map {
            let late_s = plant.now_s() - plant.map_stamp_s();
            assert!((0.15..=0.75).contains(&late_s), "{late_s} s after its scan");
            times.push(plant.map_stamp_s());
        }
    });
    let intervals: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(intervals.len() > 10 && intervals.iter().all(|&s| (2.0..=5.0).contains(&s)), "{intervals:?}");
}

#[test]
fn the_estimate_is_near_the_truth_and_jumps() {
    let mut sim = plant(SlamKind::Matched, 3);
    let (mut worst_m, mut jumps, mut last) = (0.0_f64, Vec::new(), sim.map_from_odom());
    round(&mut sim, |plant, _| {
        let (believed, truth) = (plant.map_from_odom().compose(&plant.pose_in_odom()), plant.pose());
        worst_m = worst_m.max(believed.distance_to(truth.position()));
        let now = plant.map_from_odom();
        if now != last {
            let here = plant.pose_in_odom();
            let (before, after) = (last.compose(&here), now.compose(&here));
            jumps.push(before.distance_to(after.position()).max(shortest_angle(before.yaw, after.yaw).abs()));
            last = now;
        }
    });
    let largest = jumps.iter().copied().fold(0.0, f64::max);
    assert!((0.01..0.4).contains(&worst_m), "{worst_m} m");
    assert!(jumps.len() > 20 && (0.01..0.3).contains(&largest), "{} jumps, {largest}", jumps.len());
    let mut perfect = plant(SlamKind::Perfect, 3);
    round(&mut perfect, |plant, _| assert_eq!(plant.pose_in_map(), plant.pose()));
}

#[test]
fn the_pose_is_known_late() {
    let mut sim = plant(SlamKind::Matched, 4);
    let mut lags = Vec::new();
    drive(&mut sim, &Twist::new(0.2, 0.0), 5.0, |_, _| {});
    drive(&mut sim, &Twist::new(0.2, 0.0), 5.0, |plant, _| {
        let fresh = plant.map_from_odom().compose(&plant.pose_in_odom());
        lags.push(fresh.distance_to(plant.pose_in_map().position()) / 0.2);
    });
    let mean_s = lags.iter().sum::<f64>() / lags.len() as f64;
    assert!((0.12..0.24).contains(&mean_s), "{mean_s} s");
}

/// Unknown cells between occupied ones, by sides or corners, as gmapping's walls have them;
/// and occupied cells.
fn dots(grid: &OccupancyGrid) -> (usize, usize) {
    let is_wall = |cell: Cell| grid.get(cell).is_some_and(|value| value >= 65);
    let is_dot = |cell: Cell| {
        let pair = |(x, y)| is_wall(cell.offset((x, y))) && is_wall(cell.offset((-x, -y)));
        grid.get(cell) == Some(OccupancyGrid::UNKNOWN) && [(1, 0), (0, 1), (1, 1), (1, -1)].into_iter().any(pair)
    };
    let cells = || (0..grid.info().len()).map(|index| grid.info().cell(index));
    (cells().filter(|&cell| is_dot(cell)).count(), cells().filter(|&cell| is_wall(cell)).count())
}

/// The maps of a round with a perfect SLAM and with one that errs.
fn maps(lidar_noise_std_m: Option<f64>) -> [Arc<OccupancyGrid>; 2] {
    [SlamKind::Perfect, SlamKind::Matched].map(|kind| {
        let mut sim = plant_with(kind, 5, lidar_noise_std_m);
        round(&mut sim, |_, _| {});
        Arc::clone(sim.map())
    })
}

#[test]
fn walls_are_dotted() {
    let [clean, smeared] = maps(None).map(|map| dots(&map));
    // Of the cells of gmapping's walls there were 2.3 % as many dots.
    let [clean_share, share] = [clean, smeared].map(|(dots, walls)| dots as f64 / walls as f64);
    assert!(share > 1.5 * clean_share && (0.01..0.12).contains(&share), "{smeared:?} after {clean:?}");
}

#[test]
fn walls_smear_where_no_noise_of_ranges_is() {
    let world = hall();
    let astray = |map: &OccupancyGrid| {
        let cells = (0..map.info().len()).map(|index| map.info().cell(index));
        let is_wall = |cell: &Cell| map.get(*cell).is_some_and(|value| value >= 65);
        let walls: Vec<Cell> = cells.filter(is_wall).collect();
        let is_astray = |cell: &&Cell| !world.is_solid(world.info().cell_at(map.info().center(**cell)));
        walls.iter().filter(is_astray).count() as f64 / walls.len() as f64
    };
    let [clean, smeared] = maps(Some(0.0)).map(|map| astray(&map));
    assert_eq!(clean, 0.0);
    assert!(smeared > 0.05, "{smeared} of the walls' cells lie in free ones");
}

#[test]
fn the_same_seed_makes_the_same_errors() {
    let run = |seed| {
        let mut sim = plant(SlamKind::Matched, seed);
        let mut seen = String::new();
        round(&mut sim, |plant, _| seen += &format!("{:?}", plant.pose_in_map()));
        (seen, Arc::clone(sim.map()))
    };
    assert!(run(6) == run(6) && run(6) != run(7));
}

#[test]
fn coverage_counts_what_was_seen_wherever_the_map_shows_it() {
    let slam = SlamConfig {
        kind: SlamKind::Matched,
        // No match is believed: errors add up.
        min_likelihood: 1.0,
        match_error_rad: 0.1,
        ..SlamConfig::default()
    };
    let config = SimConfig { seed: 3, slam, ..SimConfig::default() };
    let mut erring = Plant::new(hall(), &burger(), config, Pose::new(1.6, -1.0, 0.3)).unwrap();
    round(&mut erring, |_, _| {});
    let mut perfect = plant(SlamKind::Perfect, 3);
    round(&mut perfect, |_, _| {});
    let (seen, by_rights) = (erring.stats().coverage, perfect.stats().coverage);
    assert!((seen - by_rights).abs() < 0.01, "{seen} seen, {by_rights} without errors");
    let shown = erring.target().coverage_of(erring.map());
    assert!((seen - shown).abs() > 0.01, "{seen} seen, {shown} where the map shows it");
}
