//! What is written of a tile, and where it differs from what was there.

use super::super::window::Window;
use crate::grid::BitPlane;

/// Where in a tile other cells are reached than before.
#[derive(Clone, Copy, Debug, Default)]
pub(in super::super) struct Changed {
    /// Anywhere.
    pub any: bool,
    /// In its lowest row.
    pub below: bool,
    /// In its highest row.
    pub above: bool,
    /// In its first column.
    pub left: bool,
    /// In its last column.
    pub right: bool,
}

impl Changed {
    /// Whether cells of a tile so many columns and rows on lie beside one that changed, as
    /// far as can be told from the sides.
    pub const fn touches(self, (columns, rows): (isize, isize)) -> bool {
        self.any
            && (columns == 0 || if columns > 0 { self.right } else { self.left })
            && (rows == 0 || if rows > 0 { self.above } else { self.below })
    }
}

/// Where the reached cells of a tile are written.
pub(super) struct Written<'a> {
    pub changed: Changed,
    pub window: &'a Window,
    pub plane: &'a mut BitPlane,
}

impl Written<'_> {
    /// Writes a word and notes where it differs from what was there.
    #[inline(always)]
    pub fn put(&mut self, y: usize, i: usize, word: u64) {
        let Self { changed, window, plane } = self;
        let target = &mut plane.row_mut(y)[i];
        let differs = *target ^ word;
        *target = word;
        if differs != 0 {
            changed.any = true;
            changed.below |= y == window.rows.start;
            changed.above |= y + 1 == window.rows.end;
            changed.left |= i == window.words.start && differs & 1 != 0;
            changed.right |= i + 1 == window.words.end && differs >> 63 != 0;
        }
    }
}
