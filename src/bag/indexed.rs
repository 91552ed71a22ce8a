//! A whole bag, read by the `rosbag` crate, which maps the file into memory.
//!
//! The crate trusts what a bag says: it panics where the index lies outside of the file and
//! unpacks before it compares sizes. So [`Layout`] has looked at every record before, and a
//! chunk that is too large or that the crate refuses goes to the scanner, which takes out of
//! it what can be read and tells what is wrong. As with any mapped file, the process ends
//! when somebody makes the file shorter meanwhile; bags that are still written have no index
//! and do not come here.

use super::connections::Connection;
use super::content::Chunk;
use super::layout::{ChunkRecord, Layout};
use super::reader::BagReader;
use super::scanner::BagScanner;
use rosbag::{MessageRecord, RosBag};
use std::collections::BTreeMap;
use std::io::{self, Read, Seek};
use std::sync::Arc;

/// Reads a whole bag.
pub struct IndexedBag<R> {
    bag: RosBag,
    layout: Layout,
    /// The number of the next chunk.
    next: usize,
    /// Reads what the crate does not, and keeps connections and problems.
    scanner: BagScanner<R>,
}

impl<R: Read + Seek> IndexedBag<R> {
    /// Before the first chunk; `bag` and `scanner` read the same file, of `layout`.
    pub fn new(bag: RosBag, layout: Layout, scanner: BagScanner<R>) -> Self {
        Self { bag, layout, next: 0, scanner }
    }

    /// Unpacks a chunk into an empty one.
    pub(super) fn unpack(&mut self, record: ChunkRecord, chunk: &mut Chunk) -> Result<(), rosbag::Error> {
        let mut records = self.bag.chunk_records();
        records.seek(record.offset)?;
        let Some(rosbag::ChunkRecord::Chunk(unpacked)) = records.next().transpose()? else {
            return Err(rosbag::Error::InvalidRecord);
        };
        let (connections, problems) = (&mut self.scanner.connections, &mut self.scanner.problems);
        (chunk.compression, chunk.packed_bytes) = (record.compression, record.packed_bytes);
        chunk.claimed_bytes = Some(record.bytes);
        for message in unpacked.messages() {
            match message? {
                MessageRecord::MessageData(message) => {
                    chunk.add(message.conn_id, message.time, message.data, connections, problems);
                }
                MessageRecord::Connection(connection) => {
                    connections.insert(connection.id, || described(&connection), problems);
                }
            }
        }
        Ok(())
    }
}

impl<R: Read + Seek> BagReader for IndexedBag<R> {
    fn length(&self) -> u64 {
        self.scanner.length()
    }

    fn is_indexed(&self) -> bool {
        true
    }

    fn connections(&self) -> &BTreeMap<u32, Arc<Connection>> {
        self.scanner.connections()
    }

    fn know(&mut self, connections: &BTreeMap<u32, Arc<Connection>>) {
        self.scanner.know(connections);
    }

    fn problems(&self) -> &[String] {
        self.scanner.problems()
    }

    fn seek(&mut self, offset: u64) -> io::Result<()> {
        self.next = self.layout.chunks.partition_point(|chunk| chunk.offset < offset);
        Ok(())
    }

    fn next_chunk(&mut self, chunk: &mut Chunk) -> io::Result<bool> {
        while let Some(&record) = self.layout.chunks.get(self.next) {
            self.next += 1;
            chunk.clear(record.offset);
            if !record.is_bounded() || self.unpack(record, chunk).is_err() {
                self.scanner.seek(record.offset)?;
                let is_there = self.scanner.next_chunk(chunk)?;
                // A chunk without messages is passed over.
                self.next = self.layout.chunks.partition_point(|next| next.offset <= chunk.offset);
                return Ok(is_there);
            }
            if !chunk.messages.is_empty() {
                return Ok(true);
            }
        }
        chunk.clear(self.length());
        Ok(false)
    }
}

fn described(connection: &rosbag::record_types::Connection<'_>) -> Connection {
    Connection {
        topic: connection.storage_topic.to_owned(),
        kind: connection.tp.to_owned(),
        md5: connection.md5sum.iter().map(|byte| format!("{byte:02x}")).collect(),
        definition: connection.message_definition.to_owned(),
        caller: connection.caller_id.to_owned(),
        is_latching: connection.latching,
    }
}
