//! ROS 1 bags (format 2.0): reading, writing, and the messages in them that exploration
//! needs (the rim).
//!
//! Two readers stand behind one trait, [`BagReader`]: the `rosbag` crate for bags that are
//! whole, a scanner for what is cut, damaged or still being written. Nothing here needs ROS,
//! and only [`open_bag`] looks at a file; a scanner's bytes come from any [`std::io::Read`]
//! with [`std::io::Seek`]. Whatever the bytes say, nothing panics, hangs or takes more memory
//! than a chunk and an index: lengths are believed only as far as bytes are there.

mod action;
mod chunk;
mod connections;
mod content;
mod cursor;
mod definitions;
mod encode;
mod indexed;
mod input;
mod layout;
mod links;
mod message;
mod open;
mod playback;
mod problems;
mod reader;
mod record;
mod scanner;
mod skew;
mod span;
mod summary;
mod topics;
mod writer;

pub use action::{GoalMessage, ResultMessage, goal, result};
pub use chunk::Compression;
pub use connections::Connection;
pub use content::{Chunk, ChunkMessage};
pub use cursor::Malformed;
pub use definitions::MessageType;
pub use encode::{
    clock_message, goal_message, map_message, marker_message, odometry_message, path_message, pose_message,
    result_message, scan_message, tf_message,
};
pub use links::FrameLink;
pub use message::{
    Header, MapMessage, Odometry, PatchMessage, ScanMessage, StampedPose, clock, header, map, odometry, patch, path,
    pose, scan, transforms,
};
pub use open::open_bag;
pub use playback::{Playback, PlayedMessage};
pub use reader::{BagError, BagReader};
pub use scanner::BagScanner;
pub use skew::Skew;
pub use summary::{ChunkPlace, Summary};
pub use topics::TopicSummary;
pub use writer::BagWriter;

/// Nanoseconds since 1970, as bags count time.
pub type Nanos = u64;

/// Nanoseconds in seconds.
#[must_use]
pub fn seconds(nanos: Nanos) -> f64 {
    (nanos / 1_000_000_000) as f64 + (nanos % 1_000_000_000) as f64 * 1e-9
}

/// Seconds in nanoseconds, as far as a ROS time reaches: from 0 to 2^32 s.
#[must_use]
pub fn nanos(seconds: f64) -> Nanos {
    let whole = seconds.clamp(0.0, f64::from(u32::MAX)).floor();
    let rest = ((seconds - whole).clamp(0.0, 1.0) * 1e9).round();
    whole as u64 * 1_000_000_000 + rest as u64
}

#[cfg(test)]
mod tests;
