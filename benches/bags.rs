//! Reading a bag of 512 MB: beside the plain reading of the file, and beside Python's rosbag
//! where that is installed. The bag is made in a temporary folder, of what a robot records:
//! scans of 1080 rays, transforms and a map.
//!
//! `cargo bench --bench bags`, or `cargo bench --bench bags -- FILE.bag` for a bag of one's own.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

use frontier_explorer::bag::{
    BagReader, BagWriter, Chunk, Compression, Header, MessageType, Summary, map, map_message, nanos, open_bag, scan,
    scan_message, tf_message, transforms,
};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{GridInfo, OccupancyGrid};
use frontier_explorer::scan::LaserScan;
use frontier_explorer::tf::TransformSample;
use std::fs::File;
use std::hint::black_box;
use std::io::{BufWriter, Read};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

const BAG_BYTES: usize = 512_000_000;
const ROUNDS: usize = 5;

fn main() {
    let folder = tempfile::tempdir().unwrap();
    // cargo passes --bench.
    let given = std::env::args().skip(1).find(|argument| !argument.starts_with("--"));
    let path = given.map_or_else(|| make(&folder.path().join("large.bag")), PathBuf::from);
    let megabytes = std::fs::metadata(&path).unwrap().len() as f64 / 1e6;
    println!("{megabytes:.0} MB, the fastest of {ROUNDS} rounds in turns");
    let mut fastest = [f64::INFINITY; 3];
    for _ in 0..ROUNDS {
        for (best, read) in fastest.iter_mut().zip([plain, look_through, decode]) {
            let began = Instant::now();
            read(&path);
            *best = best.min(began.elapsed().as_secs_f64());
        }
    }
    let [plain_s, info_s, decode_s] = fastest;
    for (name, took_s) in [("reading the file", plain_s), ("bag info", info_s), ("all messages decoded", decode_s)] {
        println!("{name:22} {:7.0} MB/s, {:.2} of the file", megabytes / took_s, plain_s / took_s);
    }
    if let Some(peak) = peak_megabytes() {
        println!("peak memory {peak:.0} MB");
    }
    match python(&path) {
        Some(python_s) => println!("Python's rosbag took {python_s:.1} s: {:.0} times as long", python_s / decode_s),
        None => println!("Python's rosbag is not installed: no comparison"),
    }
}

fn plain(path: &Path) {
    let mut file = File::open(path).unwrap();
    let mut buffer = vec![0; 1 << 20];
    while file.read(&mut buffer).unwrap() > 0 {
        black_box(&buffer);
    }
}

fn opened(path: &Path) -> Box<dyn BagReader> {
    open_bag(path, File::open(path).unwrap()).unwrap()
}

fn look_through(path: &Path) {
    black_box(Summary::of(opened(path).as_mut()).unwrap());
}

fn decode(path: &Path) {
    let mut reader = opened(path);
    let mut chunk = Chunk::default();
    while reader.next_chunk(&mut chunk).unwrap() {
        for message in &chunk.messages {
            let connection = &reader.connections()[&message.connection];
            let data = chunk.data(message);
            match MessageType::of(&connection.kind, &connection.md5) {
                Some(MessageType::Map) => drop(black_box(map(data).unwrap())),
                Some(MessageType::Scan) => drop(black_box(scan(data).unwrap())),
                Some(MessageType::Transforms) => drop(black_box(transforms(data).unwrap())),
                _ => {}
            }
        }
    }
}

/// Seconds that Python's rosbag takes for the same.
fn python(path: &Path) -> Option<f64> {
    let program = "import sys, rosbag\nfor _ in rosbag.Bag(sys.argv[1]).read_messages(): pass";
    let can = |program: &str| Command::new("/usr/bin/python3").args(["-c", program]).arg(path).status();
    if !can("import rosbag").ok()?.success() {
        return None;
    }
    let began = Instant::now();
    can(program).ok()?.success().then(|| began.elapsed().as_secs_f64())
}

fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1e3)
}

fn make(path: &Path) -> PathBuf {
    let file = BufWriter::new(File::create(path).unwrap());
    let mut writer = BagWriter::new(file, Compression::None).unwrap();
    let map_topic = writer.topic("/map", MessageType::Map, true);
    let tf_topic = writer.topic("/tf", MessageType::Transforms, false);
    let scan_topic = writer.topic("/scan", MessageType::Scan, false);
    let grid = OccupancyGrid::filled(GridInfo::new(1000, 800, 0.05, Pose::default()).unwrap(), 0);
    let sweep = LaserScan {
        angle_min_rad: -2.35,
        angle_increment_rad: 0.00436,
        range_min_m: 0.1,
        range_max_m: 30.0,
        ranges_m: (0..1080_u16).map(|ray| 1.0 + 0.01 * f32::from(ray)).collect(),
        ..LaserScan::default()
    };
    let mut written = 0;
    for tick in 0_u32.. {
        let stamp_s = 1000.0 + 0.025 * f64::from(tick);
        let header = |frame: &str| Header { seq: tick, stamp: nanos(stamp_s), frame: frame.to_owned() };
        let pose = Pose::new(0.01 * f64::from(tick % 1000), 0.0, 0.0);
        let samples = [TransformSample::planar(stamp_s, "odom", "base_link", &pose)];
        let mut messages =
            vec![(tf_topic, tf_message(&samples)), (scan_topic, scan_message(&header("laser"), &sweep, 0.025))];
        if tick % 40 == 0 {
            messages.push((map_topic, map_message(&header("map"), &grid)));
        }
        for (topic, bytes) in messages {
            written += bytes.len();
            writer.write(topic, nanos(stamp_s), &bytes).unwrap();
        }
        if written >= BAG_BYTES {
            break;
        }
    }
    writer.finish().unwrap();
    path.to_owned()
}
