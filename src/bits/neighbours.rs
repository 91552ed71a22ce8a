//! Neighbours by shifts: which cells lie beside those of a plane.

use crate::bits::BitPlane;
use crate::grid::Neighbourhood;
use std::ops::Range;

/// Writes into `target` the words `words` of row `y`: the cells that have a neighbour in
/// `source`, whatever they are themselves. Four words at a time where the work it is part of
/// is compiled for that: see [`crate::grid::with_bit_instructions`].
#[inline(always)]
pub(crate) fn neighbours_of_row(
    source: &BitPlane,
    neighbourhood: Neighbourhood,
    y: usize,
    words: Range<usize>,
    target: &mut [u64],
) {
    let row = source.row(y);
    let below = if y > 0 { Some(source.row(y - 1)) } else { None };
    let above = if y + 1 < source.height() { Some(source.row(y + 1)) } else { None };
    // At the rim the one row stands for both; where there is none, nothing of them counts.
    let [below, above] = [below.or(above).unwrap_or(row), above.or(below).unwrap_or(row)];
    let counts = if source.height() > 1 { u64::MAX } else { 0 };
    let corners = if neighbourhood == Neighbourhood::Eight { u64::MAX } else { 0 };
    // The first and the last word of a row have nothing on one side.
    let last = row.len() - 1;
    for i in [0, last] {
        if words.contains(&i) {
            let mask = if i == last { source.last_word_mask() } else { u64::MAX };
            let here = neighbours([around(row, i), around(below, i), around(above, i)], counts, corners);
            target[i - words.start] = here & mask;
        }
    }
    let inner = words.start.max(1)..words.end.min(last);
    if inner.start >= inner.end {
        return;
    }
    let with_sides = inner.start - 1..inner.end + 1;
    let beside = below[with_sides.clone()].windows(3).zip(above[with_sides.clone()].windows(3));
    let target = target[inner.start - words.start..].iter_mut();
    for (target, (row, (below, above))) in target.zip(row[with_sides].windows(3).zip(beside)) {
        *target = neighbours([three(row), three(below), three(above)], counts, corners);
    }
}

/// A word of a row with those before and after it.
type Three = [u64; 3];

/// The window of three words as an array.
#[inline(always)]
fn three(words: &[u64]) -> Three {
    [words[0], words[1], words[2]]
}

/// A word of a row with those before and after it, as far as there are such.
#[inline(always)]
fn around(row: &[u64], i: usize) -> Three {
    let at = |i: usize| row.get(i).copied().unwrap_or(0);
    [at(i.wrapping_sub(1)), at(i), at(i + 1)]
}

/// The cells of a word that have a neighbour in these words of its row and those below and
/// above.
#[inline(always)]
const fn neighbours([row, below, above]: [Three; 3], counts: u64, corners: u64) -> u64 {
    let vertical = [(below[0] | above[0]) & counts, (below[1] | above[1]) & counts, (below[2] | above[2]) & counts];
    let [before, here, after] =
        [row[0] | vertical[0] & corners, row[1] | vertical[1] & corners, row[2] | vertical[2] & corners];
    vertical[1] | here << 1 | before >> 63 | here >> 1 | after << 63
}
