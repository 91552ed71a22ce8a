//! Recordings with faults that real ones have: clocks apart, times that cannot be, stray
//! transforms, limits that are none, frames that are missing. Each gives its result or the
//! true reason.

#![allow(clippy::unwrap_used)]

#[path = "odd_bags/fixture.rs"]
mod fixture;

use assert_cmd::Command;
use fixture::{BEGIN_S, DRIVE_S, Drive, MAP_CELLS, Message, WAY_M, tf, write};
use frontier_explorer::bag::{MessageType, clock_message, nanos};
use frontier_explorer::geometry::Pose;
use frontier_explorer::tf::TransformSample;
use serde_json::Value;
use std::path::Path;

/// Exit code, stdout and stderr of a command.
fn run(args: &[&str], bag: &Path, out: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frontier"));
    let output = command.args(args).arg(bag).args(out).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

fn info(bag: &Path) -> Value {
    let (code, said, _) = run(&["bag", "info", "--json"], bag, &[]);
    assert_eq!(code, 0);
    serde_json::from_str(&said).unwrap()
}

/// The run.json and the words of a replay that must succeed.
fn replayed(bag: &Path, args: &[&str]) -> (Value, String) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap().to_owned();
    let (code, said, error) = run(&["replay"], bag, &[&["--out", &out], args].concat());
    assert_eq!(code, 0, "{said}{error}");
    let run: Value = serde_json::from_slice(&std::fs::read(folder.path().join("run.json")).unwrap()).unwrap();
    assert!(folder.path().join("replay.gif").is_file());
    (run, said)
}

/// A replay of the whole drive, with decisions.
fn is_whole(bag: &Path, args: &[&str]) {
    let (run, said) = replayed(bag, args);
    let way_m = run["distance_m"].as_f64().unwrap();
    assert!((way_m - WAY_M).abs() < 0.2, "{way_m} m: {said}");
    let (time_s, decisions) = (run["sim_time_s"].as_f64().unwrap(), run["decisions"].as_array().unwrap().len());
    assert!((time_s - DRIVE_S).abs() < 0.5 && decisions >= 1, "{time_s} s, {decisions} decisions: {said}");
}

/// A map build; how many scans were taken in.
fn mapped(bag: &Path, args: &[&str]) -> (i32, usize, String) {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("map").to_str().unwrap().to_owned();
    let (code, said, error) = run(&["map", "build"], bag, &[&["-o", &out], args].concat());
    let taken = said.lines().find_map(|line| line.split_once(" scans taken in")).map_or("0", |(count, _)| count);
    assert!(code != 0 || folder.path().join("map.yaml").is_file());
    (code, taken.parse().unwrap(), said + &error)
}

/// A good drive, changed by a test.
fn spoiled(folder: &Path, drive: Drive, spoil: impl FnOnce(&mut Vec<Message>)) -> std::path::PathBuf {
    let mut messages = drive.messages();
    spoil(&mut messages);
    write(folder, "drive.bag", &messages)
}

#[test]
fn headers_may_go_by_a_clock_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    for skew_s in [-4000.0, -60.0, -4.9, -3.0, -1.0, -0.6, -0.3, 0.0, 0.1, 0.6, 1.0, 4.9, 60.0, 9000.0] {
        let bag = spoiled(folder.path(), Drive { skew_s, begin_s: 50_000.0, ..Drive::default() }, |_| {});
        is_whole(&bag, &[]);
        is_whole(&bag, &["--map-from-scans"]);
        let (code, taken, said) = mapped(&bag, &[]);
        assert!(code == 0 && taken >= 45, "{skew_s}: {said}");
    }
}

#[test]
fn the_clock_of_the_headers_may_have_its_own_speed() {
    let folder = tempfile::tempdir().unwrap();
    for (speed, skew_s) in [(0.25, 0.0), (0.5, -40_000.0), (2.0, 0.0), (4.0, 300.0)] {
        let bag = spoiled(folder.path(), Drive { speed, skew_s, begin_s: 50_000.0, ..Drive::default() }, |_| {});
        is_whole(&bag, &[]);
        is_whole(&bag, &["--map-from-scans"]);
        assert!(mapped(&bag, &[]).1 >= 45, "{speed}");
    }
}

#[test]
fn sources_may_have_clocks_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    for skew_s in [-4000.0, -20.0, 20.0, 4000.0] {
        for topic in ["/tf", "/scan", "/map"] {
            let others = Drive { begin_s: 50_000.0, ..Drive::default() };
            let bag = spoiled(folder.path(), others, |messages| {
                messages.retain(|message| message.topic != topic);
                let skewed = Drive { skew_s, ..others }.messages();
                messages.extend(skewed.into_iter().filter(|message| message.topic == topic));
                messages.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
            });
            is_whole(&bag, &[]);
            let (code, taken, said) = mapped(&bag, &[]);
            assert!(code == 0 && taken >= 45, "{topic} {skew_s}: {said}");
        }
    }
}

#[test]
fn a_time_that_cannot_be_poisons_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let topics = ["/tf", "/tf_static", "/map", "/scan"];
    for (topic, time_s) in topics.iter().flat_map(|topic| [0.0, 1.0, 2e9, 4.29e9].map(|time_s| (*topic, time_s))) {
        for nth in [0, 5] {
            let bag = spoiled(folder.path(), Drive::default(), |messages| {
                let mut of_topic = messages.iter_mut().filter(|message| message.topic == topic);
                if let Some(message) = of_topic.nth(nth) {
                    message.time_s = time_s;
                }
            });
            is_whole(&bag, &[]);
            is_whole(&bag, &["--map-from-scans"]);
            let (code, taken, said) = mapped(&bag, &[]);
            assert!(code == 0 && taken >= 45, "{topic} {nth} at {time_s}: {said}");
            let duration_s = info(&bag)["duration_s"].as_f64().unwrap();
            assert!((duration_s - DRIVE_S).abs() < 0.2, "{topic} at {time_s}: {duration_s} s");
        }
    }
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        let data = clock_message(nanos(0.0));
        messages.insert(0, Message { topic: "/clock", kind: MessageType::Clock, time_s: 0.0, data });
    });
    is_whole(&bag, &[]);
    assert!(info(&bag)["notes"].to_string().contains("1 messages were recorded at times that cannot be"));
}

#[test]
fn years_between_two_messages_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let years_s = 3e8;
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        messages.extend(Drive { begin_s: BEGIN_S + years_s, ..Drive::default() }.messages());
    });
    // Quick even at the speed of the recording, of which only the end is driven.
    let (run, said) = replayed(&bag, &["--rate", "40"]);
    let (time_s, way_m) = (run["sim_time_s"].as_f64().unwrap(), run["distance_m"].as_f64().unwrap());
    assert!(time_s > years_s && (way_m - 2.0 * WAY_M).abs() < 0.4, "{time_s} s, {way_m} m: {said}");
}

#[test]
fn transforms_that_tf2_ignores_decide_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let sample =
        |parent: &str, child: &str, time_s: f64| TransformSample::planar(time_s, parent, child, &Pose::default());
    for since_s in [0.0, 0.5 * DRIVE_S, DRIVE_S + 0.05] {
        let time_s = BEGIN_S + since_s;
        let strays = [
            sample("base_link", "base_link", time_s),
            sample("odom", "odom", time_s),
            sample("", "base_link", time_s),
            sample("base_link", "", time_s),
            TransformSample { rotation_xyzw: [f64::NAN; 4], ..sample("foo", "base_link", time_s) },
            TransformSample { rotation_xyzw: [0.0; 4], ..sample("foo", "base_link", time_s) },
            TransformSample { translation_m: [f64::INFINITY; 3], ..sample("foo", "odom", time_s) },
            // tf2 takes these as new parents, for the moment.
            sample("foo", "base_link", time_s - 0.001),
            sample("base_link", "map", time_s - 0.001),
        ];
        for stray in &strays {
            let bag = spoiled(folder.path(), Drive::default(), |messages| {
                let at = messages.partition_point(|message| message.time_s < time_s);
                messages.insert(at, tf(time_s, stray));
            });
            let found = info(&bag);
            assert_eq!(found["inputs"]["base_frame"], "base_link", "{stray:?}");
            assert_eq!(found["notes"].as_array().unwrap().len(), 1, "{stray:?} is told of");
            is_whole(&bag, &[]);
            let (code, taken, said) = mapped(&bag, &[]);
            assert!(code == 0 && taken >= 45, "{stray:?}: {said}");
        }
    }
}

#[test]
fn a_limit_that_is_none_makes_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let inf = f64::INFINITY;
    for (range_min, range_max) in [(0.1, inf), (0.1, f64::NAN), (0.1, 0.0), (0.1, 3.4e38), (12.0, 0.1), (f64::NAN, inf)]
    {
        for nothing in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.0, f32::MAX] {
            let drive = Drive { range_min, range_max, nothing, ..Drive::default() };
            let bag = spoiled(folder.path(), drive, |_| {});
            let (code, taken, said) = mapped(&bag, &[]);
            assert!(code == 0 && taken >= 45, "{range_min} {range_max} {nothing}: {said}");
        }
    }
}

#[test]
fn scans_that_tell_nothing_are_said_to() {
    let folder = tempfile::tempdir().unwrap();
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        for message in messages.iter_mut().filter(|message| message.topic == "/scan") {
            let ranges = message.data.len() - 4 - 4 * 360;
            let end = message.data.len() - 4;
            message.data[ranges..end]
                .chunks_exact_mut(4)
                .for_each(|range| range.copy_from_slice(&f32::NAN.to_le_bytes()));
        }
    });
    let (code, _, said) = mapped(&bag, &[]);
    assert!(code == 1 && said.contains("no reading of any scan on /scan tells a distance"), "{said}");
    let (_, said, _) = run(&["bag", "info"], &bag, &[]);
    assert!(said.contains("frontier map build: no, no reading of any scan on /scan tells a distance"), "{said}");
}

#[test]
fn odometry_alone_makes_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        messages.retain(|message| message.topic != "/tf");
        for tick in 0..=(10.0 * DRIVE_S) as u32 {
            let (time_s, x_m) = (BEGIN_S + 0.1 * f64::from(tick), 2.0 + 0.02 * f64::from(tick));
            let pose = Pose::new(x_m, 3.0, 0.0);
            messages.push(tf(time_s, &TransformSample::planar(time_s, "odom", "base_link", &pose)));
        }
        messages.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    });
    assert_eq!(mapped(&bag, &[]).0, 0);
    is_whole(&bag, &["--map-from-scans"]);
    let (code, _, error) = run(&["replay"], &bag, &["--out", folder.path().join("x").to_str().unwrap()]);
    assert!(code == 1 && error.contains("map is not in tf") && error.contains("--map-from-scans"), "{error}");
}

#[test]
fn one_scan_without_a_place_costs_no_other() {
    let folder = tempfile::tempdir().unwrap();
    for begins_at_s in [0.0, 0.05, 3.0] {
        let bag = spoiled(folder.path(), Drive::default(), |messages| {
            messages.retain(|message| message.topic != "/tf" || message.time_s >= BEGIN_S + begins_at_s);
        });
        let lost = if begins_at_s > 0.0 { (begins_at_s / 0.2).ceil() as usize } else { 0 };
        let (code, _, said) = mapped(&bag, &[]);
        assert!(code == 0 && said.contains(&format!("{lost} without a place in tf")), "{begins_at_s}: {said}");
        assert_eq!(said.contains(&format!("{lost} scans in laser were left out: ")), lost > 0, "{said}");
    }
}

#[test]
fn a_lidar_that_is_not_in_tf_is_named_before() {
    let folder = tempfile::tempdir().unwrap();
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        messages.retain(|message| message.topic != "/tf_static");
    });
    let (_, said, _) = run(&["bag", "info"], &bag, &[]);
    assert!(said.contains("frontier map build: no, laser is not in tf") && said.contains("/tf_static"), "{said}");
    let (code, _, error) = mapped(&bag, &[]);
    assert!(code == 1 && error.contains("laser is not in tf") && error.contains("/tf_static"), "{error}");
    is_whole(&bag, &[]);
}

#[test]
fn a_map_without_an_orientation_is_told_by_topic_and_reason() {
    let folder = tempfile::tempdir().unwrap();
    // The orientation of the origin stands before the number of cells and the cells.
    let turned = |value: f64, all: bool| {
        spoiled(folder.path(), Drive::default(), |messages| {
            let maps = messages.iter_mut().filter(|message| message.topic == "/map");
            for message in maps.skip(usize::from(!all)) {
                let end = message.data.len() - (MAP_CELLS.0 * MAP_CELLS.1) as usize - 4;
                message.data[end - 32..end].chunks_exact_mut(8).for_each(|v| v.copy_from_slice(&value.to_le_bytes()));
            }
        })
    };
    let out = folder.path().join("x").to_str().unwrap().to_owned();
    let bag = turned(f64::NAN, true);
    let (code, _, error) = run(&["replay"], &bag, &["--out", &out]);
    assert!(code == 1 && error.contains("11 messages on /map") && error.contains("orientation (NaN"), "{error}");
    let (_, said, _) = run(&["bag", "info"], &bag, &[]);
    assert!(said.contains("frontier replay: no") && said.contains("11 messages on /map are malformed"), "{said}");
    // One map is enough; the others are told of.
    let (_, said) = replayed(&turned(f64::NAN, false), &[]);
    assert!(said.contains("warning: 10 messages on /map could not be used") && said.contains("NaN"), "{said}");
    // Nobody filled it in: no turn.
    is_whole(&turned(0.0, true), &[]);
}

#[test]
fn a_replay_without_a_decision_fails_and_says_what_was_missing() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x").to_str().unwrap().to_owned();
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        // tf ends before the first map.
        messages.retain(|message| match message.topic {
            "/tf" => message.time_s < BEGIN_S + 3.0,
            "/map" => message.time_s > BEGIN_S + 10.0,
            _ => true,
        });
    });
    let (code, _, error) = run(&["replay"], &bag, &["--out", &out]);
    assert!(code == 1 && error.contains("nothing was decided: a map and the robot's pose"), "{error}");
    // What there is, is written; no moment can be shown.
    let is_there = |name: &str| folder.path().join("x").join(name).is_file();
    assert!(is_there("run.json") && is_there("report.html") && !is_there("replay.gif"));
    let bag = spoiled(folder.path(), Drive::default(), |messages| {
        let stale = |time_s: f64| TransformSample::planar(time_s - 30.0, "map", "odom", &Pose::default());
        for message in messages.iter_mut().filter(|message| message.topic == "/tf") {
            let base = TransformSample::planar(message.time_s, "odom", "base_link", &Pose::default());
            let sample = if message.time_s < BEGIN_S + 0.05 { stale(message.time_s) } else { base };
            *message = tf(message.time_s, &sample);
        }
    });
    let (code, _, error) = run(&["replay"], &bag, &["--out", &out]);
    assert!(code == 1 && error.contains("from map to base_link"), "{error}");
}

#[test]
fn one_message_has_no_gap_and_no_rate() {
    let folder = tempfile::tempdir().unwrap();
    let bag = spoiled(folder.path(), Drive::default(), |_| {});
    let found = info(&bag);
    let topics = found["topics"].as_array().unwrap();
    let single = topics.iter().find(|topic| topic["topic"] == "/tf_static").unwrap();
    assert!(["rate_hz", "longest_gap_s", "longest_gap_at_s"].iter().all(|name| single[name].is_null()), "{single}");
    let (_, said, _) = run(&["bag", "info"], &bag, &[]);
    assert!(!said.contains("-1000"), "{said}");
}
