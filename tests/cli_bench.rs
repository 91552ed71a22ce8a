//! `frontier bench detect` as a user runs it.

#![allow(clippy::unwrap_used)] // the helpers below serve tests alone

use assert_cmd::Command;
use std::path::Path;

fn bench(detector: &str) -> Command {
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml");
    let mut command = Command::cargo_bin("frontier").unwrap();
    command.args(["bench", "detect", "--at", "1.5,7.9", "--runs", "3", "--detector", detector]).arg(map);
    command
}

#[test]
fn every_detector_is_timed_beside_the_byte_sum() {
    let output = bench("all").arg("--json").output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["cells"], 420 * 320);
    let names: Vec<_> = json["detectors"].as_array().unwrap().iter().map(|d| d["detector"].clone()).collect();
    assert!(names.contains(&"wavefront".into()) && names.contains(&"bitplane".into()), "{names:?}");
    for times in json["detectors"].as_array().unwrap().iter().chain([&json["byte_sum"]]) {
        let ms = |key: &str| times[key].as_f64().unwrap();
        assert!(0.0 < ms("min_ms") && ms("min_ms") <= ms("median_ms") && ms("median_ms") <= ms("p90_ms"), "{times}");
    }
}

#[test]
fn a_wrong_name_is_answered_with_the_valid_ones() {
    let output = bench("bitmap").output().unwrap();
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1));
    assert!(message.contains("\"bitmap\"") && message.contains("bitplane"), "{message}");
}
