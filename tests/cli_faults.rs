//! Files that are none: inputs without an end, outputs that are devices, pipes and links; and names
//! with what a terminal or a browser would obey.

#![cfg(unix)]
#![allow(clippy::unwrap_used)]

#[path = "odd_bags/fixture.rs"]
#[allow(dead_code)]
mod fixture;

use assert_cmd::Command;
use fixture::{Drive, write};
use frontier_explorer::grid::OccupancyGrid;
use frontier_explorer::io::{SaveOptions, save_map};
use std::os::unix::fs::{FileTypeExt, symlink};
use std::path::Path;
use std::time::Duration;

fn frontier() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frontier"));
    command.timeout(Duration::from_secs(60));
    command
}

#[test]
fn inputs_without_an_end_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    let no_end = "it is longer than 268435456 bytes, or has no end";
    for (args, said) in [
        (&["explore", "office", "--config", "/dev/zero", "--out", &out][..], no_end),
        (&["explore", "office", "--robot", "/dev/zero", "--out", &out], no_end),
        (&["explore", "/dev/zero", "--out", &out], "/dev/zero is not a regular file"),
        (&["compare", "--worlds", "office", "--starts", "/dev/zero"], no_end),
        (&["compare", "--merge", "/dev/zero"], no_end),
        (&["map", "info", "/dev/zero"], "/dev/zero is not a regular file"),
        (&["bag", "info", "/dev/zero"], "/dev/zero is no file"),
        (&["replay", "/dev/zero", "--out", &out], "/dev/zero is no file"),
    ] {
        let output = frontier().args(args).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{args:?}: {error}");
        assert!(error.contains(said) && error.trim_end().lines().count() == 1, "{args:?}: {error}");
    }
}

#[test]
fn outputs_that_are_devices_pipes_or_links_stay_so() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let grid = OccupancyGrid::from_ascii("?????\n?...?\n?...?\n?????").unwrap();
    let map = save_map(&at("map"), &grid, &SaveOptions::default()).unwrap().yaml;
    let detect = |picture: &Path| {
        frontier().arg("detect").arg(&map).args(["--at", "2.5,1.5", "--overlay"]).arg(picture).assert()
    };
    symlink("/dev/null", at("null.png")).unwrap();
    symlink("/dev/full", at("full.png")).unwrap();
    symlink("real.png", at("link.png")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(at("pipe.png")).status().unwrap().success());
    detect(&at("null.png")).success();
    detect(&at("link.png")).success();
    let full = detect(&at("full.png")).code(1);
    let error = String::from_utf8_lossy(&full.get_output().stderr).into_owned();
    assert!(error.contains("No space left on device"), "{error}");
    let reader = {
        let pipe = at("pipe.png");
        std::thread::spawn(move || std::fs::read(pipe).unwrap())
    };
    detect(&at("pipe.png")).success();
    let is_png = |bytes: &[u8]| bytes.starts_with(&[0x89, b'P', b'N', b'G']);
    assert!(is_png(&reader.join().unwrap()) && is_png(&std::fs::read(at("real.png")).unwrap()));
    let kind = |path: &Path| std::fs::symlink_metadata(path).unwrap().file_type();
    assert!(["null.png", "full.png", "link.png"].iter().all(|name| kind(&at(name)).is_symlink()));
    assert!(kind(&at("pipe.png")).is_fifo() && kind(Path::new("/dev/null")).is_char_device());
    // A device cannot hold the two files of a map.
    let refused = frontier().args(["map", "convert"]).arg(&map).arg("/dev/null").assert().code(1);
    let error = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(error.contains("/dev/null is a device or a pipe"), "{error}");
}

#[test]
fn names_in_a_bag_command_no_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let mut messages = Drive::default().messages();
    for message in messages.iter_mut().filter(|message| message.topic == "/map") {
        message.topic = "/map\u{1b}[2J\u{7}";
    }
    let bag = write(folder.path(), "drive.bag", &messages);
    let told = |args: &[&str]| {
        let output = frontier().args(args).arg(&bag).output().unwrap();
        [output.stdout, output.stderr].concat()
    };
    for args in [&["bag", "info"][..], &["replay", "--map-topic", "/nothing", "--out", "x"]] {
        let said = String::from_utf8_lossy(&told(args)).into_owned();
        assert!(said.contains("/map\\u{1b}[2J\\u{7}"), "{said}");
        assert!(!said.contains(['\u{1b}', '\u{7}']), "{said:?}");
    }
}

#[test]
fn names_with_markup_are_text_in_the_report() {
    let folder = tempfile::tempdir().unwrap();
    let (preset, out) = (folder.path().join("odd.yaml"), folder.path().join("out"));
    std::fs::write(&preset, "preset: \"<script>alert(1)</script>\"\n").unwrap();
    let args = ["--time-limit", "5", "--quiet", "--config"];
    frontier().args(["explore", "office"]).args(args).arg(&preset).arg("--out").arg(&out).assert().code(3);
    let page = std::fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("&lt;script&gt;alert(1)") && !page.contains("<script>alert"), "{page}");
}
