//! A plane of cells cut into bands: two rows where corners connect, else one.

use crate::bits::BitPlane;
use crate::bits::contacts::{Meet, for_each_band_contact};

/// A plane cut into bands.
#[derive(Clone, Copy)]
pub(super) struct Bands<'a> {
    pub plane: &'a BitPlane,
    pub none: &'a [u64],
    pub eight: bool,
}

impl<'a> Bands<'a> {
    /// Rows of a band.
    #[inline(always)]
    pub const fn rows(self) -> usize {
        if self.eight { 2 } else { 1 }
    }

    #[inline(always)]
    pub const fn count(self) -> usize {
        self.plane.height().div_ceil(self.rows())
    }

    /// The two rows of a band, the second empty if there is none.
    #[inline(always)]
    pub fn band(self, band: usize) -> [&'a [u64]; 2] {
        let row = |y: usize| if y < self.plane.height() { self.plane.row(y) } else { self.none };
        if self.eight { [row(2 * band), row(2 * band + 1)] } else { [row(band), self.none] }
    }

    /// Meets the runs of a band that touch those of the band below it. The number of runs.
    #[inline(always)]
    pub fn for_each_contact(self, rows: [&[u64]; 2], below: [&[u64]; 2], visit: impl Meet) -> u32 {
        let nearest = if self.eight { below[1] } else { below[0] };
        let words = rows[0].iter().zip(rows[1]).zip(below[0].iter().zip(below[1]).zip(nearest));
        let words = words.map(|((a, b), ((c, d), &near))| [(a | b, *a), (c | d, near)]);
        for_each_band_contact(words, self.eight, visit)
    }
}
