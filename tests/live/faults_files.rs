//! Places that a map cannot be saved in, disks that are full, and signals in the middle of a save.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{KIND, SOON, Test, World};
use frontier_explorer::io::load_map;
use frontier_explorer::ros::call;
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::std_srvs::{Trigger, TriggerReq};
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("a_map_file_that_is_no_file_is_named_and_holds_nobody", no_files),
    ("a_map_file_that_is_a_link_keeps_the_link", link),
    ("a_full_disk_is_named_and_the_old_map_stays", full_disk),
    ("a_session_on_a_full_disk_is_named_and_the_run_goes_on", full_disk_for_the_session),
    ("ctrl_c_in_the_middle_of_a_save_leaves_a_whole_map", interrupted_saves),
    ("sigkill_in_the_middle_of_a_save_leaves_a_whole_map", killed_saves),
    ("a_preset_without_an_end_is_refused", endless_preset),
];

/// Starts an explorer, waits for a map, and ends it; the exit code and the log.
fn short_run(world: &World, name: &str, map_file: &str) -> (Option<i32>, String) {
    let (node, map_file) = (format!("__name:={name}"), format!("_map_file:={map_file}"));
    let log = world.folder.join(format!("{name}.log"));
    let status = Heard::<ExplorationStatus>::on(&world.probe, &format!("/{name}/status"));
    let mut explore = Process::start(env!("CARGO_BIN_EXE_explore_node"), &[&node, &map_file], log);
    status.expect(SOON, "a map", |m| m.known_area_m2 > 1.0);
    let began = Instant::now();
    explore.signal("INT");
    let code = explore.wait(SOON).code();
    assert!(began.elapsed() < Duration::from_millis(2200), "{:?}:\n{}", began.elapsed(), explore.log());
    (code, explore.log())
}

fn pipe(path: &Path) -> String {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    path.display().to_string()
}

fn no_files(world: &World) {
    let _sim = world.simulate_kindly(&[]);
    pipe(&world.folder.join("image.pgm"));
    std::fs::create_dir(world.folder.join("taken.pgm")).unwrap();
    let beside = |name: &str| world.folder.join(name).display().to_string();
    let cases = [
        ("null", "/dev/null".to_owned(), "/dev/null is a device or a pipe"),
        ("full", "/dev/full".to_owned(), "/dev/full is a device or a pipe"),
        ("pipe", pipe(&world.folder.join("pipe")), "pipe is a device or a pipe"),
        ("image", beside("image"), "image.pgm is a device or a pipe"),
        ("taken", beside("taken"), "taken.pgm: "),
        ("kernel", "/proc/map".to_owned(), "cannot write /proc/map.pgm: "),
        ("folder", format!("{}/", world.folder.display()), "must end in a file name"),
        ("link", beside("round"), "too many symbolic links"),
    ];
    std::os::unix::fs::symlink("round.pgm", world.folder.join("round.pgm")).unwrap();
    for (name, map_file, said) in cases {
        let (code, log) = short_run(world, name, &map_file);
        assert_eq!(code, Some(1), "{name}: {log}");
        assert!(log.contains("the map could not be saved as ~map_file says: "), "{name}: {log}");
        assert!(log.matches(said).count() >= 2, "{name}: {said:?} is not at both ends of:\n{log}");
        assert!(log.contains("the map is not saved: "), "{name}: {log}");
    }
}

fn link(world: &World) {
    let _sim = world.simulate_kindly(&[]);
    let (link, target) = (world.folder.join("map.pgm"), world.folder.join("elsewhere.pgm"));
    std::os::unix::fs::symlink(&target, &link).unwrap();
    let (code, log) = short_run(world, "linked", &world.map().display().to_string());
    assert_eq!(code, Some(0), "{log}");
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink() && target.is_file());
    load_map(&world.map().with_extension("yaml")).unwrap();
}

/// No process of this shell can write files of more than so many kilobytes, and hears of it as of a
/// full disk.
fn limited(world: &World, kilobytes: u32, args: &[&str]) -> Process {
    let script =
        format!("set -o pipefail; trap '' XFSZ; ulimit -f {kilobytes}; exec \"$0\" \"$@\" 2>&1 | cat > explore.piped");
    let script = format!("cd {} && {script}", world.folder.display());
    let all = [&["-c", &script, env!("CARGO_BIN_EXE_explore_node")], args].concat();
    Process::start("bash", &all, world.folder.join("explore.log"))
}

fn full_disk(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate_kindly(&[]);
    let map = world.map();
    std::fs::write(map.with_extension("pgm"), "the old one").unwrap();
    let map_file = format!("_map_file:={}", map.display());
    let mut explore = limited(world, 8, &["_config:=wfd", "_exit_when_done:=true", &map_file]);
    let end = status.expect(DEADLINE, "the end", |m| {
        m.phase == ExplorationStatus::ENDED && m.message.contains("the map is not saved: cannot write")
    });
    assert_eq!(end.end_reason, "complete");
    explore.expect_code(1, SOON);
    let log = std::fs::read_to_string(world.folder.join("explore.piped")).unwrap();
    assert!(log.contains("map.pgm: File too large"), "{log}");
    assert_eq!(std::fs::read_to_string(map.with_extension("pgm")).unwrap(), "the old one");
    expect_nothing_half_written(&world.folder);
}

fn full_disk_for_the_session(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate_kindly(&[]);
    let session = format!("_session_file:={}", world.folder.join("session.json").display());
    let mut explore = limited(world, 8, &["_config:=wfd", "_exit_when_done:=true", "_session_period:=0.5", &session]);
    let said = "the session is not saved as ";
    status.expect(DEADLINE, "a status that says it", |m| m.message.contains(said));
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "complete");
    explore.expect_code(0, SOON);
    let log = std::fs::read_to_string(world.folder.join("explore.piped")).unwrap();
    assert!(log.contains(said) && log.contains("File too large"), "{log}");
    expect_nothing_half_written(&world.folder);
}

fn expect_nothing_half_written(folder: &Path) {
    let left: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert!(!left.iter().any(|name| name.to_string_lossy().starts_with(".writing-")), "{left:?}");
}

/// Saves the map again and again, and sends a signal at moments that differ; each time a whole map
/// lies there.
fn signalled_saves(world: &World, signal: &str, then: impl Fn(&mut Process, Duration)) {
    let _sim = world.simulate(&[&["_world:=office", "_start:=[]"], KIND].concat());
    for round in 0..5_u64 {
        let mut explore = world.explore(&["_config:=wfd"]);
        let save = || {
            let limit = Duration::from_secs(1);
            call::<Trigger>(&world.probe, "/explore/save_map", TriggerReq {}, limit)
        };
        eventually(SOON, || save().is_ok_and(|answer| answer.success), || explore.log());
        std::thread::scope(|scope| {
            // It is asked until nobody answers.
            scope.spawn(|| while save().is_ok() {});
            std::thread::sleep(Duration::from_millis(40 + 13 * round));
            explore.signal(signal);
            let began = Instant::now();
            explore.wait(SOON);
            then(&mut explore, began.elapsed());
        });
        let saved = load_map(&world.map().with_extension("yaml")).unwrap().grid;
        assert!(saved.census(&Default::default()).free > 1000, "{}", explore.log());
    }
}

fn interrupted_saves(world: &World) {
    signalled_saves(world, "INT", |explore, within| {
        assert!(within < Duration::from_millis(2200), "{within:?}:\n{}", explore.log());
        explore.expect_code(0, SOON);
    });
    expect_nothing_half_written(&world.folder);
}

fn killed_saves(world: &World) {
    signalled_saves(world, "KILL", |_, _| {});
}

fn endless_preset(world: &World) {
    let mut explore = world.explore(&["_config:=/dev/zero"]);
    explore.expect_code(1, SOON);
    let said = "cannot read /dev/zero: it is longer than 268435456 bytes, or has no end";
    assert!(explore.log().contains(said), "{}", explore.log());
}
