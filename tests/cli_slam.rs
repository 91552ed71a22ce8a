//! `--slam matched`: runs with a SLAM that errs and a stand-in for move_base that fails.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use frontier_explorer::config::Preset;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{GridInfo, OccupancyGrid};
use frontier_explorer::io::{SaveOptions, save_map};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Two rooms of 3.5 m x 3 m with a door of 1 m between them, at 0.05 m.
fn rooms(folder: &Path) -> PathBuf {
    let (width, height) = (160, 70);
    let info = GridInfo::new(width, height, 0.05, Pose::default()).unwrap();
    let mut grid = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    for index in 0..info.len() {
        let cell = info.cell(index);
        let outer = cell.x < 4 || cell.y < 4 || cell.x >= width as i32 - 4 || cell.y >= height as i32 - 4;
        let inner = (78..82).contains(&cell.x) && !(25..47).contains(&cell.y);
        if outer || inner {
            grid.set(cell, OccupancyGrid::OCCUPIED);
        }
    }
    save_map(&folder.join("rooms"), &grid, &SaveOptions::default()).unwrap().yaml
}

/// The run of a preset in the rooms, as run.json holds it up to `wall`.
fn run(folder: &Path, more: &[&str]) -> (String, Value) {
    let (world, out) = (rooms(folder), folder.join("out"));
    let mut command = Command::new(env!("CARGO_BIN_EXE_frontier"));
    command.arg("explore").arg(world).args(["--start", "2.0,1.7", "--time-limit", "600", "--quiet", "--out"]).arg(&out);
    command.args(more).output().unwrap();
    let text = std::fs::read_to_string(out.join("run.json")).unwrap();
    let run = serde_json::from_str(&text).unwrap();
    (text[..text.rfind("\"wall\"").unwrap()].to_owned(), run)
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_seed_others() {
    let folder = tempfile::tempdir().unwrap();
    let matched = |seed: &str| run(folder.path(), &["--slam", "matched", "--seed", seed]);
    let (first, record) = matched("3");
    assert_eq!(record["slam"], "matched");
    assert_eq!(first, matched("3").0);
    assert_ne!(first, matched("4").0);
    assert!(run(folder.path(), &[]).1.get("slam").is_none(), "of the perfect one nothing is said");
}

#[test]
fn every_preset_gets_to_know_the_rooms() {
    for preset in Preset::names() {
        let folder = tempfile::tempdir().unwrap();
        let (_, record) = run(folder.path(), &["--slam", "matched", "--config", preset]);
        let coverage = record["coverage"].as_f64().unwrap();
        assert!(coverage >= 0.97, "{preset}: {coverage} of the rooms, {}", record["end_message"]);
        assert!(record["goals_sent"].as_u64().unwrap() > 0, "{preset}");
    }
}

/// What is left of the exploration is decided by a map that came after the last motion, and
/// no such map may come: a run in which all is known may then wait up to its time limit.
#[test]
fn every_preset_ends_by_itself() {
    for preset in Preset::names() {
        for seed in ["1", "2", "3"] {
            let folder = tempfile::tempdir().unwrap();
            let (_, record) = run(folder.path(), &["--slam", "matched", "--config", preset, "--seed", seed]);
            assert_ne!(record["end_reason"], "time_limit", "{preset} with seed {seed}: {}", record["coverage"]);
        }
    }
}

#[test]
fn a_comparison_says_which_slam_it_had() {
    let folder = tempfile::tempdir().unwrap();
    let world = rooms(folder.path());
    let json = folder.path().join("all.json");
    let compare = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frontier"));
        command.args(["compare", "--quiet", "--presets", "wfd", "--time-limit", "60", "--worlds"]).arg(&world);
        command.args(["--starts", "auto:1", "--json"]).arg(&json).args(more).assert().success();
        let file: Value = serde_json::from_slice(&std::fs::read(&json).unwrap()).unwrap();
        file["plan"]["slam"].clone()
    };
    assert_eq!(compare(&["--slam", "matched"]), "matched");
    assert_eq!(compare(&[]), Value::Null);
}

#[test]
fn a_slam_that_is_none_is_named_with_what_there_is() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frontier"));
    let output = command.args(["explore", "--slam", "true"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("must be perfect or matched"));
}
