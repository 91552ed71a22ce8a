//! Neighbours by shifts: which cells lie beside those of a plane.

use crate::grid::{BitPlane, Neighbourhood};
use std::ops::Range;

/// One word of a row with what stands around it.
#[derive(Clone, Copy, Debug, Default)]
struct Around {
    /// What stands below and above.
    vertical: u64,
    /// What counts for the neighbours to the left and right.
    centre: u64,
}

/// Writes into the words `words` of `target`'s row `y` the cells that have a neighbour in
/// `source`, a plane of the same size, whatever they are themselves.
pub(super) fn neighbours_of_row(
    source: &BitPlane,
    neighbourhood: Neighbourhood,
    y: usize,
    words: Range<usize>,
    target: &mut [u64],
) {
    let below = if y > 0 { source.row(y - 1) } else { &[] };
    let above = if y + 1 < source.height() { source.row(y + 1) } else { &[] };
    let row = source.row(y);
    let corners = if neighbourhood == Neighbourhood::Eight { u64::MAX } else { 0 };
    let around = |i: usize| {
        let vertical = below.get(i).copied().unwrap_or(0) | above.get(i).copied().unwrap_or(0);
        Around { vertical, centre: row.get(i).copied().unwrap_or(0) | (vertical & corners) }
    };
    let mut before = if words.start > 0 { around(words.start - 1) } else { Around::default() };
    let mut here = around(words.start);
    let last = (row.len() - 1, source.last_word_mask());
    for (i, target) in words.zip(target) {
        let after = around(i + 1);
        *target = here.vertical | here.centre << 1 | before.centre >> 63 | here.centre >> 1 | after.centre << 63;
        if i == last.0 {
            *target &= last.1;
        }
        (before, here) = (here, after);
    }
}
