//! A bag from its first byte to its last, one chunk at a time: the index is not needed.
//!
//! So a bag that is still being written, or was cut, is read as far as it goes. A chunk
//! that is damaged gives what comes before the damage, and behind a damaged record it goes
//! on with the next chunk. What was wrong is told by [`BagReader::problems`].

use super::chunk::{Compression, MAX_CHUNK_BYTES};
use super::connections::{Connection, Connections, MAX_DEFINITION_BYTES};
use super::content::Chunk;
use super::input::{Input, Record};
use super::problems::Problems;
use super::reader::{BagError, BagReader};
use super::record::{Fields, MAGIC, op};
use std::collections::BTreeMap;
use std::io::{self, Read, Seek};
use std::sync::Arc;

/// Messages outside of chunks are handed over in lots of this size.
const LOT_BYTES: usize = 1 << 20;

/// Reads a bag whose records may be cut or damaged.
pub struct BagScanner<R> {
    pub(super) input: Input<R>,
    is_indexed: bool,
    pub(super) connections: Connections,
    pub(super) problems: Problems,
}

impl<R: Read + Seek> BagScanner<R> {
    /// Looks at the first bytes.
    ///
    /// # Errors
    /// [`BagError`] when this is no bag, or one of another format.
    pub fn new(input: R) -> Result<Self, BagError> {
        let mut input = Input::new(input)?;
        let mut first = Vec::new();
        input.read_up_to(MAGIC.len() as u64, &mut first)?;
        if first != MAGIC {
            input.read_up_to(8, &mut first)?;
            let line = String::from_utf8_lossy(&first);
            let version = line.strip_prefix("#ROS").and_then(|rest| rest.split(['V', 'v']).nth(1));
            let version = version.map(|v| v.split(char::is_whitespace).next().unwrap_or_default().to_owned());
            return Err(version.filter(|v| v != "2.0").map_or(BagError::NoBag, BagError::Version));
        }
        let (connections, problems) = (Connections::default(), Problems::default());
        Ok(Self { input, is_indexed: false, connections, problems })
    }

    /// The data of a chunk, without its compression.
    fn expand(&mut self, record: &Record, chunk: &mut Chunk) -> io::Result<()> {
        let offset = record.offset;
        let fields = Fields::new(&record.header);
        let claimed = fields.u32("size").map_or(0, u64::from);
        let name = fields.text("compression");
        let Some(compression) = Compression::from_name(&name) else {
            self.problems
                .tell(format!("the chunk at byte {offset} is compressed by {name:?}: must be none, bz2 or lz4"));
            return self.skip(record);
        };
        // The sizes are filled in when a chunk is closed: this one was not.
        let is_open = record.data_bytes == 0 && claimed == 0;
        if is_open && compression == Compression::None {
            return Ok(());
        }
        let left = self.input.left();
        let is_cut = record.data_bytes > left;
        if is_cut {
            self.problems.tell(format!("the bag is cut at byte {}, within a chunk", self.input.length));
        } else if is_open {
            self.problems.tell("the bag ends in a chunk that was not closed".to_owned());
        }
        chunk.compression = compression;
        chunk.packed_bytes = if is_open { left } else { record.data_bytes.min(left) };
        match self.input.expand(compression, chunk.packed_bytes, &mut chunk.bytes)? {
            // A file that got shorter is found out by its missing bytes.
            Err(error) if !(is_cut || is_open) => {
                self.problems.tell(format!("the chunk at byte {offset} cannot be unpacked to its end: {error}"));
            }
            Ok(()) if !(is_cut || is_open) && chunk.bytes.len() as u64 != claimed => self.problems.tell(format!(
                "the chunk at byte {offset} holds {} bytes: its header says {claimed}",
                chunk.bytes.len()
            )),
            _ => {}
        }
        Ok(())
    }

    fn loose_message(&mut self, record: &Record, chunk: &mut Chunk) -> io::Result<()> {
        if record.data_bytes > self.input.left().min(MAX_CHUNK_BYTES) {
            return self.go_on_behind(record.offset);
        }
        let start = chunk.bytes.len();
        self.input.read_up_to(record.data_bytes, &mut chunk.bytes)?;
        chunk.packed_bytes = self.input.at - chunk.offset;
        chunk.push(&Fields::new(&record.header), start, &self.connections, &mut self.problems);
        Ok(())
    }

    /// Goes behind a record, or behind the damage if it claims more than there is.
    fn skip(&mut self, record: &Record) -> io::Result<()> {
        if record.end() > self.input.length { self.go_on_behind(record.offset) } else { self.input.go_to(record.end()) }
    }

    /// Goes on with the next chunk behind a record that cannot be read.
    fn go_on_behind(&mut self, damaged: u64) -> io::Result<()> {
        let next = self.input.find_chunk(damaged + 1)?;
        let to = next.unwrap_or(self.input.length);
        let lost = to - damaged.min(to);
        self.problems.tell(format!("the bag is cut or damaged at byte {damaged}: {lost} bytes are not read"));
        self.input.go_to(to)
    }
}

impl<R: Read + Seek> BagReader for BagScanner<R> {
    fn length(&self) -> u64 {
        self.input.length
    }

    fn is_indexed(&self) -> bool {
        self.is_indexed
    }

    fn connections(&self) -> &BTreeMap<u32, Arc<Connection>> {
        &self.connections.known
    }

    fn know(&mut self, connections: &BTreeMap<u32, Arc<Connection>>) {
        self.connections = Connections::known(connections);
    }

    fn problems(&self) -> &[String] {
        self.problems.all()
    }

    fn seek(&mut self, offset: u64) -> io::Result<()> {
        self.input.go_to(offset)
    }

    fn next_chunk(&mut self, chunk: &mut Chunk) -> io::Result<bool> {
        chunk.clear(self.input.at);
        while self.input.left() > 0 {
            let offset = self.input.at;
            let Some(record) = self.input.record()? else {
                self.go_on_behind(offset)?;
                continue;
            };
            let fields = Fields::new(&record.header);
            match fields.op() {
                Some(op::CHUNK) if !chunk.messages.is_empty() => {
                    self.input.go_to(offset)?;
                    return Ok(true);
                }
                Some(op::CHUNK) => {
                    chunk.clear(offset);
                    self.expand(&record, chunk)?;
                    let is_whole = chunk.parse(&mut self.connections, &mut self.problems);
                    if !is_whole && self.input.left() > 0 {
                        self.problems.tell(format!("the chunk at byte {offset} ends within a message"));
                    }
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
                    self.input.read_up_to(record.data_bytes.min(MAX_DEFINITION_BYTES as u64), &mut data)?;
                    self.connections.take(&fields, &data, &mut self.problems);
                    self.skip(&record)?;
                }
                Some(op::BAG_HEADER) => {
                    self.is_indexed =
                        fields.u64("index_pos").is_ok_and(|at| at > MAGIC.len() as u64 && at <= self.input.length);
                    self.skip(&record)?;
                }
                Some(op::INDEX | op::CHUNK_INFO) => self.skip(&record)?,
                _ => self.go_on_behind(offset)?,
            }
        }
        Ok(!chunk.messages.is_empty())
    }
}
