//! How long the simulator's parts take in the office with a lidar of 400 rays at 10 Hz:
//! `cargo run --release --example sim_speed`. Prints milliseconds for each part and how much faster than the robot's
//! own time a drive through the office is.

#![allow(clippy::print_stdout, reason = "an example prints its figures")]

use anyhow::{Context, Result};
use frontier_explorer::config::{RobotConfig, builtin_robot};
use frontier_explorer::control::{FollowerConfig, PathFollower};
use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Costmap, Thresholds};
use frontier_explorer::io::load_map;
use frontier_explorer::navigation::{Navigator, NavigatorConfig};
use frontier_explorer::planning::Astar;
use frontier_explorer::robot::{Command, NavigationState, Robot};
use frontier_explorer::sim::{Coverage, Lidar, MapStyle, Mapper, MapperConfig, SimConfig, SimRobot, TargetArea, World};
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

fn main() -> Result<()> {
    let truth = load_map(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/maps/office.yaml")))?.grid;
    let robot = robot()?;
    let started = Instant::now();
    let world = Arc::new(World::new(&truth, &Thresholds::default())?);
    println!("world       {:8.3} ms once", ms(started, 1));

    let start = Pose::new(1.5, 7.9, 0.0);
    let started = Instant::now();
    let target = TargetArea::new(&world, &robot.footprint, &start)?;
    println!("target      {:8.3} ms once, {:.1} m2", ms(started, 1), target.area_m2());

    // Places all over the office.
    let places: Vec<Pose> = target
        .cells()
        .iter()
        .step_by(41)
        .enumerate()
        .map(|(i, &cell)| (truth.info().center(truth.info().cell(cell as usize)), i as f64))
        .map(|(at, yaw)| Pose::new(at.x, at.y, yaw))
        .collect();
    let mut lidar = Lidar::new(robot.lidar, 0);
    let started = Instant::now();
    let scans: Vec<_> = places.iter().map(|pose| lidar.sweep(&world, pose, 0.0)).collect();
    println!("sweep       {:8.3} ms for {} rays", ms(started, scans.len()), robot.lidar.rays);

    let config = MapperConfig::default();
    let mut mapper = Mapper::new(config, start.position(), world.info().origin_in_map().position())?;
    let started = Instant::now();
    for (pose, scan) in places.iter().zip(&scans) {
        mapper.integrate(pose, scan)?;
    }
    println!("integrate   {:8.3} ms", ms(started, scans.len()));

    let greys = MapperConfig { style: MapStyle::Cartographer, ..config };
    let grey = Mapper::new(greys, start.position(), Point::origin())?;
    let plain = Mapper::new(config, start.position(), Point::origin())?;
    for (name, mut mapper) in [("gmapping", plain), ("cartographer", grey)] {
        let mut spent = Duration::ZERO;
        for (pose, scan) in places.iter().zip(&scans) {
            mapper.integrate(pose, scan)?;
            let started = Instant::now();
            std::hint::black_box(mapper.publish()?);
            spent += started.elapsed();
        }
        println!("publish     {:8.3} ms as {name}", spent.as_secs_f64() * 1e3 / scans.len() as f64);
    }
    let map = mapper.publish()?.cells;
    let started = Instant::now();
    for _ in 0..20 {
        std::hint::black_box(Costmap::inflate(&map, &Thresholds::default(), &robot.inflation()));
    }
    println!("inflate     {:8.3} ms for {} x {} cells", ms(started, 20), map.info().width(), map.info().height());
    let mut coverage = Coverage::new(&target);
    let started = Instant::now();
    coverage.update(&map);
    println!("coverage    {:8.3} ms from nothing to {:.4}", ms(started, 1), coverage.share());
    drive(&world, &start)
}

/// Through the office on known ground, room by room.
fn drive(world: &Arc<World>, start: &Pose) -> Result<()> {
    let robot = robot()?;
    let body = robot.body();
    let follower = Box::new(PathFollower::new(FollowerConfig::default(), body.clone()));
    let navigator = Navigator::new(NavigatorConfig::default(), Box::<Astar>::default(), follower, &body);
    let mut sim = SimRobot::new(Arc::clone(world), &robot, SimConfig::default(), navigator, *start)?;
    let started = Instant::now();
    let mut id = 0;
    for _ in 0..3000 {
        let observation = sim.observe()?;
        if observation.navigation.state != NavigationState::Active {
            id += 1;
            let x = if id % 2 == 1 { start.x + 4.0 } else { start.x };
            sim.command(&Command::Drive { id, goal_in_map: Pose::new(x, start.y, 0.0) })?;
        }
    }
    let stats = sim.stats();
    let factor = stats.sim_time_s / started.elapsed().as_secs_f64();
    println!("drive       {factor:8.0} x real time over {:.0} s, {:.0} m", stats.sim_time_s, stats.distance_m);
    (stats.collisions == 0).then_some(()).context("the robot touched something")
}

fn robot() -> Result<RobotConfig> {
    let mut robot = builtin_robot("turtlebot2")?;
    (robot.lidar.rays, robot.lidar.rate_hz) = (400, 10.0);
    Ok(robot)
}

fn ms(started: Instant, count: usize) -> f64 {
    started.elapsed().as_secs_f64() * 1e3 / count as f64
}
