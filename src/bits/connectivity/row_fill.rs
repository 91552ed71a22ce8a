//! Fills the cells that are connected to a seed, a whole row of a plane at a time, without labels.
//!
//! To fill a run of bits from a seed in it to its end is one addition, whose carry runs
//! along the ones; it goes on from word to word as in the addition of long integers. To
//! its beginning it is six steps of doubling length (Kogge and Stone, IEEE Transactions on
//! Computers 1973), where that is needed at all. Rows are visited in sweeps up and down as
//! long as one has something to take from a row beside it, and there only.
//!
//! On maps of buildings each row is visited a few times. A spiral or a maze can take as
//! many sweeps as it has turns: after so many visits the fill gives up.

use crate::bits::word_spans::WordSpan;
use crate::bits::{BitPlane, BitWork, WORD_CELLS, with_bit_instructions};
use crate::grid::{Cell, Neighbourhood};
use std::ops::Range;

/// Visits and looks at rows, in rows of the plane, after which to join tiles is cheaper.
const MOST_STEPS_PER_ROW: usize = 48;

/// The work of a fill from a seed that is reached.
struct Sweeps<'a> {
    flood: &'a mut RowFill,
    open: &'a BitPlane,
    seed: Cell,
    reached: &'a mut BitPlane,
    most_steps: usize,
}

impl BitWork for Sweeps<'_> {
    type Output = Option<()>;

    #[inline(always)]
    fn run(self) -> Option<()> {
        self.flood.sweep(self.open, self.seed, self.reached, self.most_steps)
    }
}

/// The fill, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct RowFill {
    /// Of each row, the words in which it has cells beside reached ones that it has not
    /// taken.
    pending: Vec<WordSpan>,
    /// The row that is visited.
    row: Vec<u64>,
    /// A row without a cell, beyond the first and the last.
    none: Vec<u64>,
    /// Whether corners connect.
    eight: bool,
}

impl RowFill {
    /// Finds the cells of `open` that are connected to a seed; none if it is not open.
    /// `None`, with nothing useful in `reached`, if that takes too many visits.
    pub fn fill(
        &mut self,
        open: &BitPlane,
        neighbourhood: Neighbourhood,
        seed: Cell,
        reached: &mut BitPlane,
    ) -> Option<()> {
        self.fill_within(open, neighbourhood, seed, reached, MOST_STEPS_PER_ROW * open.height())
    }

    /// The same with so many steps at most.
    fn fill_within(
        &mut self,
        open: &BitPlane,
        neighbourhood: Neighbourhood,
        seed: Cell,
        reached: &mut BitPlane,
        most_steps: usize,
    ) -> Option<()> {
        reached.resize(open.width(), open.height());
        reached.clear();
        if !open.contains(seed) {
            return Some(());
        }
        self.eight = neighbourhood == Neighbourhood::Eight;
        reached.insert(seed);
        with_bit_instructions(Sweeps { flood: self, open, seed, reached, most_steps })
    }

    /// Sweeps up and down from the seed as long as there is something to take.
    #[inline(always)]
    fn sweep(&mut self, open: &BitPlane, seed: Cell, reached: &mut BitPlane, most_steps: usize) -> Option<()> {
        self.row.resize(open.row_words(), 0);
        self.none.resize(open.row_words(), 0);
        self.pending.clear();
        self.pending.resize(open.height(), WordSpan::NONE);
        let (first, word) = (seed.y as usize, seed.x as usize / WORD_CELLS);
        self.pending[first] = WordSpan::of(&(word..word + 1));
        let (mut low, mut high, mut steps) = (first, first, 0);
        let mut upwards = true;
        // All that is pending lies from `low` to `high`, and after a sweep behind it.
        loop {
            let (mut y, mut behind) = (if upwards { low } else { high }, WordSpan::NONE);
            loop {
                steps += 1;
                if steps > most_steps {
                    return None;
                }
                if !self.pending[y].is_empty() {
                    let (below, above) = self.visit(open, reached, y);
                    if below {
                        low = low.min(y - 1);
                        if upwards {
                            behind.join(WordSpan::of(&(y - 1..y)));
                        }
                    }
                    if above {
                        high = high.max(y + 1);
                        if !upwards {
                            behind.join(WordSpan::of(&(y + 1..y + 2)));
                        }
                    }
                }
                if y == if upwards { high } else { low } {
                    break;
                }
                y = if upwards { y + 1 } else { y - 1 };
            }
            if behind.is_empty() {
                return Some(());
            }
            let rows = behind.words();
            (low, high) = (rows.start, rows.end - 1);
            upwards = !upwards;
        }
    }

    /// Takes into a row what is beside the reached cells of those around it; whether the
    /// row below and the one above have then something to take from it.
    #[inline(always)]
    fn visit(&mut self, open: &BitPlane, reached: &mut BitPlane, y: usize) -> (bool, bool) {
        let Self { pending, row, none, eight } = self;
        let none = &none[..];
        let words = std::mem::replace(&mut pending[y], WordSpan::NONE).words();
        let has_above = y + 1 < open.height();
        let below = if y > 0 { reached.row(y - 1) } else { none };
        let above = if has_above { reached.row(y + 1) } else { none };
        let (here, cells) = (reached.row(y), open.row(y));
        take_from_beside(row, &words, [below, here, above], cells, *eight);
        let end = fill_upwards(row, &words, here, cells);
        let start = fill_downwards(row, &(words.start..end), here, cells);
        reached.row_mut(y)[start..end].copy_from_slice(&row[start..end]);
        let filled = start..end;
        let offered = if *eight { widen(row, &filled, reached.row(y)) } else { filled };
        let mut takes = [false; 2];
        for (takes, y) in takes.iter_mut().zip([y.checked_sub(1), has_above.then_some(y + 1)]) {
            let Some(y) = y else { continue };
            let taken = taken_from(row, &offered, open.row(y), reached.row(y));
            pending[y].join(taken);
            *takes = !taken.is_empty();
        }
        (takes[0], takes[1])
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.pending.capacity() * size_of::<WordSpan>()
            + (self.row.capacity() + self.none.capacity()) * size_of::<u64>()
    }
}

/// Writes into the span of `row` the cells that are reached or beside what is reached in
/// the rows below and above.
#[inline(always)]
fn take_from_beside(
    row: &mut [u64],
    words: &Range<usize>,
    [below, here, above]: [&[u64]; 3],
    cells: &[u64],
    eight: bool,
) {
    let Range { start, end } = *words;
    let pairs = below[start..end].iter().zip(&above[start..end]).zip(here[start..end].iter().zip(&cells[start..end]));
    for (target, ((below, above), (here, cells))) in row[start..end].iter_mut().zip(pairs) {
        let beside = below | above;
        *target = here | beside & cells;
    }
    if eight {
        let beside = |i: usize| below.get(i).copied().unwrap_or(0) | above.get(i).copied().unwrap_or(0);
        for i in start..end {
            let before = if i > 0 { beside(i - 1) } else { 0 };
            row[i] |= (beside(i) << 1 | before >> 63 | beside(i) >> 1 | beside(i + 1) << 63) & cells[i];
        }
    }
}

/// Fills runs of `cells` from their seeds to their last cell, from the span on as far as
/// that leads; where it ends.
#[inline(always)]
fn fill_upwards(row: &mut [u64], words: &Range<usize>, here: &[u64], cells: &[u64]) -> usize {
    let mut carry = false;
    let mut fill = |seeds: u64, cells: u64| {
        let (sum, over) = cells.overflowing_add(seeds);
        let (sum, over_again) = sum.overflowing_add(u64::from(carry));
        carry = over | over_again;
        (seeds | cells & !sum, carry)
    };
    let mut goes_on = false;
    for (seeds, &cells) in row[words.clone()].iter_mut().zip(&cells[words.clone()]) {
        (*seeds, goes_on) = fill(*seeds, cells);
    }
    let mut end = words.end;
    while goes_on && end < row.len() {
        (row[end], goes_on) = fill(here[end], cells[end]);
        end += 1;
    }
    end
}

/// Fills runs of `cells` from their seeds to their first cell, from the span on as far
/// as that leads; where it begins.
#[inline(always)]
fn fill_downwards(row: &mut [u64], words: &Range<usize>, here: &[u64], cells: &[u64]) -> usize {
    for (seeds, &cells) in row[words.clone()].iter_mut().zip(&cells[words.clone()]) {
        *seeds = filled_downwards(*seeds, cells);
    }
    // All bits if the first cell of the word after is filled.
    let mut from_next = 0;
    let mut fill = |filled: u64, cells: u64| {
        let gaps = !cells;
        let last_run = if gaps == 0 { u64::MAX } else { !(u64::MAX >> gaps.leading_zeros()) };
        let filled = filled | last_run & from_next;
        from_next = (filled & 1).wrapping_neg();
        filled
    };
    for (filled, &cells) in row[words.clone()].iter_mut().zip(&cells[words.clone()]).rev() {
        *filled = fill(*filled, cells);
    }
    let mut start = words.start;
    while start > 0 && row[start] << 63 & cells[start - 1] & !here[start - 1] != 0 {
        start -= 1;
        row[start] = fill(here[start], cells[start]);
    }
    start
}

/// The runs of `cells` from their first cell to the last of their seeds.
#[inline(always)]
pub(crate) const fn filled_downwards(mut seeds: u64, mut cells: u64) -> u64 {
    let mut length = 1;
    while length < WORD_CELLS {
        seeds |= seeds >> length & cells;
        cells &= cells >> length;
        length *= 2;
    }
    seeds
}

/// The words of a row beside this one in which it has something to take from it.
#[inline(always)]
fn taken_from(row: &[u64], words: &Range<usize>, open: &[u64], reached: &[u64]) -> WordSpan {
    let taken = || {
        row[words.clone()].iter().zip(&open[words.clone()]).zip(&reached[words.clone()]).map(|((a, b), c)| a & b & !c)
    };
    // To look at all, four at a time, is faster than to look for the first.
    if taken().fold(0, |any, word| any | word) == 0 {
        return WordSpan::NONE;
    }
    let mut takes = taken().map(|word| word != 0);
    let Some(first) = takes.position(|takes| takes) else { return WordSpan::NONE };
    let start = words.start + first;
    WordSpan::of(&(start..start + 1 + takes.rposition(|takes| takes).map_or(0, |after| after + 1)))
}

/// Adds the cells to the left and right within a span, one word wider than what is filled.
#[inline(always)]
fn widen(row: &mut [u64], filled: &Range<usize>, here: &[u64]) -> Range<usize> {
    let wider = filled.start.saturating_sub(1)..(filled.end + 1).min(row.len());
    row[wider.start..filled.start].copy_from_slice(&here[wider.start..filled.start]);
    row[filled.end..wider.end].copy_from_slice(&here[filled.end..wider.end]);
    let mut before = 0;
    for i in wider.clone() {
        let word = row[i];
        let after = if i + 1 < wider.end { row[i + 1] } else { 0 };
        row[i] |= word << 1 | before >> 63 | word >> 1 | after << 63;
        before = word;
    }
    wider
}

#[cfg(test)]
#[path = "row_fill_tests.rs"]
mod tests;
