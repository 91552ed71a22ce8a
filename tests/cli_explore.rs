//! `frontier explore` and `frontier detect` as a user runs them.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use frontier_explorer::config::Preset;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{GridInfo, OccupancyGrid};
use frontier_explorer::io::{SaveOptions, load_map, save_map};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

fn frontier() -> Command {
    Command::new(env!("CARGO_BIN_EXE_frontier"))
}

/// Three rooms of 3 m side by side with doors of 1 m between them, at 0.1 m.
fn rooms(folder: &Path) -> PathBuf {
    let (width, height) = (96, 34);
    let info = GridInfo::new(width, height, 0.1, Pose::new(-1.0, -1.0, 0.0)).unwrap();
    let mut grid = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    for index in 0..info.len() {
        let cell = info.cell(index);
        let outer = cell.x < 2 || cell.y < 2 || cell.x >= width as i32 - 2 || cell.y >= height as i32 - 2;
        let inner = matches!(cell.x, 32 | 33 | 63 | 64) && !(12..22).contains(&cell.y);
        if outer || inner {
            grid.set(cell, OccupancyGrid::OCCUPIED);
        }
    }
    save_map(&folder.join("rooms"), &grid, &SaveOptions::default()).unwrap().yaml
}

fn explore(world: &Path, out: &Path, more: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = frontier();
    command.arg("explore").arg(world).args(["--start", "0.5,0.5", "--quiet", "--out"]).arg(out).args(more);
    command.assert()
}

fn run_json(out: &Path) -> Value {
    serde_json::from_slice(&std::fs::read(out.join("run.json")).unwrap()).unwrap()
}

#[test]
fn a_world_goes_in_and_its_map_comes_out() {
    let folder = tempfile::tempdir().unwrap();
    let (world, out) = (rooms(folder.path()), folder.path().join("out"));
    explore(&world, &out, &["--config", "wfd", "--lidar-noise", "0"]).success().stdout("");
    let run = run_json(&out);
    assert_eq!(run["end_reason"], "complete");
    assert_eq!(run["collisions"], 0);
    assert!(run["coverage"].as_f64().unwrap() >= 0.99, "{}", run["coverage"]);
    // Topiwala 2018: a full turn at the start and at every goal reached.
    let counts = &run["counts"];
    assert!(counts["turns"].as_u64().unwrap() > counts["goals_reached"].as_u64().unwrap());
    assert!(run["decisions"].as_array().unwrap().iter().any(|d| !d["goal"].is_null()));

    let (truth, map) = (load_map(&world).unwrap().grid, load_map(&out.join("map.yaml")).unwrap().grid);
    let mut known = 0;
    for (index, &value) in map.data().iter().enumerate().filter(|(_, v)| **v != OccupancyGrid::UNKNOWN) {
        let point = map.info().center(map.info().cell(index));
        assert_eq!(Some(value), truth.get(truth.info().cell_at(point)), "{point}");
        known += 1;
    }
    assert!(known > 2500, "{known}");
    for file in ["map.png", "exploration.gif", "report.html"] {
        assert!(std::fs::metadata(out.join(file)).unwrap().len() > 1000, "{file}");
    }
    let html = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(!html.contains("src=\"http") && !html.contains("href=\"http"), "the report needs nothing beside it");
}

/// The robot keeps to the first room and to the western end of the second.
#[test]
fn areas_in_a_preset_hold_the_robot() {
    let folder = tempfile::tempdir().unwrap();
    let (world, out, preset) = (rooms(folder.path()), folder.path().join("out"), folder.path().join("areas.yaml"));
    let areas = "preset: areas\nexplorer:\n  region: [[-1, -1], [5.4, -1], [5.4, 2.4], [-1, 2.4]]\n  no_go: [[[4.0, -1], \
                 [5.0, -1], [5.0, 2.4], [4.0, 2.4]]]\n";
    std::fs::write(&preset, areas).unwrap();
    explore(&world, &out, &["--config", preset.to_str().unwrap()]).success();
    let run = run_json(&out);
    assert_eq!(run["end_reason"], "outside_region", "{}", run["end_message"]);
    assert!(run["end_message"].as_str().unwrap().contains("no-go areas"), "{}", run["end_message"]);
    let decisions = run["decisions"].as_array().unwrap();
    let x = |place: &Value| place["x"].as_f64();
    assert!(decisions.iter().filter_map(|d| x(&d["goal"])).all(|x| x < 4.0), "{decisions:?}");
    assert!(decisions.iter().filter_map(|d| x(&d["pose"])).all(|x| x < 4.0));
    assert!(x(&decisions[decisions.len() - 1]["pose"]).unwrap() > 2.0, "it entered the second room");
}

#[test]
fn the_same_seed_gives_the_same_bytes_but_for_wall() {
    let folder = tempfile::tempdir().unwrap();
    let world = rooms(folder.path());
    let noisy = ["--seed", "7", "--lidar-noise", "0.01"];
    let run = |name: &str, more: &[&str]| {
        let out = folder.path().join(name);
        explore(&world, &out, more).success();
        let json = std::fs::read_to_string(out.join("run.json")).unwrap();
        let (run, _) = json.split_once("\"wall\"").unwrap();
        (run.to_owned(), std::fs::read(out.join("exploration.gif")).unwrap())
    };
    assert_eq!(run("a", &noisy), run("b", &noisy));
    assert_ne!(run("a", &noisy).0, run("c", &["--seed", "8", "--lidar-noise", "0.01"]).0);
}

#[test]
fn every_preset_repeats_itself_from_the_same_seed() {
    let folder = tempfile::tempdir().unwrap();
    let world = rooms(folder.path());
    for preset in Preset::names() {
        let run = |name: &str, seed: &str| {
            let out = folder.path().join(format!("{preset}-{name}"));
            explore(&world, &out, &["--config", preset, "--seed", seed, "--lidar-noise", "0.01"]).success();
            let json = std::fs::read_to_string(out.join("run.json")).unwrap();
            assert!(json.contains("\"end_reason\": \"complete\""), "{preset}");
            let (run, _) = json.split_once("\"wall\"").unwrap();
            (run.to_owned(), std::fs::read(out.join("map.pgm")).unwrap())
        };
        let first = run("a", "7");
        assert!(first == run("b", "7"), "{preset}: two runs from one seed differ");
        assert!(first.0 != run("c", "8").0, "{preset}: two seeds give one run");
    }
}

#[test]
fn interrupting_saves_what_is_there_and_exits_with_3() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let warehouse = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/warehouse.yaml");
    let mut child = Process::new(env!("CARGO_BIN_EXE_frontier"))
        .arg("explore")
        .arg(warehouse)
        .arg("--out")
        .arg(&out)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let began = Instant::now();
    // The folder is made right before the run begins.
    while !out.exists() && began.elapsed() < Duration::from_secs(30) {
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(300));
    assert!(Process::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(3));
    assert_eq!(run_json(&out)["end_reason"], "interrupted");
    assert!(load_map(&out.join("map.yaml")).is_ok());
}

#[test]
fn limits_of_time_end_incomplete() {
    let folder = tempfile::tempdir().unwrap();
    let (world, out) = (rooms(folder.path()), folder.path().join("out"));
    explore(&world, &out, &["--time-limit", "12"]).code(3);
    let run = run_json(&out);
    assert_eq!(run["end_reason"], "time_limit");
    assert!((12.0..13.0).contains(&run["sim_time_s"].as_f64().unwrap()));
}

#[test]
fn the_way_back_leads_to_the_start() {
    let folder = tempfile::tempdir().unwrap();
    let (world, out) = (rooms(folder.path()), folder.path().join("out"));
    explore(&world, &out, &["--return-to-start", "--map-style", "cartographer"]).success();
    let there = run_json(&out);
    explore(&world, &out, &["--map-style", "cartographer"]).success();
    let here = run_json(&out);
    assert_eq!((&there["end_reason"], &here["end_reason"]), (&"complete".into(), &"complete".into()));
    assert!(there["distance_m"].as_f64() > here["distance_m"].as_f64());
}

#[test]
fn bad_input_is_answered_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let world = rooms(folder.path());
    let world = world.to_str().unwrap();
    let preset = folder.path().join("bad.yaml");
    std::fs::write(&preset, "explorer: {detector: {min_size_m: -1}}").unwrap();
    let preset = preset.to_str().unwrap();
    let cases: &[(&[&str], i32, &str)] = &[
        (&["explore", "nowhere.yaml"], 1, "nowhere.yaml"),
        (&["explore", world, "--start", "0.5"], 2, "must be X,Y or X,Y,YAW"),
        (&["explore", world, "--start", "99,99"], 1, "outside"),
        (&["explore", world, "--start", "-0.95,-0.95"], 1, "to the nearest solid cell: the robot needs more than"),
        (&["explore", world, "--config", "wdf"], 1, "there is no preset \"wdf\": must be one of"),
        (&["explore", world, "--config", preset], 1, "explorer.detector.min_size_m is -1: must be finite and >= 0"),
        (&["explore", world, "--robot", "roomba"], 1, "turtlebot2"),
        (&["explore", world, "--lidar-range", "0"], 2, "must be a number of metres > 0"),
        (&["explore", world, "--time-limit", "nan"], 2, "must be a number of seconds > 0"),
        (&["detect", world, "--at", "99,99"], 1, "outside the map"),
        (&["detect", world, "--at", "0,0", "--neighbours", "6"], 2, "must be 4 or 8"),
        (&["detect", world, "--at", "0,0", "--min-size", "-1"], 2, "unexpected argument '-1'"),
        (&["detect", world, "--at", "0,0", "--min-size=-1"], 1, "must be finite and >= 0"),
    ];
    for (args, code, expected) in cases {
        let output = frontier().args(*args).current_dir(folder.path()).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(*code), "{args:?}: {stderr}");
        assert!(stderr.contains(expected), "{args:?}: {stderr}");
        assert!(!stderr.contains("panicked"), "{stderr}");
        if *code == 1 {
            assert_eq!(stderr.trim_end().lines().count(), 1, "{stderr}");
        }
    }
}

#[test]
fn detect_prints_a_table_json_and_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut grid = OccupancyGrid::from_ascii("?????\n?...?\n?...?\n?????").unwrap();
    grid.set(frontier_explorer::grid::Cell::new(1, 0), OccupancyGrid::OCCUPIED);
    let map = save_map(&folder.path().join("map"), &grid, &SaveOptions::default()).unwrap().yaml;
    let map = map.to_str().unwrap();
    let picture = folder.path().join("overlay.png");
    frontier()
        .args(["detect", map, "--at", "2.5,1.5", "--overlay", picture.to_str().unwrap(), "--theme", "paper"])
        .assert()
        .success()
        .stdout(predicates::str::contains("1 frontiers, nearest first (bitplane, reachability walls_block)"));
    assert!(std::fs::read(&picture).unwrap().starts_with(&[0x89, b'P', b'N', b'G']));

    let output = frontier().args(["detect", map, "--at", "2.5,1.5", "--json", "--neighbours", "4"]).output().unwrap();
    let found: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["detector"], "bitplane");
    assert_eq!(found["reachability"], "walls_block");
    assert_eq!(found["grid"]["width"], 5);
    // With sides alone the rim falls apart at its corners; one frontier is too small.
    let frontiers = found["frontiers"].as_array().unwrap();
    assert!(frontiers.iter().all(|f| f["size_m"] == f["size_cells"].as_f64().unwrap()));
    let distances: Vec<f64> = frontiers.iter().map(|f| f["distance_m"].as_f64().unwrap()).collect();
    assert!(distances.windows(2).all(|pair| pair[0] <= pair[1]), "{distances:?}");
    assert_eq!(frontiers.len(), 4);
}

#[test]
fn print_config_shows_every_setting_and_can_be_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let output = frontier().args(["explore", "--print-config"]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    for key in ["progress_timeout_s", "max_failures", "lookahead_m", "min_size_m"] {
        assert!(text.contains(key), "{key} is missing:\n{text}");
    }
    let file = folder.path().join("mine.yaml");
    std::fs::write(&file, &text).unwrap();
    let again = frontier().args(["explore", "--print-config", "--config"]).arg(&file).output().unwrap();
    assert_eq!(String::from_utf8(again.stdout).unwrap(), text);
}

/// What a preset does not take for free is not counted as free: here no cell ever is, as the
/// mapper is never surer than 12 %.
#[test]
fn free_area_is_counted_by_the_presets_thresholds() {
    let folder = tempfile::tempdir().unwrap();
    let (world, config) = (rooms(folder.path()), folder.path().join("strict.yaml"));
    for (free_max, has_free) in [(5, false), (65, true)] {
        let yaml =
            format!("preset: strict\nexplorer:\n  thresholds:\n    free_max: {free_max}\n    occupied_min: 66\n");
        std::fs::write(&config, yaml).unwrap();
        let (out, config) = (folder.path().join(free_max.to_string()), config.to_str().unwrap());
        explore(&world, &out, &["--config", config, "--map-style", "cartographer", "--time-limit", "2"]).code(3);
        let run = run_json(&out);
        assert!(run["known_area_m2"].as_f64().unwrap() > 1.0, "{}", run["known_area_m2"]);
        assert_eq!(run["free_area_m2"].as_f64().unwrap() > 1.0, has_free, "{}", run["free_area_m2"]);
    }
}
