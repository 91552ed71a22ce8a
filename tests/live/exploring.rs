//! Explorations from beginning to end: what is shown, driven, saved and named.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{DRIFTED, EXACT, SOON, Test, World};
use frontier_explorer::io::load_map;
use frontier_explorer::ros::msg::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use frontier_explorer::ros::msg::frontier_explorer::{ExplorationStatus, FrontierArray};
use frontier_explorer::ros::msg::geometry_msgs::{Point32, Polygon, PolygonStamped, PoseStamped, Twist};
use frontier_explorer::ros::msg::move_base_msgs::MoveBaseActionGoal;
use frontier_explorer::ros::msg::nav_msgs::OccupancyGrid;
use frontier_explorer::ros::msg::std_msgs::{Bool, String as StringMessage};
use frontier_explorer::ros::msg::visualization_msgs::MarkerArray;
use std::process::Command;
use std::time::Duration;

pub const TESTS: &[Test] = &[
    ("explores_a_house_saves_its_map_and_leaves", explores_a_house),
    ("shows_frontiers_goals_and_status", shows_what_it_does),
    ("tells_what_it_uses_and_when_that_is_too_much", resources),
    ("sigterm_stops_the_robot_and_saves_the_map", sigterm),
    ("lost_transforms_pause_and_do_not_end", lost_transforms),
    ("a_dead_move_base_is_named_at_the_end", dead_move_base),
    ("aborted_goals_are_tried_elsewhere_and_end_by_name", aborted_goals),
    ("drives_by_itself_where_there_is_no_move_base", internal_drive),
    ("looks_round_by_goals_of_move_base", turn_by_goals),
    ("goals_that_hang_are_given_up", hanging_goals),
    ("rests_and_goes_on", rests_and_goes_on),
    ("a_goal_clicked_in_rviz_is_no_failure", foreign_goal),
    ("explores_inside_a_region_only", region),
    ("looks_at_the_costmap_of_move_base", costmap_of_move_base),
    ("counts_free_area_by_the_presets_thresholds", free_area),
    ("lives_in_a_namespace_under_another_name", namespace),
    ("wrong_parameters_are_named", wrong_parameters),
    ("map_save_saves_one_map", map_save),
    ("the_demo_needs_nothing", demo),
];

fn explores_a_house(world: &World) {
    let mut sim = world.simulate_kindly(&[]);
    // A preset that decides on maps as they come.
    let mut explore = world.explore(&["_config:=liang"]);
    explore.expect_code(0, DEADLINE);
    let log = explore.log();
    assert!(log.contains("complete: "), "{log}");
    assert!(log.contains("from a map to the goal that it led to: median"), "{log}");
    assert!(log.contains("saved "), "{log}");
    world.expect_explored(&mut sim, EXACT);
    assert!(sim.log().contains(" 0 collisions"), "{}", sim.log());
}

fn shows_what_it_does(world: &World) {
    let arrays = Heard::<FrontierArray>::on(&world.probe, "/explore/frontier_array");
    let markers = Heard::<MarkerArray>::on(&world.probe, "/explore/frontiers");
    let goals = Heard::<PoseStamped>::on(&world.probe, "/explore/goal");
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate(&[]);
    let mut explore = world.explore(&[]);
    let array = arrays.expect(SOON, "a decision with a goal", |m| m.frontiers.iter().any(|f| f.has_goal));
    let best = &array.frontiers[0];
    assert_eq!((best.rank, array.header.frame_id.as_str()), (1, "map"));
    assert!(best.score_names.contains(&"total".to_owned()) && best.path_m > 0.0, "{best:?}");
    let shown = markers.expect(SOON, "markers", |m| m.markers.iter().any(|m| m.ns == "frontiers"));
    assert!(shown.markers.iter().any(|m| m.id == i32::try_from(best.id).unwrap()));
    goals.expect(SOON, "a goal", |m| m.header.frame_id == "map");
    status.expect(SOON, "driving", |m| m.phase == ExplorationStatus::DRIVING && m.goals_sent > 0);
    explore.expect_code(0, DEADLINE);
    let end = status.expect(SOON, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "complete");
    assert!(end.known_area_m2 > 22.0 && end.distance_m > 2.0 && end.goals_failed == 0, "{end:?}");
}

fn resources(world: &World) {
    let health = Heard::<DiagnosticArray>::on(&world.probe, "/diagnostics");
    let explore = world.explore(&["_autostart:=false"]);
    let value = |m: &DiagnosticArray, key: &str| -> Option<f64> {
        m.status.iter().flat_map(|s| &s.values).find(|v| v.key == key)?.value.parse().ok()
    };
    explore.expect_log("waiting to be started", SOON);
    // The probe, too, has connected by then.
    std::thread::sleep(Duration::from_secs(3));
    let now = health.last().unwrap();
    let open = value(&now, "open descriptors").unwrap();
    assert!(open > 10.0 && value(&now, "threads") > Some(10.0) && value(&now, "memory [MB]") > Some(1.0), "{now:?}");
    let limit = |most: f64| {
        let (id, limit) = (explore.id().to_string(), format!("--nofile={most:.0}:"));
        assert!(Command::new("prlimit").args(["--pid", &id, &limit]).status().unwrap().success());
    };
    let says = |m: &DiagnosticArray| m.status.iter().any(|s| s.message.contains("the node runs short: "));
    assert!(!health.all().iter().any(says), "{now:?}");
    // Numbers that are free again are counted by nobody: there is room above the count.
    limit(1.2 * open);
    let warned = health.expect(SOON, "a warning", says);
    assert!(warned.status.iter().all(|s| s.level == DiagnosticStatus::WARN), "{warned:?}");
    limit(0.5 * open);
    explore.expect_log("no descriptor is left to open", SOON);
    limit(10.0 * open);
    eventually(SOON, || !health.last().is_some_and(|m| says(&m)), || format!("{:?}", health.last()));
}

fn sigterm(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let cancels = Heard::<frontier_explorer::ros::msg::actionlib_msgs::GoalID>::on(&world.probe, "/move_base/cancel");
    let twists = Heard::<Twist>::on(&world.probe, "/cmd_vel");
    let mut sim = world.simulate(&[]);
    let mut explore = world.explore(&["_exit_when_done:=false"]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    explore.signal("TERM");
    explore.expect_code(0, Duration::from_secs(6));
    cancels.expect(SOON, "a cancellation", |m| m.id.starts_with("/explore-"));
    twists.expect(SOON, "standing still", |m| m.linear.x == 0.0 && m.angular.z == 0.0);
    assert!(world.map().with_extension("pgm").exists(), "{}", explore.log());
    assert!(explore.log().contains("interrupted"), "{}", explore.log());
    sim.signal("INT");
    sim.expect_code(0, SOON);
}

fn lost_transforms(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let faults = world.probe.publish_latched::<StringMessage>("/sim/fault").unwrap();
    let mut sim = world.simulate(&[]);
    let mut explore = world.explore(&[]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    faults.send(StringMessage { data: "drop_tf".to_owned() }).unwrap();
    status.expect(SOON, "waiting for the pose", |m| m.phase == ExplorationStatus::WAITING_FOR_POSE);
    explore.expect_log("s old: must be at most 0.5 s", SOON);
    faults.send(StringMessage { data: "none".to_owned() }).unwrap();
    explore.expect_code(0, DEADLINE);
    world.expect_explored(&mut sim, DRIFTED);
}

fn dead_move_base(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate(&["_fault:=dead_move_base"]);
    let mut explore = world.explore(&["_explorer:={patience: {navigation_timeout_s: 20.0}}"]);
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "no_navigation");
    assert!(end.message.contains("move_base/status"), "{end:?}");
    explore.expect_code(3, SOON);
    assert!(world.map().with_extension("pgm").exists());
}

fn aborted_goals(world: &World) {
    let _sim = world.simulate_kindly(&["_fault:=abort_goals"]);
    let mut explore = world.explore(&[]);
    explore.expect_code(3, DEADLINE);
    let log = explore.log();
    assert!(log.contains("all_unreachable") && log.contains("aborted by a fault"), "{log}");
}

fn internal_drive(world: &World) {
    let mut sim = world.simulate(&["_move_base:=false"]);
    let mut explore = world.explore(&["_config:=alghfeli", "_navigation:={drive: internal}"]);
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("goals to our own controller"), "{}", explore.log());
    world.expect_explored(&mut sim, DRIFTED);
}

fn turn_by_goals(world: &World) {
    let goals = Heard::<MoveBaseActionGoal>::on(&world.probe, "/move_base/goal");
    let mut sim = world.simulate(&[]);
    let mut explore = world.explore(&["_turn_by:=move_base"]);
    explore.expect_code(0, DEADLINE);
    world.expect_explored(&mut sim, DRIFTED);
    let place = |m: &MoveBaseActionGoal| (m.goal.target_pose.pose.position.x, m.goal.target_pose.pose.position.y);
    let first: Vec<_> = goals.all().iter().take(3).map(place).collect();
    assert!(first.len() == 3 && first.iter().all(|&(x, y)| (x - 2.0).hypot(y - 1.7) < 0.2), "{first:?}");
}

fn hanging_goals(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate_kindly(&["_fault:=hang"]);
    let mut explore = world.explore(&["_explorer:={patience: {progress_timeout_s: 5.0}}"]);
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!((end.end_reason.as_str(), end.goals_reached), ("all_unreachable", 0), "{end:?}");
    assert!(end.goals_failed > 0, "{end:?}");
    explore.expect_code(3, SOON);
}

fn rests_and_goes_on(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let resume = world.probe.publish_latched::<Bool>("/explore/resume").unwrap();
    let _sim = world.simulate(&[]);
    let mut explore = world.explore(&[]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    resume.send(Bool { data: false }).unwrap();
    let rest = status.expect(SOON, "resting", |m| m.phase == ExplorationStatus::PAUSED);
    std::thread::sleep(Duration::from_secs(5));
    let later = status.last().unwrap();
    assert_eq!((later.phase, later.distance_m), (ExplorationStatus::PAUSED, rest.distance_m));
    resume.send(Bool { data: true }).unwrap();
    explore.expect_code(0, DEADLINE);
    let end = status.expect(SOON, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!((end.end_reason.as_str(), end.goals_failed), ("complete", 0), "a rest is no failure");
}

fn foreign_goal(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let click = world.probe.publish::<PoseStamped>("/move_base_simple/goal", 1).unwrap();
    let _sim = world.simulate(&[]);
    let mut explore = world.explore(&[]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    let mut goal = PoseStamped::default();
    goal.header.frame_id = "map".to_owned();
    (goal.pose.position.x, goal.pose.position.y, goal.pose.orientation.w) = (1.5, 1.5, 1.0);
    click.send(goal).unwrap();
    explore.expect_code(0, DEADLINE);
    let end = status.expect(SOON, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!((end.end_reason.as_str(), end.goals_failed), ("complete", 0));
}

fn region(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let regions = world.probe.publish_latched::<PolygonStamped>("/explore/set_region").unwrap();
    let corner = |x: f32, y: f32| Point32 { x, y, z: 0.0 };
    let points = vec![corner(0.0, 0.0), corner(3.7, 0.0), corner(3.7, 3.5), corner(0.0, 3.5)];
    regions.send(PolygonStamped { polygon: Polygon { points }, ..PolygonStamped::default() }).unwrap();
    let _sim = world.simulate_kindly(&[]);
    let mut explore = world.explore(&[]);
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "outside_region", "{}", explore.log());
    explore.expect_code(0, SOON);
}

fn costmap_of_move_base(world: &World) {
    // The saved map is compared with the world cell by cell: its frame must not drift.
    let mut sim = world.simulate_kindly(&[]);
    let topic = "_global_costmap_topic:=move_base/global_costmap/costmap";
    let mut explore = world.explore(&["_config:=northwestern", topic, "_check_with_make_plan:=true"]);
    explore.expect_code(0, DEADLINE);
    world.expect_explored(&mut sim, EXACT);
}

/// Nothing is as free as this preset wants it: the mapper is never surer than 12 %.
fn free_area(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate_kindly(&["_map_style:=cartographer"]);
    let _explore = world.explore(&["_explorer:={thresholds: {free_max: 5, occupied_min: 66}}"]);
    let seen = status.expect(SOON, "a map", |m| m.known_area_m2 > 1.0);
    assert_eq!(seen.free_area_m2, 0.0, "of {} m2", seen.known_area_m2);
}

fn namespace(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/robot/scout/status");
    let mut sim = world.simulate_kindly(&["__ns:=/robot"]);
    let mut explore = world.explore(&["__ns:=/robot", "__name:=scout"]);
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "complete");
    explore.expect_code(0, SOON);
    world.expect_explored(&mut sim, EXACT);
}

fn wrong_parameters(world: &World) {
    let cases = [
        ("_tick_rate:=0", "parameter ~tick_rate is 0: must be within 0.1 to 50"),
        ("_base_frme:=base_link", "parameter ~base_frme: unknown field `base_frme`"),
        ("_config:=wdf", "parameter ~config: there is no preset \"wdf\": must be one of wfd"),
        ("_explorer:={goal: {search_radius_m: -1}}", "~explorer.goal.search_radius_m is -1: must be finite and > 0"),
        ("_config:=", "the parameter ~config on the command line has no value"),
    ];
    for (argument, message) in cases {
        let name = format!("__name:=explore_{}", argument.len());
        let mut explore = world.explore(&[argument, &name]);
        explore.expect_code(1, SOON);
        assert!(explore.log().contains(message), "{}", explore.log());
    }
}

fn map_save(world: &World) {
    let maps = Heard::<OccupancyGrid>::on(&world.probe, "/map");
    let _sim = world.simulate(&[]);
    maps.expect(SOON, "a map", |_| true);
    let file = world.folder.join("saved");
    let args = ["map", "save", "-f", file.to_str().unwrap(), "map:=/map"];
    let mut save = Process::start(env!("CARGO_BIN_EXE_frontier"), &args, world.folder.join("save.log"));
    save.expect_code(0, SOON);
    let saved = load_map(&file.with_extension("yaml")).unwrap().grid;
    assert!(saved.census(&Default::default()).free > 1000);
    let nothing = ["map", "save", "-f", file.to_str().unwrap(), "--topic", "no_map", "--timeout", "1"];
    let mut save = Process::start(env!("CARGO_BIN_EXE_frontier"), &nothing, world.folder.join("save.log"));
    save.expect_code(1, SOON);
    assert!(save.log().contains("no map came on no_map for 1 s"), "{}", save.log());
}

fn demo(world: &World) {
    let file = world.folder.join("demo");
    let house = world.house.to_str().unwrap();
    let args =
        ["demo", house, "--port", "0", "--speed", "8", "--slam", "perfect", "--map-file", file.to_str().unwrap()];
    let mut demo = Process::start(env!("CARGO_BIN_EXE_frontier"), &args, world.folder.join("demo.log"));
    demo.expect_code(0, DEADLINE);
    eventually(SOON, || file.with_extension("pgm").exists(), || demo.log());
    assert!(demo.log().contains("complete"), "{}", demo.log());
}
