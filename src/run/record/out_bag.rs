//! A bag with the recorded map and transforms and with what we decided, for RViz.

use super::RecordError;
use super::bag_file::BagFile;
use crate::bag::{
    Connection, Header, MessageType, Nanos, PlayedMessage, map_message, marker_message, nanos, path_message,
    pose_message, seconds, tf_message,
};
use crate::explore::Decision;
use crate::geometry::{Point, Pose};
use crate::grid::OccupancyGrid;
use crate::replay::{Inputs, ScanMapping, Tap};
use crate::tf::TransformSample;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// The frame of a map that is made here: no recording has it.
const MADE_FRAME: &str = "frontier_map";

struct Inner {
    file: BagFile,
    /// The bag's begin.
    begin: Nanos,
    inputs: Inputs,
    /// Numbers of the recorded connections, by topic and publisher.
    copied: BTreeMap<(String, String), u32>,
    seq: u32,
}

/// The bag while it is written: what is played comes by its tap.
pub struct OutBag {
    inner: Rc<RefCell<Inner>>,
    frontiers: u32,
    goal: u32,
    path: u32,
    /// The topics of a map that is made here, and of where odometry lies in it.
    made: Option<(u32, u32)>,
}

impl OutBag {
    /// Begins the bag of a replay of these inputs, whose recording begins at `begin`.
    ///
    /// # Errors
    /// [`RecordError::Write`] with the file.
    pub fn create(path: &Path, inputs: &Inputs, begin: Nanos) -> Result<Self, RecordError> {
        let mut file = BagFile::create(path)?;
        let (frontiers, goal, path) = (
            file.topic("/explore/frontiers", MessageType::Markers, true),
            file.topic("/explore/goal", MessageType::Pose, true),
            file.topic("/explore/path", MessageType::Path, true),
        );
        let is_made = inputs.map_topic.is_none();
        let made = is_made
            .then(|| (file.topic("/map", MessageType::Map, true), file.topic("/tf", MessageType::Transforms, false)));
        let inner = Inner { file, begin, inputs: inputs.clone(), copied: BTreeMap::new(), seq: 0 };
        Ok(Self { inner: Rc::new(RefCell::new(inner)), frontiers, goal, path, made })
    }

    /// Takes the recorded map, transforms and scans over.
    #[must_use]
    pub fn tap(&self) -> Tap {
        let inner = Rc::clone(&self.inner);
        Box::new(move |message| inner.borrow_mut().copy(message))
    }

    /// Writes the outcome of a decision.
    pub(super) fn decided(&self, now_s: f64, decision: &Decision, goal: Option<Pose>, edge_m: f64) {
        let Inner { file, begin, inputs, seq, .. } = &mut *self.inner.borrow_mut();
        *seq = seq.wrapping_add(1);
        let frame =
            if self.made.is_some() { MADE_FRAME.to_owned() } else { inputs.map_frame.clone().unwrap_or_default() };
        let header = Header { seq: *seq, stamp: *begin + nanos(now_s), frame };
        let points: Vec<Point> = decision.frontiers.cells().collect();
        file.put(self.frontiers, header.stamp, &marker_message(&header, "frontiers", edge_m, &points));
        if let Some(pose) = goal {
            file.put(self.goal, header.stamp, &pose_message(&header, &pose));
        }
        if let Some(way) = &decision.path {
            file.put(self.path, header.stamp, &path_message(&header, &way.poses));
        }
    }

    /// Writes the map that is made here.
    pub(super) fn mapped(&self, now_s: f64, mapping: &ScanMapping, grid: &OccupancyGrid) {
        let (Some((map, tf)), Inner { file, begin, inputs, seq, .. }) = (self.made, &mut *self.inner.borrow_mut())
        else {
            return;
        };
        *seq = seq.wrapping_add(1);
        let header = Header { seq: *seq, stamp: *begin + nanos(now_s), frame: MADE_FRAME.to_owned() };
        file.put(map, header.stamp, &map_message(&header, grid));
        let odom = inputs.odom_frame.clone().unwrap_or_default();
        // Below odometry, as a frame has one parent: a recorded map may be above it.
        let map_in_odom =
            TransformSample::planar(seconds(header.stamp), &odom, MADE_FRAME, &mapping.odom_in_map().inverse());
        file.put(tf, header.stamp, &tf_message(&[map_in_odom]));
    }

    /// Closes it.
    pub(super) fn finish(&self) -> Result<(), RecordError> {
        self.inner.borrow_mut().file.finish()
    }
}

impl Inner {
    /// Takes over a message of an input.
    fn copy(&mut self, message: &PlayedMessage<'_>) {
        let Connection { topic, kind, md5, caller, .. } = &**message.connection;
        let Inputs { map_topic, updates_topic, scan_topic, goal_topic, results_topic, .. } = &self.inputs;
        let is_input = [map_topic, updates_topic, scan_topic, goal_topic, results_topic]
            .into_iter()
            .any(|name| name.as_ref() == Some(topic));
        let known = MessageType::of(kind, md5);
        if !(is_input || matches!(known, Some(MessageType::Transforms | MessageType::Clock))) {
            return;
        }
        let key = (topic.clone(), caller.clone());
        let number = match self.copied.get(&key) {
            Some(&number) => number,
            None => {
                let number = self.file.connect((**message.connection).clone());
                self.copied.insert(key, number);
                number
            }
        };
        self.file.put(number, message.time, message.data);
    }
}
