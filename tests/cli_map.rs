//! `frontier map` as a user meets it: output, messages and exit codes.

#![allow(clippy::unwrap_used)] // the helpers below serve tests alone

use assert_cmd::Command;
use predicates::prelude::*;
use predicates::str::contains;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn frontier(args: &[&str]) -> Command {
    let mut command = Command::cargo_bin("frontier").unwrap();
    command.args(args);
    command
}

/// A 3 x 2 map at 0.5 m: the top row occupied, free, unknown, the bottom row free.
fn write_map(dir: &TempDir, name: &str, pixels: &[u8; 6]) -> String {
    let path = dir.path().join(name).with_extension("yaml");
    let image = path.with_extension("pgm");
    std::fs::write(&image, [b"P5\n3 2\n255\n".as_slice(), pixels].concat()).unwrap();
    let yaml = format!(
        "image: {name}.pgm\nresolution: 0.5\norigin: [-1, 2, 0.25]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    );
    std::fs::write(&path, yaml).unwrap();
    text(&path)
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_owned()
}

fn fixture() -> (TempDir, String) {
    let dir = tempfile::tempdir().unwrap();
    let map = write_map(&dir, "a", b"\x00\xfe\xcd\xfe\xfe\xfe");
    (dir, map)
}

#[test]
fn info_prints_size_and_areas() {
    let (_dir, map) = fixture();
    frontier(&["map", "info", &map])
        .assert()
        .success()
        .stdout(contains("size        3 x 2 cells, 1.50 x 1.00 m"))
        .stdout(contains("resolution  0.5 m per cell"))
        .stdout(contains("origin      x -1 m, y 2 m, yaw 0.25 rad"))
        .stdout(contains("free      1.00 m2").and(contains("occupied  0.25 m2")))
        .stdout(contains("unknown     0.25 m2"))
        .stderr("");
}

#[test]
fn info_as_json_can_be_read_by_a_program() {
    let (_dir, map) = fixture();
    let output = frontier(&["map", "info", "--json", &map]).output().unwrap();
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["mode"], "trinary");
    assert_eq!(json["width_cells"], 3);
    assert_eq!(json["origin_in_map"]["yaw"], 0.25);
    assert_eq!(json["known_m2"], 1.25);
}

#[test]
fn failures_are_one_sentence_on_stderr() {
    let dir = tempfile::tempdir().unwrap();
    let here = text(dir.path());
    let missing = text(&dir.path().join("no.yaml"));
    for (path, expected) in [(&here, "is a directory: must be the .yaml file of a map"), (&missing, "cannot read")] {
        let assert = frontier(&["map", "info", path]).assert().code(1).stdout("").stderr(contains(expected));
        let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
        assert!(stderr.starts_with("frontier: ") && stderr.lines().count() == 1, "{stderr}");
    }
}

#[test]
fn wrong_usage_is_exit_code_2() {
    frontier(&["map"]).assert().code(2).stderr(contains("info").and(contains("convert")).and(contains("diff")));
    frontier(&["map", "inof", "a"]).assert().code(2).stderr(contains("'info'"));
    frontier(&["map", "convert", "a", "b", "--occ", "101"]).assert().code(2).stderr(contains("1..=100"));
    frontier(&["map", "convert", "a", "b", "--format", "bmp"]).assert().code(2).stderr(contains("pgm, png"));
}

#[test]
fn help_says_what_each_command_does() {
    frontier(&["map", "--help"])
        .assert()
        .success()
        .stdout(contains("Compare two maps place by place; exit code 1 when they differ"));
    frontier(&["map", "convert", "--help"]).assert().success().stdout(contains("[default: 65]"));
}

#[test]
fn convert_writes_both_files_and_says_where() {
    let (dir, map) = fixture();
    for (format, image) in [("pgm", "out.pgm"), ("png", "out.png")] {
        let out = dir.path().join("out");
        let expected = format!("{0}.yaml\n{1}\n", text(&out), text(&dir.path().join(image)));
        frontier(&["map", "convert", &map, &text(&out), "--format", format]).assert().success().stdout(expected);
        frontier(&["map", "diff", &map, &text(&out.with_extension("yaml"))]).assert().success();
    }
}

#[test]
fn convert_refuses_thresholds_out_of_order() {
    let (dir, map) = fixture();
    let out = text(&dir.path().join("out"));
    frontier(&["map", "convert", &map, &out, "--free", "65"])
        .assert()
        .code(1)
        .stderr(contains("--free 65 and --occ 65: --free must be below --occ"));
    assert!(!Path::new(&format!("{out}.yaml")).exists());
}

#[test]
fn diff_counts_and_answers_by_its_exit_code() {
    let (dir, a) = fixture();
    frontier(&["map", "diff", &a, &a]).assert().code(0).stdout(contains("agreement           100.000 %"));
    let b = write_map(&dir, "b", b"\xfe\xfe\xfe\x00\xcd\xfe");
    frontier(&["map", "diff", &a, &b])
        .assert()
        .code(1)
        .stdout(contains("free -> occupied    1 cells").and(contains("occupied -> free    1 cells")))
        .stdout(contains("known only in A     1 cells").and(contains("known only in B     1 cells")))
        .stdout(contains("agreement           50.000 %"))
        .stderr("");
    let output = frontier(&["map", "diff", &a, &b, "--json"]).output().unwrap();
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!((&json["both_free"], &json["agreement_percent"]), (&2.into(), &50.0.into()));
}

#[test]
fn diff_draws_a_picture() {
    let (dir, a) = fixture();
    let b = write_map(&dir, "b", b"\xfe\xfe\xfe\x00\xcd\xfe");
    let out: PathBuf = dir.path().join("diff.png");
    frontier(&["map", "diff", &a, &b, "--picture", &text(&out)]).assert().code(1);
    let picture = image::open(&out).unwrap().into_rgb8();
    assert_eq!(picture.dimensions(), (3, 2));
    // Occupied in A and free in B, at the upper left.
    assert_eq!(picture.get_pixel(0, 0).0, [69, 117, 180]);
    frontier(&["map", "diff", &a, &b, "--picture", "diff.bmp"]).assert().code(1).stderr(contains("must end in .png"));
}

#[test]
fn diff_refuses_other_resolutions() {
    let (dir, a) = fixture();
    let b = dir.path().join("b.yaml");
    std::fs::write(&b, std::fs::read_to_string(&a).unwrap().replace("0.5\n", "0.25\n")).unwrap();
    frontier(&["map", "diff", &a, &text(&b)])
        .assert()
        .code(1)
        .stderr(contains("has 0.5 m per cell and").and(contains("has 0.25: must be the same")));
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_gone_is_no_failure() {
    use std::process::Stdio;
    let (_dir, map) = fixture();
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("frontier"))
        .args(["map", "info", &map])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Whoever saves a map from a script waits no longer than asked, with or without a master.
#[test]
fn saving_gives_up_when_no_master_answers_and_names_an_address_that_is_none() {
    let save = |uri: &str| {
        let mut command = Command::cargo_bin("frontier").unwrap();
        command.env("ROS_MASTER_URI", uri).args(["map", "save", "-f", "nowhere", "--timeout", "1"]);
        let output = command.timeout(std::time::Duration::from_secs(20)).output().unwrap();
        (output.status.code(), String::from_utf8(output.stderr).unwrap())
    };
    // Nobody listens on a port that was free a moment ago.
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let (code, said) = save(&format!("http://127.0.0.1:{port}"));
    assert!(code == Some(1) && said.contains("no ROS master answers at"), "{code:?} {said}");
    let (code, said) = save("127.0.0.1:11311");
    assert!(code == Some(1) && said.contains("must look like http://host:11311"), "{code:?} {said}");
}
