//! Where the chunks of a bag lie, if all its records are there: found by the records' headers,
//! unpacking nothing.

use super::chunk::{Compression, MAX_CHUNK_BYTES};
use super::input::{Input, Record};
use super::record::{Fields, MAGIC, op};
use std::io::{self, Read, Seek};

/// A byte of an LZ4 block stands for at most so many.
const MAX_LZ4_RATIO: u64 = 255;
/// LZ4 chunks whose bytes could become more than this are not handed to a reader that
/// unpacks first and compares sizes afterwards.
const MAX_LZ4_BYTES: u64 = 1 << 30;

/// A chunk's record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChunkRecord {
    /// Where it begins in the file, bytes.
    pub offset: u64,
    /// How its data is compressed.
    pub compression: Compression,
    /// The length of its data in the file, bytes.
    pub packed_bytes: u64,
    /// The same without compression, as its header says.
    pub bytes: u64,
}

impl ChunkRecord {
    /// Reads a record's header; `None` when it is no chunk's.
    fn of(record: &Record) -> Option<Self> {
        let fields = Fields::new(&record.header);
        let bytes = u64::from(fields.u32("size").ok()?);
        let compression = Compression::from_name(&fields.text("compression"))?;
        Some(Self { offset: record.offset, compression, packed_bytes: record.data_bytes, bytes })
    }

    /// Whether unpacking it takes a bounded amount of memory, whatever its data is.
    pub const fn is_bounded(&self) -> bool {
        let is_packed_small = match self.compression {
            Compression::None => self.packed_bytes == self.bytes,
            // Its decoder fills what the header says and no more.
            Compression::Bz2 => true,
            Compression::Lz4 => self.packed_bytes * MAX_LZ4_RATIO <= MAX_LZ4_BYTES,
        };
        self.bytes <= MAX_CHUNK_BYTES && is_packed_small
    }
}

/// The chunks of a whole bag.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Layout {
    /// In the order of the file.
    pub chunks: Vec<ChunkRecord>,
}

impl Layout {
    /// Goes from record to record: chunks and their indexes up to where the bag's header
    /// names the index, then as many connections and chunks' infos as it counts, up to the
    /// last byte. `None` when anything else is there or anything is missing.
    pub fn of<R: Read + Seek>(input: &mut Input<R>) -> io::Result<Option<Self>> {
        input.go_to(MAGIC.len() as u64)?;
        let Some(header) = input.record()? else { return Ok(None) };
        let fields = Fields::new(&header.header);
        let counts = (fields.u64("index_pos"), fields.u32("chunk_count"), fields.u32("conn_count"));
        let (Ok(index_at), Ok(chunk_count), Ok(connection_count)) = counts else { return Ok(None) };
        let is_header = fields.op() == Some(op::BAG_HEADER);
        if !is_header || header.end() > index_at || index_at > input.length {
            return Ok(None);
        }
        input.go_to(header.end())?;
        let mut this = Self::default();
        let are_chunks = each_record(input, index_at, |record, op| match op {
            op::INDEX => true,
            op::CHUNK => ChunkRecord::of(record).map(|chunk| this.chunks.push(chunk)).is_some(),
            _ => false,
        })?;
        let (mut connections, mut infos) = (0, 0);
        let end = input.length;
        let is_index = are_chunks
            && each_record(input, end, |_, op| {
                match op {
                    op::CONNECTION => connections += 1,
                    op::CHUNK_INFO => infos += 1,
                    _ => return false,
                }
                true
            })?;
        let are_all = infos == chunk_count && connections == connection_count;
        Ok((is_index && are_all && this.chunks.len() == infos as usize).then_some(this))
    }
}

/// Shows each record up to `end` with its kind; false when one is refused, or is not whole.
fn each_record<R: Read + Seek>(
    input: &mut Input<R>,
    end: u64,
    mut is_taken: impl FnMut(&Record, u8) -> bool,
) -> io::Result<bool> {
    while input.at < end {
        let Some(record) = input.record()? else { return Ok(false) };
        let kind = Fields::new(&record.header).op();
        if record.end() > end || !kind.is_some_and(|kind| is_taken(&record, kind)) {
            return Ok(false);
        }
        input.go_to(record.end())?;
    }
    Ok(true)
}
