//! A bag with the recorded map and transforms and with what we decided, for RViz.

use anyhow::Context;
use frontier_explorer::bag::{
    BagWriter, Compression, Connection, Header, MessageType, marker_message, nanos, path_message, pose_message,
};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Point;
use frontier_explorer::io::AtomicFile;
use frontier_explorer::replay::{Inputs, Tap};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::rc::Rc;

struct Inner {
    writer: Option<BagWriter<AtomicFile>>,
    /// Numbers of the recorded connections, by topic and publisher.
    copied: BTreeMap<(String, String), u32>,
    ours: [u32; 3],
    seq: u32,
    failed: Option<io::Error>,
}

/// The bag while it is written.
pub struct OutBag {
    inner: Rc<RefCell<Inner>>,
    inputs: Inputs,
}

impl OutBag {
    /// Begins it.
    pub fn create(path: &Path, inputs: &Inputs) -> anyhow::Result<Self> {
        let begin = || BagWriter::new(AtomicFile::create(path)?, Compression::Lz4);
        let mut writer = begin().with_context(|| format!("cannot write {}", path.display()))?;
        let ours = [
            writer.topic("/explore/frontiers", MessageType::Markers, true),
            writer.topic("/explore/goal", MessageType::Pose, true),
            writer.topic("/explore/path", MessageType::Path, true),
        ];
        let inner = Inner { writer: Some(writer), copied: BTreeMap::new(), ours, seq: 0, failed: None };
        Ok(Self { inner: Rc::new(RefCell::new(inner)), inputs: inputs.clone() })
    }

    /// Takes the recorded map, transforms and scans over.
    pub fn tap(&self) -> Tap {
        let (inner, inputs) = (Rc::clone(&self.inner), self.inputs.clone());
        Box::new(move |message| {
            let Connection { topic, kind, md5, caller, .. } = &**message.connection;
            let is_input = [&inputs.map_topic, &inputs.updates_topic, &inputs.scan_topic, &inputs.goal_topic]
                .into_iter()
                .any(|name| name.as_ref() == Some(topic));
            let known = MessageType::of(kind, md5);
            if !(is_input || matches!(known, Some(MessageType::Transforms | MessageType::Clock))) {
                return;
            }
            let Inner { writer, copied, failed, .. } = &mut *inner.borrow_mut();
            let Some(writer) = writer else { return };
            let key = (topic.clone(), caller.clone());
            let number = match copied.get(&key) {
                Some(&number) => number,
                None => {
                    let number = writer.connect((**message.connection).clone());
                    copied.insert(key, number);
                    number
                }
            };
            note(failed, writer.write(number, message.time, message.data));
        })
    }

    /// Writes the outcome of a decision.
    pub fn decided(&self, now_s: f64, explorer: &Explorer, edge_m: f64) {
        let Inner { writer, ours, seq, failed, .. } = &mut *self.inner.borrow_mut();
        let Some(writer) = writer else { return };
        *seq = seq.wrapping_add(1);
        let frame = self.inputs.map_frame.clone().unwrap_or_default();
        let header = Header { seq: *seq, stamp: nanos(now_s), frame };
        let points: Vec<Point> = explorer.frontiers().iter().flat_map(|f| &f.cells).copied().collect();
        let [frontiers, goal, path] = *ours;
        let mut put = |number: u32, data: &[u8]| {
            note(failed, writer.write(number, header.stamp, data));
        };
        put(frontiers, &marker_message(&header, "frontiers", edge_m, &points));
        if let Some(pose) = explorer.goal() {
            put(goal, &pose_message(&header, &pose));
        }
        if let Some(way) = explorer.path() {
            put(path, &path_message(&header, &way.poses));
        }
    }

    /// Closes it.
    pub fn finish(&self) -> anyhow::Result<()> {
        let mut inner = self.inner.borrow_mut();
        if let Some(error) = inner.failed.take() {
            return Err(error).context("cannot write the bag");
        }
        let Some(writer) = inner.writer.take() else { return Ok(()) };
        let file = writer.finish().context("cannot write the bag")?;
        file.commit().context("cannot write the bag")
    }
}

/// Remembers the first failure.
fn note(failed: &mut Option<io::Error>, result: io::Result<()>) {
    if let Err(error) = result {
        failed.get_or_insert(error);
    }
}
