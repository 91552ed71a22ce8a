//! The image half of a map: PGM or PNG into greys and transparency.
//!
//! map_server sees what SDL_image gives it: one byte a channel (of two-byte samples
//! the high one), and grey with transparency as red, green, blue and alpha. One thing
//! is read better than there: a PNG with a palette by its colours, where map_server
//! takes the number of the palette entry for a grey.

use super::MapError;
use super::error::read_file;
use super::pgm::{self, PgmError};
use crate::grid::MAX_CELLS;
use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, Limits};
use std::io::Cursor;
use std::path::Path;

/// The largest image file that is read, bytes: four samples of two bytes a cell.
const MAX_IMAGE_BYTES: u64 = 8 * MAX_CELLS;

/// The most bytes that a PNG may unpack to: four samples of one byte a cell.
const MAX_UNPACKED_BYTES: u64 = 4 * MAX_CELLS;

/// Deflate's best: no PNG unpacks to more than this many times its size.
const MAX_DEFLATE_RATIO: u64 = 1032;

/// A PNG's numbers for kinds of pixels with more than one sample.
const PNG_RGB: u8 = 2;
const PNG_GREY_ALPHA: u8 = 4;
const PNG_RGBA: u8 = 6;

/// What a map is made of, top row first.
pub(super) struct MapPixels {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The channels of each pixel.
    pub channels: Channels,
}

/// The samples of an image.
pub(super) enum Channels {
    /// One grey a pixel.
    Grey(Vec<u8>),
    /// Red, green and blue.
    Rgb(Vec<[u8; 3]>),
    /// Red, green, blue and alpha.
    Rgba(Vec<[u8; 4]>),
}

/// Reads a map's image.
pub(super) fn read_image(path: &Path) -> Result<MapPixels, MapError> {
    decode_image(&read_file(path, "the image of a map", MAX_IMAGE_BYTES)?, path)
}

/// Decodes the bytes of a map's image; `path` is for messages.
pub(super) fn decode_image(bytes: &[u8], path: &Path) -> Result<MapPixels, MapError> {
    match bytes {
        [b'P', b'2' | b'5', ..] => read_pgm(bytes, path),
        [0x89, b'P', b'N', b'G', ..] => read_png(bytes, path),
        [b'P', b'1' | b'3' | b'4' | b'6' | b'7', ..] => Err(kind(path, "another kind of PNM image")),
        [b'B', b'M', ..] => Err(kind(path, "a BMP image")),
        [0xff, 0xd8, ..] => Err(kind(path, "a JPEG image")),
        [b'G', b'I', b'F', ..] => Err(kind(path, "a GIF image")),
        _ => Err(kind(path, "of no kind that is known here")),
    }
}

fn kind(path: &Path, found: &'static str) -> MapError {
    MapError::ImageKind { path: path.to_path_buf(), found }
}

fn read_pgm(bytes: &[u8], path: &Path) -> Result<MapPixels, MapError> {
    let path = path.to_path_buf();
    match pgm::decode(bytes) {
        Ok(map) => Ok(MapPixels { width: map.width, height: map.height, channels: Channels::Grey(map.pixels) }),
        Err(PgmError::Damaged(reason)) => Err(MapError::Image { path, reason }),
        Err(PgmError::Size(width, height)) => Err(MapError::ImageSize { path, width, height }),
        Err(PgmError::Truncated(found, width, height)) => Err(MapError::Truncated { path, found, width, height }),
    }
}

fn read_png(bytes: &[u8], path: &Path) -> Result<MapPixels, MapError> {
    let damaged = |error: image::ImageError| MapError::Image {
        path: path.to_path_buf(),
        reason: error.to_string().lines().collect::<Vec<_>>().join(" "),
    };
    check_png_size(bytes, path)?;
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_UNPACKED_BYTES);
    let decoder = PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(damaged)?;
    let (width, height) = decoder.dimensions();
    let unpacked = decoder.total_bytes();
    if unpacked > MAX_UNPACKED_BYTES {
        let reason = format!("it unpacks to {unpacked} bytes: must be at most {MAX_UNPACKED_BYTES}");
        return Err(MapError::Image { path: path.to_path_buf(), reason });
    }
    let decoded = DynamicImage::from_decoder(decoder).map_err(damaged)?;
    let channels = match decoded {
        DynamicImage::ImageLuma8(grey) => Channels::Grey(grey.into_raw()),
        DynamicImage::ImageLuma16(grey) => Channels::Grey(grey.into_raw().into_iter().map(high_byte).collect()),
        DynamicImage::ImageRgb8(rgb) => Channels::Rgb(rgb.pixels().map(|p| p.0).collect()),
        DynamicImage::ImageRgb16(rgb) => Channels::Rgb(rgb.pixels().map(|p| p.0.map(high_byte)).collect()),
        DynamicImage::ImageRgba16(rgba) => Channels::Rgba(rgba.pixels().map(|p| p.0.map(high_byte)).collect()),
        DynamicImage::ImageLumaA16(both) => {
            let spread = |[grey, alpha]: [u8; 2]| [grey, grey, grey, alpha];
            Channels::Rgba(both.pixels().map(|p| spread(p.0.map(high_byte))).collect())
        }
        other => Channels::Rgba(other.into_rgba8().pixels().map(|p| p.0).collect()),
    };
    Ok(MapPixels { width, height, channels })
}

/// Checks the size that a PNG claims, before a decoder sees it: a header may promise
/// more than a grid can hold, or than its own file can.
fn check_png_size(bytes: &[u8], path: &Path) -> Result<(), MapError> {
    // The first chunk follows signature, length and name, and begins with the size.
    let Some(&[w0, w1, w2, w3, h0, h1, h2, h3, depth, colours]) = bytes.get(16..26) else {
        return Err(MapError::Image { path: path.to_path_buf(), reason: "its header is cut off".to_owned() });
    };
    let width = u64::from(u32::from_be_bytes([w0, w1, w2, w3]));
    let height = u64::from(u32::from_be_bytes([h0, h1, h2, h3]));
    let count = width * height;
    if !(1..=MAX_CELLS).contains(&count) {
        return Err(MapError::ImageSize { path: path.to_path_buf(), width, height });
    }
    let samples = match colours {
        PNG_RGB => 3,
        PNG_GREY_ALPHA => 2,
        PNG_RGBA => 4,
        // One of grey or of a palette; others the decoder refuses.
        _ => 1,
    };
    let bits = (u64::from(depth) * samples).max(1);
    let found = (bytes.len() as u64).saturating_mul(MAX_DEFLATE_RATIO * 8) / bits;
    if count > found {
        return Err(MapError::Truncated { path: path.to_path_buf(), found, width, height });
    }
    Ok(())
}

/// What libpng keeps of a two-byte sample when it is told to strip.
const fn high_byte(sample: u16) -> u8 {
    (sample >> 8) as u8
}
