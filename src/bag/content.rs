//! What a chunk holds: messages, and connections on the way.

use super::Nanos;
use super::chunk::Compression;
use super::connections::Connections;
use super::cursor::{Cursor, Malformed};
use super::problems::Problems;
use super::record::{Fields, op};
use std::ops::Range;

/// A message of a chunk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ChunkMessage {
    /// The connection's number.
    pub connection: u32,
    /// When it was recorded.
    pub time: Nanos,
    range: Range<usize>,
}

/// The messages of a chunk. Kept and filled again, it needs memory once.
#[derive(Debug, Default)]
pub struct Chunk {
    /// Where its record begins in the file.
    pub offset: u64,
    /// How it was compressed.
    pub compression: Compression,
    /// Its length in the file, bytes.
    pub packed_bytes: u64,
    /// Its messages in the order of the file.
    pub messages: Vec<ChunkMessage>,
    /// Its length without compression, where `bytes` holds the messages' data alone.
    pub(super) claimed_bytes: Option<u64>,
    pub(super) bytes: Vec<u8>,
}

impl Chunk {
    /// The bytes of one of its messages.
    #[must_use]
    pub fn data(&self, message: &ChunkMessage) -> &[u8] {
        self.bytes.get(message.range.clone()).unwrap_or_default()
    }

    /// Its length without compression, bytes.
    #[must_use]
    pub fn unpacked_bytes(&self) -> u64 {
        self.claimed_bytes.unwrap_or(self.bytes.len() as u64)
    }

    pub(super) fn clear(&mut self, offset: u64) {
        self.messages.clear();
        self.bytes.clear();
        (self.offset, self.compression) = (offset, Compression::default());
        (self.packed_bytes, self.claimed_bytes) = (0, None);
    }

    /// Finds the messages in its bytes; false when they end within one.
    pub(super) fn parse(&mut self, connections: &mut Connections, problems: &mut Problems) -> bool {
        let Self { bytes, messages, .. } = self;
        let mut cursor = Cursor::new(bytes);
        while !cursor.is_empty() {
            let Ok((header, data)) = record_of(&mut cursor) else { return false };
            let fields = Fields::new(header);
            match fields.op() {
                Some(op::MESSAGE) => {
                    let end = bytes.len() - cursor.left();
                    messages.extend(message(&fields, end - data.len()..end, connections, problems));
                }
                Some(op::CONNECTION) => connections.take(&fields, data, problems),
                _ => {}
            }
        }
        true
    }

    /// Adds a message that stands outside of chunks, its data being the last bytes.
    pub(super) fn push(
        &mut self,
        fields: &Fields<'_>,
        start: usize,
        connections: &Connections,
        problems: &mut Problems,
    ) {
        self.messages.extend(message(fields, start..self.bytes.len(), connections, problems));
    }

    /// Adds a message whose data stands elsewhere.
    pub(super) fn add(
        &mut self,
        connection: u32,
        time: Nanos,
        data: &[u8],
        connections: &Connections,
        problems: &mut Problems,
    ) {
        if connections.has(connection, problems) {
            let start = self.bytes.len();
            self.bytes.extend_from_slice(data);
            self.messages.push(ChunkMessage { connection, time, range: start..self.bytes.len() });
        }
    }
}

fn message(
    fields: &Fields<'_>,
    range: Range<usize>,
    connections: &Connections,
    problems: &mut Problems,
) -> Option<ChunkMessage> {
    let (Ok(connection), Ok(time)) = (fields.u32("conn"), fields.time("time")) else {
        problems.tell("a message without connection or time is left out".to_owned());
        return None;
    };
    connections.has(connection, problems).then_some(ChunkMessage { connection, time, range })
}

fn record_of<'a>(cursor: &mut Cursor<'a>) -> Result<(&'a [u8], &'a [u8]), Malformed> {
    Ok((cursor.block("a record's header")?, cursor.block("a record's data")?))
}
