//! Little-endian values one after the other, as ROS writes messages and records.

use super::Nanos;

/// Bytes that are not what they should be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Malformed {
    /// The bytes end before the value does.
    #[error("{what} needs {needed} bytes and {left} are left")]
    Cut {
        /// Which value.
        what: &'static str,
        /// Its length.
        needed: u64,
        /// How many bytes there are.
        left: usize,
    },
    /// A value that cannot be.
    #[error("{0}")]
    Wrong(String),
}

/// What is still to be read.
#[derive(Clone, Copy, Debug)]
pub struct Cursor<'a> {
    rest: &'a [u8],
}

impl<'a> Cursor<'a> {
    /// From the first byte.
    pub const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    /// Whether all is read.
    pub const fn is_empty(&self) -> bool {
        self.rest.is_empty()
    }

    /// How many bytes are left.
    pub const fn left(&self) -> usize {
        self.rest.len()
    }

    /// The next `count` bytes.
    pub fn take(&mut self, count: u64, what: &'static str) -> Result<&'a [u8], Malformed> {
        let cut = Malformed::Cut { what, needed: count, left: self.rest.len() };
        let count = usize::try_from(count).map_err(|_| cut.clone())?;
        let (taken, rest) = self.rest.split_at_checked(count).ok_or(cut)?;
        self.rest = rest;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self, what: &'static str) -> Result<[u8; N], Malformed> {
        let cut = Malformed::Cut { what, needed: N as u64, left: self.rest.len() };
        let (taken, rest) = self.rest.split_first_chunk::<N>().ok_or(cut)?;
        self.rest = rest;
        Ok(*taken)
    }

    /// A number.
    pub fn u32(&mut self, what: &'static str) -> Result<u32, Malformed> {
        Ok(u32::from_le_bytes(self.array(what)?))
    }

    /// A number.
    pub fn i32(&mut self, what: &'static str) -> Result<i32, Malformed> {
        Ok(i32::from_le_bytes(self.array(what)?))
    }

    /// A number.
    pub fn f32(&mut self, what: &'static str) -> Result<f32, Malformed> {
        Ok(f32::from_le_bytes(self.array(what)?))
    }

    /// A number.
    pub fn f64(&mut self, what: &'static str) -> Result<f64, Malformed> {
        Ok(f64::from_le_bytes(self.array(what)?))
    }

    /// A time: seconds and nanoseconds.
    pub fn time(&mut self, what: &'static str) -> Result<Nanos, Malformed> {
        let (seconds, rest) = (self.u32(what)?, self.u32(what)?);
        Ok(u64::from(seconds) * 1_000_000_000 + u64::from(rest))
    }

    /// Bytes with their number before them.
    pub fn block(&mut self, what: &'static str) -> Result<&'a [u8], Malformed> {
        let length = self.u32(what)?;
        self.take(u64::from(length), what)
    }

    /// A text with its length before it; bytes that are no UTF-8 are replaced.
    pub fn text(&mut self, what: &'static str) -> Result<String, Malformed> {
        Ok(String::from_utf8_lossy(self.block(what)?).into_owned())
    }

    /// The number of elements that follow, each of which takes at least `size` bytes.
    pub fn count(&mut self, size: usize, what: &'static str) -> Result<usize, Malformed> {
        let count = self.u32(what)?;
        let needed = u64::from(count) * size as u64;
        if needed > self.rest.len() as u64 {
            return Err(Malformed::Cut { what, needed, left: self.rest.len() });
        }
        Ok(count as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_checked_against_what_is_left() {
        let bytes = [2, 0, 0, 0, b'a', b'b', 255, 255, 255, 255, 1];
        let mut cursor = Cursor::new(&bytes);
        assert_eq!(cursor.text("name"), Ok("ab".to_owned()));
        let mut again = cursor;
        assert_eq!(cursor.block("data").unwrap_err().to_string(), "data needs 4294967295 bytes and 1 are left");
        assert!(again.count(8, "points").is_err());
        assert!(Cursor::new(&[1, 2]).u32("size").is_err());
    }
}
