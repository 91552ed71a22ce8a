//! Writing bags of format 2.0: connections, chunks and the index behind them.
//!
//! <http://wiki.ros.org/Bags/Format/2.0>

use super::Nanos;
use super::chunk::Compression;
use super::chunk::MAX_CHUNK_BYTES;
use super::connections::Connection;
use super::definitions::MessageType;
use super::record::{MAGIC, op, put_field, put_record, put_u32, time_bytes};
use std::collections::BTreeMap;
use std::io::{self, Seek, SeekFrom, Write};

/// A chunk is closed when it has this many bytes, as `rosbag record` does.
const CHUNK_BYTES: usize = 768 << 10;
/// The bag's header is filled up to this length, so that it can be written again.
const HEADER_BYTES: usize = 4096;

/// A chunk that is written.
struct Closed {
    position: u64,
    start: Nanos,
    end: Nanos,
    counts: BTreeMap<u32, u32>,
}

/// Writes a bag; without [`BagWriter::finish`] it is one that was not closed.
pub struct BagWriter<W> {
    output: W,
    at: u64,
    compression: Compression,
    connections: Vec<Connection>,
    chunk: Vec<u8>,
    /// Times and places of the messages in the chunk, by connection.
    index: BTreeMap<u32, Vec<(Nanos, u32)>>,
    closed: Vec<Closed>,
}

impl<W: Write + Seek> BagWriter<W> {
    /// Begins a bag.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn new(mut output: W, compression: Compression) -> io::Result<Self> {
        output.write_all(MAGIC)?;
        output.write_all(&bag_header(0, 0, 0))?;
        Ok(Self {
            output,
            at: (MAGIC.len() + HEADER_BYTES) as u64,
            compression,
            connections: Vec::new(),
            chunk: Vec::new(),
            index: BTreeMap::new(),
            closed: Vec::new(),
        })
    }

    /// A topic of one of the known types; its number is for [`BagWriter::write`].
    pub fn topic(&mut self, topic: &str, kind: MessageType, is_latching: bool) -> u32 {
        self.connect(Connection {
            topic: topic.to_owned(),
            kind: kind.name().to_owned(),
            md5: kind.md5().to_owned(),
            definition: kind.definition(),
            caller: "/frontier_explorer".to_owned(),
            is_latching,
        })
    }

    /// A topic as it was recorded elsewhere; its number is for [`BagWriter::write`].
    pub fn connect(&mut self, connection: Connection) -> u32 {
        let number = self.connections.len() as u32;
        put_connection(&mut self.chunk, number, &connection);
        self.connections.push(connection);
        number
    }

    /// Adds a message.
    ///
    /// # Errors
    /// When it cannot be written, or is too large for a chunk.
    pub fn write(&mut self, connection: u32, time: Nanos, data: &[u8]) -> io::Result<()> {
        if data.len() as u64 > MAX_CHUNK_BYTES - CHUNK_BYTES as u64 - 1024 {
            return Err(io::Error::other(format!("a message of {} bytes is too large for a bag", data.len())));
        }
        let offset = self.chunk.len() as u32;
        self.index.entry(connection).or_default().push((time, offset));
        let mut header = Vec::new();
        put_field(&mut header, "op", &[op::MESSAGE]);
        put_field(&mut header, "conn", &connection.to_le_bytes());
        put_field(&mut header, "time", &time_bytes(time));
        put_record(&mut self.chunk, &header, data);
        if self.chunk.len() >= CHUNK_BYTES { self.close_chunk() } else { Ok(()) }
    }

    /// Writes the index, and gives the file back.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn finish(mut self) -> io::Result<W> {
        self.close_chunk()?;
        let index_position = self.at;
        let mut tail = Vec::new();
        for (number, connection) in self.connections.iter().enumerate() {
            put_connection(&mut tail, number as u32, connection);
        }
        for chunk in &self.closed {
            let mut header = Vec::new();
            put_field(&mut header, "op", &[op::CHUNK_INFO]);
            put_field(&mut header, "ver", &1_u32.to_le_bytes());
            put_field(&mut header, "chunk_pos", &chunk.position.to_le_bytes());
            put_field(&mut header, "start_time", &time_bytes(chunk.start));
            put_field(&mut header, "end_time", &time_bytes(chunk.end));
            put_field(&mut header, "count", &(chunk.counts.len() as u32).to_le_bytes());
            let mut data = Vec::new();
            for (&connection, &count) in &chunk.counts {
                put_u32(&mut data, connection);
                put_u32(&mut data, count);
            }
            put_record(&mut tail, &header, &data);
        }
        self.output.write_all(&tail)?;
        self.output.seek(SeekFrom::Start(MAGIC.len() as u64))?;
        let (connections, chunks) = (self.connections.len() as u32, self.closed.len() as u32);
        self.output.write_all(&bag_header(index_position, connections, chunks))?;
        self.output.flush()?;
        Ok(self.output)
    }

    fn close_chunk(&mut self) -> io::Result<()> {
        if self.chunk.is_empty() {
            return Ok(());
        }
        let mut header = Vec::new();
        put_field(&mut header, "compression", self.compression.name().as_bytes());
        put_field(&mut header, "op", &[op::CHUNK]);
        put_field(&mut header, "size", &(self.chunk.len() as u32).to_le_bytes());
        let mut out = Vec::new();
        put_record(&mut out, &header, &self.compression.compress(&self.chunk)?);
        for (connection, entries) in &self.index {
            let mut header = Vec::new();
            put_field(&mut header, "op", &[op::INDEX]);
            put_field(&mut header, "ver", &1_u32.to_le_bytes());
            put_field(&mut header, "conn", &connection.to_le_bytes());
            put_field(&mut header, "count", &(entries.len() as u32).to_le_bytes());
            let mut data = Vec::new();
            for &(time, offset) in entries {
                data.extend_from_slice(&time_bytes(time));
                put_u32(&mut data, offset);
            }
            put_record(&mut out, &header, &data);
        }
        let times = || self.index.values().flatten().map(|(time, _)| *time);
        let counts = self.index.iter().map(|(&connection, entries)| (connection, entries.len() as u32)).collect();
        // A chunk that only describes topics needs no entry in the index.
        if let (Some(start), Some(end)) = (times().min(), times().max()) {
            self.closed.push(Closed { position: self.at, start, end, counts });
        }
        self.output.write_all(&out)?;
        self.at += out.len() as u64;
        self.chunk.clear();
        self.index.clear();
        Ok(())
    }
}

fn put_connection(out: &mut Vec<u8>, number: u32, connection: &Connection) {
    let mut header = Vec::new();
    put_field(&mut header, "op", &[op::CONNECTION]);
    put_field(&mut header, "conn", &number.to_le_bytes());
    put_field(&mut header, "topic", connection.topic.as_bytes());
    let mut data = Vec::new();
    put_field(&mut data, "topic", connection.topic.as_bytes());
    put_field(&mut data, "type", connection.kind.as_bytes());
    put_field(&mut data, "md5sum", connection.md5.as_bytes());
    put_field(&mut data, "message_definition", connection.definition.as_bytes());
    if !connection.caller.is_empty() {
        put_field(&mut data, "callerid", connection.caller.as_bytes());
    }
    if connection.is_latching {
        put_field(&mut data, "latching", b"1");
    }
    put_record(out, &header, &data);
}

/// The bag's header, always of the same length.
fn bag_header(index_position: u64, connections: u32, chunks: u32) -> Vec<u8> {
    let mut header = Vec::new();
    put_field(&mut header, "op", &[op::BAG_HEADER]);
    put_field(&mut header, "index_pos", &index_position.to_le_bytes());
    put_field(&mut header, "conn_count", &connections.to_le_bytes());
    put_field(&mut header, "chunk_count", &chunks.to_le_bytes());
    let padding = vec![b' '; HEADER_BYTES.saturating_sub(header.len() + 8)];
    let mut out = Vec::new();
    put_record(&mut out, &header, &padding);
    out
}
