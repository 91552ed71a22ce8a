//! What a bag holds, found by looking through all of it once.

use super::chunk::Compression;
use super::connections::Connection;
use super::content::Chunk;
use super::definitions::MessageType;
use super::message;
use super::reader::BagReader;
use super::{BagError, Nanos, seconds};
use crate::tf::frame_name;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};
use std::io::{Read, Seek};
use std::sync::Arc;

/// The most frames that are told apart for one topic, and of tf.
const MAX_FRAMES: usize = 4096;

/// Where a chunk lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChunkPlace {
    /// Where its record begins in the file.
    pub offset: u64,
    /// The time of its first message.
    pub start: Nanos,
}

/// What is recorded of one topic.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TopicSummary {
    /// Its name.
    pub topic: String,
    /// Its type.
    pub kind: String,
    /// The type's md5 sum.
    pub md5: String,
    /// The type, if it is one that this program reads.
    pub is_read: bool,
    /// How many publishers there were.
    pub connections: usize,
    /// Whether one of them latched.
    pub is_latching: bool,
    /// How many messages.
    pub messages: u64,
    /// Their bytes.
    pub bytes: u64,
    /// Time of the first message, seconds.
    pub first_s: f64,
    /// Time of the last message, seconds.
    pub last_s: f64,
    /// Messages a second, on average.
    pub rate_hz: f64,
    /// The longest time without a message between two, seconds.
    pub longest_gap_s: f64,
    /// When it began, seconds.
    pub longest_gap_at_s: f64,
    /// The frames of the headers, where the type is read.
    pub frames: BTreeSet<String>,
    /// Messages that are not what their type says.
    pub malformed: u64,
}

/// A frame and its parent in tf.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct FrameLink {
    /// The frame that it is expressed in.
    pub parent: String,
    /// Whether it came by `/tf_static`.
    pub is_static: bool,
    /// How many transforms.
    pub messages: u64,
}

/// What a bag holds.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// The file's length, bytes.
    pub bytes: u64,
    /// Whether the bag was closed properly.
    pub is_indexed: bool,
    /// Time of the first message.
    pub start: Nanos,
    /// Time of the last message.
    pub end: Nanos,
    /// How many messages.
    pub messages: u64,
    /// Chunks by their compression, with their bytes before and after.
    pub compression: BTreeMap<Compression, (u64, u64, u64)>,
    /// The connections by their numbers.
    pub connections: BTreeMap<u32, Arc<Connection>>,
    /// The topics in the order of their names; one row for each type.
    pub topics: Vec<TopicSummary>,
    /// The frames of tf with their parents.
    pub tf: BTreeMap<String, FrameLink>,
    /// Where the chunks lie, in the order of the file.
    pub chunks: Vec<ChunkPlace>,
    /// What is wrong with the file, a sentence each.
    pub problems: Vec<String>,
}

impl Summary {
    /// Looks through a bag.
    ///
    /// # Errors
    /// [`BagError`] when it is none, or cannot be read.
    pub fn of<R: Read + Seek>(input: R) -> Result<Self, BagError> {
        let mut reader = BagReader::new(input)?;
        let mut this = Self { bytes: reader.length(), ..Self::default() };
        let mut chunk = Chunk::default();
        let mut topics = Counts::default();
        while reader.next_chunk(&mut chunk)? {
            this.count(&chunk, reader.connections(), &mut topics);
        }
        this.is_indexed = reader.is_indexed();
        this.problems = reader.problems().to_vec();
        this.connections = reader.connections().clone();
        this.topics = topics.finish();
        if !this.is_indexed {
            this.problems.insert(0, "the bag was not closed: it has no index".to_owned());
        }
        if !this.problems.is_empty() {
            let until = format!("{} messages are read, up to {:.3} s", this.messages, this.duration_s());
            this.problems.push(until);
        }
        Ok(this)
    }

    /// From the first to the last message, seconds.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        seconds(self.end.saturating_sub(self.start))
    }

    /// The topics of one type that this program reads, those with most messages first.
    #[must_use]
    pub fn topics_of(&self, kind: MessageType) -> Vec<&TopicSummary> {
        let mut topics: Vec<_> =
            self.topics.iter().filter(|t| MessageType::of(&t.kind, &t.md5) == Some(kind)).collect();
        topics.sort_by(|a, b| b.messages.cmp(&a.messages).then(a.topic.cmp(&b.topic)));
        topics
    }

    fn count(&mut self, chunk: &Chunk, known: &BTreeMap<u32, Arc<Connection>>, topics: &mut Counts) {
        let (chunks, packed, raw) = self.compression.entry(chunk.compression).or_default();
        *chunks += 1;
        *packed += chunk.packed_bytes;
        *raw += chunk.len() as u64;
        let start = chunk.messages.iter().map(|message| message.time).min().unwrap_or_default();
        self.chunks.push(ChunkPlace { offset: chunk.offset, start });
        for message in &chunk.messages {
            let Some(connection) = known.get(&message.connection) else { continue };
            self.start = if self.messages == 0 { message.time } else { self.start.min(message.time) };
            self.end = self.end.max(message.time);
            self.messages += 1;
            let data = chunk.data(message);
            if let Some(counted) = topics.of(message.connection, connection) {
                counted.count(message.time, data, &mut self.tf);
            }
        }
    }
}

/// The topics while they are counted; the connections of one topic and type are one.
#[derive(Default)]
struct Counts {
    topics: Vec<Counted>,
    by_connection: BTreeMap<u32, usize>,
}

impl Counts {
    fn of(&mut self, number: u32, connection: &Connection) -> Option<&mut Counted> {
        let index = match self.by_connection.get(&number) {
            Some(&index) => index,
            None => {
                let is_it = |t: &Counted| t.summary.topic == connection.topic && t.summary.md5 == connection.md5;
                let index = self.topics.iter().position(is_it).unwrap_or_else(|| {
                    self.topics.push(Counted::new(connection));
                    self.topics.len() - 1
                });
                self.by_connection.insert(number, index);
                if let Some(counted) = self.topics.get_mut(index) {
                    counted.summary.connections += 1;
                    counted.summary.is_latching |= connection.is_latching;
                }
                index
            }
        };
        self.topics.get_mut(index)
    }

    fn finish(self) -> Vec<TopicSummary> {
        let mut topics: Vec<_> = self.topics.into_iter().map(|counted| counted.summary).collect();
        for topic in &mut topics {
            let span_s = topic.last_s - topic.first_s;
            topic.rate_hz = if span_s > 0.0 { topic.messages.saturating_sub(1) as f64 / span_s } else { 0.0 };
        }
        topics.sort_by(|a, b| (&a.topic, &a.md5).cmp(&(&b.topic, &b.md5)));
        topics
    }
}

/// A topic while it is counted.
struct Counted {
    kind: Option<MessageType>,
    last: Option<Nanos>,
    summary: TopicSummary,
}

impl Counted {
    fn new(connection: &Connection) -> Self {
        let kind = MessageType::of(&connection.kind, &connection.md5);
        let summary = TopicSummary {
            topic: connection.topic.clone(),
            kind: connection.kind.clone(),
            md5: connection.md5.clone(),
            is_read: kind.is_some(),
            ..TopicSummary::default()
        };
        Self { kind, last: None, summary }
    }

    fn count(&mut self, time: Nanos, data: &[u8], tf: &mut BTreeMap<String, FrameLink>) {
        let summary = &mut self.summary;
        let time_s = seconds(time);
        if summary.messages == 0 {
            (summary.first_s, summary.last_s) = (time_s, time_s);
        }
        summary.first_s = summary.first_s.min(time_s);
        summary.last_s = summary.last_s.max(time_s);
        if let Some(last) = self.last {
            let gap_s = seconds(time.saturating_sub(last));
            if gap_s > summary.longest_gap_s {
                (summary.longest_gap_s, summary.longest_gap_at_s) = (gap_s, seconds(last));
            }
        }
        self.last = Some(time);
        summary.messages += 1;
        summary.bytes += data.len() as u64;
        match self.kind {
            Some(MessageType::Transforms) => {
                let is_static = summary.topic.ends_with("tf_static");
                summary.malformed += u64::from(!count_transforms(data, is_static, tf));
            }
            Some(kind) if kind.has_header() => match message::header(data) {
                Ok(header) if summary.frames.len() < MAX_FRAMES && !summary.frames.contains(&header.frame) => {
                    summary.frames.insert(header.frame);
                }
                Ok(_) => {}
                Err(_) => summary.malformed += 1,
            },
            _ => {}
        }
    }
}

fn count_transforms(data: &[u8], is_static: bool, tf: &mut BTreeMap<String, FrameLink>) -> bool {
    let Ok(samples) = message::transforms(data) else { return false };
    for sample in samples {
        let (parent, child) = (frame_name(&sample.parent), frame_name(&sample.child));
        if tf.len() >= MAX_FRAMES && !tf.contains_key(child) {
            continue;
        }
        let link = tf.entry(child.to_owned()).or_default();
        if link.parent != parent {
            parent.clone_into(&mut link.parent);
        }
        link.is_static = is_static;
        link.messages += 1;
    }
    true
}
