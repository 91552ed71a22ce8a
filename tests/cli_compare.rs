//! `frontier compare` as a user runs it.

#![allow(clippy::unwrap_used)]

use assert_cmd::Command;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{GridInfo, OccupancyGrid};
use frontier_explorer::io::{SaveOptions, save_map};
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command as Process, Stdio};
use tempfile::TempDir;

fn frontier(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frontier"));
    command.current_dir(folder);
    command
}

/// Two rooms of 2.5 m with a door of 1 m between them, at 0.1 m.
fn save_rooms(folder: &Path) {
    let (width, height) = (56, 30);
    let info = GridInfo::new(width, height, 0.1, Pose::new(-1.0, -1.0, 0.0)).unwrap();
    let mut grid = OccupancyGrid::filled(info, OccupancyGrid::FREE);
    for index in 0..info.len() {
        let cell = info.cell(index);
        let outer = cell.x < 2 || cell.y < 2 || cell.x >= width as i32 - 2 || cell.y >= height as i32 - 2;
        let inner = matches!(cell.x, 27 | 28) && !(10..20).contains(&cell.y);
        if outer || inner {
            grid.set(cell, OccupancyGrid::OCCUPIED);
        }
    }
    save_map(&folder.join("rooms"), &grid, &SaveOptions::default()).unwrap();
}

/// A folder with a world, two starts in it and two presets.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    save_rooms(folder.path());
    for (name, text) in [
        ("starts.csv", "map,x_m,y_m\nrooms,0.2,0.2\nrooms,3.5,0.5\nelsewhere,1,1\n"),
        ("plain.yaml", "explorer: {}"),
        ("large.yaml", "explorer: {detector: {min_size_m: 0.4}}"),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

const SMALL: [&str; 7] = [
    "compare",
    "--quiet",
    "--presets",
    "plain.yaml,large.yaml",
    "--worlds=rooms.yaml",
    "--starts=starts.csv",
    "--seeds=1,2",
];

fn compare(folder: &Path, more: &[&str]) {
    frontier(folder).args(SMALL).args(more).assert().success().stdout("");
}

/// A file without what the computer took.
fn without_wall(folder: &Path, name: &str) -> String {
    let text = std::fs::read_to_string(folder.join(name)).unwrap();
    text.split_once("\n  \"wall\"").unwrap().0.to_owned()
}

#[test]
fn all_combinations_are_made_and_parts_merge_to_the_whole() {
    let folder = folder();
    let path = folder.path();
    compare(path, &["--json=all.json", "--csv=all.csv", "--html=all.html", "--jobs=2"]);
    compare(path, &["--json=1.json", "--shard=1/2", "--jobs=1"]);
    compare(path, &["--json=2.json", "--shard=2/2", "--jobs=3"]);
    let merge = ["compare", "--quiet", "--json=merged.json", "--csv=merged.csv", "--merge", "2.json", "1.json"];
    frontier(path).args(merge).assert().success();
    assert_eq!(without_wall(path, "all.json"), without_wall(path, "merged.json"));

    let all: Value = serde_json::from_slice(&std::fs::read(path.join("all.json")).unwrap()).unwrap();
    assert_eq!(all["schema_version"], 1);
    let runs = all["runs"].as_array().unwrap();
    assert_eq!((runs.len(), all["wall"].as_array().unwrap().len()), (8, 8));
    assert!(runs.iter().all(|run| run["end_reason"] == "complete"), "{runs:?}");
    assert_eq!((&runs[0]["preset"], &runs[1]["preset"]), (&json!("plain"), &json!("large")));
    assert_eq!(all["summaries"][0]["measures"]["t50"]["reached"], 4);
    assert_eq!(all["plan"]["presets"][1]["settings"]["explorer"]["detector"]["min_size_m"], 0.4);

    let csv = std::fs::read_to_string(path.join("all.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines.len(), 9);
    let columns = "run,preset,world,start,start_x_m,start_y_m,seed,end_reason,succeeded,coverage,sim_time_s,distance_m,\
                   goals_sent,goals_failed,collisions,t50_s,t80_s,t90_s,t95_s,t99_s,d50_m,d80_m,d90_m,d95_m,d99_m,\
                   decision_median_ms,decision_max_ms,wall_s";
    assert_eq!(lines[0], columns);
    assert!(lines.iter().all(|line| line.split(',').count() == 28));
    assert!(lines[1].starts_with("0,plain,rooms,1,0.2,0.2,1,complete,"), "{}", lines[1]);
    assert_eq!(std::fs::read_to_string(path.join("merged.csv")).unwrap().lines().count(), 9);

    let html = std::fs::read_to_string(path.join("all.html")).unwrap();
    assert!(html.contains("8 of 8 runs") && !html.contains("src=\"http") && !html.contains("href=\"http"));
}

#[test]
fn the_oracle_stands_beside_the_presets_and_measures_them() {
    let folder = folder();
    let path = folder.path();
    let small = ["compare", "--presets=plain.yaml", "--worlds=rooms.yaml", "--starts=starts.csv", "--oracle"];
    let output =
        frontier(path).args(small).args(["--json=all.json", "--csv=all.csv", "--html=all.html"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.contains("T99/oracle's") && stdout.contains(" oracle "), "{stdout}");
    for part in ["1/2", "2/2"] {
        let json = format!("--json={}.json", &part[..1]);
        frontier(path).args(small).args(["--quiet", "--shard", part, json.as_str()]).assert().success();
    }
    let merge = ["compare", "--quiet", "--json=merged.json", "--merge", "1.json", "2.json"];
    frontier(path).args(merge).assert().success();
    assert_eq!(without_wall(path, "all.json"), without_wall(path, "merged.json"));

    let all: Value = serde_json::from_slice(&std::fs::read(path.join("all.json")).unwrap()).unwrap();
    assert_eq!(all["plan"]["presets"][1]["is_oracle"], true);
    let runs = all["runs"].as_array().unwrap();
    let presets: Vec<&Value> = runs.iter().map(|run| &run["preset"]).collect();
    assert_eq!(presets, ["plain", "oracle", "plain", "oracle"]);
    for pair in runs.chunks(2) {
        let time_s = |run: &Value| run["time_to_coverage_s"]["0.99"].as_f64().unwrap();
        assert!(pair[1]["end_reason"] == "complete" && time_s(&pair[1]) <= time_s(&pair[0]), "{pair:?}");
        assert_eq!(pair[1]["sim_time_s"], pair[1]["time_to_coverage_s"]["0.99"]);
    }
    let ratio = &all["summaries"][0]["t99_to_oracle"];
    assert!(ratio["median"].as_f64().unwrap() >= 1.0 && ratio["of"] == 2, "{ratio}");
    assert!(std::fs::read_to_string(path.join("all.html")).unwrap().contains("oracle's"));
    assert_eq!(std::fs::read_to_string(path.join("all.csv")).unwrap().matches(",oracle,rooms,").count(), 2);

    // Neither is a part with an oracle one of a comparison without, nor may a preset have its name.
    compare(path, &["--json=plain.json", "--shard=1/8"]);
    let other = frontier(path).args(["compare", "--merge", "plain.json", "1.json"]).output().unwrap();
    assert!(String::from_utf8_lossy(&other.stderr).contains("presets are not those of the first part"));
    std::fs::write(path.join("oracle.yaml"), "explorer: {}").unwrap();
    let twice = frontier(path).args(["compare", "--presets=oracle.yaml", "--worlds=rooms.yaml", "--oracle"]).output();
    assert!(String::from_utf8_lossy(&twice.unwrap().stderr).contains("two presets with the name \"oracle\""));
}

#[test]
fn a_part_alone_is_printed_and_known_to_be_incomplete() {
    let folder = folder();
    let path = folder.path();
    compare(path, &["--json=1.json", "--shard=1/8"]);
    let output = frontier(path).args(["compare", "--merge", "1.json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(stdout.contains("preset") && stdout.contains("T99 (s)") && stdout.contains("plain"), "{stdout}");
    assert!(stdout.ends_with("7 of 8 runs were not made\n"), "{stdout}");
}

#[test]
fn runs_that_take_too_long_are_failures_and_stay_in_the_table() {
    let folder = folder();
    let args = ["compare", "--presets=plain.yaml", "--worlds=rooms.yaml", "--starts=auto:2", "--time-limit=5"];
    let output = frontier(folder.path()).args(args).args(["--json", "all.json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let all: Value = serde_json::from_slice(&std::fs::read(folder.path().join("all.json")).unwrap()).unwrap();
    assert_eq!((&all["summaries"][0]["runs"], &all["summaries"][0]["failed"]), (&json!(2), &json!(2)));
    assert_eq!(all["summaries"][0]["measures"]["tend"]["median"], Value::Null);
    assert_eq!(all["runs"][1]["end_reason"], "time_limit");
    assert!(String::from_utf8(output.stdout).unwrap().contains("0/2"));
    // Without a terminal every run is a line.
    assert_eq!(String::from_utf8(output.stderr).unwrap().lines().count(), 2);
}

#[test]
fn interrupting_keeps_the_runs_that_are_done_and_exits_with_3() {
    let folder = folder();
    let seeds: Vec<String> = (1..=500).map(|seed| seed.to_string()).collect();
    let mut child = Process::new(env!("CARGO_BIN_EXE_frontier"))
        .current_dir(folder.path())
        .args(["compare", "--presets=plain.yaml", "--worlds=rooms.yaml", "--json=some.json", "--jobs=1", "--seeds"])
        .arg(seeds.join(","))
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A line is written for every run that is done.
    let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
    lines.next().unwrap().unwrap();
    assert!(Process::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    lines.for_each(drop);
    assert_eq!(child.wait().unwrap().code(), Some(3));
    let some: Value = serde_json::from_slice(&std::fs::read(folder.path().join("some.json")).unwrap()).unwrap();
    let runs = some["runs"].as_array().unwrap();
    assert!((1..500).contains(&runs.len()), "{}", runs.len());
    assert!(runs.iter().all(|run| run["end_reason"] == "complete"));
}

/// The results of runs that were never made.
fn synthetic(end_s: &[(&str, f64)]) -> Value {
    let picture = json!({"png_base64": "", "width_px": 1, "height_px": 1, "left_m": 0, "top_m": 0, "m_per_px": 1});
    let start = json!({"x": 1.0, "y": 1.0, "yaw": 0.0});
    let run = |(index, (preset, end_s)): (usize, &(&str, f64))| {
        let shares =
            json!({"0.50": end_s / 4.0, "0.80": end_s / 3.0, "0.90": end_s / 2.0, "0.95": null, "0.99": end_s - 10.0});
        json!({
            "index": index, "preset": preset, "world": "museum", "start_number": 1, "start": start, "seed": 1,
            "end_reason": "complete", "coverage": 1.0, "sim_time_s": end_s, "distance_m": 1.0,
            "goals_sent": 1, "goals_failed": 0, "collisions": 0, "time_to_coverage_s": shares,
            "distance_to_coverage_m": {}, "coverage_over_time": [[0, 0]], "trajectory": [],
        })
    };
    let presets: Vec<Value> = end_s.iter().map(|(name, _)| json!({"name": name, "settings": {}})).collect();
    let wall = json!({"total_s": 1.0, "decision_ms": {"median": 1.0, "max": 1.0}});
    json!({
        "schema_version": 1,
        "plan": {
            "robot": "robot", "time_limit_s": null, "presets": presets, "seeds": [1],
            "worlds": [{"name": "museum", "starts": [start], "picture": picture}],
        },
        "runs": end_s.iter().enumerate().map(run).collect::<Vec<Value>>(),
        "wall": vec![wall; end_s.len()],
    })
}

#[test]
fn the_table_of_liang_stands_beside_ours() {
    let folder = tempfile::tempdir().unwrap();
    let print = |end_s: &[(&str, f64)]| {
        std::fs::write(folder.path().join("a.json"), synthetic(end_s).to_string()).unwrap();
        let output =
            frontier(folder.path()).args(["compare", "--merge", "a.json", "--html", "a.html"]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let same = print(&[("liang", 290.0), ("liang_closest", 430.0), ("liang_max_gain", 510.0), ("wfd", 100.0)]);
    let row = |method: &str| {
        let line = same.lines().find(|line| line.trim_start().starts_with(method)).unwrap();
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("closest frontier")[2..], ["liang_closest", "431", "430", "420"]);
    assert_eq!(row("maximum gain")[2..], ["liang_max_gain", "515", "510", "500"]);
    assert_eq!(row("proposed")[1..], ["liang", "292", "290", "280"]);
    assert!(same.contains("holds for our median Tend and holds for our median T99."), "{same}");
    assert!(std::fs::read_to_string(folder.path().join("a.html")).unwrap().contains("Table 1 of Liang"));
    let other = print(&[("liang", 500.0), ("liang_closest", 430.0), ("liang_max_gain", 510.0)]);
    assert!(other.contains("does not hold for our median Tend"), "{other}");
    let without = print(&[("liang", 500.0), ("liang_closest", 430.0)]);
    assert!(!without.contains("Liang, Wang, Li"), "{without}");
}

#[test]
fn presets_are_measured_by_one_of_them() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("a.json"), synthetic(&[("a", 110.0), ("b", 210.0)]).to_string()).unwrap();
    let print = |name: &str| {
        let args = ["compare", "--merge", "a.json", "--against", name];
        frontier(folder.path()).args(args).output().unwrap()
    };
    let told = String::from_utf8(print("b").stdout).unwrap();
    let table = told.split("Measured by b:").nth(1).unwrap();
    let row = |preset: &str| {
        let line = table.lines().find(|line| line.trim_start().starts_with(preset)).unwrap();
        line.split_whitespace().map(str::to_owned).collect::<Vec<_>>()
    };
    // T99 of 100 and 200 s; nobody reached 95 % according to this file.
    assert_eq!(row("a ")[1..6], ["0.52", "inf", "0.50", "0.52", "0.50"]);
    assert_eq!((row("a ").last().unwrap().as_str(), row("b ").last().unwrap().as_str()), ("1/1", "0/1"));
    let unknown = print("c");
    let error = String::from_utf8(unknown.stderr).unwrap();
    assert!(unknown.status.code() == Some(1) && error.contains("must be one of a, b"), "{error}");
}

#[test]
fn bad_input_is_answered_in_one_sentence() {
    let folder = folder();
    let path = folder.path();
    for (name, text) in [
        ("outside.csv", "map,x_m,y_m\nrooms,99,99\n"),
        ("broken.csv", "map,x_m,y_m\nrooms,99\n"),
        ("none.json", "{}"),
        ("future.json", r#"{"schema_version": 9}"#),
    ] {
        std::fs::write(path.join(name), text).unwrap();
    }
    let world = "--worlds=rooms.yaml";
    let cases: &[(&[&str], i32, &str)] = &[
        (&["--presets=wdf", world], 1, "there is no preset \"wdf\": must be one of"),
        (&["--presets=wfd,wfd", world], 1, "there are two presets with the name \"wfd\""),
        (&["--worlds=nowhere.yaml"], 1, "nowhere.yaml"),
        (&["--worlds=rooms.yaml,rooms.yaml"], 1, "there are two worlds with the name \"rooms\""),
        (&[world, "--seeds=1,1"], 1, "the seed 1 is given twice"),
        (&[world, "--shard=3/2"], 2, "must be I/N with 1 <= I <= N"),
        (&[world, "--starts=outside.csv"], 1, "world rooms: "),
        (&[world, "--starts=broken.csv"], 1, "broken.csv: line 2: \"rooms,99\""),
        (&[world, "--starts=auto:0"], 2, "must be auto:N with N > 0"),
        (&[world, "--starts=missing.csv"], 1, "cannot read missing.csv"),
        (&[world, "--robot=roomba"], 1, "turtlebot2"),
        (&[world, "--jobs=0"], 2, "invalid value '0' for '--jobs <N>'"),
        (&["--merge", "none.json"], 1, "none.json: not the results of a comparison"),
        (&["--merge", "future.json"], 1, "future.json: the results have schema version 9: must be 1"),
        (&["--merge", "none.json", "--seeds=1"], 2, "cannot be used with"),
        (&["--merge", "none.json", "--oracle"], 2, "cannot be used with"),
    ];
    for (args, code, expected) in cases {
        let output = frontier(path).arg("compare").args(*args).output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(*code), "{args:?}: {stderr}");
        assert!(stderr.contains(expected), "{args:?}: {stderr}");
        if *code == 1 {
            assert_eq!(stderr.trim_end().lines().count(), 1, "{stderr}");
        }
    }
}
