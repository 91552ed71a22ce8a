//! Portable greymaps, read as SDL_image reads them for map_server.
//!
//! P2 and P5 of <https://netpbm.sourceforge.net/doc/pgm.html>, with comments and any
//! maximum from 1 to 65535. Values are scaled to 0..=255 in integers as SDL_image's
//! `IMG_pnm.c` has it, which itself stops at a maximum of 255; for two-byte samples the
//! same rule is carried on. Written here rather than left to an image library, since
//! the scaling decides on which side of a threshold a pixel falls.

use crate::grid::MAX_CELLS;

/// Why a greymap cannot be read.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum PgmError {
    /// Not in the format.
    Damaged(String),
    /// No pixels, or too many.
    Size(u64, u64),
    /// Pixels found, columns, rows.
    Truncated(u64, u64, u64),
}

/// A decoded greymap.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Greymap {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Grey 0..=255, top row first.
    pub pixels: Vec<u8>,
}

/// Decodes a file that starts with `P2` or `P5`.
pub(super) fn decode(bytes: &[u8]) -> Result<Greymap, PgmError> {
    let binary = bytes.starts_with(b"P5");
    let mut reader = Reader { bytes, at: 2 };
    let width = reader.header("the width")?;
    let height = reader.header("the height")?;
    let maximum = reader.header("the largest grey value")?;
    let count = width.checked_mul(height).filter(|count| (1..=MAX_CELLS).contains(count));
    let (Some(count), Ok(columns), Ok(rows)) = (count, u32::try_from(width), u32::try_from(height)) else {
        return Err(PgmError::Size(width, height));
    };
    if !(1..=65535).contains(&maximum) {
        return Err(PgmError::Damaged(format!("its largest grey value is {maximum}: must be 1 to 65535")));
    }
    let pixels = if binary { reader.raster(count, maximum) } else { reader.text(count, maximum) };
    let found = pixels.len() as u64;
    if found < count {
        return Err(PgmError::Truncated(found, width, height));
    }
    Ok(Greymap { width: columns, height: rows, pixels })
}

/// A value on the scale 0..=maximum as a byte; above the maximum is the maximum.
fn scaled(value: u64, maximum: u64) -> u8 {
    (value.min(maximum) * 255 / maximum) as u8
}

/// What is left of the file.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn header(&mut self, what: &str) -> Result<u64, PgmError> {
        self.number().ok_or_else(|| PgmError::Damaged(format!("its header ends before {what}")))
    }

    /// The next decimal number after white space and comments; one too large for 64
    /// bits is the largest there is.
    fn number(&mut self) -> Option<u64> {
        loop {
            match self.bytes.get(self.at)? {
                b'#' => {
                    let rest = self.bytes.get(self.at..)?;
                    self.at += rest.iter().position(|b| matches!(b, b'\n' | b'\r'))?;
                }
                byte if byte.is_ascii_whitespace() => self.at += 1,
                byte if byte.is_ascii_digit() => break,
                _ => return None,
            }
        }
        let mut number = 0_u64;
        while let Some(digit) = self.bytes.get(self.at).filter(|byte| byte.is_ascii_digit()) {
            number = number.saturating_mul(10).saturating_add(u64::from(digit - b'0'));
            self.at += 1;
        }
        Some(number)
    }

    /// Binary samples, as many as there are, at most `count`: they start after the one
    /// character of white space that ends the header.
    fn raster(&self, count: u64, maximum: u64) -> Vec<u8> {
        let data = self.bytes.get(self.at + 1..).unwrap_or_default();
        let count = usize::try_from(count).unwrap_or(usize::MAX);
        if maximum < 256 {
            data.iter().take(count).map(|&value| scaled(u64::from(value), maximum)).collect()
        } else {
            let (pairs, _) = data.as_chunks::<2>();
            pairs.iter().take(count).map(|&pair| scaled(u64::from(u16::from_be_bytes(pair)), maximum)).collect()
        }
    }

    /// Samples in decimal, as many as there are, at most `count`.
    fn text(&mut self, count: u64, maximum: u64) -> Vec<u8> {
        let mut pixels = Vec::new();
        while (pixels.len() as u64) < count {
            match self.number() {
                Some(value) => pixels.push(scaled(value, maximum)),
                None => break,
            }
        }
        pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(bytes: &[u8]) -> Vec<u8> {
        decode(bytes).unwrap().pixels
    }

    #[test]
    fn both_kinds_with_comments_are_read() {
        let expected = Greymap { width: 2, height: 1, pixels: vec![0, 254] };
        assert_eq!(decode(b"P5\n# CREATOR: map_saver.cpp 0.050 m/pix\n2 1\n255\n\x00\xfe").unwrap(), expected);
        assert_eq!(decode(b"P2 # one\n#two\n2#three\n1 255 0 # four\n254").unwrap(), expected);
    }

    #[test]
    fn a_pixel_that_looks_like_white_space_or_a_comment_is_a_pixel() {
        assert_eq!(pixels(b"P5 3 1 255\n\n# "), [10, 35, 32]);
    }

    #[test]
    fn other_maxima_are_scaled_in_integers() {
        assert_eq!(pixels(b"P5 3 1 100\n\x00\x32\x64"), [0, 127, 255]);
        assert_eq!(pixels(b"P5 2 1 1\n\x01\x07"), [255, 255]);
        assert_eq!(pixels(b"P5 3 1 65535\n\xff\xff\x80\x00\x00\x01"), [255, 127, 0]);
        assert_eq!(pixels(b"P2 2 1 1000\n1000 500"), [255, 127]);
    }

    #[test]
    fn damage_is_named() {
        let huge = decode(b"P5 2147483648 2147483648 255\n").unwrap_err();
        assert_eq!(huge, PgmError::Size(2_147_483_648, 2_147_483_648));
        assert!(matches!(decode(b"P5 99999999999999999999999 1 255\n"), Err(PgmError::Size(_, 1))));
        assert_eq!(decode(b"P5 0 4 255\n").unwrap_err(), PgmError::Size(0, 4));
        assert_eq!(decode(b"P5 2 2 255\nabc").unwrap_err(), PgmError::Truncated(3, 2, 2));
        assert_eq!(decode(b"P5 2 1 256\nabc").unwrap_err(), PgmError::Truncated(1, 2, 1));
        assert_eq!(decode(b"P2 2 2 255\n1 2 x").unwrap_err(), PgmError::Truncated(2, 2, 2));
        assert_eq!(decode(b"P5 16384 16384 255\n").unwrap_err(), PgmError::Truncated(0, 16384, 16384));
        for bad in [b"P5".as_slice(), b"P5 2", b"P5 2 -2 255\n", b"P5 2 2 # no end", b"P5 1 1 0\na", b"P5 1 1 70000\na"]
        {
            assert!(matches!(decode(bad), Err(PgmError::Damaged(_))), "{bad:?}");
        }
    }
}
