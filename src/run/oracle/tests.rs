//! The oracle sees all that can be seen, is not beaten by who does not know the world, and gives the
//! same bytes for the same seed.

use super::*;
use crate::config::builtin_robot;
use crate::explore::run as explore;
use crate::geometry::{Point, Pose};
use crate::grid::{GridInfo, OccupancyGrid};
use crate::io::load_world;
use crate::run::NamedWorld;
use crate::run::record::SimRecorder;
use crate::sim::{DriverKind, MapStyle, SlamKind};
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use seen::Seen;

/// Two rooms with a door between, and a niche that is seen from in front of it alone.
const ROOMS: &str = "
    ##############################################
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    #............................................#
    #............................................#
    #............................................#
    #............................................#
    #............................................#
    #............................................#
    #....................#.......................#
    #....................#.......................#
    #....................#...................#####
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    #....................#.......................#
    ##############################################";

fn plan_in(world: NamedWorld, start: Pose, robot: &str, seed: u64) -> Plan {
    let mut preset = oracle_preset();
    preset.explorer.patience.time_limit_s = Some(3600.0);
    Plan {
        preset,
        robot: builtin_robot(robot).unwrap(),
        world,
        start,
        seed,
        map_style: MapStyle::Gmapping,
        lidar_noise_std_m: None,
        odometry_noise: None,
        slam: SlamKind::Perfect,
        driver: DriverKind::Navigator,
    }
}

/// A drawing in cells of 0.1 m.
fn rooms(robot: &str) -> Plan {
    let ascii = OccupancyGrid::from_ascii(ROOMS).unwrap();
    let (width, height) = (ascii.info().width() as u32, ascii.info().height() as u32);
    let info = GridInfo::new(width, height, 0.1, Pose::new(-1.0, 2.0, 0.0)).unwrap();
    let truth = OccupancyGrid::new(info, ascii.data().to_vec()).unwrap();
    plan_in(NamedWorld::new("rooms".to_owned(), &truth).unwrap(), Pose::new(0.0, 3.0, 0.0), robot, 1)
}

fn built_in(world: &str, x: f64, y: f64) -> Plan {
    let (truth, name) = load_world(world).unwrap();
    plan_in(NamedWorld::new(name, &truth).unwrap(), Pose::new(x, y, 0.0), "turtlebot2", 1)
}

/// Rooms of 3 m by 2.4 m in rows, with a door in most of the walls between them.
fn random_rooms(seed: u64) -> Plan {
    const WIDTH: u32 = 4 * 30 + 2;
    const HEIGHT: u32 = 3 * 24 + 2;
    let mut random = Pcg32::new(seed, 7);
    let info = GridInfo::new(WIDTH, HEIGHT, 0.1, Pose::default()).unwrap();
    let mut truth = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    let mut doors = || (!random.next_u32().is_multiple_of(4), 4 + (random.next_u32() % 9) as i32);
    let upright: Vec<_> = (0..12).map(|_| doors()).collect();
    let level: Vec<_> = (0..12).map(|_| doors()).collect();
    for index in 0..info.len() {
        let cell = info.cell(index);
        let (column, row) = (cell.x / 30, cell.y / 24);
        let room = (row.min(2) * 4 + column.min(3)) as usize;
        let outer = cell.x < 2 || cell.y < 2 || cell.x >= WIDTH as i32 - 2 || cell.y >= HEIGHT as i32 - 2;
        let is_door = |(is_open, at): (bool, i32), along: i32| is_open && (at..at + 9).contains(&along);
        let wall = cell.x % 30 < 2 && !is_door(upright[room], cell.y % 24)
            || cell.y % 24 < 2 && !is_door(level[room], cell.x % 30);
        if outer || wall {
            truth.set(cell, OccupancyGrid::OCCUPIED);
        }
    }
    let world = NamedWorld::new(format!("random {seed}"), &truth).unwrap();
    plan_in(world, Pose::new(7.6, 3.6, 0.0), "turtlebot2", 1)
}

fn oracle(plan: &Plan) -> OracleRun {
    run_oracle(plan, &AtomicBool::new(false)).unwrap().unwrap()
}

fn t99_s<D>(record: &crate::report::RunRecord<D>) -> Option<f64> {
    record.time_to_coverage_s["0.99"]
}

/// No preset is faster than the oracle by more than 2 %.
fn unbeaten(plan: &Plan) {
    let run = oracle(plan);
    let best_s = t99_s(&run.record);
    assert_eq!(run.record.collisions, 0);
    for name in ["wfd_360", "explore_lite", "tour", "liang"] {
        let mut preset = Preset::built_in(name).unwrap();
        preset.explorer.patience.time_limit_s = Some(3600.0);
        let online = Plan { preset, ..plan.clone() };
        let (mut sim, mut explorer) = online.prepare().unwrap();
        let mut recorder = SimRecorder::of_figures(Arc::default());
        let end = explore(&mut sim, &mut explorer, &mut recorder);
        let record = recorder.record(&online, &sim, &explorer, &end, 0.0);
        if let Some(time_s) = t99_s(&record) {
            let best_s = best_s.unwrap_or(f64::INFINITY);
            assert!(best_s <= 1.02 * time_s, "{name} in {}: {time_s} s, oracle {best_s} s", plan.world.name);
        }
    }
}

#[test]
fn no_preset_beats_it_in_the_office() {
    unbeaten(&built_in("office", 13.4, 4.0));
}

#[test]
fn no_preset_beats_it_in_the_museum() {
    unbeaten(&built_in("museum", 18.6, 13.4));
}

#[test]
fn no_preset_beats_it_in_the_maze() {
    unbeaten(&built_in("maze", 1.2, 1.2));
}

#[test]
fn no_preset_beats_it_in_random_rooms() {
    for seed in 1..=4 {
        unbeaten(&random_rooms(seed));
    }
}

#[test]
fn no_preset_beats_it_in_two_rooms() {
    unbeaten(&rooms("turtlebot2"));
}

#[test]
fn the_same_seed_gives_the_same_drive() {
    let (one, two) = (oracle(&rooms("turtlebot2")), oracle(&rooms("turtlebot2")));
    assert_eq!(one.record.end_reason, EndReason::Complete);
    assert_eq!(one.trajectory, two.trajectory);
    let wall = one.record.wall;
    assert_eq!(one.record, crate::report::RunRecord { wall, ..two.record });
}

#[test]
fn a_robot_that_sees_ahead_alone_turns_where_it_must() {
    let run = oracle(&rooms("turtlebot2_astra"));
    assert_eq!(run.record.end_reason, EndReason::Complete, "{}", run.record.coverage);
}

#[test]
fn a_drive_that_is_stopped_or_out_of_time_says_so() {
    let mut plan = rooms("turtlebot2");
    assert!(run_oracle(&plan, &AtomicBool::new(true)).unwrap().is_none());
    plan.preset.explorer.patience.time_limit_s = Some(2.0);
    let record = oracle(&plan).record;
    assert_eq!((record.end_reason, record.sim_time_s), (EndReason::TimeLimit, 2.0));
    assert!(record.coverage > 0.1 && t99_s(&record).is_none());
}

/// What is seen from all of some blocks, and at the start.
fn seen_from(planner: &mut Planner<'_>, blocks: &[usize]) -> Seen {
    let mut seen = planner.begin.seen.clone();
    blocks.iter().for_each(|&block| seen.add(&planner.routes.around(block)));
    seen
}

#[test]
fn a_cover_sees_every_cell_that_counts() {
    let plan = rooms("turtlebot2");
    let robot = plan.robot().unwrap();
    let mut planner = Planner::new(&plan, &robot).unwrap();
    // The world is so small that each cell is a sample.
    let all = planner.routes.sights.samples();
    assert_eq!(all, robot.target().cells().len());
    planner.begin.enough = all;
    assert!(planner.begin.seen.count() < all, "one look is not enough");
    let cover = planner.search.cover(&mut planner.routes, &planner.begin);
    assert!(!cover.is_empty() && cover.len() < 12, "{}", cover.len());
    assert_eq!(seen_from(&mut planner, &cover).count(), all);
    // Annealing leaves out what is not needed and never makes it worse.
    let before = planner.routes.estimate(&planner.begin, &cover);
    let (route, after) = planner.search.anneal(&mut planner.routes, &planner.begin, cover, 500);
    assert!(before.is_enough && after.is_enough && after.cost_s <= before.cost_s);
    assert_eq!((after.used, after), (route.len(), planner.routes.estimate(&planner.begin, &route)));
}

#[test]
fn what_is_seen_ends_at_walls_and_at_the_range() {
    let plan = rooms("turtlebot2");
    let robot = plan.robot().unwrap();
    let Planner { routes, .. } = Planner::new(&plan, &robot).unwrap();
    let seen = routes.sights.around(Point::new(0.0, 3.6));
    let mut short = plan.robot.lidar;
    short.range_max_m = 0.5;
    let near = Sights::new(Arc::clone(&plan.world.world), short, robot.target()).around(Point::new(0.0, 3.6));
    // A disc of five cells' radius, and the cells that its rim touches.
    assert!((70..=110).contains(&near.count()), "{}", near.count());
    assert_eq!(near.new_to(&seen), 0);
    // All of the first room, and not the corners beyond the door.
    let share = seen.count() as f64 / routes.sights.samples() as f64;
    assert!((0.5..0.99).contains(&share), "{share}");
}
