//! Bags, by whichever reader they get, and a replay of them.

use super::engine::{Answer, Target};
use super::exploring::{room, sweep};
use frontier_explorer::bag::{
    BagWriter, Compression, Header, MessageType, Summary, goal_message, map_message, nanos, open_bag, scan_message,
    tf_message,
};
use frontier_explorer::config::{Preset, builtin_robot};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::mapping::BuilderConfig;
use frontier_explorer::replay::{BagRobot, Clock, Inputs, Player, Verdict, Wanted};
use frontier_explorer::robot::Robot as _;
use frontier_explorer::tf::TransformSample;
use std::cell::RefCell;
use std::fs::File;

#[test]
fn bags() {
    // A chunk may unpack to much; a map of scans holds what these see.
    Target { name: "bags", run: replay, seeds, memory: (512 << 20, 100_000), least_taken_percent: 10.0 }.fuzz();
}

/// Ticks of a replay, which would otherwise go on for years.
const TICKS: usize = 60;

thread_local! {
    static FOLDER: RefCell<Option<tempfile::TempDir>> = const { RefCell::new(None) };
}

/// A replay, by the recorded map or by one made of the scans, as the number of the bytes says.
fn replay(input: &[u8]) -> Answer {
    let path =
        FOLDER.with_borrow_mut(|folder| folder.get_or_insert_with(|| tempfile::tempdir().unwrap()).path().join("bag"));
    // Mapped into memory by the last one.
    let _ = std::fs::remove_file(&path);
    std::fs::write(&path, input).unwrap();
    let open = || open_bag(&path, File::open(&path).unwrap()).map_err(|error| error.to_string());
    let summary = Summary::of(open()?.as_mut()).map_err(|error| error.to_string())?;
    let mut inputs = Inputs::of(&summary, &Wanted::default()).map_err(|error| error.to_string())?;
    if input.len().is_multiple_of(3) {
        inputs.forget_map();
    }
    let verdict = Verdict::of(&summary, &inputs);
    let _ = (Clock::of(&summary, &inputs).notes().len(), verdict.sentences(), summary.warnings().count());
    verdict.replay.as_ref().map_err(ToString::to_string)?;
    let mut player = Player::new(open()?, &summary, inputs.clone());
    if inputs.map_topic.is_none() {
        player.map_scans(BuilderConfig::with_resolution(0.1), &summary);
    }
    let mut robot = BagRobot::new(player, &summary, None);
    let preset = Preset::built_in("tour").unwrap();
    let mut explorer = Explorer::new(preset.explorer, &builtin_robot("turtlebot2").unwrap().traits()).unwrap();
    let mut said = summary.problems.first().cloned().unwrap_or_default();
    for _ in 0..TICKS {
        let observation = match robot.observe() {
            Ok(observation) => observation,
            Err(error) => return Ok(said + &error.to_string()),
        };
        let decision = explorer.step(&observation);
        robot.command(&decision.command).unwrap();
        if let Some(end) = decision.end {
            said += &format!("{:?}", end.reason);
            break;
        }
    }
    Ok(said)
}

/// Two seconds of a drive, with each compression.
fn seeds() -> Vec<(String, Vec<u8>)> {
    let mut bags = Vec::new();
    for (name, compression) in [("plain", Compression::None), ("bz2", Compression::Bz2), ("lz4", Compression::Lz4)] {
        let mut writer = BagWriter::new(std::io::Cursor::new(Vec::new()), compression).unwrap();
        let map = writer.topic("/map", MessageType::Map, true);
        let tf = writer.topic("/tf", MessageType::Transforms, false);
        let scan = writer.topic("/scan", MessageType::Scan, false);
        let goal = writer.topic("/move_base/goal", MessageType::Goal, false);
        for tick in 0..8 {
            let stamp_s = 1000.0 + 0.25 * f64::from(tick);
            let at = nanos(stamp_s);
            let header = |frame: &str| Header { seq: tick, stamp: at, frame: frame.to_owned() };
            let pose = Pose::new(1.0 + 0.05 * f64::from(tick), 1.0, 0.0);
            let samples = [
                TransformSample::planar(stamp_s, "map", "odom", &Pose::default()),
                TransformSample::planar(stamp_s, "odom", "base_link", &pose),
                TransformSample::planar(stamp_s, "base_link", "laser", &Pose::default()),
            ];
            writer.write(tf, at, &tf_message(&samples)).unwrap();
            writer.write(scan, at, &scan_message(&header("laser"), &sweep(), 0.1)).unwrap();
            if tick % 4 == 0 {
                writer.write(map, at, &map_message(&header("map"), &room())).unwrap();
            }
            if tick == 3 {
                writer.write(goal, at, &goal_message(&header("map"), "g", &Pose::new(2.0, 1.5, 0.5))).unwrap();
            }
        }
        let mut bytes = writer.finish().unwrap().into_inner();
        bags.push((format!("{name}.bag"), bytes.clone()));
        bytes.truncate(bytes.len() * 3 / 4);
        bags.push((format!("{name}_cut.bag"), bytes));
    }
    bags
}
