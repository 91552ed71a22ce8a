//! Writes the cells of all components into one list, each component's in row-major order.

use super::bands::Bands;
use crate::bits::contacts::Starts;
use crate::bits::{BitWork, WORD_CELLS};
use crate::frontier::grouping::cell_lists::Room;
use crate::grid::Cell;
use std::ops::Range;

/// Tag of a component's entry: none of its cells has a place in the list yet, and the other bits
/// count its cells. Without the tag, the entry is the place of its next cell.
pub(crate) const UNPLACED: u32 = 1 << 31;

/// A word of a row that has cells.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Piece {
    cells: u64,
    /// Where runs of the band begin in it.
    begun: u64,
    /// The last run that began before it.
    run_before: u32,
    /// The column of its first cell.
    column: u32,
}

/// Puts all cells of a strip in their places, in row-major order; a component gets its place
/// with its first cell.
pub(crate) struct List<'a, 'b> {
    /// The component of each run.
    pub of_run: &'a [u32],
    /// Room for the words of a row and two more.
    pub pieces: &'a mut [Piece],
    pub bands: Bands<'a>,
    /// The bands that the runs are of.
    pub strip: Range<usize>,
    pub given: &'a mut Given,
    /// For the cells of what is kept, and a row of those that are dropped: to write them is
    /// faster than to ask for each. Of each component it is noted how many cells it has
    /// ([`UNPLACED`]), then where the next goes.
    pub room: &'a mut Room<'b>,
}

impl BitWork for List<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { of_run, pieces, bands, strip, given, room: Room { cells, notes: places, ends } } = self;
        let dropped = (cells.len() - bands.plane.width()) as u32;
        let mut first_run = 0;
        for band in strip {
            let rows = bands.band(band);
            let mut runs = 0;
            for (y, row) in (bands.rows() * band..).zip(rows).take(bands.rows()) {
                let (count, after) = collect(row, rows, first_run, pieces);
                runs = after;
                places[0] = dropped;
                let mut at = 0;
                let (mut left, mut next_word) = (pieces[0].cells, pieces[1].cells);
                // One loop for all cells of a row: how many a word has nobody can guess. The
                // next word is at hand before it is known whether this one ends.
                for _ in 0..count {
                    let piece = pieces[at];
                    let up_to = left ^ left.wrapping_sub(1);
                    let run = piece.run_before.wrapping_add((piece.begun & up_to).count_ones());
                    let place = &mut places[of_run[run as usize] as usize];
                    if *place & UNPLACED != 0 {
                        *place = given.give(*place & !UNPLACED, ends);
                    }
                    let x = piece.column + left.trailing_zeros();
                    cells[*place as usize] = Cell::new(x as i32, y as i32);
                    *place += 1;
                    let rest = left & left.wrapping_sub(1);
                    at += usize::from(rest == 0);
                    left = std::hint::select_unpredictable(rest == 0, next_word, rest);
                    next_word = pieces[at + 1].cells;
                }
            }
            first_run = runs;
        }
    }
}

/// Where the next component goes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Given {
    /// How many have a place.
    components: usize,
    /// The next cell without an owner.
    next: u32,
}

impl Given {
    /// Gives a component room for its cells; where it begins. Seldom done beside what is
    /// done for each cell, and so not among it.
    #[cold]
    fn give(&mut self, cells: u32, ends: &mut [u32]) -> u32 {
        let place = self.next;
        self.next += cells;
        if let Some(end) = ends.get_mut(self.components) {
            *end = self.next;
        }
        self.components += 1;
        place
    }
}

/// Collects the words of a row that have cells, without a branch for each. How many cells
/// there are, and how many runs are begun at the end of the band.
#[inline(always)]
fn collect(row: &[u64], [a, b]: [&[u64]; 2], first_run: u32, pieces: &mut [Piece]) -> (u32, u32) {
    let mut starts = Starts::default();
    let (mut count, mut cells, mut begun_before) = (0, 0, first_run);
    for (index, (&word, (a, b))) in row.iter().zip(a.iter().zip(b)).enumerate() {
        let begun = starts.of(a | b);
        let column = (index * WORD_CELLS) as u32;
        pieces[count] = Piece { cells: word, begun, run_before: begun_before.wrapping_sub(1), column };
        count += usize::from(word != 0);
        cells += word.count_ones();
        begun_before += begun.count_ones();
    }
    (cells, begun_before)
}
