//! Neighbours by shifts: which cells lie beside those of a plane.

use crate::grid::{BitPlane, BitWork, Neighbourhood, with_bit_instructions};
use std::ops::Range;

/// Writes into `target` the words `words` of row `y`: the cells that have a neighbour in
/// `source`, whatever they are themselves.
pub(super) fn neighbours_of_row(
    source: &BitPlane,
    neighbourhood: Neighbourhood,
    y: usize,
    words: Range<usize>,
    target: &mut [u64],
) {
    let row = source.row(y);
    let below = (y > 0).then(|| source.row(y - 1));
    let above = (y + 1 < source.height()).then(|| source.row(y + 1));
    // At the rim the one row stands for both; where there is none, nothing of them counts.
    let beside = [below.or(above), above.or(below)].map(|beside| beside.unwrap_or(row));
    let counts = if source.height() > 1 { u64::MAX } else { 0 };
    let corners = if neighbourhood == Neighbourhood::Eight { u64::MAX } else { 0 };
    with_bit_instructions(Neighbours { row, beside, counts, corners, words: words.clone(), target });
    if words.end == row.len()
        && let Some(last) = target.get_mut(words.len() - 1)
    {
        *last &= source.last_word_mask();
    }
}

/// The work of it, four words at a time where nothing stands in the way.
struct Neighbours<'a> {
    row: &'a [u64],
    beside: [&'a [u64]; 2],
    /// Which cells of the rows beside this one count.
    counts: u64,
    /// Which of them do for the columns to the left and right.
    corners: u64,
    words: Range<usize>,
    target: &'a mut [u64],
}

impl BitWork for Neighbours<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { row, beside: [below, above], counts, corners, words, target } = self;
        // The first and the last word of a row have nothing on one side.
        let inner = words.start.max(1)..words.end.min(row.len() - 1).max(1);
        for i in [0, row.len() - 1].into_iter().filter(|i| words.contains(i)) {
            target[i - words.start] = neighbours([around(row, i), around(below, i), around(above, i)], counts, corners);
        }
        if inner.is_empty() {
            return;
        }
        let threes = inner.start - 1..=inner.end;
        let [row, below, above] = [&row[threes.clone()], &below[threes.clone()], &above[threes]];
        let beside = below.windows(3).zip(above.windows(3));
        for (target, (row, (below, above))) in
            target[inner.start - words.start..].iter_mut().zip(row.windows(3).zip(beside))
        {
            *target = neighbours([three(row), three(below), three(above)], counts, corners);
        }
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
