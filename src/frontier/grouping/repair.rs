//! Groups frontier cells again where words of their plane changed, and keeps all other frontiers.

use crate::bits::connectivity::row_fill::filled_downwards;
use crate::bits::word_spans::WordSpans;
use crate::bits::{BitPlane, BitWork, WORD_CELLS, with_bit_instructions};
use crate::frontier::grouping::cell_lists::{FrontierCells, Splice};
use crate::grid::{Cell, Neighbourhood};
use std::ops::Range;

/// To find a cell's frontier again costs about as much as to label so many words.
const WORDS_PER_CELL: usize = 8;
/// So many cells are found again in any case.
const MIN_CELLS: usize = 16;

/// Cells of one word.
#[derive(Clone, Copy, Debug)]
struct WordCells {
    y: u32,
    word: u32,
    cells: u64,
}

/// Repairs lists of frontiers, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Regroup {
    /// The cells taken out of the plane, those of one frontier after those of another.
    pieces: Vec<WordCells>,
    /// Where the pieces of each frontier end.
    ends: Vec<u32>,
    /// The cells of the frontiers found again, and which are whose.
    cells: Vec<Cell>,
    frontiers: Vec<[u32; 2]>,
    splice: Splice,
}

impl Regroup {
    /// Finds again the frontiers that have a cell in a word that changed or touch one that
    /// has; the others are kept. `false`, and nothing done, if these are so many that to
    /// find all anew is as good. Cells of the lists lie `offset` further on in the plane, of which
    /// nothing is changed in the end.
    pub fn update(
        &mut self,
        plane: &mut BitPlane,
        changed: &WordSpans,
        offset: (i32, i32),
        neighbourhood: Neighbourhood,
        min_cells: usize,
        found: &mut FrontierCells,
    ) -> bool {
        let most_cells = plane.words().len() / WORDS_PER_CELL + MIN_CELLS;
        self.pieces.clear();
        self.ends.clear();
        let eight = neighbourhood == Neighbourhood::Eight;
        let Self { pieces, ends, .. } = self;
        let takes = Takes { plane, changed, offset, eight, found, pieces, ends, left: most_cells };
        let done = with_bit_instructions(takes).is_some();
        if done {
            self.splice.forget();
            // Dropped are those whose cells are out of the plane: some of those that have a
            // cell within or beside the rows that changed.
            for index in near(changed, offset, found) {
                if found.frontier(index).first().is_none_or(|cell| !plane.contains(cell.offset(offset))) {
                    self.splice.drop(index);
                }
            }
        }
        for &WordCells { y, word, cells } in &self.pieces {
            plane.row_mut(y as usize)[word as usize] |= cells;
        }
        if done {
            self.list(offset, min_cells);
            let cells_of = |&[start, end]: &[u32; 2]| &self.cells[start as usize..end as usize];
            found.splice(&mut self.splice, self.frontiers.iter().map(cells_of));
        }
        done
    }

    /// Lists the cells of the frontiers that have enough of them, in the order of first cells.
    fn list(&mut self, offset: (i32, i32), min_cells: usize) {
        let Self { pieces, ends, cells, frontiers, .. } = self;
        cells.clear();
        frontiers.clear();
        let mut start = 0;
        for &end in &*ends {
            let of_frontier = &mut pieces[start..end as usize];
            start = end as usize;
            of_frontier.sort_unstable_by_key(|piece| (piece.y, piece.word));
            let first = cells.len();
            for of_word in of_frontier.chunk_by(|a, b| (a.y, a.word) == (b.y, b.word)) {
                let WordCells { y, word, .. } = of_word[0];
                let mut left = of_word.iter().fold(0, |all, piece| all | piece.cells);
                while left != 0 {
                    let x = word * WORD_CELLS as u32 + left.trailing_zeros();
                    cells.push(Cell::new(x as i32 - offset.0, y as i32 - offset.1));
                    left &= left - 1;
                }
            }
            if cells.len() - first < min_cells {
                cells.truncate(first);
            } else {
                frontiers.push([first as u32, cells.len() as u32]);
            }
        }
        frontiers.sort_unstable_by_key(|&[start, _]| (cells[start as usize].y, cells[start as usize].x));
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.pieces.capacity() * size_of::<WordCells>()
            + self.ends.capacity() * size_of::<u32>()
            + self.cells.capacity() * size_of::<Cell>()
            + self.frontiers.capacity() * size_of::<[u32; 2]>()
            + self.splice.memory_bytes()
    }
}

/// The frontiers that have a cell in the rows that changed or in one beside them.
fn near(changed: &WordSpans, offset: (i32, i32), found: &FrontierCells) -> impl Iterator<Item = usize> {
    let rows = changed.rows();
    let (low, high) = (rows.start as i32 - 1 - offset.1, rows.end as i32 - offset.1);
    // They are in the order of first cells, and their cells in that of rows.
    let begun = if rows.is_empty() { 0 } else { found.count_before(Cell::new(0, high + 1)) };
    (0..begun).filter(move |&index| found.frontier(index).last().is_some_and(|last| last.y >= low))
}

/// Takes the frontiers to be found again out of the plane; `None` if they are too many.
struct Takes<'a> {
    plane: &'a mut BitPlane,
    changed: &'a WordSpans,
    /// By how much the cells of the lists lie further on in the plane.
    offset: (i32, i32),
    eight: bool,
    found: &'a FrontierCells,
    pieces: &'a mut Vec<WordCells>,
    ends: &'a mut Vec<u32>,
    /// So many cells may be taken yet.
    left: usize,
}

impl BitWork for Takes<'_> {
    type Output = Option<()>;

    #[inline(always)]
    fn run(mut self) -> Option<()> {
        for (y, span) in self.changed.iter() {
            for word in span.words() {
                while let cells @ 1.. = self.plane.row(y)[word] {
                    self.take_connected(y, word, cells & cells.wrapping_neg())?;
                }
            }
        }
        // What is left of the frontiers that lost a cell.
        let (found, changed, offset) = (self.found, self.changed, self.offset);
        let in_plane = |cell: &Cell| cell.offset(offset);
        let is_changed = |cell: Cell| changed.contain(cell.y as usize, cell.x as usize / WORD_CELLS);
        for cells in near(changed, offset, found).map(|index| found.frontier(index)) {
            if cells.iter().map(in_plane).any(is_changed) {
                for Cell { x, y } in cells.iter().map(in_plane) {
                    let (y, word, bit) = (y as usize, x as usize / WORD_CELLS, 1 << (x as usize % WORD_CELLS));
                    if self.plane.row(y)[word] & bit != 0 {
                        self.take_connected(y, word, bit)?;
                    }
                }
            }
        }
        Some(())
    }
}

impl Takes<'_> {
    /// Takes a frontier out of the plane, of which a cell is given.
    #[inline(always)]
    fn take_connected(&mut self, y: usize, word: usize, cell: u64) -> Option<()> {
        let mut next = self.pieces.len();
        self.take(y, word, cell);
        while let Some(&WordCells { y, word, cells }) = self.pieces.get(next) {
            next += 1;
            let (y, word) = (y as usize, word as usize);
            let corners = if self.eight { cells << 1 | cells >> 1 } else { 0 };
            let Range { start, end } = y.saturating_sub(1)..(y + 2).min(self.plane.height());
            for beside in start..end {
                // Within the row all that is beside in the word is taken already.
                if beside != y {
                    self.take(beside, word, cells | corners);
                }
                if beside == y || self.eight {
                    if cells & 1 != 0 && word > 0 {
                        self.take(beside, word - 1, 1 << 63);
                    }
                    if cells >> 63 != 0 && word + 1 < self.plane.row_words() {
                        self.take(beside, word + 1, 1);
                    }
                }
            }
            self.left = self.left.checked_sub(cells.count_ones() as usize)?;
        }
        self.ends.push(next as u32);
        Some(())
    }

    /// Takes the runs of a word that have one of these cells.
    #[inline(always)]
    fn take(&mut self, y: usize, word: usize, seeds: u64) {
        let cells = &mut self.plane.row_mut(y)[word];
        let seeds = seeds & *cells;
        if seeds != 0 {
            let to_the_end = seeds | *cells & !cells.wrapping_add(seeds);
            let taken = filled_downwards(to_the_end, *cells);
            *cells &= !taken;
            self.pieces.push(WordCells { y: y as u32, word: word as u32, cells: taken });
        }
    }
}
