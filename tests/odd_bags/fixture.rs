//! A small recording that a test can spoil: a robot drives into a corridor without an end.

use frontier_explorer::bag::{
    BagWriter, Compression, Header, MessageType, map_message, nanos, scan_message, tf_message,
};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Cell, GridInfo, OccupancyGrid};
use frontier_explorer::scan::LaserScan;
use frontier_explorer::tf::TransformSample;
use std::path::{Path, PathBuf};

/// When the drive begins, seconds.
pub const BEGIN_S: f64 = 1000.0;
/// How long it takes, seconds.
pub const DRIVE_S: f64 = 20.0;
/// How far it goes, metres.
pub const WAY_M: f64 = 4.0;
/// The map's size, cells.
pub const MAP_CELLS: (u32, u32) = (240, 140);
/// The corridor begins at 0 and is so wide, metres.
const WIDTH_M: f64 = 6.0;
/// Rays see no farther, metres.
const REACH_M: f64 = 12.0;

/// A message of the recording.
#[derive(Clone, Debug)]
pub struct Message {
    pub topic: &'static str,
    pub kind: MessageType,
    /// When it was recorded, seconds.
    pub time_s: f64,
    pub data: Vec<u8>,
}

/// How the drive is recorded.
#[derive(Clone, Copy, Debug)]
pub struct Drive {
    /// Header time minus record time, seconds.
    pub skew_s: f64,
    /// So many times as fast as the recorder's goes the clock of the headers.
    pub speed: f64,
    pub range_min: f64,
    pub range_max: f64,
    /// What rays say that hit nothing.
    pub nothing: f32,
    /// The drive begins at this record time, seconds.
    pub begin_s: f64,
}

impl Default for Drive {
    fn default() -> Self {
        Self { skew_s: 0.0, speed: 1.0, range_min: 0.1, range_max: REACH_M, nothing: f32::INFINITY, begin_s: BEGIN_S }
    }
}

impl Drive {
    /// All messages in the order of their times.
    pub fn messages(&self) -> Vec<Message> {
        let mut messages = Vec::new();
        let put = |messages: &mut Vec<Message>, topic, kind, time_s, data| {
            messages.push(Message { topic, kind, time_s, data });
        };
        let mount = TransformSample::planar(self.begin_s + self.skew_s, "base_link", "laser", &Pose::default());
        put(&mut messages, "/tf_static", MessageType::Transforms, self.begin_s, tf_message(&[mount]));
        for tick in 0..=(10.0 * DRIVE_S) as u32 {
            let since_s = 0.1 * f64::from(tick);
            let (time_s, stamp_s) = (self.begin_s + since_s, self.begin_s + self.speed * since_s + self.skew_s);
            let pose = Pose::new(2.0 + WAY_M * since_s / DRIVE_S, 3.0, 0.0);
            let header = |frame: &str| Header { seq: tick, stamp: nanos(stamp_s), frame: frame.to_owned() };
            let both = [
                TransformSample::planar(stamp_s, "map", "odom", &Pose::default()),
                TransformSample::planar(stamp_s, "odom", "base_link", &pose),
            ];
            put(&mut messages, "/tf", MessageType::Transforms, time_s, tf_message(&both));
            if tick % 2 == 0 {
                let data = scan_message(&header("laser"), &self.scan(&pose), 0.1);
                put(&mut messages, "/scan", MessageType::Scan, time_s, data);
            }
            if tick % 20 == 0 {
                let data = map_message(&header("map"), &known());
                put(&mut messages, "/map", MessageType::Map, time_s, data);
            }
        }
        messages
    }

    fn scan(&self, pose: &Pose) -> LaserScan {
        let ray = |i: u32| {
            let (sin, cos) = f64::from(i).to_radians().sin_cos();
            let x_m = if cos > 0.0 { f64::INFINITY } else { -pose.x / cos };
            let y_m = if sin > 0.0 { (WIDTH_M - pose.y) / sin } else { -pose.y / sin };
            let range_m = x_m.abs().min(y_m.abs());
            if range_m > REACH_M { self.nothing } else { range_m as f32 }
        };
        LaserScan {
            stamp_s: 0.0,
            angle_min_rad: 0.0,
            angle_increment_rad: 1_f64.to_radians(),
            range_min_m: self.range_min,
            range_max_m: self.range_max,
            ranges_m: (0..360).map(ray).collect(),
        }
    }
}

/// The map: the first eight metres of the corridor.
fn known() -> OccupancyGrid {
    let info = GridInfo::new(MAP_CELLS.0, MAP_CELLS.1, 0.05, Pose::new(-0.5, -0.5, 0.0)).unwrap();
    let mut grid = OccupancyGrid::filled(info, -1);
    for index in 0..info.len() {
        let Cell { x, y } = info.cell(index);
        if (10..170).contains(&x) && (10..130).contains(&y) {
            let is_wall = x == 10 || y == 10 || y == 129;
            grid.set(Cell::new(x, y), if is_wall { 100 } else { 0 });
        }
    }
    grid
}

/// Writes a bag with the messages in the order in which they are given.
pub fn write(folder: &Path, name: &str, messages: &[Message]) -> PathBuf {
    let path = folder.join(name);
    let file = std::fs::File::create(&path).unwrap();
    let mut writer = BagWriter::new(file, Compression::None).unwrap();
    let mut numbers = std::collections::BTreeMap::new();
    for message in messages {
        let number = *numbers
            .entry(message.topic)
            .or_insert_with(|| writer.topic(message.topic, message.kind, message.topic.ends_with("static")));
        writer.write(number, nanos(message.time_s), &message.data).unwrap();
    }
    writer.finish().unwrap();
    path
}

/// A message of tf with one transform.
pub fn tf(time_s: f64, sample: &TransformSample) -> Message {
    Message { topic: "/tf", kind: MessageType::Transforms, time_s, data: tf_message(std::slice::from_ref(sample)) }
}
