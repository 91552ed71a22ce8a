//! What is known at a moment of a recording: map, frames, newest scan, goals.

use super::Inputs;
use super::clock::Clock;
use super::faults::Faults;
use super::frames::Frames;
use super::goals::RecordedGoals;
use super::scans::{ScanMapping, on_robot};
use super::told::Told;
use crate::bag::{
    BagError, BagReader, Nanos, Playback, PlayedMessage, ScanMessage, StampedPose, Summary, nanos, seconds,
};
use crate::geometry::Pose;
use crate::grid::{Live, OccupancyGrid};
use crate::mapping::{BuilderConfig, MapperError};
use crate::robot::{MapSnapshot, PoseError};
use crate::scan::LaserScan;
use crate::tf::{frame_name, planar, upright};
use std::sync::Arc;

/// From one map that is made of scans to the next, seconds at the least.
const MAP_PERIOD_S: f64 = 1.0;

/// Is handed every message as it is played.
pub type Tap = Box<dyn FnMut(&PlayedMessage<'_>)>;

/// Why a recording cannot be played on.
#[derive(Debug, thiserror::Error)]
pub enum PlayError {
    /// The file.
    #[error(transparent)]
    Bag(#[from] BagError),
    /// The map that is made of its scans.
    #[error("cannot make a map of the scans: {0}")]
    Map(#[from] MapperError),
}

/// Plays a bag and keeps what it says. All times are seconds since the bag's begin.
pub struct Player {
    playback: Playback,
    /// The bag's begin, seconds since 1970.
    begin_s: f64,
    inputs: Inputs,
    frames: Frames,
    /// The newest map with its stamp, seconds.
    map: Option<(f64, Live<OccupancyGrid>)>,
    scan: Option<ScanMessage>,
    goals: RecordedGoals,
    /// Makes the map where the recording has none.
    mapping: Option<ScanMapping>,
    faults: Faults,
    tap: Option<Tap>,
}

impl Player {
    /// Before the first message.
    #[must_use]
    pub fn new(reader: Box<dyn BagReader>, summary: &Summary, inputs: Inputs) -> Self {
        Self {
            playback: Playback::new(reader, summary),
            begin_s: seconds(summary.start),
            goals: RecordedGoals::new(inputs.results_topic.is_some()),
            mapping: None,
            frames: Frames::new(summary, Clock::of(summary, &inputs)),
            inputs,
            map: None,
            scan: None,
            faults: Faults::default(),
            tap: None,
        }
    }

    /// Hands every message that is played to somebody else too.
    pub fn set_tap(&mut self, tap: Tap) {
        self.tap = Some(tap);
    }

    /// Makes a map of the scans from now on, and does not look at recorded ones. Without
    /// odometry there will be none.
    pub fn map_scans(&mut self, config: BuilderConfig, summary: &Summary) {
        self.mapping = ScanMapping::new(config, &self.inputs);
        self.inputs.forget_map();
        self.frames.clock = Clock::of(summary, &self.inputs);
    }

    /// Plays all messages up to a time, but no further than a map or a result:
    /// those wake the node too. The time that was reached.
    ///
    /// # Errors
    /// [`PlayError`] when the bag cannot be read, or mapped.
    pub fn play_to(&mut self, until_s: f64) -> Result<f64, PlayError> {
        let until = nanos(self.begin_s + until_s);
        while let Some(time) = self.playback.peek()?.filter(|&time| time <= until) {
            if self.play_one()? {
                return Ok(self.since_begin_s(time));
            }
        }
        if self.playback.peek()?.is_none() {
            self.take_scans(until_s, f64::INFINITY)?;
        }
        Ok(until_s)
    }

    /// When the next message was recorded; `None` at the end.
    ///
    /// # Errors
    /// [`PlayError`] when the bag cannot be read.
    pub fn next_time_s(&mut self) -> Result<Option<f64>, PlayError> {
        Ok(self.playback.peek()?.map(|time| self.since_begin_s(time)))
    }

    /// Plays one message; whether it is news that the node would wake for.
    fn play_one(&mut self) -> Result<bool, PlayError> {
        let Some(message) = self.playback.next_message()? else { return Ok(false) };
        if let Some(tap) = &mut self.tap {
            tap(&message);
        }
        let told = Told::of(&self.inputs, message.connection, message.data);
        let (time_s, is_stray) = (seconds(message.time) - self.begin_s, message.is_stray);
        let topic = Arc::clone(message.connection);
        match told {
            None => Ok(false),
            Some(Ok(told)) => {
                let is_news = matches!(told, Told::Map(_) | Told::Patch(_) | Told::Result(_));
                self.learn(told, &topic.topic, time_s, is_stray)?;
                Ok(is_news)
            }
            Some(Err(error)) => {
                self.faults.count(&topic.topic, error);
                Ok(false)
            }
        }
    }

    fn learn(&mut self, told: Told, topic: &str, time_s: f64, is_stray: bool) -> Result<(), PlayError> {
        match told {
            Told::Transforms { samples, is_static: true } => self.frames.learn_fixed(&samples),
            Told::Transforms { samples, .. } => {
                if let Err(reason) = self.frames.learn_moving(samples, time_s, is_stray) {
                    self.faults.count(topic, reason);
                }
            }
            Told::Map(message) => {
                let stamp_s = self.stamp_s(message.header.stamp, time_s);
                self.take_map(stamp_s, message.grid);
            }
            Told::Patch(message) => {
                let stamp_s = self.stamp_s(message.header.stamp, time_s);
                if let Some((map_s, map)) = &mut self.map {
                    match map.apply(&message.patch) {
                        Ok(()) => *map_s = stamp_s,
                        Err(error) => self.faults.count(topic, error),
                    }
                }
            }
            Told::Scan(message) => self.learn_scan(message, time_s)?,
            Told::Goal(message) => {
                let StampedPose { header, pose } = message.target;
                if let Some(goal) = self.in_map(&header.frame, &pose) {
                    let robot = self.pose(time_s).ok();
                    self.goals.begin(time_s, message.id, goal, robot);
                }
            }
            Told::Result(message) => self.goals.end(time_s, &message.id, message.status, message.text),
        }
        Ok(())
    }

    fn since_begin_s(&self, time: Nanos) -> f64 {
        seconds(time) - self.begin_s
    }

    /// A whole map comes.
    fn take_map(&mut self, stamp_s: f64, grid: OccupancyGrid) {
        let mut live = self.map.take().map(|(_, live)| live);
        Live::renew(&mut live, Arc::new(grid));
        self.map = live.map(|live| (stamp_s, live));
    }

    /// Keeps a scan, and takes it into the map that is made here.
    fn learn_scan(&mut self, mut message: ScanMessage, time_s: f64) -> Result<(), PlayError> {
        message.scan.stamp_s -= self.begin_s + self.frames.clock.scans_s();
        if let Some(mapping) = &mut self.mapping {
            let now_s = self.frames.now_s(time_s);
            let taken = mapping.add(message.clone(), &self.frames.transforms, now_s)?;
            self.show_mapped(taken, time_s);
        }
        self.scan = Some(message);
        Ok(())
    }

    /// Takes in the scans that still wait, at a time by the clock of the stamps.
    fn take_scans(&mut self, time_s: f64, now_s: f64) -> Result<(), PlayError> {
        if let Some(mapping) = &mut self.mapping {
            let taken = mapping.settle(&self.frames.transforms, now_s)?;
            self.show_mapped(taken, time_s);
        }
        Ok(())
    }

    /// Shows the map that is made here, if it grew and its time has come.
    fn show_mapped(&mut self, taken: usize, time_s: f64) {
        let is_due = self.map.as_ref().is_none_or(|(map_s, _)| time_s - map_s >= MAP_PERIOD_S);
        if taken > 0
            && is_due
            && let Some(grid) = self.mapping.as_ref().and_then(ScanMapping::map)
        {
            self.take_map(time_s, grid);
        }
    }

    /// The time of a header by the recording's clock where that can be, else when it was
    /// recorded.
    fn stamp_s(&self, header: Nanos, recorded_s: f64) -> f64 {
        let header_s = self.since_begin_s(header) - self.frames.clock.offset_s();
        if (0.0..=30.0).contains(&(recorded_s - header_s)) { header_s } else { recorded_s }
    }

    fn in_map(&self, frame: &str, pose: &Pose) -> Option<Pose> {
        let map_frame = self.inputs.map_frame.as_deref()?;
        if frame_name(frame) == frame_name(map_frame) || frame.is_empty() {
            return Some(self.corrected(*pose));
        }
        let there = self.frames.transforms.latest(map_frame, frame).ok()?;
        Some(self.corrected(planar(&(there.transform * upright(pose)))))
    }

    /// A pose by tf as it is in the map: another one only where the map is made here.
    fn corrected(&self, pose: Pose) -> Pose {
        self.mapping.as_ref().map_or(pose, |mapping| mapping.odom_in_map().compose(&pose))
    }

    /// Where the robot was, as tf told it until a time.
    ///
    /// # Errors
    /// [`PoseError`] when no transform leads there, or the newest is too old.
    pub fn pose(&self, now_s: f64) -> Result<Pose, PoseError> {
        let name = |frame: &Option<String>| frame.clone().unwrap_or_else(|| "(none)".to_owned());
        let (map_frame, base_frame) = (name(&self.inputs.map_frame), name(&self.inputs.base_frame));
        let newest = self.frames.robot(&map_frame, &base_frame, now_s)?;
        Ok(self.corrected(planar(&newest.transform)))
    }

    /// The newest map.
    #[must_use]
    pub fn map(&self) -> Option<MapSnapshot> {
        let (stamp_s, map) = self.map.as_ref()?;
        let (grid, changes) = (Arc::clone(map.newest()), map.changes().clone());
        Some(MapSnapshot { stamp_s: *stamp_s, grid, changes, costmap: None })
    }

    /// The map so far, for who wants to change nothing.
    #[must_use]
    pub fn grid(&self) -> Option<&Arc<OccupancyGrid>> {
        self.map.as_ref().map(|(_, map)| map.newest())
    }

    /// The goals of the recording so far.
    #[must_use]
    pub const fn goals(&self) -> &RecordedGoals {
        &self.goals
    }

    /// The map under way where it is made of the scans.
    #[must_use]
    pub const fn mapping(&self) -> Option<&ScanMapping> {
        self.mapping.as_ref()
    }

    /// The newest scan where its lidar was in the map frame.
    #[must_use]
    pub fn scan(&self, robot_in_map: &Pose) -> Option<(Pose, Arc<LaserScan>)> {
        let base = self.inputs.base_frame.as_deref()?;
        let (mount, scan) = on_robot(&self.frames.transforms, base, self.scan.as_ref()?).ok()?;
        Some((robot_in_map.compose(&mount), Arc::new(scan)))
    }

    /// Messages so far that could not be used.
    #[must_use]
    pub const fn faults(&self) -> &Faults {
        &self.faults
    }

    /// The inputs that are played.
    #[must_use]
    pub const fn inputs(&self) -> &Inputs {
        &self.inputs
    }
}
