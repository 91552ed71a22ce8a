//! `frontier ctl`: what a user asks of a running explorer.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{SOON, Test, World};
use frontier_explorer::ros::Node;
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::std_srvs::{Trigger, TriggerRes};
use serde_json::Value;
use std::process::Command;
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("ctl_calls_the_service_of_each_word_and_prints_the_answer", words),
    ("ctl_says_which_explorers_there_are_where_one_is_missing", missing_explorer),
    ("ctl_saves_tells_the_status_and_stops_a_real_explorer", real_explorer),
];

/// The exit code, standard output and standard error of `frontier ctl`.
fn ctl(args: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_frontier")).arg("ctl").args(args).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Offers a service that answers with its own name.
fn serve(node: &Node, service: &str, success: bool) -> rosrust::Service {
    let message = format!("{service} was asked for");
    node.serve::<Trigger>(&format!("~{service}"), move |_| Ok(TriggerRes { success, message: message.clone() }))
        .unwrap()
}

fn words(_: &World) {
    const WORDS: [(&str, &str); 8] = [
        ("start", "start"),
        ("pause", "pause"),
        ("resume", "resume"),
        ("stop", "stop"),
        ("home", "return_home"),
        ("save", "save_map"),
        ("clear-blacklist", "clear_blacklist"),
        ("explain", "explain"),
    ];
    let explorer = Node::start("explore").unwrap();
    let services: Vec<_> = WORDS.iter().map(|(_, service)| serve(&explorer, service, true)).collect();
    for (word, service) in WORDS {
        let (code, out, error) = ctl(&[word]);
        assert_eq!((code, out), (0, format!("{service} was asked for\n")), "{word}: {error}");
    }
    drop(services);
    let second = Node::start("second").unwrap();
    let _no = serve(&second, "pause", false);
    for args in [["pause", "--node", "/second"], ["--node", "second", "pause"]] {
        let (code, out, error) = ctl(&args);
        assert_eq!((code, out.as_str()), (3, "pause was asked for\n"), "{error}");
    }
    // One that hangs is waited for as long as was said.
    let _hangs = second
        .serve::<Trigger>("~explain", |_| {
            std::thread::sleep(Duration::from_secs(60));
            Ok(TriggerRes::default())
        })
        .unwrap();
    let began = Instant::now();
    let (code, _, error) = ctl(&["explain", "--node", "/second", "--timeout", "2"]);
    assert!(code == 1 && error.contains("the service /second/explain gave no answer for 2 s"), "{error}");
    assert!(began.elapsed() < Duration::from_secs(8), "{:?}", began.elapsed());
}

fn missing_explorer(_: &World) {
    let (code, _, error) = ctl(&["start"]);
    assert!(code == 1 && error.contains("no explorer /explore is there; explorers that run: none"), "{error}");
    let other = Node::start("scout").unwrap();
    let _status = other.publish_latched::<ExplorationStatus>("~status").unwrap();
    for args in [&["pause"][..], &["status"], &["status", "--watch"]] {
        let (code, _, error) = ctl(args);
        let named = "no explorer /explore is there; explorers that run: /scout; choose one with --node";
        assert!(code == 1 && error.contains(named), "{args:?}: {error}");
    }
    let (code, _, error) = ctl(&["pause", "--node", "/scout"]);
    assert!(code == 1 && error.contains("the explorer /scout offers no service /scout/pause"), "{error}");
    let (code, _, error) = ctl(&["status", "--node", "/scout", "--timeout", "2"]);
    assert!(code == 1 && error.contains("/scout has told no status for 2 s"), "{error}");
    let nobody = Command::new(env!("CARGO_BIN_EXE_frontier"))
        .args(["ctl", "pause"])
        .env("ROS_MASTER_URI", "http://localhost:1")
        .output()
        .unwrap();
    let error = String::from_utf8(nobody.stderr).unwrap();
    assert!(nobody.status.code() == Some(1) && error.contains("start `roscore` there"), "{error}");
}

fn real_explorer(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let _sim = world.simulate(&["_speed:=2.0"]);
    let mut explore = world.explore(&[]);
    status.expect(SOON, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    let (code, out, error) = ctl(&["status"]);
    assert!(code == 0 && out.contains("[wfd: ") && out.contains("goals: "), "{out}{error}");
    let (_, out, _) = ctl(&["status", "--json"]);
    let json: Value = serde_json::from_str(&out).unwrap();
    assert!(json["preset"] == "wfd" && json["known_area_m2"].as_f64().unwrap() > 1.0, "{json}");
    let args = ["ctl", "status", "--watch", "--json"];
    let mut watch = Process::start(env!("CARGO_BIN_EXE_frontier"), &args, world.folder.join("watch.log"));
    eventually(SOON, || watch.log().lines().count() >= 3, || watch.log());
    watch.signal("INT");
    watch.expect_code(0, SOON);
    let times: Vec<f64> = watch
        .log()
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap()["elapsed_s"].as_f64().unwrap())
        .collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
    let (code, out, error) = ctl(&["save"]);
    assert!(code == 0 && out.trim_end() == world.map().with_extension("yaml").to_str().unwrap(), "{out}{error}");
    let mut watch = Process::start(env!("CARGO_BIN_EXE_frontier"), &args, world.folder.join("watch.log"));
    eventually(SOON, || watch.log().lines().count() >= 1, || watch.log());
    assert_eq!(ctl(&["stop"]).0, 0);
    // It leaves with an exit code of its own.
    explore.wait(DEADLINE);
    // The explorer has left.
    watch.expect_code(1, SOON);
    assert!(watch.log().contains("the status of /explore has stopped"), "{}", watch.log());
}
