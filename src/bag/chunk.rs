//! How the data of a chunk is compressed.
//!
//! roslz4 reads LZ4 frames with independent blocks and without block checksums or a
//! content size; so they are written.

use serde::Serialize;
use std::io::{self, Read, Write};

/// A chunk with more than this is not read: `rosbag record` closes one at 768 kB unless
/// told otherwise, and one message can be as large as a map.
pub const MAX_CHUNK_BYTES: u64 = 128 << 20;

/// How a chunk is compressed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Compression {
    /// Not at all.
    #[default]
    None,
    /// By bzip2.
    Bz2,
    /// As an LZ4 frame.
    Lz4,
}

impl Compression {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::None, Self::Bz2, Self::Lz4];

    /// Its name in a chunk's header.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Bz2 => "bz2",
            Self::Lz4 => "lz4",
        }
    }

    /// The compression of a name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Appends what `input` holds, without the compression, to `out`, and no more than
    /// [`MAX_CHUNK_BYTES`]; what could be read before an error stays.
    pub(super) fn expand(self, input: &mut dyn Read, out: &mut Vec<u8>) -> io::Result<()> {
        match self {
            Self::None => copy(input, out),
            Self::Bz2 => copy(&mut bzip2::read::BzDecoder::new(input), out),
            Self::Lz4 => copy(&mut lz4::Decoder::new(input)?, out),
        }
    }

    /// The compressed bytes.
    pub(super) fn compress(self, bytes: &[u8]) -> io::Result<Vec<u8>> {
        match self {
            Self::None => Ok(bytes.to_vec()),
            Self::Bz2 => {
                let mut encoder = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
                encoder.write_all(bytes)?;
                encoder.finish()
            }
            Self::Lz4 => {
                let mut encoder = lz4::EncoderBuilder::new()
                    .block_mode(lz4::BlockMode::Independent)
                    .block_size(lz4::BlockSize::Max1MB)
                    .block_checksum(lz4::liblz4::BlockChecksum::NoBlockChecksum)
                    .checksum(lz4::ContentChecksum::ChecksumEnabled)
                    .build(Vec::new())?;
                encoder.write_all(bytes)?;
                let (bytes, result) = encoder.finish();
                result.map(|()| bytes)
            }
        }
    }
}

/// What a chunk of more than the most bytes gives.
pub(super) fn too_long() -> io::Error {
    io::Error::other(format!("it holds more than {MAX_CHUNK_BYTES} bytes"))
}

/// Reads to the end in steps, so that what came before an error is kept.
fn copy(input: &mut dyn Read, out: &mut Vec<u8>) -> io::Result<()> {
    let mut buffer = [0; 1 << 16];
    loop {
        let count = match input.read(&mut buffer) {
            Ok(0) => return Ok(()),
            Ok(count) => count,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        if out.len() as u64 + count as u64 > MAX_CHUNK_BYTES {
            return Err(too_long());
        }
        out.extend_from_slice(buffer.get(..count).unwrap_or_default());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_compressed_comes_back_and_a_cut_gives_its_beginning() {
        let bytes: Vec<u8> = (0..300_000_u32).map(|i| (i.wrapping_mul(i) >> 7) as u8).collect();
        for kind in Compression::ALL {
            let packed = kind.compress(&bytes).unwrap();
            let mut back = Vec::new();
            kind.expand(&mut packed.as_slice(), &mut back).unwrap();
            assert!(back == bytes, "{kind:?}");
            back.clear();
            let _ = kind.expand(&mut &packed[..packed.len() / 2], &mut back);
            assert!(bytes.starts_with(&back) && back.len() < bytes.len(), "{kind:?}");
            assert_eq!(Compression::from_name(kind.name()), Some(kind));
        }
    }
}
