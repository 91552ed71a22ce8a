//! A part of a plane: whole words of some rows.

use crate::bits::BitPlane;
use std::ops::Range;

/// Words of rows of a plane. Beyond them nothing is looked at.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Window {
    /// The rows.
    pub rows: Range<usize>,
    /// The words of each of them.
    pub words: Range<usize>,
}

impl Window {
    /// All of a plane.
    pub const fn of(plane: &BitPlane) -> Self {
        Self { rows: 0..plane.height(), words: 0..plane.row_words() }
    }

    /// The words of row `y` of a plane, counted as the plane does; none if the row is not
    /// in the window.
    pub fn row<'a>(&self, plane: &'a BitPlane, y: usize) -> &'a [u64] {
        if self.rows.contains(&y) { &plane.row(y)[self.words.clone()] } else { &[] }
    }
}
