//! A bag from its first byte to its last, one chunk at a time: the index is not needed.
//!
//! So a bag that is still being written, or was cut, is read as far as it goes. A chunk
//! that is damaged gives what comes before the damage. What was wrong is told by
//! [`BagReader::problems`].

use super::Nanos;
use super::chunk::{Compression, MAX_CHUNK_BYTES};
use super::cursor::{Cursor, Malformed};
use super::record::{Fields, MAGIC, op};
use std::collections::BTreeMap;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::ops::Range;
use std::sync::Arc;

/// A record's header is shorter than this: the longest holds a topic's name.
const MAX_HEADER_BYTES: u32 = 1 << 20;
/// The most connections, and the most bytes of their definitions, that are kept.
const MAX_CONNECTIONS: usize = 10_000;
const MAX_DEFINITION_BYTES: usize = 32 << 20;
/// The most problems that are told apart.
const MAX_PROBLEMS: usize = 20;
/// Messages outside of chunks are handed over in lots of this size.
const LOT_BYTES: usize = 1 << 20;

/// Why a file cannot be read as a bag at all.
#[derive(Debug, thiserror::Error)]
pub enum BagError {
    /// The file system refused.
    #[error("cannot read the bag: {0}")]
    Io(#[from] io::Error),
    /// An old bag.
    #[error("this is a bag of format {0}: must be 2.0 (`rosbag fix old.bag new.bag` turns it into one)")]
    Version(String),
    /// Something else.
    #[error("this is no ROS 1 bag: it must begin with #ROSBAG V2.0")]
    NoBag,
}

/// A topic as one publisher published it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Connection {
    /// The topic's name.
    pub topic: String,
    /// The type, such as `nav_msgs/OccupancyGrid`.
    pub kind: String,
    /// The sum over the type's definition.
    pub md5: String,
    /// The type's definition, with those that it uses.
    pub definition: String,
    /// Who published it, if that was recorded.
    pub caller: String,
    /// Whether late subscribers get the last message.
    pub is_latching: bool,
}

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
    bytes: Vec<u8>,
}

impl Chunk {
    /// The bytes of one of its messages.
    #[must_use]
    pub fn data(&self, message: &ChunkMessage) -> &[u8] {
        self.bytes.get(message.range.clone()).unwrap_or_default()
    }

    /// Its length without compression, bytes.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.bytes.len()
    }

    /// Whether it holds nothing.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    fn clear(&mut self, offset: u64) {
        *self = Self {
            messages: std::mem::take(&mut self.messages),
            bytes: std::mem::take(&mut self.bytes),
            offset,
            ..Self::default()
        };
        self.messages.clear();
        self.bytes.clear();
    }
}

/// A record's header, and where its data lies.
struct Record {
    offset: u64,
    header: Vec<u8>,
    /// As claimed.
    data_bytes: u64,
}

/// Reads a bag.
pub struct BagReader<R> {
    input: BufReader<R>,
    length: u64,
    at: u64,
    is_indexed: bool,
    connections: BTreeMap<u32, Arc<Connection>>,
    definition_bytes: usize,
    problems: Vec<String>,
}

impl<R: Read + Seek> BagReader<R> {
    /// Looks at the first bytes.
    ///
    /// # Errors
    /// [`BagError`] when this is no bag, or one of another format.
    pub fn new(mut input: R) -> Result<Self, BagError> {
        let length = input.seek(SeekFrom::End(0))?;
        input.rewind()?;
        let mut this = Self {
            input: BufReader::with_capacity(1 << 16, input),
            length,
            at: 0,
            is_indexed: false,
            connections: BTreeMap::new(),
            definition_bytes: 0,
            problems: Vec::new(),
        };
        let mut first = Vec::new();
        this.read_up_to(MAGIC.len() as u64, &mut first)?;
        if first != MAGIC {
            this.read_up_to(8, &mut first)?;
            let line = String::from_utf8_lossy(&first);
            let version = line.strip_prefix("#ROS").and_then(|rest| rest.split(['V', 'v']).nth(1));
            let version = version.map(|v| v.split(char::is_whitespace).next().unwrap_or_default().to_owned());
            return Err(version.filter(|v| v != "2.0").map_or(BagError::NoBag, BagError::Version));
        }
        Ok(this)
    }

    /// The file's length, bytes.
    #[must_use]
    pub const fn length(&self) -> u64 {
        self.length
    }

    /// Up to where it has been read, bytes.
    #[must_use]
    pub const fn position(&self) -> u64 {
        self.at
    }

    /// Whether the bag was closed properly: its header names an index.
    #[must_use]
    pub const fn is_indexed(&self) -> bool {
        self.is_indexed
    }

    /// The connections seen so far, by their numbers.
    #[must_use]
    pub const fn connections(&self) -> &BTreeMap<u32, Arc<Connection>> {
        &self.connections
    }

    /// What was wrong so far, a sentence each.
    #[must_use]
    pub fn problems(&self) -> &[String] {
        &self.problems
    }

    /// Takes over connections that were read before.
    pub(super) fn know(&mut self, connections: &BTreeMap<u32, Arc<Connection>>) {
        self.connections.clone_from(connections);
    }

    /// Goes to a chunk whose place is known.
    ///
    /// # Errors
    /// When the file cannot be read.
    pub fn seek(&mut self, offset: u64) -> io::Result<()> {
        self.go_to(offset.min(self.length))
    }

    /// Reads the next chunk; false at the end, wherever that is.
    ///
    /// # Errors
    /// When the file cannot be read; damage is no error.
    pub fn next_chunk(&mut self, chunk: &mut Chunk) -> io::Result<bool> {
        chunk.clear(self.at);
        loop {
            let Some(record) = self.record()? else { return Ok(!chunk.messages.is_empty()) };
            let fields = Fields::new(&record.header);
            match fields.op() {
                Some(op::CHUNK) if !chunk.messages.is_empty() => {
                    self.go_to(record.offset)?;
                    return Ok(true);
                }
                Some(op::CHUNK) => {
                    chunk.clear(record.offset);
                    self.expand(&record, chunk)?;
                    self.parse(chunk);
                    if !chunk.messages.is_empty() {
                        return Ok(true);
                    }
                }
                // A recording under way has its last messages outside of a chunk.
                Some(op::MESSAGE) => {
                    self.loose_message(&record, chunk)?;
                    if chunk.bytes.len() >= LOT_BYTES {
                        return Ok(true);
                    }
                }
                Some(op::CONNECTION) => {
                    let mut data = Vec::new();
                    self.read_up_to(record.data_bytes.min(MAX_DEFINITION_BYTES as u64), &mut data)?;
                    self.connection(&fields, &data);
                    self.skip_to_end_of(&record)?;
                }
                Some(op::BAG_HEADER) => {
                    self.is_indexed =
                        fields.u64("index_pos").is_ok_and(|at| at > MAGIC.len() as u64 && at <= self.length);
                    self.skip_to_end_of(&record)?;
                }
                Some(op::INDEX | op::CHUNK_INFO) => self.skip_to_end_of(&record)?,
                _ => {
                    self.stop(record.offset);
                    return Ok(!chunk.messages.is_empty());
                }
            }
        }
    }

    /// The next record's header; `None` at the end of what can be read.
    fn record(&mut self) -> io::Result<Option<Record>> {
        let offset = self.at;
        if offset >= self.length {
            return Ok(None);
        }
        let mut bytes = Vec::new();
        self.read_up_to(4, &mut bytes)?;
        let header_bytes = Cursor::new(&bytes).u32("a record").unwrap_or(u32::MAX);
        let is_possible = header_bytes <= MAX_HEADER_BYTES && u64::from(header_bytes) + 4 <= self.length - self.at;
        let mut header = Vec::new();
        bytes.clear();
        if is_possible {
            self.read_up_to(u64::from(header_bytes), &mut header)?;
            self.read_up_to(4, &mut bytes)?;
        }
        match Cursor::new(&bytes).u32("a record") {
            Ok(data_bytes) => Ok(Some(Record { offset, header, data_bytes: u64::from(data_bytes) })),
            Err(_) => {
                self.stop(offset);
                Ok(None)
            }
        }
    }

    /// The data of a chunk, without its compression.
    fn expand(&mut self, record: &Record, chunk: &mut Chunk) -> io::Result<()> {
        let fields = Fields::new(&record.header);
        let claimed = fields.u32("size").map_or(0, u64::from);
        let name = fields.text("compression");
        let Some(compression) = Compression::from_name(&name) else {
            self.problem(format!(
                "the chunk at byte {} is compressed by {name:?}: must be none, bz2 or lz4",
                record.offset
            ));
            return self.skip_to_end_of(record);
        };
        // The sizes are filled in when a chunk is closed: this one was not.
        let is_open = record.data_bytes == 0 && claimed == 0;
        if is_open && compression == Compression::None {
            return Ok(());
        }
        let left = self.length - self.at;
        let is_cut = record.data_bytes > left;
        let packed_bytes = if is_open { left } else { record.data_bytes.min(left) };
        if is_cut {
            self.problem(format!("the bag is cut at byte {}, within a chunk", self.length));
        } else if is_open {
            self.problem("the bag ends in a chunk that was not closed".to_owned());
        }
        chunk.compression = compression;
        chunk.packed_bytes = packed_bytes;
        let from = self.at;
        let mut packed = (&mut self.input).take(packed_bytes);
        let expanded = compression.expand(&mut packed, &mut chunk.bytes);
        let unread = packed.limit();
        self.at = from + packed_bytes - unread;
        self.go_to(from + packed_bytes)?;
        match expanded {
            // A file that got shorter is found out by its missing bytes.
            Err(error) if !(is_cut || is_open) => {
                self.problem(format!("the chunk at byte {} cannot be unpacked to its end: {error}", record.offset));
            }
            Ok(()) if !(is_cut || is_open) && chunk.bytes.len() as u64 != claimed => self.problem(format!(
                "the chunk at byte {} holds {} bytes: its header says {claimed}",
                record.offset,
                chunk.bytes.len()
            )),
            _ => {}
        }
        Ok(())
    }

    /// Finds the messages of a chunk's bytes.
    fn parse(&mut self, chunk: &mut Chunk) {
        let bytes = std::mem::take(&mut chunk.bytes);
        let mut cursor = Cursor::new(&bytes);
        while !cursor.is_empty() {
            let Ok((header, data)) = record_of(&mut cursor) else {
                let is_cut = self.at >= self.length;
                if !is_cut {
                    self.problem(format!("the chunk at byte {} ends within a message", chunk.offset));
                }
                break;
            };
            let fields = Fields::new(header);
            match fields.op() {
                Some(op::MESSAGE) => {
                    let end = bytes.len() - cursor.left();
                    self.message(&fields, end - data.len()..end, &mut chunk.messages);
                }
                Some(op::CONNECTION) => self.connection(&fields, data),
                _ => {}
            }
        }
        chunk.bytes = bytes;
    }

    fn loose_message(&mut self, record: &Record, chunk: &mut Chunk) -> io::Result<()> {
        if record.data_bytes > (self.length - self.at).min(MAX_CHUNK_BYTES) {
            self.stop(record.offset);
            return self.go_to(self.length);
        }
        let start = chunk.bytes.len();
        self.read_up_to(record.data_bytes, &mut chunk.bytes)?;
        chunk.packed_bytes = self.at - chunk.offset;
        self.message(&Fields::new(&record.header), start..chunk.bytes.len(), &mut chunk.messages);
        Ok(())
    }

    fn message(&mut self, fields: &Fields<'_>, range: Range<usize>, messages: &mut Vec<ChunkMessage>) {
        let (Ok(connection), Ok(time)) = (fields.u32("conn"), fields.time("time")) else {
            self.problem("a message without connection or time is left out".to_owned());
            return;
        };
        if self.connections.contains_key(&connection) {
            messages.push(ChunkMessage { connection, time, range });
        } else {
            self.problem(format!("messages of connection {connection}, which nothing describes, are left out"));
        }
    }

    fn connection(&mut self, fields: &Fields<'_>, data: &[u8]) {
        let Ok(number) = fields.u32("conn") else { return };
        if self.connections.contains_key(&number) {
            return;
        }
        let described = Fields::new(data);
        let definition = described.text("message_definition");
        self.definition_bytes += definition.len();
        if self.connections.len() >= MAX_CONNECTIONS || self.definition_bytes > MAX_DEFINITION_BYTES {
            self.problem(format!("only the first {} connections are read", self.connections.len()));
            return;
        }
        let connection = Connection {
            topic: fields.text("topic"),
            kind: described.text("type"),
            md5: described.text("md5sum"),
            definition,
            caller: described.text("callerid"),
            is_latching: described.get("latching") == Some(b"1"),
        };
        self.connections.insert(number, Arc::new(connection));
    }

    /// Nothing from here on can be read.
    fn stop(&mut self, offset: u64) {
        let left = self.length - offset.min(self.length);
        self.problem(format!("the bag is cut or damaged at byte {offset}: {left} bytes are not read"));
        self.at = self.length;
    }

    fn problem(&mut self, problem: String) {
        if self.problems.len() < MAX_PROBLEMS && !self.problems.contains(&problem) {
            self.problems.push(problem);
        }
    }

    fn skip_to_end_of(&mut self, record: &Record) -> io::Result<()> {
        let end = record.offset + 8 + record.header.len() as u64 + record.data_bytes;
        if end > self.length {
            self.stop(record.offset);
            return Ok(());
        }
        self.go_to(end)
    }

    fn go_to(&mut self, offset: u64) -> io::Result<()> {
        let by = offset as i64 - self.at as i64;
        self.input.seek_relative(by)?;
        self.at = offset;
        Ok(())
    }

    /// Appends the next bytes, fewer at the end of the file.
    fn read_up_to(&mut self, count: u64, out: &mut Vec<u8>) -> io::Result<()> {
        self.at += (&mut self.input).take(count).read_to_end(out)? as u64;
        Ok(())
    }
}

fn record_of<'a>(cursor: &mut Cursor<'a>) -> Result<(&'a [u8], &'a [u8]), Malformed> {
    Ok((cursor.block("a record's header")?, cursor.block("a record's data")?))
}
