//! Explorations that go on: after a crash, after a rest, on another day, and in another place.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{EXACT, SOON, Test, World};
use frontier_explorer::io::load_map;
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::std_msgs::Bool;
use std::time::Duration;

pub const TESTS: &[Test] = &[
    ("an_exploration_that_is_killed_ten_times_ends_as_one_that_is_not", killed),
    ("a_paused_exploration_that_is_killed_stays_paused", paused),
    ("what_was_explored_stays_explored_on_another_day", another_day),
    ("a_session_of_another_place_is_left_out", another_place),
    ("a_session_that_cannot_be_read_is_named", unreadable),
];

fn go_on(world: &World, more: &[&str]) -> Process {
    let session = world.folder.join("session.json").display().to_string();
    let (keep, resume) = (format!("_session_file:={session}"), format!("_resume_from:={session}"));
    world.explore(&[&[keep.as_str(), resume.as_str(), "_session_period:=0.3"], more].concat())
}

fn killed(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let mut sim = world.simulate_kindly(&["_speed:=2"]);
    for kill in 0..10_u64 {
        let mut explore = go_on(world, &[]);
        explore.expect_log(if kill == 0 { "a new session begins" } else { "going on with the session of" }, SOON);
        // Moments that differ, and no chance that is another one each time.
        std::thread::sleep(Duration::from_millis(700 + 97 * ((kill * 7) % 10)));
        explore.signal("KILL");
        explore.wait(SOON);
    }
    let driven = status.last().map_or(0.0, |last| last.elapsed_s);
    let mut explore = go_on(world, &[]);
    explore.expect_code(0, DEADLINE);
    let log = explore.log();
    assert!(log.contains("complete: ") && log.contains("what was explored stays so"), "{log}");
    let end = status.expect(SOON, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert!(end.elapsed_s > driven && end.distance_m > 2.0, "{end:?}");
    let left: Vec<_> = std::fs::read_dir(&world.folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(!left.iter().any(|name| name.to_string_lossy().starts_with(".writing-")), "{left:?}");
    world.expect_explored(&mut sim, EXACT);
}

fn paused(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let resume = world.probe.publish::<Bool>("/explore/resume", 5).unwrap();
    let _sim = world.simulate_kindly(&["_speed:=2"]);
    let mut explore = go_on(world, &[]);
    status.expect(DEADLINE, "turning", |m| m.phase == ExplorationStatus::TURNING);
    // What is sent before the two are connected is lost.
    let rests = || {
        resume.send(Bool { data: false }).unwrap();
        status.last().is_some_and(|m| m.phase == ExplorationStatus::PAUSED)
    };
    eventually(SOON, rests, || format!("no rest: {:?}", status.last()));
    // A slow disk takes its time.
    let session = || std::fs::read_to_string(world.folder.join("session.json")).unwrap_or_default();
    eventually(SOON, || session().contains("\"activity\": \"paused\""), session);
    explore.signal("KILL");
    explore.wait(SOON);
    let before = status.all().len();
    let mut explore = go_on(world, &[]);
    explore.expect_log("the session was paused: call ~resume to go on", SOON);
    std::thread::sleep(Duration::from_secs(3));
    let since = status.all().split_off(before);
    assert!(!since.is_empty() && since.iter().all(|m| m.distance_m < 0.05), "it drives: {since:?}");
    assert_eq!(since.last().unwrap().phase, ExplorationStatus::PAUSED);
    resume.send(Bool { data: true }).unwrap();
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
}

fn another_day(world: &World) {
    let mut sim = world.simulate_kindly(&[]);
    let mut explore = go_on(world, &[]);
    explore.expect_code(0, DEADLINE);
    world.expect_explored(&mut sim, EXACT);
    // A mapper that begins anew in the same frame: it knows one room.
    let _sim = world.simulate_kindly(&[]);
    let mut explore = go_on(world, &["_explorer:={turns: {at_start: false}}"]);
    explore.expect_code(0, DEADLINE);
    let log = explore.log();
    assert!(log.contains("agrees with the one that comes") && log.contains("complete: "), "{log}");
    assert!(log.matches("best of").count() == 0, "it drove to explored places: {log}");
    let saved = load_map(&world.map().with_extension("yaml")).unwrap().grid;
    assert!(saved.census(&Default::default()).free as f64 * 0.0025 > 22.0, "{log}");
}

fn another_place(world: &World) {
    let mut sim = world.simulate_kindly(&[]);
    let mut explore = go_on(world, &[]);
    explore.expect_code(0, DEADLINE);
    sim.signal("TERM");
    sim.expect_code(0, SOON);
    let _office = Process::start(
        env!("CARGO_BIN_EXE_sim_node"),
        &["_world:=office", "_speed:=8", "_slam:=perfect", "_driver:=navigator"],
        world.folder.join("office.log"),
    );
    let explore = go_on(world, &["_config:=liang"]);
    explore.expect_log("the map of the session contradicts the one that comes", SOON);
    explore.expect_log("best of", SOON);
}

fn unreadable(world: &World) {
    for (text, why) in [("{", "EOF while parsing"), ("{\"format\": \"other\"}", "missing field")] {
        std::fs::write(world.folder.join("session.json"), text).unwrap();
        let mut explore = go_on(world, &[]);
        explore.expect_code(1, SOON);
        let log = explore.log();
        assert!(log.contains("parameter ~resume_from: ") && log.contains(why), "{log}");
    }
}
