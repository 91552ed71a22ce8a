//! The messages of a bag in the order of their times.
//!
//! In the file they stand as they were written, and chunks can overlap: a chunk is opened
//! when the times that it begins with have come.

use super::connections::Connection;
use super::content::Chunk;
use super::reader::BagReader;
use super::summary::{ChunkPlace, Summary};
use super::{BagError, Nanos};
use std::sync::Arc;

/// Chunks that overlap are kept open up to this many bytes; beyond it, messages come in
/// the order of the file.
const MAX_OPEN_BYTES: usize = 96 << 20;

/// A message with its bytes.
#[derive(Clone, Copy, Debug)]
pub struct PlayedMessage<'a> {
    /// Its topic and type.
    pub connection: &'a Arc<Connection>,
    /// When it was recorded; a time that cannot be is the bag's begin or end.
    pub time: Nanos,
    /// Whether it was recorded at a time that cannot be.
    pub is_stray: bool,
    /// The message.
    pub data: &'a [u8],
}

struct Open {
    chunk: Chunk,
    next: usize,
}

/// Plays a bag.
pub struct Playback {
    reader: Box<dyn BagReader>,
    /// From when to when times are believed.
    start: Nanos,
    end: Nanos,
    /// Still to be opened, the last first.
    places: Vec<ChunkPlace>,
    open: Vec<Open>,
    spare: Vec<Chunk>,
}

impl Playback {
    /// From the first message of a bag that was looked through before.
    #[must_use]
    pub fn new(mut reader: Box<dyn BagReader>, summary: &Summary) -> Self {
        let mut places = summary.chunks.clone();
        places.sort_by_key(|place| std::cmp::Reverse((place.start, place.offset)));
        reader.know(&summary.connections);
        Self {
            reader,
            start: summary.start,
            end: summary.end.max(summary.start),
            places,
            open: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// The time of the next message; `None` at the end.
    ///
    /// # Errors
    /// [`BagError`] when the file cannot be read.
    pub fn peek(&mut self) -> Result<Option<Nanos>, BagError> {
        Ok(self.recorded()?.map(|time| time.clamp(self.start, self.end)))
    }

    /// The time at which the next message says that it was recorded.
    fn recorded(&mut self) -> Result<Option<Nanos>, BagError> {
        loop {
            let earliest = self.open.iter().filter_map(Open::time).min();
            let bytes: usize = self.open.iter().map(|open| open.chunk.bytes.len()).sum();
            match (self.places.last(), earliest) {
                (Some(place), Some(time)) if place.start > time || bytes > MAX_OPEN_BYTES => return Ok(Some(time)),
                (None, earliest) => return Ok(earliest),
                (Some(place), _) => {
                    let offset = place.offset;
                    self.places.pop();
                    self.reader.seek(offset)?;
                    let mut chunk = self.spare.pop().unwrap_or_default();
                    self.reader.next_chunk(&mut chunk)?;
                    chunk.messages.sort_by_key(|message| message.time);
                    self.open.push(Open { chunk, next: 0 });
                }
            }
        }
    }

    /// The next message; `None` at the end.
    ///
    /// # Errors
    /// [`BagError`] when the file cannot be read.
    pub fn next_message(&mut self) -> Result<Option<PlayedMessage<'_>>, BagError> {
        let Some(recorded) = self.recorded()? else { return Ok(None) };
        while let Some(done) = self.open.iter().position(|open| open.time().is_none()) {
            self.spare.push(self.open.remove(done).chunk);
        }
        self.spare.truncate(2);
        let Some(open) = self.open.iter_mut().find(|open| open.time() == Some(recorded)) else { return Ok(None) };
        let Some(message) = open.chunk.messages.get(open.next) else { return Ok(None) };
        open.next += 1;
        let connection = self.reader.connections().get(&message.connection);
        let time = recorded.clamp(self.start, self.end);
        let (is_stray, data) = (time != recorded, open.chunk.data(message));
        Ok(connection.map(|connection| PlayedMessage { connection, time, is_stray, data }))
    }
}

impl Open {
    fn time(&self) -> Option<Nanos> {
        self.chunk.messages.get(self.next).map(|message| message.time)
    }
}
