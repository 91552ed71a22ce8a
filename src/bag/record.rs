//! The records of bag format 2.0: a header of named fields, and data.
//!
//! <http://wiki.ros.org/Bags/Format/2.0>

use super::Nanos;
use super::cursor::{Cursor, Malformed};

/// What a file of this format begins with.
pub const MAGIC: &[u8; 13] = b"#ROSBAG V2.0\n";

/// The kinds of records, by their field `op`.
pub mod op {
    /// A message.
    pub const MESSAGE: u8 = 2;
    /// The bag's own header.
    pub const BAG_HEADER: u8 = 3;
    /// Where the messages of one connection lie in a chunk.
    pub const INDEX: u8 = 4;
    /// Messages and connections, compressed or not.
    pub const CHUNK: u8 = 5;
    /// Where a chunk lies and what it holds.
    pub const CHUNK_INFO: u8 = 6;
    /// A topic as one publisher published it.
    pub const CONNECTION: u8 = 7;
}

/// The fields of a record's header.
#[derive(Clone, Copy, Debug)]
pub struct Fields<'a> {
    bytes: &'a [u8],
}

impl<'a> Fields<'a> {
    /// The fields in a header's bytes.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// Whether these are fields from the first byte to the last.
    pub fn are_whole(&self) -> bool {
        let mut cursor = Cursor::new(self.bytes);
        while !cursor.is_empty() {
            if !cursor.block("a field").is_ok_and(|field| field.contains(&b'=')) {
                return false;
            }
        }
        true
    }

    /// A field by its name.
    pub fn get(&self, name: &str) -> Option<&'a [u8]> {
        let mut cursor = Cursor::new(self.bytes);
        while !cursor.is_empty() {
            let field = cursor.block("a field").ok()?;
            let equals = field.iter().position(|&byte| byte == b'=')?;
            let (key, value) = field.split_at_checked(equals)?;
            if key == name.as_bytes() {
                return value.get(1..);
            }
        }
        None
    }

    /// The kind of record; `None` without one.
    pub fn op(&self) -> Option<u8> {
        self.get("op").and_then(<[u8]>::first).copied()
    }

    /// A number of four bytes.
    pub fn u32(&self, name: &'static str) -> Result<u32, Malformed> {
        Cursor::new(self.need(name)?).u32(name)
    }

    /// A time.
    pub fn time(&self, name: &'static str) -> Result<Nanos, Malformed> {
        Cursor::new(self.need(name)?).time(name)
    }

    /// A number of eight bytes.
    pub fn u64(&self, name: &'static str) -> Result<u64, Malformed> {
        let mut cursor = Cursor::new(self.need(name)?);
        let (low, high) = (cursor.u32(name)?, cursor.u32(name)?);
        Ok(u64::from(low) | u64::from(high) << 32)
    }

    /// A text; empty when it is not there.
    pub fn text(&self, name: &str) -> String {
        String::from_utf8_lossy(self.get(name).unwrap_or_default()).into_owned()
    }

    fn need(&self, name: &'static str) -> Result<&'a [u8], Malformed> {
        self.get(name).ok_or_else(|| Malformed::Wrong(format!("a record without its field {name}")))
    }
}

/// Appends a field to a header.
pub fn put_field(header: &mut Vec<u8>, name: &str, value: &[u8]) {
    put_u32(header, (name.len() + 1 + value.len()) as u32);
    header.extend_from_slice(name.as_bytes());
    header.push(b'=');
    header.extend_from_slice(value);
}

/// Appends a record.
pub fn put_record(out: &mut Vec<u8>, header: &[u8], data: &[u8]) {
    put_u32(out, header.len() as u32);
    out.extend_from_slice(header);
    put_u32(out, data.len() as u32);
    out.extend_from_slice(data);
}

/// Appends a number.
pub fn put_u32(out: &mut Vec<u8>, value: u32) {
    out.extend_from_slice(&value.to_le_bytes());
}

/// A time as its eight bytes.
pub fn time_bytes(nanos: Nanos) -> [u8; 8] {
    let [a, b, c, d] = ((nanos / 1_000_000_000) as u32).to_le_bytes();
    let [e, f, g, h] = ((nanos % 1_000_000_000) as u32).to_le_bytes();
    [a, b, c, d, e, f, g, h]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_by_name() {
        let mut header = Vec::new();
        put_field(&mut header, "op", &[op::CHUNK]);
        put_field(&mut header, "time", &time_bytes(3_000_000_007));
        put_field(&mut header, "topic", b"/a=b");
        let fields = Fields::new(&header);
        assert_eq!((fields.op(), fields.time("time")), (Some(5), Ok(3_000_000_007)));
        assert_eq!(fields.text("topic"), "/a=b");
        assert!(fields.u32("size").is_err() && fields.u32("op").is_err());
        assert_eq!(Fields::new(&[9, 0, 0, 0, 1]).op(), None);
    }
}
