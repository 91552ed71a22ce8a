//! What a bag holds, found by looking through all of it once.

use super::chunk::Compression;
use super::connections::Connection;
use super::content::Chunk;
use super::definitions::MessageType;
use super::links::{FrameLink, Links, Tree};
use super::reader::BagReader;
use super::span::Span;
use super::topics::{TopicSummary, Topics};
use super::{BagError, Nanos, seconds};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A stray this near to the rest is not worth a word, seconds.
const NEAR_S: f64 = 1.0;

/// Where a chunk lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChunkPlace {
    /// Where its record begins in the file.
    pub offset: u64,
    /// The time of its first message.
    pub start: Nanos,
}

/// What a bag holds.
#[derive(Clone, Debug, Default)]
pub struct Summary {
    /// The file's length, bytes.
    pub bytes: u64,
    /// Whether the bag was closed properly.
    pub is_indexed: bool,
    /// Time of the first message; messages at times that cannot be do not count.
    pub start: Nanos,
    /// Time of the last message, likewise.
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
    /// Frames and parents that are ignored, as they would make a circle of the tree.
    pub circular: BTreeSet<(String, String)>,
    /// Where the chunks lie, in the order of the file.
    pub chunks: Vec<ChunkPlace>,
    /// What is wrong with the file, a sentence each.
    pub problems: Vec<String>,
    /// What is odd about the messages, a sentence each.
    pub notes: Vec<String>,
}

impl Summary {
    /// Looks through a bag.
    ///
    /// # Errors
    /// [`BagError`] when the file cannot be read.
    pub fn of(reader: &mut dyn BagReader) -> Result<Self, BagError> {
        let mut this = Self { bytes: reader.length(), ..Self::default() };
        let mut chunk = Chunk::default();
        let (mut topics, mut links, mut span) = (Topics::default(), Links::default(), Span::default());
        while reader.next_chunk(&mut chunk)? {
            this.count(&chunk, reader.connections(), &mut topics, &mut links, &mut span);
        }
        this.is_indexed = reader.is_indexed();
        this.problems = reader.problems().to_vec();
        this.connections = reader.connections().clone();
        let body = span.body().unwrap_or_default();
        (this.start, this.end) = (body.start, body.end);
        this.topics = topics.finish(&body);
        Tree { links: this.tf, circular: this.circular, notes: this.notes } = links.finish();
        if let Some((messages, time)) = body.strays {
            let away_s = seconds(time.abs_diff(if time < body.start { body.start } else { body.end }));
            if away_s > NEAR_S {
                this.notes.push(format!(
                    "{messages} messages were recorded at times that cannot be, the farthest at {:.3} s, {away_s:.0} s \
                     away from the rest: they are taken as recorded at the {}",
                    seconds(time),
                    if time < body.start { "begin" } else { "end" },
                ));
            }
        }
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

    /// All sentences about what is wrong or odd.
    pub fn warnings(&self) -> impl Iterator<Item = &String> {
        self.problems.iter().chain(&self.notes)
    }

    fn count(
        &mut self,
        chunk: &Chunk,
        known: &BTreeMap<u32, Arc<Connection>>,
        topics: &mut Topics,
        links: &mut Links,
        span: &mut Span,
    ) {
        let (chunks, packed, raw) = self.compression.entry(chunk.compression).or_default();
        *chunks += 1;
        *packed += chunk.packed_bytes;
        *raw += chunk.unpacked_bytes();
        let start = chunk.messages.iter().map(|message| message.time).min().unwrap_or_default();
        self.chunks.push(ChunkPlace { offset: chunk.offset, start });
        for message in &chunk.messages {
            let Some(connection) = known.get(&message.connection) else { continue };
            span.add(message.time);
            self.messages += 1;
            if let Some(topic) = topics.of(message.connection, connection) {
                topic.count(message.time, chunk.data(message), links);
            }
        }
    }
}
