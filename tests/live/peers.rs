//! Connections, files, a master and a move_base that go wrong, and names that are misspelt.

use crate::fake_publisher::FakePublisher;
use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{SOON, Test, World};
use frontier_explorer::ros::msg::actionlib_msgs::{GoalID, GoalStatusArray};
use frontier_explorer::ros::msg::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::move_base_msgs::{MoveBaseActionFeedback, MoveBaseActionGoal, MoveBaseActionResult};
use frontier_explorer::ros::msg::nav_msgs::OccupancyGrid;
use frontier_explorer::ros::msg::std_msgs::Bool;
use frontier_explorer::ros::{Feed, Node, start_embedded_master};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("silent_topics_leave_no_threads_and_descriptors_behind", silent_topics),
    ("a_connection_that_was_cut_is_made_anew", cut_connection),
    ("a_map_that_cannot_be_saved_is_said_at_the_start_and_exit_1", unsaved_map),
    ("a_frozen_master_keeps_nobody_from_leaving", frozen_master),
    ("a_move_base_that_ignores_goals_ends_the_run", ignoring_move_base),
    ("misspelt_inputs_are_named_with_what_there_is", misspelt_inputs),
];

/// The name under which a process of this program is a master and nothing else.
pub const MASTER: &str = "master";

fn count(folder: &str) -> usize {
    std::fs::read_dir(folder).unwrap().count()
}

fn silent_topics(world: &World) {
    let other = Node::start("other").unwrap();
    let latched = other.publish_latched::<OccupancyGrid>("/latched").unwrap();
    latched.send(OccupancyGrid::default()).unwrap();
    let silent: Vec<_> = (0..4).map(|i| other.publish::<Bool>(&format!("/silent_{i}"), 1).unwrap()).collect();
    let period = Duration::from_millis(200);
    let maps = Arc::new(AtomicUsize::new(0));
    let theirs = Arc::clone(&maps);
    let _map = Feed::listen(&world.probe, "/latched", 1, period, move |_: OccupancyGrid, _| {
        theirs.fetch_add(1, Ordering::Relaxed);
    });
    let bools = Arc::new(AtomicUsize::new(0));
    let _feeds: Vec<_> = (0..4)
        .map(|i| {
            let (topic, theirs) = (format!("/silent_{i}"), Arc::clone(&bools));
            let count = move |_: Bool, _: &str| {
                theirs.fetch_add(1, Ordering::Relaxed);
            };
            if i % 2 == 0 {
                Feed::listen(&world.probe, &topic, 1, period, count)
            } else {
                Feed::listen_seldom(&world.probe, &topic, 1, period, count)
            }
        })
        .collect();
    eventually(SOON, || maps.load(Ordering::Relaxed) > 0, || "no latched map".to_owned());
    std::thread::sleep(Duration::from_secs(2));
    let look = || (count("/proc/self/fd"), count("/proc/self/task"));
    let before = look();
    // Sixty periods.
    std::thread::sleep(Duration::from_secs(12));
    let after = look();
    eprintln!("descriptors and threads: {before:?}, after 60 periods of silence {after:?}");
    // A question to the master may be under way.
    assert!(after.0 <= before.0 + 2 && after.1 <= before.1 + 2, "{before:?} became {after:?}");
    assert_eq!(maps.load(Ordering::Relaxed), 1, "subscribed once");
    // Those who speak after all are heard.
    for topic in &silent {
        topic.send(Bool { data: true }).unwrap();
    }
    eventually(SOON, || bools.load(Ordering::Relaxed) == 4, || format!("heard {bools:?} of 4"));
}

fn cut_connection(world: &World) {
    let fake = FakePublisher::start(&std::env::var("ROS_MASTER_URI").unwrap(), "/cut");
    let heard = Arc::new(AtomicUsize::new(0));
    let theirs = Arc::clone(&heard);
    let _feed = Feed::listen(&world.probe, "/cut", 1, Duration::from_secs(1), move |_: Bool, _| {
        theirs.fetch_add(1, Ordering::Relaxed);
    });
    let speaks = |more: usize| eventually(SOON, || heard.load(Ordering::Relaxed) >= more, || format!("{heard:?}"));
    speaks(40);
    for _ in 0..2 {
        fake.cut();
        std::thread::sleep(Duration::from_millis(300));
        let (at, began) = (heard.load(Ordering::Relaxed), Instant::now());
        speaks(at + 40);
        eprintln!("heard again within {:.1} s", began.elapsed().as_secs_f64());
    }
}

fn unsaved_map(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let health = Heard::<DiagnosticArray>::on(&world.probe, "/diagnostics");
    let mut explore = world.explore(&["_map_file:=/nowhere/at/all/map"]);
    explore.expect_log("the map could not be saved as ~map_file says: cannot write /nowhere/at/all/map.pgm", SOON);
    let is_error = |m: &DiagnosticArray, text: &str| {
        m.status.iter().any(|s| s.level == DiagnosticStatus::ERROR && s.message.contains(text))
    };
    health.expect(SOON, "an error at the start", |m| is_error(m, "cannot write /nowhere/at/all/map.pgm"));
    status.expect(SOON, "a status with it", |m| m.message.contains("cannot write /nowhere/at/all/map.pgm"));
    let _sim = world.simulate_kindly(&[]);
    explore.expect_code(1, DEADLINE);
    let end = status.expect(SOON, "the end", |m| {
        m.phase == ExplorationStatus::ENDED && m.message.contains("the map is not saved: cannot write")
    });
    assert_eq!(end.end_reason, "complete");
    health.expect(SOON, "an error at the end", |m| is_error(m, "the map is not saved"));
}

fn frozen_master(world: &World) {
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let env = [
        ("ROS_MASTER_URI".to_owned(), format!("http://localhost:{port}")),
        (crate::rig::CHILD.to_owned(), MASTER.to_owned()),
        ("FRONTIER_LIVE_PORT".to_owned(), port.to_string()),
    ];
    let program = std::env::current_exe().unwrap();
    let master = Process::start_in(program, &[], world.folder.join("master.log"), &env);
    let sim_args = ["_world:=office", "_speed:=1.0"];
    let sim_log = world.folder.join("sim.log");
    let _sim = Process::start_in(env!("CARGO_BIN_EXE_sim_node"), &sim_args, sim_log, &env[..1]);
    for signal in ["INT", "TERM"] {
        let map = world.folder.join(format!("map_{signal}"));
        let map_file = format!("_map_file:={}", map.display());
        let args = [map_file.as_str(), "__name:=explore"];
        let log = world.folder.join(format!("explore_{signal}.log"));
        let mut explore = Process::start_in(env!("CARGO_BIN_EXE_explore_node"), &args, log, &env[..1]);
        explore.expect_log("map on map, goals to move_base", SOON);
        std::thread::sleep(Duration::from_secs(6));
        master.signal("STOP");
        std::thread::sleep(Duration::from_millis(500));
        let began = Instant::now();
        explore.signal(signal);
        explore.expect_code(0, Duration::from_millis(2200));
        eprintln!("left {:.2} s after SIG{signal}", began.elapsed().as_secs_f64());
        assert!(explore.log().contains("interrupted: "), "{}", explore.log());
        assert!(map.with_extension("pgm").exists() && map.with_extension("yaml").exists(), "{}", explore.log());
        master.signal("CONT");
    }
}

/// Connects as move_base does, tells that it has nothing to do, and does nothing.
struct Ignorer {
    stop: Arc<AtomicBool>,
}

impl Ignorer {
    fn start(node: &Node) -> Self {
        let stop = Arc::<AtomicBool>::default();
        let (node, theirs) = (node.clone(), Arc::clone(&stop));
        std::thread::spawn(move || {
            let status = node.publish::<GoalStatusArray>("/move_base/status", 5).unwrap();
            let _result = node.publish::<MoveBaseActionResult>("/move_base/result", 5).unwrap();
            let _feedback = node.publish::<MoveBaseActionFeedback>("/move_base/feedback", 5).unwrap();
            let second = Duration::from_secs(60);
            let _goals = Feed::listen(&node, "/move_base/goal", 5, second, |_: MoveBaseActionGoal, _| {});
            let _cancels = Feed::listen(&node, "/move_base/cancel", 5, second, |_: GoalID, _| {});
            while !theirs.load(Ordering::Relaxed) {
                status.send(GoalStatusArray::default()).unwrap();
                std::thread::sleep(Duration::from_millis(200));
            }
        });
        Self { stop }
    }
}

impl Drop for Ignorer {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

fn ignoring_move_base(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let goals = Heard::<MoveBaseActionGoal>::on(&world.probe, "/move_base/goal");
    let _server = Ignorer::start(&world.probe);
    let _sim = world.simulate(&["_move_base:=false", "_speed:=2.0"]);
    let patience = "_explorer:={patience: {navigation_timeout_s: 20.0}, turns: {at_start: false}}";
    let mut explore = world.explore(&[patience]);
    let end = status.expect(Duration::from_secs(60), "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "no_navigation", "{end:?}\n{}", explore.log());
    assert_eq!(end.goals_sent, 1, "one goal, sent again and again");
    assert!(end.message.contains("never took the goal up"), "{end:?}");
    explore.expect_code(3, SOON);
    eprintln!("the goal was sent {} times", goals.all().len());
    assert!((2..=6).contains(&goals.all().len()), "{}", goals.all().len());
}

fn misspelt_inputs(world: &World) {
    let _sim = world.simulate(&["_speed:=2.0"]);
    let cases = [
        (
            "map",
            "_map_topic:=mapp",
            "no map has come on /mapp (~map_topic) for",
            "nobody publishes it; topics with maps: /map (of /sim), /move_base/global_costmap/costmap (of /sim); \
             set ~map_topic to one of them",
        ),
        (
            "base",
            "_base_frame:=base_lnk",
            "the robot's frame base_lnk (~base_frame) is unknown: tf has",
            "base_footprint, base_link, base_scan, map, odom; set ~base_frame to the robot's",
        ),
        (
            "server",
            "_move_base:=move_bse",
            "no action server tells its status on move_bse/status",
            "action servers that drive: /move_base; set ~move_base to one of them",
        ),
    ];
    let health = Heard::<DiagnosticArray>::on(&world.probe, "/diagnostics");
    let started: Vec<_> = cases
        .iter()
        .map(|(name, argument, ..)| {
            let (node, log) = (format!("__name:={name}"), world.folder.join(format!("{name}.log")));
            let status = Heard::<ExplorationStatus>::on(&world.probe, &format!("/{name}/status"));
            let explore = Process::start(env!("CARGO_BIN_EXE_explore_node"), &[*argument, &node], log);
            (explore, status)
        })
        .collect();
    for ((name, _, said, also), (explore, status)) in cases.iter().zip(&started) {
        let told = |log: &str| log.lines().filter(|line| line.contains(said) && line.contains(also)).count();
        let began = Instant::now();
        eventually(Duration::from_secs(10), || told(&explore.log()) > 0, || explore.log());
        eprintln!("{name}: told within {:.1} s", began.elapsed().as_secs_f64());
        let shown = status.expect(SOON, "a status with it", |m| m.message.contains(said) && m.message.contains(also));
        assert_eq!(shown.goals_sent, 0, "{shown:?}");
        health.expect(SOON, "a warning", |m| {
            m.status.iter().any(|s| {
                s.name == format!("{name}: exploration")
                    && s.level == DiagnosticStatus::WARN
                    && s.message.contains(said)
            })
        });
        // And again while it lasts, every 15 s.
        eventually(Duration::from_secs(25), || told(&explore.log()) > 1, || explore.log());
    }
    assert_eq!(started[2].1.last().unwrap().goals_sent, 0);
}

/// A master that serves until it is killed.
pub fn serve_master(port: u16) {
    start_embedded_master(port).unwrap();
    std::thread::sleep(DEADLINE);
}
