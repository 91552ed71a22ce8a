//! What is known at a moment of a recording: map, frames, newest scan, goals.

use super::Inputs;
use crate::bag::{
    BagError, MessageType, Nanos, Playback, PlayedMessage, ScanMessage, Summary, goal, map, nanos, patch, pose, scan,
    seconds, transforms,
};
use crate::geometry::Pose;
use crate::grid::OccupancyGrid;
use crate::robot::{MapSnapshot, PoseError};
use crate::scan::LaserScan;
use crate::tf::{TransformBuffer, frame_name, is_upside_down, planar, upright};
use std::io::{Read, Seek};
use std::sync::Arc;

/// How far back transforms are remembered, seconds.
const HISTORY_S: f64 = 10.0;
/// A transform that is older than this is not believed, seconds.
const TOLERANCE_S: f64 = 0.5;
/// Headers of another clock than the recorder's differ by more than this, seconds.
const CLOCKS_DIFFER_S: f64 = 5.0;

/// Is handed every message as it is played.
pub type Tap = Box<dyn FnMut(&PlayedMessage<'_>)>;

/// A goal that the recording was sent to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedGoal {
    /// When, seconds of the bag.
    pub time_s: f64,
    /// Where to, in the map frame.
    pub goal_in_map: Pose,
}

/// Plays a bag and keeps what it says.
pub struct Player<R> {
    playback: Playback<R>,
    inputs: Inputs,
    transforms: TransformBuffer,
    /// Header time minus recorded time, seconds, where the clocks differ.
    offset_s: Option<f64>,
    map: Option<MapSnapshot>,
    scan: Option<ScanMessage>,
    goals: Vec<RecordedGoal>,
    malformed: u64,
    tap: Option<Tap>,
}

impl<R: Read + Seek> Player<R> {
    /// Before the first message.
    ///
    /// # Errors
    /// [`BagError`] when the bag cannot be read.
    pub fn new(input: R, summary: &Summary, inputs: Inputs) -> Result<Self, BagError> {
        Ok(Self {
            playback: Playback::new(input, summary)?,
            inputs,
            transforms: TransformBuffer::new(HISTORY_S),
            offset_s: None,
            map: None,
            scan: None,
            goals: Vec::new(),
            malformed: 0,
            tap: None,
        })
    }

    /// Hands every message that is played to somebody else too.
    pub fn set_tap(&mut self, tap: Tap) {
        self.tap = Some(tap);
    }

    /// Plays all messages up to a time in seconds; false when none is left after it.
    ///
    /// # Errors
    /// [`BagError`] when the bag cannot be read.
    pub fn play_to(&mut self, until_s: f64) -> Result<bool, BagError> {
        let until = nanos(until_s);
        loop {
            match self.playback.peek()? {
                None => return Ok(false),
                Some(time) if time > until => return Ok(true),
                Some(_) => self.play_one()?,
            }
        }
    }

    /// Plays on to the next scan, and takes it; `None` at the end.
    ///
    /// # Errors
    /// [`BagError`] when the bag cannot be read.
    pub fn next_scan(&mut self) -> Result<Option<ScanMessage>, BagError> {
        self.scan = None;
        while self.playback.peek()?.is_some() {
            self.play_one()?;
            if let Some(scan) = self.scan.take() {
                return Ok(Some(scan));
            }
        }
        Ok(None)
    }

    fn play_one(&mut self) -> Result<(), BagError> {
        let Some(message) = self.playback.next_message()? else { return Ok(()) };
        if let Some(tap) = &mut self.tap {
            tap(&message);
        }
        let PlayedMessage { connection, time, data } = message;
        let (topic, time_s) = (Some(&connection.topic), seconds(time));
        let is_understood = match MessageType::of(&connection.kind, &connection.md5) {
            Some(MessageType::Transforms) => take_transforms(
                &mut self.transforms,
                &mut self.offset_s,
                connection.topic.ends_with("tf_static"),
                time,
                data,
            ),
            Some(MessageType::Map) if topic == self.inputs.map_topic.as_ref() => match map(data) {
                Ok(message) => {
                    let stamp_s = believable(seconds(message.header.stamp) - self.offset_s.unwrap_or(0.0), time_s);
                    self.map = Some(MapSnapshot { stamp_s, grid: Arc::new(message.grid), costmap: None });
                    true
                }
                Err(_) => false,
            },
            Some(MessageType::MapUpdate) if topic == self.inputs.updates_topic.as_ref() => match patch(data) {
                Ok(message) => match &mut self.map {
                    Some(map) => {
                        map.stamp_s = believable(seconds(message.header.stamp) - self.offset_s.unwrap_or(0.0), time_s);
                        Arc::make_mut(&mut map.grid).apply(&message.patch).is_ok()
                    }
                    None => true,
                },
                Err(_) => false,
            },
            Some(MessageType::Scan) if topic == self.inputs.scan_topic.as_ref() => match scan(data) {
                Ok(message) => {
                    self.scan = Some(message);
                    true
                }
                Err(_) => false,
            },
            Some(kind @ (MessageType::Goal | MessageType::Pose)) if topic == self.inputs.goal_topic.as_ref() => {
                match if kind == MessageType::Goal { goal(data) } else { pose(data) } {
                    Ok(stamped) => {
                        let frame = stamped.header.frame;
                        if let Some(goal_in_map) = self.in_map(&frame, &stamped.pose) {
                            self.goals.push(RecordedGoal { time_s, goal_in_map });
                        }
                        true
                    }
                    Err(_) => false,
                }
            }
            _ => true,
        };
        self.malformed += u64::from(!is_understood);
        Ok(())
    }

    fn in_map(&self, frame: &str, pose: &Pose) -> Option<Pose> {
        let map_frame = self.inputs.map_frame.as_deref()?;
        if frame_name(frame) == frame_name(map_frame) || frame.is_empty() {
            return Some(*pose);
        }
        let there = self.transforms.latest(map_frame, frame).ok()?;
        Some(planar(&(there.transform * upright(pose))))
    }

    /// Where the robot was, as tf told it until a time in seconds.
    ///
    /// # Errors
    /// [`PoseError`] when no transform leads there, or the newest is too old.
    pub fn pose(&self, now_s: f64) -> Result<Pose, PoseError> {
        let name = |frame: &Option<String>| frame.clone().unwrap_or_else(|| "(none)".to_owned());
        let (map_frame, base_frame) = (name(&self.inputs.map_frame), name(&self.inputs.base_frame));
        match self.transforms.latest(&map_frame, &base_frame) {
            Err(why) => Err(PoseError::NotYet { map_frame, base_frame, why: why.to_string() }),
            Ok(newest) => {
                let age_s = now_s + self.offset_s.unwrap_or(0.0) - newest.stamp_s;
                if age_s > TOLERANCE_S {
                    return Err(PoseError::Stale { map_frame, base_frame, age_s, limit_s: TOLERANCE_S });
                }
                Ok(planar(&newest.transform))
            }
        }
    }

    /// A scan seen from the robot: where the lidar stands on it, and the scan turned upright.
    /// `None` when tf does not lead there.
    #[must_use]
    pub fn on_robot(&self, message: &ScanMessage) -> Option<(Pose, LaserScan)> {
        let base = self.inputs.base_frame.as_deref()?;
        let mount = self.transforms.latest(base, &message.header.frame).ok()?.transform;
        let mut scan = message.scan.clone();
        if is_upside_down(&mount) {
            (scan.angle_min_rad, scan.angle_increment_rad) = (-scan.angle_min_rad, -scan.angle_increment_rad);
        }
        Some((planar(&mount), scan))
    }

    /// Where the robot was at the time of a header, in a frame; `None` where tf does not know.
    #[must_use]
    pub fn robot_at(&self, frame: &str, stamp_s: f64) -> Option<Pose> {
        let base = self.inputs.base_frame.as_deref()?;
        self.transforms.at(frame, base, stamp_s).ok().map(|transform| planar(&transform))
    }

    /// The newest map.
    #[must_use]
    pub const fn map(&self) -> Option<&MapSnapshot> {
        self.map.as_ref()
    }

    /// The map so far, for who wants to change nothing.
    #[must_use]
    pub fn grid(&self) -> Option<&Arc<OccupancyGrid>> {
        self.map.as_ref().map(|map| &map.grid)
    }

    /// The goals of the recording so far.
    #[must_use]
    pub fn goals(&self) -> &[RecordedGoal] {
        &self.goals
    }

    /// The newest scan where its lidar was in the map frame.
    #[must_use]
    pub fn scan(&self, robot_in_map: &Pose) -> Option<(Pose, Arc<LaserScan>)> {
        let (mount, scan) = self.on_robot(self.scan.as_ref()?)?;
        Some((robot_in_map.compose(&mount), Arc::new(scan)))
    }

    /// Messages so far that were not what their types say, or updates that did not fit.
    #[must_use]
    pub const fn malformed(&self) -> u64 {
        self.malformed
    }
}

fn take_transforms(
    buffer: &mut TransformBuffer,
    offset_s: &mut Option<f64>,
    is_static: bool,
    time: Nanos,
    data: &[u8],
) -> bool {
    let Ok(samples) = transforms(data) else { return false };
    for sample in &samples {
        if !is_static && sample.stamp_s > 0.0 {
            let difference_s = sample.stamp_s - seconds(time);
            offset_s.get_or_insert(if difference_s.abs() > CLOCKS_DIFFER_S { difference_s } else { 0.0 });
        }
        // What cannot be a transform is left out, as tf2 does.
        let _ = buffer.insert(sample, is_static);
    }
    true
}

/// The time of a header where that can be, else that of the recording.
fn believable(header_s: f64, recorded_s: f64) -> f64 {
    if (0.0..=30.0).contains(&(recorded_s - header_s)) { header_s } else { recorded_s }
}
