//! Parameters that change while the node runs (dynamic_reconfigure): a change takes effect, a bad
//! value changes nothing, and what was set outlives the process.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{SOON, Test, World};
use frontier_explorer::ros::call;
use frontier_explorer::ros::msg::dynamic_reconfigure::{
    BoolParameter, Config, ConfigDescription, DoubleParameter, Reconfigure, ReconfigureReq,
};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::std_msgs::String as StringMessage;
use frontier_explorer::ros::msg::visualization_msgs::{Marker, MarkerArray};
use std::time::Duration;

pub const TESTS: &[Test] = &[
    ("live_parameters_change_the_run_under_way", changes_the_run),
    ("live_parameters_reach_the_robot", reaches_the_robot),
    ("live_parameters_outlive_the_process_and_told_ones_do_not", outlives),
];

fn double(name: &str, value: f64) -> Config {
    Config { doubles: vec![DoubleParameter { name: name.to_owned(), value }], ..Config::default() }
}

fn boolean(name: &str, value: bool) -> Config {
    Config { bools: vec![BoolParameter { name: name.to_owned(), value }], ..Config::default() }
}

/// Asks for values; all values after that, or why nothing was changed.
fn set(world: &World, config: Config) -> Result<Config, String> {
    let asked = ReconfigureReq { config };
    let answer = call::<Reconfigure>(&world.probe, "/explore/set_parameters", asked, Duration::from_secs(15));
    answer.map(|answer| answer.config).map_err(|error| error.to_string())
}

fn number(config: &Config, name: &str) -> f64 {
    config.doubles.iter().find(|p| p.name == name).unwrap_or_else(|| panic!("no {name} in {config:?}")).value
}

fn param(world: &World, name: &str) -> serde_json::Value {
    let tree = world.probe.params_below("/explore").unwrap();
    tree.pointer(&format!("/{name}")).cloned().unwrap_or_default()
}

fn stays(world: &World, more: &[&str]) -> Process {
    let process = world.explore(&[&["_exit_when_done:=false"], more].concat());
    process.expect_log("preset ", SOON);
    process
}

fn changes_the_run(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let described = Heard::<ConfigDescription>::on(&world.probe, "/explore/parameter_descriptions");
    let updates = Heard::<Config>::on(&world.probe, "/explore/parameter_updates");
    let markers = Heard::<MarkerArray>::on(&world.probe, "/explore/frontiers");
    // Slow enough for all this, by a preset that decides each second.
    let _sim = world.simulate_kindly(&["_speed:=1"]);
    let mut explore = stays(world, &["_config:=nearest_by_way"]);
    let told = described.expect(SOON, "the descriptions", |_| true);
    let names: Vec<&str> = told.groups[0].parameters.iter().map(|p| p.name.as_str()).collect();
    assert!(names.contains(&"min_size") && names.contains(&"visualize") && names.contains(&"nearest_by"), "{names:?}");
    assert_eq!((number(&told.min, "min_size"), number(&told.max, "min_size")), (0.0, 10.0));
    let first = updates.expect(SOON, "the values", |_| true);
    assert_eq!((number(&first, "min_size"), number(&first, "time_limit")), (0.75, 0.0));
    let preset = param(world, "effective/preset/preset");
    assert_eq!((param(world, "min_size"), preset), (0.75.into(), "nearest_by_way".into()));
    assert_eq!(param(world, "effective/robot/name"), "turtlebot2");
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);

    // What cannot be is refused, and nothing is changed, the good value beside it neither.
    let mut bad = double("min_size", -1.0);
    bad.bools = boolean("visualize", false).bools;
    let why = set(world, bad).unwrap_err();
    assert!(why.contains("min_size is -1.0: must be a number within 0 to 10; nothing is changed"), "{why}");
    let why = set(world, double("min_siz", 1.0)).unwrap_err();
    assert!(why.contains("did you mean min_size?"), "{why}");
    explore.expect_log("WARN", SOON);
    assert!(explore.log().contains("must be a number within 0 to 10"), "{}", explore.log());
    let same = set(world, Config::default()).unwrap();
    assert_eq!((number(&same, "min_size"), param(world, "min_size")), (0.75, 0.75.into()));

    // Markers are taken away, and none come any more.
    markers.expect(SOON, "markers", |m| !m.markers.is_empty());
    let now = set(world, boolean("visualize", false)).unwrap();
    assert!(now.bools.iter().any(|p| p.name == "visualize" && !p.value));
    updates.expect(SOON, "the change", |m| m.bools.iter().any(|p| p.name == "visualize" && !p.value));
    let is_clear = |m: &MarkerArray| m.markers.iter().all(|m| m.action == i32::from(Marker::DELETEALL));
    markers.expect(SOON, "their removal", is_clear);
    let decisions = Heard::<frontier_explorer::ros::msg::frontier_explorer::FrontierArray>::on(
        &world.probe,
        "/explore/frontier_array",
    );
    let before = decisions.all().len();
    eventually(DEADLINE, || decisions.all().len() > before + 1, || "no decisions".to_owned());
    assert!(markers.last().is_some_and(|m| is_clear(&m)));

    // A limit ends the run, and holds for the next one too.
    let now = set(world, double("time_limit", 1.0)).unwrap();
    assert_eq!((number(&now, "time_limit"), param(world, "time_limit")), (1.0, 1.0.into()));
    assert_eq!(param(world, "effective/preset/explorer/patience/time_limit_s"), 1.0);
    let end = status.expect(SOON, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "time_limit");
    let ask = |name: &str| {
        let request = frontier_explorer::ros::msg::std_srvs::TriggerReq {};
        let service = format!("/explore/{name}");
        call::<frontier_explorer::ros::msg::std_srvs::Trigger>(&world.probe, &service, request, SOON).unwrap()
    };
    let earlier = status.all().len();
    assert!(ask("start").success);
    let ends_again = || {
        let all = status.all();
        let mut later = all[earlier..].iter().skip_while(|m| m.phase == ExplorationStatus::ENDED);
        later.any(|m| m.end_reason == "time_limit" && m.elapsed_s < 3.0)
    };
    eventually(SOON, ends_again, || format!("{:?}", status.last()));
    explore.signal("TERM");
    explore.expect_code(0, SOON);
}

fn reaches_the_robot(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let faults = world.probe.publish_latched::<StringMessage>("/sim/fault").unwrap();
    let _sim = world.simulate_kindly(&["_speed:=3"]);
    let explore = stays(world, &[]);
    status.expect(DEADLINE, "a way", |m| m.phase == ExplorationStatus::TURNING || m.goals_sent > 0);
    set(world, double("transform_tolerance", 2.25)).unwrap();
    faults.send(StringMessage { data: "drop_tf".to_owned() }).unwrap();
    explore.expect_log("s old: must be at most 2.25 s", SOON);
}

fn outlives(world: &World) {
    let _sim = world.simulate_kindly(&[]);
    let mut explore = stays(world, &["_autostart:=false", "_max_visits:=3"]);
    eventually(SOON, || param(world, "effective/preset").is_object(), || explore.log());
    assert_eq!(param(world, "effective/preset/explorer/taboo/max_visits"), 3);
    set(world, double("goal_timeout", 77.0)).unwrap();
    set(world, boolean("exit_when_done", true)).unwrap();
    // As after a crash: nothing is taken back.
    explore.signal("KILL");
    explore.wait(SOON);
    assert_eq!(param(world, "min_size"), 0.3);

    // Another preset has its own smallest frontier; what was set holds.
    let mut again = stays(world, &["_autostart:=false", "_config:=liang"]);
    again.expect_log("~goal_timeout is 77", SOON);
    eventually(SOON, || param(world, "effective/preset/preset") == "liang", || again.log());
    assert_eq!((param(world, "min_size"), param(world, "goal_timeout")), (0.75.into(), 77.0.into()));
    let explorer = |path: &str| param(world, &format!("effective/preset/explorer/{path}"));
    assert_eq!((explorer("detector/min_size_m"), explorer("patience/goal_timeout_s")), (0.75.into(), 77.0.into()));
    assert_eq!(explorer("taboo/max_visits"), 3, "the user's own stays");
    again.signal("TERM");
    again.expect_code(0, SOON);
    assert!(param(world, "min_size").is_null(), "told, and taken back");
    assert_eq!((param(world, "goal_timeout"), param(world, "max_visits")), (77.0.into(), 3.into()));
}
