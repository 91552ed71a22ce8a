//! The bytes of a bag: where one is in them, and where the next chunk begins.

use super::chunk::{Compression, MAX_CHUNK_BYTES, too_long};
use super::cursor::Cursor;
use super::record::{Fields, op};
use memchr::memmem;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// A record's header is shorter than this: the longest holds a topic's name.
const MAX_HEADER_BYTES: u32 = 1 << 20;
/// The field that a chunk's header holds somewhere.
const CHUNK_FIELD: &[u8] = b"\x04\0\0\0op=\x05";
/// A chunk's header is shorter than this.
const MAX_CHUNK_HEADER: usize = 128;
/// So many bytes are looked through at a time for the next chunk.
const WINDOW: usize = 1 << 20;

/// A record's header, and where its data lies.
pub struct Record {
    /// Where the record begins.
    pub offset: u64,
    /// Its header.
    pub header: Vec<u8>,
    /// The length of its data, as claimed.
    pub data_bytes: u64,
}

impl Record {
    /// One past its last byte, as claimed.
    pub const fn end(&self) -> u64 {
        self.offset + 8 + self.header.len() as u64 + self.data_bytes
    }
}

/// A file and a place in it.
pub struct Input<R> {
    file: BufReader<R>,
    /// The file's length, bytes.
    pub length: u64,
    /// Up to where it has been read, bytes.
    pub at: u64,
}

impl<R: Read + Seek> Input<R> {
    /// At the first byte.
    pub fn new(mut file: R) -> io::Result<Self> {
        let length = file.seek(SeekFrom::End(0))?;
        file.rewind()?;
        Ok(Self { file: BufReader::with_capacity(1 << 16, file), length, at: 0 })
    }

    /// How many bytes are left.
    pub const fn left(&self) -> u64 {
        self.length.saturating_sub(self.at)
    }

    /// Goes to a place.
    pub fn go_to(&mut self, offset: u64) -> io::Result<()> {
        let offset = offset.min(self.length);
        self.file.seek_relative(offset as i64 - self.at as i64)?;
        self.at = offset;
        Ok(())
    }

    /// Appends the next bytes, fewer at the end of the file.
    pub fn read_up_to(&mut self, count: u64, out: &mut Vec<u8>) -> io::Result<()> {
        self.at += (&mut self.file).take(count).read_to_end(out)? as u64;
        Ok(())
    }

    /// Appends what the next bytes hold without their compression, and goes behind them.
    /// The inner result is that of unpacking; what came before an error is kept.
    pub fn expand(
        &mut self,
        compression: Compression,
        packed_bytes: u64,
        out: &mut Vec<u8>,
    ) -> io::Result<io::Result<()>> {
        if compression == Compression::None {
            let is_too_long = packed_bytes > MAX_CHUNK_BYTES;
            let end = self.at + packed_bytes;
            self.read_up_to(packed_bytes.min(MAX_CHUNK_BYTES), out)?;
            self.go_to(end)?;
            return Ok(if is_too_long { Err(too_long()) } else { Ok(()) });
        }
        let from = self.at;
        let mut packed = (&mut self.file).take(packed_bytes);
        let expanded = compression.expand(&mut packed, out);
        self.at = from + packed_bytes - packed.limit();
        self.go_to(from + packed_bytes)?;
        Ok(expanded)
    }

    /// The header of the record that begins here; `None` where none can.
    pub fn record(&mut self) -> io::Result<Option<Record>> {
        let offset = self.at;
        let mut bytes = Vec::new();
        self.read_up_to(4, &mut bytes)?;
        let header_bytes = Cursor::new(&bytes).u32("a record").unwrap_or(u32::MAX);
        if header_bytes > MAX_HEADER_BYTES || u64::from(header_bytes) + 4 > self.left() {
            return Ok(None);
        }
        let mut header = Vec::new();
        bytes.clear();
        self.read_up_to(u64::from(header_bytes), &mut header)?;
        self.read_up_to(4, &mut bytes)?;
        let data_bytes = Cursor::new(&bytes).u32("a record").ok().filter(|_| Fields::new(&header).are_whole());
        Ok(data_bytes.map(|data_bytes| Record { offset, header, data_bytes: u64::from(data_bytes) }))
    }

    /// Where the next chunk begins, at `from` or behind it.
    pub fn find_chunk(&mut self, from: u64) -> io::Result<Option<u64>> {
        let finder = memmem::Finder::new(CHUNK_FIELD);
        let mut window = Vec::new();
        self.go_to(from)?;
        loop {
            let begin = self.at - window.len() as u64;
            self.read_up_to(WINDOW as u64, &mut window)?;
            for field in finder.find_iter(&window) {
                let first = field.saturating_sub(MAX_CHUNK_HEADER);
                if let Some(start) = (first..field).rev().find(|&start| is_chunk(&window, start, field)) {
                    return Ok(Some(begin + start as u64));
                }
            }
            if self.left() == 0 {
                return Ok(None);
            }
            // A header may lie across the border.
            window.drain(..window.len().saturating_sub(2 * MAX_CHUNK_HEADER));
        }
    }
}

/// Whether a chunk's record begins at `start`, with its `op` field at `field`.
fn is_chunk(bytes: &[u8], start: usize, field: usize) -> bool {
    let Some(header) = bytes.get(start..).and_then(|rest| Cursor::new(rest).block("a header").ok()) else {
        return false;
    };
    let fields = Fields::new(header);
    let spans = start + 4 <= field && field + CHUNK_FIELD.len() <= start + 4 + header.len();
    spans
        && fields.op() == Some(op::CHUNK)
        && fields.u32("size").is_ok()
        && Compression::from_name(&fields.text("compression")).is_some()
}
