//! `frontier doctor`: the mistakes that are made when a robot is set up, each named with its
//! remedy; and `explore_node`, which names the same ones in its own log.

use crate::peers;
use crate::relay::{Relays, later};
use crate::rig::{Heard, Process, eventually};
use crate::{KIND, SOON, Test, World};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::move_base_msgs::MoveBaseActionGoal;
use frontier_explorer::ros::msg::nav_msgs::OccupancyGrid;
use frontier_explorer::ros::msg::std_srvs;
use frontier_explorer::ros::msg::visualization_msgs::MarkerArray;
use frontier_explorer::ros::{Feed, Node};
use serde_json::Value;
use std::process::Command;
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("doctor_finds_a_healthy_robot_well", healthy),
    ("doctor_names_wrong_topics_frames_and_servers", wrong_names),
    ("doctor_and_node_name_a_clock_that_is_missing_or_stands", no_clock),
    ("doctor_and_node_name_skewed_clocks", skewed_clocks),
    ("doctor_and_node_name_a_costmap_without_unknown", costmap_without_unknown),
    ("doctor_and_node_name_a_misspelt_parameter", misspelt_parameter),
    ("doctor_and_node_name_a_map_file_that_cannot_be_written", unwritable_map_file),
    ("doctor_names_others_who_drive", others_who_drive),
    ("doctor_names_blind_scans_and_a_make_plan_that_hangs", blind_scans_and_hanging_plans),
    ("doctor_without_a_master_fails_in_time", no_master),
];

/// A mistake is named within this time.
const NAMED_WITHIN: Duration = Duration::from_secs(10);
/// At the pace of the wall clock: nothing is late.
const CALM: &[&str] = &["_speed:=1.0"];

/// What the doctor said.
struct Report {
    code: i32,
    findings: Vec<Value>,
}

impl Report {
    /// The finding of a check, as level, what and remedy.
    fn of(&self, check: &str) -> [&str; 3] {
        let finding = self.findings.iter().find(|finding| finding["check"] == check);
        let finding = finding.unwrap_or_else(|| panic!("no {check} in {:#?}", self.findings));
        ["level", "what", "remedy"].map(|key| finding[key].as_str().unwrap_or_default())
    }

    /// All checks that are not well.
    fn unwell(&self) -> Vec<&str> {
        let unwell = self.findings.iter().filter(|finding| finding["level"] != "ok");
        unwell.map(|finding| finding["check"].as_str().unwrap()).collect()
    }

    fn expect(&self, check: &str, level: &str, what: &str, remedy: &str) {
        let found = self.of(check);
        assert!(found[0] == level && found[1].contains(what) && found[2].contains(remedy), "{found:#?}");
    }
}

fn doctor(more: &[&str]) -> Report {
    let args = [&["doctor", "--json"], more].concat();
    let output = Command::new(env!("CARGO_BIN_EXE_frontier")).args(args).output().unwrap();
    let findings = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|why| panic!("{why}: {}", String::from_utf8_lossy(&output.stderr)));
    Report { code: output.status.code().unwrap(), findings }
}

/// Waits for the first map, so that a SLAM that begins is no finding.
fn simulate(world: &World, more: &[&str]) -> Process {
    let maps = Heard::<OccupancyGrid>::on(&world.probe, "/map");
    let sim = world.simulate(&[KIND, CALM, more].concat());
    maps.expect(SOON, "a map", |_| true);
    sim
}

fn healthy(world: &World) {
    let _sim = simulate(world, &[]);
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let before = doctor(&[]);
    assert_eq!((before.code, before.unwell()), (0, Vec::new()), "{:#?}", before.findings);
    assert!(before.of("explorers")[1].contains("does not run yet"), "{:?}", before.of("explorers"));
    let _explore = world.explore(&[]);
    status.expect(SOON, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    let during = doctor(&[]);
    assert_eq!((during.code, during.unwell()), (0, Vec::new()), "{:#?}", during.findings);
    assert_eq!(during.of("explorers")[1], "/explore runs, and nobody else drives");
    // The clock had gone on for long before it was looked at.
    let pace = during.of("clock")[1].rsplit_once(" runs at ").and_then(|(_, rest)| rest.split(' ').next());
    let pace: f64 = pace.and_then(|pace| pace.parse().ok()).expect("a pace");
    assert!((0.5..2.0).contains(&pace), "{pace}");
    let text = Command::new(env!("CARGO_BIN_EXE_frontier")).arg("doctor").output().unwrap();
    let text = String::from_utf8(text.stdout).unwrap();
    assert!(text.lines().last() == Some("all is well") && text.contains("\nok       clock: /clock of /sim"), "{text}");
}

fn wrong_names(world: &World) {
    let _sim = simulate(world, &[]);
    let cases = [
        (
            "map_topic",
            "mapp",
            "map",
            "nobody publishes /mapp (~map_topic); topics with maps: /map (of /sim)",
            "`rosparam set /wrong_map_topic/map_topic /map`",
        ),
        (
            "base_frame",
            "base_lnk",
            "frames",
            "tf does not know base_lnk; it has base_footprint, base_link, base_scan, map, odom",
            "`rosparam set /wrong_base_frame/base_frame base_link`",
        ),
        (
            "move_base",
            "move_bse",
            "move_base",
            "no action server is called /move_bse (~move_base); action servers that drive: /move_base",
            "`rosparam set /wrong_move_base/move_base /move_base`",
        ),
    ];
    for (parameter, value, check, what, remedy) in cases {
        let node = format!("/wrong_{parameter}");
        world.probe.set_param(&format!("{node}/{parameter}"), &value).unwrap();
        let began = Instant::now();
        let report = doctor(&["--node", &node]);
        eprintln!("{parameter}: {:.1} s", began.elapsed().as_secs_f64());
        assert_eq!((report.code, report.unwell()), (3, vec![check]), "{:#?}", report.findings);
        report.expect(check, "error", what, remedy);
        // An option takes the place of the parameter.
        let right = ["map", "base_link", "move_base"].into_iter().zip(["--map-topic", "--base-frame", "--move-base"]);
        let right: Vec<&str> = right.flat_map(|(value, option)| [option, value]).collect();
        assert_eq!(doctor(&[&["--node", node.as_str()], right.as_slice()].concat()).code, 0);
    }
}

fn no_clock(world: &World) {
    let relays = Relays::new(&world.probe);
    relays.clock.hold();
    let _sim = simulate(world, &Relays::REMAPPINGS);
    let explore = world.explore(&[]);
    let named = "use_sim_time is set and no /clock has come yet";
    explore.expect_log(named, NAMED_WITHIN);
    explore.expect_log("`rosparam set /use_sim_time false` and start all nodes again", NAMED_WITHIN);
    let missing = doctor(&[]);
    assert_eq!(missing.code, 3);
    let remedy = "`rosparam set /use_sim_time false`";
    missing.expect("clock", "error", "use_sim_time is set and no /clock has come: though /probe publishes it", remedy);
    relays.clock.pass();
    assert_eq!(doctor(&[]).of("clock")[0], "ok");
    relays.clock.hold();
    std::thread::sleep(Duration::from_millis(200));
    // A node that comes now hears no clock at all: one that stands is told to those who were there.
    explore.expect_log("/clock stands at", NAMED_WITHIN);
    relays.clock.pass();
    world.probe.set_param("/use_sim_time", &false).unwrap();
    doctor(&[]).expect(
        "clock",
        "error",
        "publishes /clock and /use_sim_time is not set",
        "rosparam set /use_sim_time true",
    );
}

fn skewed_clocks(world: &World) {
    let relays = Relays::new(&world.probe);
    let _sim = simulate(world, &Relays::REMAPPINGS);
    assert_eq!(doctor(&[]).code, 0);
    relays.tf.set(|message| Some(later(message, 120)));
    let ahead = doctor(&[]);
    assert_eq!((ahead.code, ahead.unwell()), (3, vec!["frames"]), "{:#?}", ahead.findings);
    ahead.expect(
        "frames",
        "error",
        "clock skew: odom -> base_link is stamped 1",
        "set the clocks of all computers alike",
    );
    let explore = world.explore(&[]);
    explore.expect_log("s ahead of ROS time: must be at most 1.5 s; set the clocks of the robot's", NAMED_WITHIN);
    drop(explore);
    // And one that is half a minute behind.
    relays.shift(200);
    relays.tf.set(|message| Some(later(message, 170)));
    let behind = doctor(&[]);
    assert_eq!((behind.code, behind.unwell()), (3, vec!["frames"]), "{:#?}", behind.findings);
    behind.expect(
        "frames",
        "error",
        "clock skew: odom -> base_link comes stamped 30.",
        "set the clocks of all computers alike",
    );
    let explore = world.explore(&["__name:=second"]);
    explore.expect_log("s behind ROS time: must be at most 1.5 s; set the clocks of the robot's", NAMED_WITHIN);
}

/// Passes the costmap on as one of a move_base that does not track the unknown.
fn forget_unknown(node: &Node) -> Feed {
    let out = node.publish_latched::<OccupancyGrid>("/move_base/global_costmap/costmap").unwrap();
    Feed::listen(node, "/true/costmap", 5, Duration::from_secs(120), move |mut message: OccupancyGrid, _| {
        message.data.iter_mut().for_each(|value| *value = (*value).max(0));
        out.send(message).unwrap();
    })
}

fn costmap_without_unknown(world: &World) {
    let _costmap = forget_unknown(&world.probe);
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let remapped = ["", "_updates"].map(|end| format!("move_base/global_costmap/costmap{end}:=/true/costmap{end}"));
    let _sim = simulate(world, &remapped.each_ref().map(String::as_str));
    let explore = world.explore(&[]);
    let named = "the costmap on /move_base/global_costmap/costmap has no unknown cell, and the map has";
    explore.expect_log(named, NAMED_WITHIN);
    let remedy = "set /move_base/global_costmap/track_unknown_space to true in move_base's parameters";
    explore.expect_log(remedy, NAMED_WITHIN);
    // It explores all the same, and says so beside.
    let beside = |m: &ExplorationStatus| m.message.contains(named) && !m.message.starts_with(named);
    status.expect(SOON, "driving", |m| m.phase == ExplorationStatus::DRIVING && beside(m));
    drop(explore);
    let report = doctor(&[]);
    assert_eq!((report.code, report.unwell()), (0, vec!["costmap"]), "{:#?}", report.findings);
    report.expect("costmap", "warning", "has no unknown cell, and", "set `global_costmap/track_unknown_space: true`");
    // The parameter is looked at as well, and so is the outline.
    world.probe.set_param("/move_base/global_costmap/obstacles/track_unknown_space", &false).unwrap();
    world.probe.set_param("/move_base/global_costmap/robot_radius", &0.46).unwrap();
    let report = doctor(&["--move-base", "/move_base"]);
    report.expect(
        "costmap",
        "warning",
        "(obstacles/track_unknown_space is false)",
        "obstacles/track_unknown_space: true",
    );
    report.expect("footprint", "warning", "0.46 to 0.46 m around its centre", "set ~robot");
}

fn misspelt_parameter(world: &World) {
    let _sim = simulate(world, &[]);
    world.probe.set_param("/explore/base_frme", &"base_link").unwrap();
    world.probe.set_param("/explore/explorer/goal/serch_radius_m", &1.0).unwrap();
    let report = doctor(&[]);
    assert_eq!((report.code, report.unwell()), (3, vec!["parameters"]), "{:#?}", report.findings);
    let both = "`rosparam delete /explore/base_frme`, `rosparam delete /explore/explorer/goal/serch_radius_m`";
    report.expect("parameters", "error", "unknown field `base_frme`", both);
    report.expect("parameters", "error", "(did you mean base_frame?)", both);
    let mut explore = world.explore(&[]);
    explore.expect_code(1, NAMED_WITHIN);
    let log = explore.log();
    assert!(log.contains("(did you mean base_frame?); remove it with `rosparam delete /explore/base_frme`"), "{log}");
}

fn unwritable_map_file(world: &World) {
    let _sim = simulate(world, &[]);
    world.probe.set_param("/explore/map_file", &"/nowhere/at/all/map").unwrap();
    let report = doctor(&[]);
    assert_eq!((report.code, report.unwell()), (3, vec!["map_file"]), "{:#?}", report.findings);
    let what = "could not be saved from this computer as ~map_file says: cannot write /nowhere/at/all/map.pgm";
    report.expect("map_file", "error", what, "`rosparam set /explore/map_file FILE`");
    let log = world.folder.join("unsaved.log");
    let explore = Process::start(env!("CARGO_BIN_EXE_explore_node"), &[], log);
    explore.expect_log("as ~map_file says: cannot write /nowhere/at/all/map.pgm", NAMED_WITHIN);
    explore.expect_log("let this user write there, or set ~map_file elsewhere", NAMED_WITHIN);
}

fn others_who_drive(world: &World) {
    // Goals stay under way.
    let _sim = simulate(world, &["_fault:=hang"]);
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/second/status");
    let explore = world.explore(&[]);
    let second = world.explore(&["__name:=second"]);
    status.expect(SOON, "a second explorer", |_| true);
    let two = doctor(&[]);
    assert_eq!(two.code, 3, "{:#?}", two.findings);
    two.expect("explorers", "error", "2 explorers drive one robot: /explore, /second", "`rosnode kill /second`");
    drop(second);
    let lite = Node::start("lite").unwrap();
    let _markers = lite.publish::<MarkerArray>("/lite/frontiers", 1).unwrap();
    let its_goals = lite.publish::<MoveBaseActionGoal>("/move_base/goal", 1).unwrap();
    let lite_too = "2 explorers drive one robot: /explore, /lite (explore_lite)";
    doctor(&[]).expect("explorers", "error", lite_too, "`rosnode kill /lite`");
    drop((explore, its_goals));
    let patrol = Node::start("patrol").unwrap();
    let goals = patrol.publish::<MoveBaseActionGoal>("/move_base/goal", 1).unwrap();
    eventually(SOON, || goals.subscriber_count() > 0, || "nobody hears the goals".to_owned());
    let mut goal = MoveBaseActionGoal::default();
    "/patrol-1-1.0".clone_into(&mut goal.goal_id.id);
    goals.send(goal).unwrap();
    let report = doctor(&[]);
    report.expect("explorers", "warning", "other clients may send goals to the same server: /patrol", "stop them");
    report.expect("goals", "warning", "is under way: /patrol-1-1.0", "`rostopic pub -1 /move_base/cancel");
    report.expect("make_plan", "ok", "answers nobody while a goal is under way", "");
}

fn blind_scans_and_hanging_plans(world: &World) {
    let relays = Relays::new(&world.probe);
    let _sim = simulate(world, &[&Relays::REMAPPINGS[..], &["move_base/make_plan:=/true/make_plan"]].concat());
    relays.scan.set(|mut scan| {
        scan.ranges.fill(f32::NAN);
        Some(scan)
    });
    let absent = doctor(&[]);
    absent.expect("make_plan", "warning", "nobody offers /move_base/make_plan", "leave ~check_with_make_plan false");
    absent.expect("scan", "warning", "the scans on /scan show nothing: none of its", "whether the lidar is covered");
    assert_eq!(absent.code, 0);
    // One that hangs keeps nobody waiting, whatever its type.
    let _hanging = world
        .probe
        .serve::<std_srvs::Empty>("/move_base/make_plan", |_| {
            std::thread::sleep(Duration::from_secs(60));
            Ok(std_srvs::EmptyRes {})
        })
        .unwrap();
    world.probe.set_param("/explore/navigation/drive", &"internal").unwrap();
    let own = doctor(&[]);
    assert_eq!((own.code, own.unwell()), (3, vec!["scan"]), "{:#?}", own.findings);
    world.probe.set_param("/explore/navigation/drive", &"move_base").unwrap();
    let began = Instant::now();
    doctor(&[]).expect("make_plan", "warning", "does not answer", "see the log of move_base");
    assert!(began.elapsed() < Duration::from_secs(15));
}

fn no_master(world: &World) {
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let uri = format!("http://localhost:{port}");
    let fails = |what: &str| {
        let began = Instant::now();
        let output = Command::new(env!("CARGO_BIN_EXE_frontier"))
            .args(["doctor", "--timeout", "3"])
            .env("ROS_MASTER_URI", &uri)
            .output()
            .unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(1), "{what}: {said}");
        assert!(began.elapsed() < Duration::from_secs(10), "{what}: {:?}", began.elapsed());
        assert!(said.contains("start `roscore` there, or set ROS_MASTER_URI") && said.contains(&uri), "{what}: {said}");
    };
    fails("no master");
    let env = [
        ("ROS_MASTER_URI".to_owned(), uri.clone()),
        (crate::rig::CHILD.to_owned(), peers::MASTER.to_owned()),
        ("FRONTIER_LIVE_PORT".to_owned(), port.to_string()),
    ];
    let program = std::env::current_exe().unwrap();
    let master = Process::start_in(program, &[], world.folder.join("master.log"), &env);
    let is_up = || std::net::TcpStream::connect(("localhost", port)).is_ok();
    eventually(SOON, is_up, || master.log());
    master.signal("STOP");
    fails("a frozen master");
    master.signal("CONT");
}
