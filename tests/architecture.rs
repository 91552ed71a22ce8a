//! The invariants of ARCHITECTURE.md, checked on the source: which room may use which,
//! and what may not appear where.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Each room with the rooms that it may use.
const ROOMS: &[(&str, &[&[&str]])] = &[
    // Floor 0: data.
    ("range", &[]),
    ("geometry", &[]),
    ("scan", &[&["geometry"]]),
    ("tf", &[&["geometry"]]),
    ("grid", &[&["geometry"]]),
    // Floor 1: algorithms, which do not know each other.
    ("frontier", &[FLOOR_0]),
    ("selection", &[FLOOR_0]),
    ("planning", &[FLOOR_0]),
    ("control", &[FLOOR_0]),
    ("matching", &[FLOOR_0]),
    // Floor 2: the pipeline.
    ("robot", &[FLOOR_0]),
    ("navigation", &[FLOOR_0, &["planning", "control", "robot"]]),
    ("explore", &[FLOOR_0, FLOOR_1, &["robot"]]),
    ("config", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    // Floor 3: the rim, whose rooms do not use each other, but for files.
    ("io", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    ("sim", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    ("report", &[FLOOR_0, FLOOR_1, FLOOR_2, &["io"]]),
    ("bag", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    // Scans become a map by the simulator's mapper.
    ("mapping", &[FLOOR_0, FLOOR_1, FLOOR_2, &["sim"]]),
    // A recording behind the port; where it lacks a map, one is made of its scans.
    ("replay", &[FLOOR_0, FLOOR_1, FLOOR_2, &["bag", "mapping"]]),
    // The nodes: sim_node is the simulator behind ROS.
    ("ros", &[FLOOR_0, FLOOR_1, FLOOR_2, &["io", "sim"]]),
];

const FLOOR_0: &[&str] = &["range", "geometry", "scan", "grid", "tf"];
const FLOOR_1: &[&str] = &["frontier", "selection", "planning", "control", "matching"];
const FLOOR_2: &[&str] = &["robot", "navigation", "explore", "config"];

/// Rooms of floors 0 to 2, in which no clock is read.
const PURE: &[&[&str]] = &[FLOOR_0, FLOOR_1, FLOOR_2];

/// The source files by room, without their comments and tests.
fn sources() -> BTreeMap<String, Vec<(PathBuf, String)>> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut rooms: BTreeMap<String, Vec<(PathBuf, String)>> = BTreeMap::new();
    let mut folders = vec![src.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") {
                let room = path.strip_prefix(&src).unwrap().iter().next().unwrap().to_string_lossy().into_owned();
                let text = code(&std::fs::read_to_string(&path).unwrap());
                rooms.entry(room.trim_end_matches(".rs").to_owned()).or_default().push((path, text));
            }
        }
    }
    rooms
}

/// What is left of a file without comments and without what follows `#[cfg(test)]`.
fn code(text: &str) -> String {
    text.lines()
        .take_while(|line| line.trim() != "#[cfg(test)]")
        .map(|line| line.split("//").next().unwrap_or_default())
        .collect::<Vec<_>>()
        .join("\n")
}

fn is_test(path: &Path) -> bool {
    path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("tests"))
}

#[test]
fn rooms_use_lower_floors_only() {
    let allowed: BTreeMap<&str, Vec<&str>> = ROOMS.iter().map(|(room, may)| (*room, may.concat())).collect();
    let mut wrong = Vec::new();
    for (room, files) in sources() {
        if room == "lib" || room == "bin" {
            continue;
        }
        let allowed = allowed.get(room.as_str()).unwrap_or_else(|| panic!("the room {room} is not in the table"));
        for (path, text) in files.iter().filter(|(path, _)| !is_test(path)) {
            for used in text.split("crate::").skip(1) {
                let used: String = used.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                if used != room && !allowed.contains(&used.as_str()) {
                    wrong.push(format!("{} uses crate::{used}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_belongs_to_one_place_appears_there_alone() {
    let rules: &[(&str, &[&str])] = &[
        ("rosrust", &["ros"]),
        ("clap", &["bin"]),
        ("anyhow", &["bin"]),
        ("std::fs", &["io", "report", "bin"]),
        ("File::", &["io", "report", "bin"]),
    ];
    let mut wrong = Vec::new();
    for (room, files) in sources() {
        for (path, text) in files.iter().filter(|(path, _)| !is_test(path)) {
            for (word, places) in rules {
                if text.contains(word) && !places.contains(&room.as_str()) {
                    wrong.push(format!("{} contains {word}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn the_pipeline_reads_no_clock_and_draws_no_random_number() {
    let forbidden = ["Instant", "SystemTime", "thread::spawn", "rand::", "rand_pcg", "std::env", "println!"];
    let mut wrong = Vec::new();
    for (room, files) in sources() {
        if !PURE.concat().contains(&room.as_str()) {
            continue;
        }
        for (path, text) in files.iter().filter(|(path, _)| !is_test(path)) {
            for word in forbidden {
                if text.contains(word) {
                    wrong.push(format!("{} contains {word}", path.display()));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
