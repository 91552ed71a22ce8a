//! What is connected to a seed, without a label: a row is filled at once.
//!
//! To fill a run of bits from a seed in it to its end is one addition, whose carry runs
//! along the ones; it goes on from word to word as in the addition of long integers. To
//! its beginning it is six steps of doubling length (Kogge and Stone, IEEE Transactions on
//! Computers 1973), where that is needed at all. Rows are visited in sweeps up and down as
//! long as one has something to take from a row beside it, and there only.
//!
//! On maps of buildings each row is visited a few times. A spiral or a maze can take as
//! many sweeps as it has turns: after so many visits the fill gives up.

use super::spans::Span;
use crate::grid::{BitPlane, BitWork, Cell, Neighbourhood, WORD_CELLS, with_bit_instructions};
use std::ops::Range;

/// Visits and looks at rows, in rows of the plane, after which to label runs is cheaper.
const MOST_STEPS_PER_ROW: usize = 48;

/// The work of a fill from a seed that is reached.
struct Sweeps<'a> {
    flood: &'a mut Flood,
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
pub(super) struct Flood {
    /// Of each row, the words in which it has cells beside reached ones that it has not
    /// taken.
    pending: Vec<Span>,
    /// What the row that is visited offers to those beside it, where corners connect.
    row: Vec<u64>,
    /// A row without a cell, beyond the first and the last.
    none: Vec<u64>,
    /// Whether corners connect.
    eight: bool,
}

impl Flood {
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
        self.pending.resize(open.height(), Span::NONE);
        let (first, word) = (seed.y as usize, seed.x as usize / WORD_CELLS);
        self.pending[first] = Span::of(&(word..word + 1));
        let (mut low, mut high, mut steps) = (first, first, 0);
        let mut upwards = true;
        // All that is pending lies from `low` to `high`, and after a sweep behind it.
        loop {
            let (mut y, mut behind) = (if upwards { low } else { high }, Span::NONE);
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
                            behind.join(Span::of(&(y - 1..y)));
                        }
                    }
                    if above {
                        high = high.max(y + 1);
                        if !upwards {
                            behind.join(Span::of(&(y + 1..y + 2)));
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
        let span = in_fours(&std::mem::replace(&mut pending[y], Span::NONE).words(), open.row_words());
        let cells = open.row(y);
        let (below, here, above) = reached.row_between(y);
        let has_above = !above.is_empty();
        // At the rim the one row stands for both.
        let [below, above] = match [below, above] {
            [[], []] => [&none[..]; 2],
            [[], one] | [one, []] => [one; 2],
            both => both,
        };
        if *eight {
            take_from_corners(here, &span, [below, above], cells);
        }
        take_from_beside(here, &span, [below, above], cells);
        let beside = [y.checked_sub(1), has_above.then_some(y + 1)];
        let mut offers = beside.map(|y| Offer { open: y.map_or(none, |y| open.row(y)), taken: Span::NONE });
        let end = fill_upwards(here, &span, cells);
        let start = fill_downwards(here, &(span.start..end), cells, |i, word| {
            if !*eight {
                offers[0].look(i, word, below);
                offers[1].look(i, word, above);
            }
        });
        if *eight {
            for i in widen(row, &(start..end), here).rev() {
                offers[0].look(i, row[i], below);
                offers[1].look(i, row[i], above);
            }
        }
        let mut takes = [false; 2];
        for (takes, (beside, offer)) in takes.iter_mut().zip(beside.into_iter().zip(offers)) {
            if let Some(beside) = beside {
                pending[beside].join(offer.taken);
                *takes = !offer.taken.is_empty();
            }
        }
        (takes[0], takes[1])
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.pending.capacity() * size_of::<Span>() + (self.row.capacity() + self.none.capacity()) * size_of::<u64>()
    }
}

/// Some words more of a row of so many, so that there are four and four: work done on four at
/// a time has fewer left over.
fn in_fours(words: &Range<usize>, row_words: usize) -> Range<usize> {
    words.start / 4 * 4..words.end.next_multiple_of(4).min(row_words)
}

/// Adds to the reached cells of a row, in a span, those that touch a reached cell of the row
/// below or above at a corner.
#[inline(always)]
fn take_from_corners(here: &mut [u64], span: &Range<usize>, [below, above]: [&[u64]; 2], cells: &[u64]) {
    let beside = |i: usize| below.get(i).copied().unwrap_or(0) | above.get(i).copied().unwrap_or(0);
    for i in span.clone() {
        let before = if i > 0 { beside(i - 1) } else { 0 };
        here[i] |= (beside(i) << 1 | before >> 63 | beside(i) >> 1 | beside(i + 1) << 63) & cells[i];
    }
}

/// Adds to the reached cells of a row, in a span, those that have a reached one below or
/// above, and fills within each word the runs in which there are such.
#[inline(always)]
fn take_from_beside(here: &mut [u64], span: &Range<usize>, [below, above]: [&[u64]; 2], cells: &[u64]) {
    let Range { start, end } = *span;
    let words = below[start..end].iter().zip(&above[start..end]).zip(&cells[start..end]);
    for (here, ((below, above), &cells)) in here[start..end].iter_mut().zip(words) {
        let seeds = *here | (below | above) & cells;
        let to_the_end = seeds | cells & !cells.wrapping_add(seeds);
        *here = filled_downwards(to_the_end, cells);
    }
}

/// Fills the runs of a row on into the words after, from a span on as far as that leads; where
/// it ends.
#[inline(always)]
fn fill_upwards(here: &mut [u64], span: &Range<usize>, cells: &[u64]) -> usize {
    let Range { start, mut end } = *span;
    // All bits if the last cell of the word before is reached.
    let mut from_before = 0;
    let mut fill = |here: &mut u64, cells: u64| {
        *here |= cells & !cells.wrapping_add(1) & from_before;
        from_before = (*here >> 63).wrapping_neg();
    };
    for (here, &cells) in here[start..end].iter_mut().zip(&cells[start..end]) {
        fill(here, cells);
    }
    while end < here.len() && here[end - 1] >> 63 & cells[end] & !here[end] != 0 {
        fill(&mut here[end], cells[end]);
        end += 1;
    }
    end
}

/// Fills the runs of a row on into the words before, from a span on as far as that leads, and
/// visits each word when all of it is filled; where it begins.
#[inline(always)]
fn fill_downwards(here: &mut [u64], span: &Range<usize>, cells: &[u64], mut visit: impl FnMut(usize, u64)) -> usize {
    let Range { mut start, end } = *span;
    // All bits if the first cell of the word after is reached.
    let mut from_next = 0;
    let mut fill = |i: usize, here: &mut u64, cells: u64| {
        // Nobody can guess which word has no gap: no branch.
        let last_run = u64::MAX.checked_shl(WORD_CELLS as u32 - cells.leading_ones()).unwrap_or(0);
        *here |= last_run & from_next;
        from_next = (*here & 1).wrapping_neg();
        visit(i, *here);
    };
    for (i, (here, &cells)) in (start..end).zip(here[start..end].iter_mut().zip(&cells[start..end])).rev() {
        fill(i, here, cells);
    }
    while start > 0 && here[start] << 63 & cells[start - 1] & !here[start - 1] != 0 {
        start -= 1;
        fill(start, &mut here[start], cells[start]);
    }
    start
}

/// What a row offers to one beside it.
struct Offer<'a> {
    /// The cells of that row.
    open: &'a [u64],
    /// The words in which it has something to take.
    taken: Span,
}

impl Offer<'_> {
    /// Looks at a word, each before those with smaller places.
    #[inline(always)]
    fn look(&mut self, i: usize, word: u64, reached: &[u64]) {
        let takes = word & self.open[i] & !reached[i] != 0;
        let i = i as u32;
        // Nobody can guess which words these are: no branch.
        self.taken.start = if takes { i } else { self.taken.start };
        self.taken.end = self.taken.end.max(if takes { i + 1 } else { 0 });
    }
}

/// The runs of `cells` from their first cell to the last of their seeds.
#[inline(always)]
pub(super) const fn filled_downwards(mut seeds: u64, mut cells: u64) -> u64 {
    let mut length = 1;
    while length < WORD_CELLS {
        seeds |= seeds >> length & cells;
        cells &= cells >> length;
        length *= 2;
    }
    seeds
}

/// Writes to `row` the reached cells of a span and those to their left and right, one word
/// wider than what is filled.
#[inline(always)]
fn widen(row: &mut [u64], filled: &Range<usize>, here: &[u64]) -> Range<usize> {
    let wider = filled.start.saturating_sub(1)..(filled.end + 1).min(here.len());
    let at = |i: usize| here.get(i).copied().unwrap_or(0);
    for i in wider.clone() {
        row[i] = at(i.wrapping_sub(1)) >> 63 | at(i) << 1 | at(i) | at(i) >> 1 | at(i + 1) << 63;
    }
    wider
}

#[cfg(test)]
#[path = "flood_tests.rs"]
mod tests;
