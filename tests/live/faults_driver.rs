//! A move_base that comes late, goes, turns goals away, plans for nobody, or whose costmap does
//! not come; frontiers that stay, and openings that nobody fits through.

use crate::relay::Relay;
use crate::rig::{DEADLINE, Heard, Process};
use crate::{EXACT, SOON, Test, World};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::nav_msgs::{GetPlan, GetPlanRes, OccupancyGrid};
use frontier_explorer::ros::msg::std_msgs::String as StringMessage;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

pub const TESTS: &[Test] = &[
    ("a_move_base_that_comes_late_is_waited_for", comes_late),
    ("a_move_base_that_dies_on_the_way_and_returns_costs_no_goal", dies_and_returns),
    ("a_move_base_that_rejects_every_goal_ends_the_run_by_name", rejects_all),
    ("without_make_plan_our_own_planner_decides", no_make_plan),
    ("a_make_plan_that_hangs_holds_nobody_up", hanging_make_plan),
    ("a_costmap_that_does_not_come_is_named_and_waited_for", no_costmap),
    ("a_frontier_that_stays_as_it_is_on_arrival_is_given_up", frontier_that_stays),
    ("an_opening_narrower_than_the_robot_is_no_goal", narrow_opening),
];

fn statuses(world: &World) -> Heard<ExplorationStatus> {
    Heard::on(&world.probe, "/explore/status")
}

fn end_of(status: &Heard<ExplorationStatus>, explore: &Process) -> ExplorationStatus {
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    eprintln!("{} {}\n{}", end.end_reason, end.message, explore.log());
    end
}

/// move_base is gone from `gone_when` on until the explorer says that it waits for it, and comes back: no
/// goal is lost.
fn expect_no_goal_lost(
    world: &World,
    sim_args: &[&str],
    explore_args: &[&str],
    gone_when: impl Fn(&ExplorationStatus) -> bool,
) {
    let status = statuses(world);
    let faults = world.probe.publish_latched::<StringMessage>("/sim/fault").unwrap();
    let tell = |fault: &str| faults.send(StringMessage { data: fault.to_owned() }).unwrap();
    let mut sim = world.simulate_kindly(sim_args);
    let mut explore = world.explore(explore_args);
    status.expect(DEADLINE, "the moment it goes", gone_when);
    tell("dead_move_base");
    status.expect(SOON, "waiting for it", |m| m.phase == ExplorationStatus::WAITING_FOR_NAVIGATION);
    explore.expect_log("move_base/status", SOON);
    tell("none");
    explore.expect_code(0, DEADLINE);
    let end = end_of(&status, &explore);
    assert_eq!((end.end_reason.as_str(), end.goals_failed), ("complete", 0), "{end:?}");
    world.expect_explored(&mut sim, EXACT);
}

fn comes_late(world: &World) {
    let explore_args = ["_explorer:={turns: {at_start: false}}"];
    expect_no_goal_lost(world, &["_fault:=dead_move_base"], &explore_args, |m| m.goals_sent == 0);
}

fn dies_and_returns(world: &World) {
    // At this speed a robot stands for long before a server counts as gone.
    let explore_args = ["_explorer:={patience: {stall_s: 30.0}}"];
    let is_on_its_way = |m: &ExplorationStatus| m.phase == ExplorationStatus::DRIVING && m.goals_sent > 0;
    expect_no_goal_lost(world, &["_speed:=4"], &explore_args, is_on_its_way);
}

fn rejects_all(world: &World) {
    let status = statuses(world);
    let _sim = world.simulate_kindly(&["_fault:=reject_goals"]);
    let mut explore = world.explore(&[]);
    let end = end_of(&status, &explore);
    assert_eq!((end.end_reason.as_str(), end.goals_reached), ("all_unreachable", 0), "{end:?}");
    explore.expect_code(3, SOON);
    assert!(explore.log().contains("rejected by a fault"), "{}", explore.log());
}

/// The exploration ends as it does with a make_plan.
fn expect_complete_without_plans(world: &World) {
    let mut sim = world.simulate_kindly(&["move_base/make_plan:=/true/make_plan"]);
    let mut explore = world.explore(&["_check_with_make_plan:=true"]);
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    world.expect_explored(&mut sim, EXACT);
    eprintln!("{}", explore.log());
}

fn no_make_plan(world: &World) {
    expect_complete_without_plans(world);
}

fn hanging_make_plan(world: &World) {
    let asked = Arc::<AtomicUsize>::default();
    let theirs = Arc::clone(&asked);
    let hanging = world.probe.serve::<GetPlan>("/move_base/make_plan", move |_| {
        theirs.fetch_add(1, Ordering::Relaxed);
        std::thread::sleep(Duration::from_secs(60));
        Ok(GetPlanRes::default())
    });
    assert!(hanging.is_ok());
    expect_complete_without_plans(world);
    assert!(asked.load(Ordering::Relaxed) > 0, "it was never asked");
}

fn no_costmap(world: &World) {
    let status = statuses(world);
    let costs = Relay::<OccupancyGrid>::latched(&world.probe, "/true/costmap", "/costmap");
    costs.hold();
    let mut sim = world.simulate_kindly(&["move_base/global_costmap/costmap:=/true/costmap"]);
    let mut explore = world.explore(&["_global_costmap_topic:=costmap"]);
    explore.expect_log("no map has come on /costmap (~global_costmap_topic) for", SOON);
    std::thread::sleep(Duration::from_secs(3));
    assert!(status.all().iter().all(|m| m.goals_sent == 0 && m.phase != ExplorationStatus::ENDED));
    drop(costs);
    sim.signal("INT");
    sim.expect_code(0, SOON);
    // With one that comes it begins.
    let mut sim = world.simulate_kindly(&["move_base/global_costmap/costmap:=/costmap"]);
    explore.expect_code(0, DEADLINE);
    world.expect_explored(&mut sim, EXACT);
}

/// In the middle of the right room there is a spot that the map never shows.
fn frontier_that_stays(world: &World) {
    let status = statuses(world);
    let maps = Relay::<OccupancyGrid>::latched(&world.probe, "/true/map", "/map");
    maps.set(|mut map| {
        let info = &map.info;
        let (width, cell) = (info.width as usize, f64::from(info.resolution));
        for (i, value) in map.data.iter_mut().enumerate() {
            let x = info.origin.position.x + (i % width) as f64 * cell;
            let y = info.origin.position.y + (i / width) as f64 * cell;
            if (5.5..6.5).contains(&x) && (1.2..2.2).contains(&y) {
                *value = -1;
            }
        }
        Some(map)
    });
    let _sim = world.simulate_kindly(&["map:=/true/map"]);
    let mut explore = world.explore(&[]);
    let end = end_of(&status, &explore);
    assert!(end.message.contains("(1 seen in vain, "), "{end:?}");
    assert!((2..=6).contains(&end.goals_sent), "{end:?}");
    explore.wait(SOON);
    assert!(world.map().with_extension("pgm").exists());
}

/// Two rooms with a door of 0.2 m between them.
fn narrow_house(world: &World) -> PathBuf {
    let (yaml, pgm) = (world.folder.join("narrow.yaml"), world.folder.join("narrow.pgm"));
    const WIDTH: usize = 160;
    const HEIGHT: usize = 70;
    let is_wall = |x: usize, y: usize| {
        let outer = x < 4 || y < 4 || x >= WIDTH - 4 || y >= HEIGHT - 4;
        outer || ((78..82).contains(&x) && !(33..37).contains(&y))
    };
    let mut image = format!("P5\n{WIDTH} {HEIGHT}\n255\n").into_bytes();
    for row in 0..HEIGHT {
        image.extend((0..WIDTH).map(|x| if is_wall(x, HEIGHT - 1 - row) { 0 } else { 254 }));
    }
    std::fs::write(pgm, image).unwrap();
    let text = std::fs::read_to_string(&world.house).unwrap().replace("house.pgm", "narrow.pgm");
    std::fs::write(&yaml, text).unwrap();
    yaml
}

fn narrow_opening(world: &World) {
    let status = statuses(world);
    let house = format!("_world:={}", narrow_house(world).display());
    let _sim = world.simulate_kindly(&[&house]);
    let mut explore = world.explore(&[]);
    let end = end_of(&status, &explore);
    assert_eq!((end.end_reason.as_str(), end.goals_failed), ("complete", 0), "{end:?}");
    assert!(end.message.contains(", 2 behind openings too narrow for the robot"), "{end:?}");
    explore.wait(SOON);
    assert!(world.map().with_extension("pgm").exists());
}
