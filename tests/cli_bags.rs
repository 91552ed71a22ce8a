//! Bags as a user meets them: a simulated run is recorded, looked into, replayed and mapped.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn frontier() -> Command {
    Command::new(env!("CARGO_BIN_EXE_frontier"))
}

fn sample(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("bags").join(name)
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

/// Records two minutes of the office.
fn recorded(folder: &Path, preset: &str) -> PathBuf {
    let bag = folder.join("run.bag");
    let mut command = frontier();
    command.args(["explore", "office", "--time-limit", "120", "--quiet", "--config", preset, "--bag"]).arg(&bag);
    // Two minutes are not enough: it ends incomplete.
    command.arg("--out").arg(folder.join("run")).assert().code(3);
    bag
}

fn replay(bag: &Path, out: &Path, more: &[&str]) -> String {
    let output = frontier().arg("replay").arg(bag).arg("--out").arg(out).args(more).assert().success();
    String::from_utf8(output.get_output().stdout.clone()).unwrap()
}

#[test]
fn a_replay_of_our_own_run_decides_the_same() {
    for preset in ["wfd", "explore_lite", "liang"] {
        let folder = tempfile::tempdir().unwrap();
        let bag = recorded(folder.path(), preset);
        let out = folder.path().join("replay");
        let said = replay(&bag, &out, &["--config", preset]);
        let comparison = json(&out.join("comparison.json"));
        let (all, same) = (comparison["decisions"].as_u64().unwrap(), comparison["agreeing"].as_u64().unwrap());
        assert!(all >= 5 && 20 * same >= 19 * all, "{preset}: {said}");
        let causes = comparison["causes"].as_object().unwrap();
        assert_eq!(causes.values().map(|n| n.as_u64().unwrap()).sum::<u64>(), all - same, "each has a cause");
        // The same preset saw the same map grow.
        let (run, again) = (json(&folder.path().join("run/run.json")), json(&out.join("run.json")));
        let area = |run: &Value| run["known_area_m2"].as_f64().unwrap();
        assert!((area(&run) - area(&again)).abs() < 0.02 * area(&run), "{} {}", area(&run), area(&again));
        for file in ["report.html", "map.pgm", "map.yaml", "map.png", "replay.gif"] {
            assert!(out.join(file).is_file(), "{file}");
        }
    }
}

#[test]
fn another_preset_parts_from_the_recording_and_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let bag = recorded(folder.path(), "wfd");
    let out = folder.path().join("replay");
    let said = replay(&bag, &out, &["--config", "liang_max_gain"]);
    let comparison = json(&out.join("comparison.json"));
    let partings = comparison["partings"].as_array().unwrap();
    assert!(!partings.is_empty(), "{said}");
    let is_told = |parting: &Value| {
        let cause = parting["cause"].as_str().unwrap();
        !cause.is_empty() && parting["time_s"].as_f64().unwrap() <= 121.0 && said.contains(cause)
    };
    assert!(partings.iter().all(is_told), "{partings:?}\n{said}");
    // The recording's goals are there, with their ends.
    let goals = comparison["recorded_goals"].as_array().unwrap();
    assert!(goals.iter().filter(|goal| goal["end"][1] == "reached").count() >= 3, "{goals:?}");
}

#[test]
fn a_bag_without_a_map_gets_one() {
    let folder = tempfile::tempdir().unwrap();
    let bag = recorded(folder.path(), "liang");
    let recorded_out = folder.path().join("recorded");
    replay(&bag, &recorded_out, &["--config", "liang"]);
    let made_out = folder.path().join("made");
    let out_bag = folder.path().join("made.bag");
    let out_bag_text = out_bag.to_str().unwrap();
    let said = replay(&bag, &made_out, &["--config", "liang", "--map-from-scans", "--out-bag", out_bag_text]);
    assert!(said.contains("with a map made of the scans on /scan") && said.contains("scans taken in"), "{said}");
    // Odometry is exact here, so that the map made of the scans is the recorded one, shifted.
    let area = |out: &Path| json(&out.join("run.json"))["free_area_m2"].as_f64().unwrap();
    let (made, known) = (area(&made_out), area(&recorded_out));
    assert!((made - known).abs() < 0.05 * known, "{made} m2 made, {known} m2 recorded");
    // The bag that was written can be replayed in its turn, now with a map.
    let again = replay(&out_bag, &folder.path().join("again"), &["--config", "liang", "--map-frame", "frontier_map"]);
    assert!(again.contains("with the map on /map and the robot as base_footprint in frontier_map"), "{again}");
}

#[test]
fn info_tells_what_a_bag_holds() {
    let output = frontier().args(["bag", "info", "--json"]).arg(sample("office.bag")).assert().success();
    let info: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    let topics: Vec<&str> = info["topics"].as_array().unwrap().iter().map(|t| t["topic"].as_str().unwrap()).collect();
    assert!(topics.contains(&"/map") && topics.contains(&"/move_base/result"), "{topics:?}");
    assert_eq!(info["inputs"]["results_topic"], "/move_base/result");
    assert_eq!(info["inputs"]["base_frame"], "base_footprint");
    let said = frontier().args(["bag", "info"]).arg(sample("office_scans.bag")).assert().success();
    let said = String::from_utf8_lossy(&said.get_output().stdout).into_owned();
    for part in ["/scan*", "sensor_msgs/LaserScan", "frontier replay: yes, with a map made of the scans", "  odom"] {
        assert!(said.contains(part), "{part}: {said}");
    }
}

#[test]
fn the_samples_are_replayed() {
    let folder = tempfile::tempdir().unwrap();
    let config = ["--config", "explore_lite", "--robot", "turtlebot3_burger", "--until", "60"];
    let said = replay(&sample("office.bag"), &folder.path().join("a"), &[&config[..], &["--at", "30"]].concat());
    assert!(said.contains("decisions, ") && said.contains("at_30.png"), "{said}");
    let said = replay(&sample("office_scans.bag"), &folder.path().join("b"), &config);
    assert!(said.contains("recording_ended") && said.contains("holds no goals"), "{said}");
}

#[test]
fn scans_become_a_map() {
    let folder = tempfile::tempdir().unwrap();
    let map = folder.path().join("map");
    frontier().args(["map", "build"]).arg(sample("office_scans.bag")).arg("-o").arg(&map).assert().success();
    let output = frontier().args(["map", "info", "--json"]).arg(map.with_extension("yaml")).assert().success();
    let info: Value = serde_json::from_slice(&output.get_output().stdout).unwrap();
    assert!(info.to_string().contains("0.05"), "{info}");
    assert!(folder.path().join("map.way.png").is_file());
}

#[test]
fn what_is_no_bag_or_a_poor_one_gets_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], path: &Path, part: &str| {
        let output = frontier().args(args).arg(path).arg("--out").arg(folder.path().join("x")).assert().code(1);
        let said = String::from_utf8_lossy(&output.get_output().stderr).into_owned();
        assert!(said.contains(part) && said.lines().count() == 1, "{said}");
    };
    let put = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    refused(&["replay"], &folder.path().join("none.bag"), "cannot read");
    refused(&["replay"], folder.path(), "is no file");
    refused(&["replay"], &put("a.bag", b"not a bag at all"), "this is no ROS 1 bag");
    refused(&["replay"], &put("b.bag", b"#ROSBAG V1.2\nwhatever it holds"), "this is a bag of format 1.2");
    refused(&["replay"], &put("c.bag", b"#ROSBAG V2.0\n"), "there is neither a map nor a scan");
    let office = sample("office.bag");
    refused(&["replay", "--map-topic", "/nothing"], &office, "no nav_msgs/OccupancyGrid on /nothing: it has /map");
    refused(&["replay", "--pose-frame", "nobody"], &office, "no frame nobody");
    // Cut in the middle, it is read as far as it goes.
    let bytes = std::fs::read(&office).unwrap();
    let cut = put("cut.bag", &bytes[..bytes.len() / 2]);
    let said = replay(&cut, &folder.path().join("cut"), &["--until", "30"]);
    assert!(said.contains("warning: ") && said.contains("messages are read, up to"), "{said}");
}
