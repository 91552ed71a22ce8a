//! Bags as wholes: what is written is read, by the scanner and through the `rosbag` crate; and
//! what is damaged does no harm.

use super::chunk::MAX_CHUNK_BYTES;
use super::indexed::IndexedBag;
use super::layout::{ChunkRecord, Layout};
use super::*;
use crate::geometry::Pose;
use crate::grid::{GridInfo, OccupancyGrid};
use crate::scan::LaserScan;
use crate::tf::TransformSample;
use rand::{RngExt, SeedableRng};
use std::io::{Cursor as Bytes, Write};

fn transform(stamp_s: f64, parent: &str, child: &str, x_m: f64) -> TransformSample {
    let (parent, child) = (parent.to_owned(), child.to_owned());
    TransformSample { parent, child, stamp_s, translation_m: [x_m, 0.0, 0.0], rotation_xyzw: [0.0, 0.0, 0.0, 1.0] }
}

/// Forty seconds of a robot: map, transforms, scans and a goal.
fn recorded(compression: Compression, repeat: u32) -> Vec<u8> {
    let mut writer = BagWriter::new(Bytes::new(Vec::new()), compression).unwrap();
    let map = writer.topic("/map", MessageType::Map, true);
    let tf = writer.topic("/tf", MessageType::Transforms, false);
    let scan = writer.topic("/scan", MessageType::Scan, false);
    let goal = writer.topic("/move_base/goal", MessageType::Goal, false);
    let grid = OccupancyGrid::filled(GridInfo::new(60, 40, 0.05, Pose::new(-1.0, -1.0, 0.0)).unwrap(), 0);
    let sweep = LaserScan {
        angle_min_rad: -1.0,
        angle_increment_rad: 0.1,
        range_min_m: 0.1,
        range_max_m: 10.0,
        ranges_m: (0..20).map(|i| 1.0 + i as f32).collect(),
        ..LaserScan::default()
    };
    for tick in 0..repeat {
        let stamp_s = 100.0 + 0.1 * f64::from(tick);
        let header = |frame: &str| Header { seq: tick, stamp: nanos(stamp_s), frame: frame.to_owned() };
        let at = nanos(stamp_s);
        let both = [transform(stamp_s, "map", "odom", 0.0), transform(stamp_s, "odom", "base_link", 0.1)];
        writer.write(tf, at, &tf_message(&both)).unwrap();
        writer.write(scan, at, &scan_message(&header("laser"), &sweep, 0.1)).unwrap();
        if tick % 10 == 0 {
            writer.write(map, at, &map_message(&header("map"), &grid)).unwrap();
        }
        if tick % 50 == 5 {
            writer.write(goal, at, &goal_message(&header("map"), "g", &Pose::new(1.0, 2.0, 0.5))).unwrap();
        }
    }
    writer.finish().unwrap().into_inner()
}

/// A message's topic, time and bytes.
type Read = (String, Nanos, Vec<u8>);

/// Reads and decodes a bag by the reader that its file gets and by the scanner: both find the
/// same messages.
fn decode_all(bytes: &[u8]) -> Result<(Summary, u64), BagError> {
    let mut file = tempfile::NamedTempFile::new()?;
    file.write_all(bytes)?;
    let (_, scanned) = decode(Box::new(BagScanner::new(Bytes::new(bytes.to_vec()))?))?;
    let (summary, read) = decode(open_bag(file.path(), file.reopen()?)?)?;
    assert!(read == scanned, "{} messages are read and {} scanned", read.len(), scanned.len());
    Ok((summary, read.len() as u64))
}

fn decode(mut reader: Box<dyn BagReader>) -> Result<(Summary, Vec<Read>), BagError> {
    let summary = Summary::of(reader.as_mut())?;
    let mut playback = Playback::new(reader, &summary);
    let (mut last, mut read) = (0, Vec::new());
    while let Some(PlayedMessage { connection, time, data, .. }) = playback.next_message()? {
        // In a damaged bag, a connection can be found that a first look did not know.
        let is_whole = summary.problems.is_empty();
        assert!(time >= last || !is_whole, "messages come in the order of time");
        last = time;
        read.push((connection.topic.clone(), time, data.to_vec()));
        match MessageType::of(&connection.kind, &connection.md5) {
            Some(MessageType::Map) => drop(map(data)),
            Some(MessageType::MapUpdate) => drop(patch(data)),
            Some(MessageType::Transforms) => drop(transforms(data)),
            Some(MessageType::Scan) => drop(scan(data)),
            Some(MessageType::Goal) => drop(goal(data)),
            Some(MessageType::Result) => drop(result(data)),
            Some(MessageType::Path) => drop(path(data)),
            Some(MessageType::Pose) => drop(pose(data)),
            Some(MessageType::Odometry) => drop(odometry(data)),
            _ => {}
        }
    }
    assert!(read.len() as u64 == summary.messages || !summary.problems.is_empty());
    Ok((summary, read))
}

type Indexed = (Vec<ChunkRecord>, IndexedBag<Bytes<Vec<u8>>>);

/// The chunks of a bag if it is whole, and a reader of it through the `rosbag` crate.
fn indexed(bytes: &[u8]) -> Option<Indexed> {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(bytes).unwrap();
    let mut scanner = BagScanner::new(Bytes::new(bytes.to_vec())).unwrap();
    let layout = Layout::of(&mut scanner.input).unwrap()?;
    let bag = rosbag::RosBag::new(file.path()).unwrap();
    Some((layout.chunks.clone(), IndexedBag::new(bag, layout, scanner)))
}

#[test]
fn whole_bags_are_read_through_the_rosbag_crate_and_others_are_not() {
    for compression in Compression::ALL {
        let bytes = recorded(compression, 400);
        let (chunks, mut reader) = indexed(&bytes).unwrap();
        let mut chunk = Chunk::default();
        for &record in &chunks {
            chunk.clear(record.offset);
            reader.unpack(record, &mut chunk).unwrap();
            assert!(!chunk.messages.is_empty(), "{compression:?}");
            assert_eq!(chunk.unpacked_bytes(), record.bytes);
        }
        assert!(indexed(&bytes[..bytes.len() - 1]).is_none() && indexed(&bytes[..bytes.len() / 2]).is_none());
        // An index that is said to lie before the first chunk, or behind the file, at which
        // the crate would panic.
        let index_at = bytes.windows(10).position(|field| field == b"index_pos=").unwrap() + 10;
        for index_pos in [0, 20, bytes.len() as u64 + 1, u64::MAX] {
            let mut odd = bytes.clone();
            odd[index_at..index_at + 8].copy_from_slice(&index_pos.to_le_bytes());
            assert!(indexed(&odd).is_none(), "{index_pos}");
            decode_all(&odd).unwrap();
        }
    }
}

#[test]
fn a_chunk_that_would_take_much_memory_is_not_unpacked_by_the_crate() {
    let record = ChunkRecord { offset: 13, compression: Compression::None, packed_bytes: 9, bytes: 9 };
    assert!(record.is_bounded());
    assert!(!ChunkRecord { bytes: 10, ..record }.is_bounded());
    assert!(!ChunkRecord { packed_bytes: 4 << 30, bytes: 4 << 30, ..record }.is_bounded());
    assert!(!ChunkRecord { compression: Compression::Bz2, bytes: MAX_CHUNK_BYTES + 1, ..record }.is_bounded());
    assert!(!ChunkRecord { compression: Compression::Lz4, packed_bytes: 5 << 20, ..record }.is_bounded());
}

#[test]
fn what_is_written_is_read() {
    for compression in Compression::ALL {
        let bytes = recorded(compression, 400);
        let (summary, count) = decode_all(&bytes).unwrap();
        assert_eq!((count, summary.messages, summary.is_indexed), (848, 848, true), "{compression:?}");
        assert!(summary.problems.is_empty(), "{:?}", summary.problems);
        assert!((summary.duration_s() - 39.9).abs() < 1e-6);
        let topics: Vec<_> = summary.topics.iter().map(|t| (t.topic.as_str(), t.messages)).collect();
        assert_eq!(topics, [("/map", 40), ("/move_base/goal", 8), ("/scan", 400), ("/tf", 400)]);
        assert!(summary.topics[0].is_latching && summary.topics[0].frames.contains("map"));
        assert!((summary.topics[2].rate_hz - 10.0).abs() < 1e-6);
        assert_eq!(summary.tf["base_link"].parent, "odom");
    }
}

#[test]
fn messages_come_back() {
    let header_in = Header { seq: 7, stamp: nanos(12.5), frame: "map".to_owned() };
    let there = Pose::new(1.5, -2.0, 2.8);
    let same = |a: Pose, b: Pose| a.distance_to(b.position()) < 1e-12 && (a.yaw - b.yaw).abs() < 1e-12;
    assert_eq!(header(&pose_message(&header_in, &there)), Ok(header_in.clone()));
    assert!(same(pose(&pose_message(&header_in, &there)).unwrap().pose, there));
    let sent = goal(&goal_message(&header_in, "a", &there)).unwrap();
    assert!(sent.id == "a" && same(sent.target.pose, there));
    let told = result(&result_message(&header_in, "a", 3, "reached")).unwrap();
    assert_eq!((told.header, told.id, told.status, told.text), (header_in.clone(), "a".into(), 3, "reached".into()));
    assert_eq!(path(&path_message(&header_in, &[there, there])).unwrap().1.len(), 2);
    assert_eq!(clock(&clock_message(nanos(3.25))), Ok(3_250_000_000));
    let twist = crate::geometry::Twist::new(0.1, 0.2);
    let odometry_back = odometry(&odometry_message(&header_in, "base", &there, &twist)).unwrap();
    assert!(same(odometry_back.pose, there) && odometry_back.child == "base");
    let info = GridInfo::new(3, 2, 0.05, Pose::new(-1.0, 2.0, 0.3)).unwrap();
    let grid = OccupancyGrid::new(info, vec![-1, 0, 100, 25, 50, 75]).unwrap();
    let bytes = map_message(&header_in, &grid);
    let back = map(&bytes).unwrap().grid;
    assert_eq!((back.data(), back.info().resolution_m()), (grid.data(), f64::from(0.05_f32)));
    for length in 0..bytes.len() {
        assert!(map(&bytes[..length]).is_err(), "{length}");
    }
}

#[test]
fn other_formats_are_refused_by_name() {
    let message = |bytes: &[u8]| decode_all(bytes).unwrap_err().to_string();
    assert!(message(b"#ROSBAG V1.2\nrest").contains("format 1.2: must be 2.0"));
    assert!(message(b"#ROSRECORD V1.1\n").contains("format 1.1"));
    assert!(message(b"\x89MCAP0\r\n").contains("no ROS 1 bag"));
    assert!(message(b"").contains("no ROS 1 bag"));
}

#[test]
fn a_cut_bag_is_read_as_far_as_it_goes() {
    for compression in Compression::ALL {
        let bytes = recorded(compression, 4000);
        let whole = decode_all(&bytes).unwrap().1;
        let (summary, count) = decode_all(&bytes[..bytes.len() / 2]).unwrap();
        assert!(count > whole / 8 && count < whole, "{compression:?}: {count} of {whole}");
        let told = summary.problems.join("\n");
        assert!(told.contains("the bag is cut") && told.contains("messages are read, up to"), "{told}");
    }
}

#[test]
fn a_bag_under_way_is_read_though_its_last_chunk_is_open() {
    for compression in Compression::ALL {
        let mut bytes = recorded(compression, 100);
        // As `rosbag record` leaves it: no index, and a chunk whose sizes are not known yet.
        let chunk = 13 + 4096;
        let header = u32::from_le_bytes(bytes[chunk..chunk + 4].try_into().unwrap()) as usize;
        let data = chunk + 8 + header;
        let length = u32::from_le_bytes(bytes[data - 4..data].try_into().unwrap()) as usize;
        bytes[data - 4..data].fill(0);
        bytes[data - 8..data - 4].fill(0);
        bytes.truncate(data + length - 10);
        bytes[13 + 4 + 8 + 4 + 10..][..8].fill(0);
        let (summary, count) = decode_all(&bytes).unwrap();
        assert!(!summary.is_indexed && summary.problems[0].contains("no index"));
        let least = if compression == Compression::None { 211 } else { 0 };
        assert!((least..=212).contains(&count), "{compression:?}: {count}");
    }
}

/// How often each fuzz test tries: `FRONTIER_FUZZ=1` makes 1,000 cuts and 10,000 flips, and
/// the default, a twentieth, suits an unoptimised build.
fn effort() -> f64 {
    std::env::var("FRONTIER_FUZZ").ok().and_then(|value| value.parse().ok()).unwrap_or(0.05)
}

#[test]
fn cuts_and_flips_do_no_harm() {
    let mut random = rand_pcg::Pcg32::seed_from_u64(6);
    let bags = Compression::ALL.map(|compression| recorded(compression, 60));
    for round in 0..(1_000.0 * effort()) as usize {
        let bytes = &bags[round % 3];
        let _ = decode_all(&bytes[..random.random_range(0..bytes.len())]);
    }
    for round in 0..(10_000.0 * effort()) as usize {
        let mut bytes = bags[round % 3].clone();
        for _ in 0..random.random_range(1..4) {
            let at = random.random_range(0..bytes.len());
            bytes[at] = random.random();
        }
        if let Ok((summary, _)) = decode_all(&bytes) {
            let held: u64 = summary.compression.values().map(|(_, _, raw)| raw).sum();
            assert!(held < 4 << 20, "a small bag stays small: {held} bytes");
        }
    }
}

#[test]
fn behind_a_damaged_record_the_next_chunk_is_read() {
    // Enough for several chunks, without compression; the second chunk's header is struck.
    let bytes = recorded(Compression::None, 4000);
    let (whole, count) = decode_all(&bytes).unwrap();
    assert!(whole.chunks.len() >= 3, "{}", whole.chunks.len());
    let struck = whole.chunks[1].offset as usize;
    for (at, value) in [(struck, 0xff), (struck + 3, 0x7f), (struck + 8, b'x')] {
        let mut damaged = bytes.clone();
        damaged[at] = value;
        let (summary, read) = decode_all(&damaged).unwrap();
        assert_eq!(summary.chunks.len(), whole.chunks.len() - 1, "byte {at}");
        assert!(read < count && read > count / 2, "{read} of {count} messages");
        let said = format!("at byte {struck}");
        assert!(summary.problems.iter().any(|problem| problem.contains(&said)), "{:?}", summary.problems);
    }
}
