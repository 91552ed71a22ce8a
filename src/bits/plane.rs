//! A plane of one bit for each cell of a grid, in words of 64 cells.

use super::BitWork;
use crate::grid::{Cell, CellRect};
use std::ops::Range;

/// Cells in a word.
pub const WORD_CELLS: usize = 64;

/// Does work on bits with all the instructions for it that the processor has.
#[inline]
pub fn with_bit_instructions<W: BitWork>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    return super::simd::with_bit_instructions(work);
    #[cfg(not(target_arch = "x86_64"))]
    work.run()
}

/// The words of a plane's rows that hold the columns of a rectangle.
#[must_use]
pub const fn words_of(rect: &CellRect) -> Range<usize> {
    rect.x / WORD_CELLS..(rect.x + rect.width).div_ceil(WORD_CELLS)
}

/// One bit for each cell of a grid. Cell `(x, y)` is bit `x % 64` of word `x / 64` of
/// row `y`. Rows are padded to whole words and the padding is zero.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BitPlane {
    width: usize,
    height: usize,
    row_words: usize,
    words: Vec<u64>,
}

impl BitPlane {
    /// A plane without a bit set.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        let mut plane = Self::default();
        plane.resize(width, height);
        plane
    }

    /// Takes on a size. The bits are kept if it is the size already and cleared if not.
    pub fn resize(&mut self, width: usize, height: usize) {
        if (self.width, self.height) != (width, height) {
            self.width = width;
            self.height = height;
            self.row_words = width.div_ceil(WORD_CELLS);
            self.words.clear();
            self.words.resize(self.row_words * height, 0);
        }
    }

    /// Grows to a size, with so many words more in front of each row and so many rows more below
    /// the first; new bits are clear. The size must hold all that was there, and a width that is not
    /// the old one must be of whole words.
    pub fn grow(&mut self, width: usize, height: usize, (words, rows): (usize, usize)) {
        let row_words = width.div_ceil(WORD_CELLS);
        self.words.reserve_exact((row_words * height).saturating_sub(self.words.len()));
        self.words.resize(row_words * height, 0);
        let moved = self.row_words;
        // From the last row on, as no row comes to lie before where it was.
        for y in (0..height).rev() {
            let start = y * row_words;
            match y.checked_sub(rows).filter(|&from| from < self.height) {
                Some(from) => {
                    let from = from * self.row_words;
                    self.words.copy_within(from..from + moved, start + words);
                    self.words[start..start + words].fill(0);
                    self.words[start + words + moved..start + row_words].fill(0);
                }
                None => self.words[start..start + row_words].fill(0),
            }
        }
        (self.width, self.height, self.row_words) = (width, height, row_words);
    }

    /// The same bits so many columns and rows further on, in a plane of a size that holds them all;
    /// others are clear.
    #[must_use]
    pub fn moved(&self, (width, height): (usize, usize), (columns, rows): (usize, usize)) -> Self {
        let mut plane = Self::new(width, height);
        let (words, bits) = (columns / WORD_CELLS, columns % WORD_CELLS);
        for y in 0..self.height {
            let row = &mut plane.row_mut(y + rows)[words..];
            for (at, &word) in self.row(y).iter().enumerate() {
                row[at] |= word << bits;
                if let Some(next) = row.get_mut(at + 1).filter(|_| bits > 0) {
                    *next |= word >> (WORD_CELLS - bits);
                }
            }
        }
        plane
    }

    /// Clears all bits.
    pub fn clear(&mut self) {
        self.words.fill(0);
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
    }

    /// Words in a row.
    #[must_use]
    pub const fn row_words(&self) -> usize {
        self.row_words
    }

    /// The bits of the last word of a row that stand for cells.
    #[must_use]
    pub const fn last_word_mask(&self) -> u64 {
        u64::MAX >> ((WORD_CELLS - self.width % WORD_CELLS) % WORD_CELLS)
    }

    /// The words of row `y`, which must be below [`Self::height`].
    #[must_use]
    pub fn row(&self, y: usize) -> &[u64] {
        &self.words[y * self.row_words..][..self.row_words]
    }

    /// The words of row `y` for writing; who writes keeps the padding zero.
    #[must_use]
    pub fn row_mut(&mut self, y: usize) -> &mut [u64] {
        &mut self.words[y * self.row_words..][..self.row_words]
    }

    /// All words, row after row.
    #[must_use]
    pub fn words(&self) -> &[u64] {
        &self.words
    }

    /// Whether the bit of a cell is set; outside none is.
    #[must_use]
    pub fn contains(&self, cell: Cell) -> bool {
        self.place(cell).is_some_and(|(word, bit)| self.words[word] & bit != 0)
    }

    /// Sets the bit of a cell; outside nothing happens.
    pub fn insert(&mut self, cell: Cell) {
        if let Some((word, bit)) = self.place(cell) {
            self.words[word] |= bit;
        }
    }

    /// Clears the bit of a cell; whether it was set. Outside none is.
    pub fn remove(&mut self, cell: Cell) -> bool {
        self.place(cell).is_some_and(|(word, bit)| {
            let was_set = self.words[word] & bit != 0;
            self.words[word] &= !bit;
            was_set
        })
    }

    /// The first column among those given whose bit is set in row `y`.
    #[must_use]
    pub fn first_in(&self, y: usize, columns: Range<usize>) -> Option<usize> {
        let row = self.row(y);
        let mut index = columns.start / WORD_CELLS;
        let mut word = row.get(index)? & (u64::MAX << (columns.start % WORD_CELLS));
        while word == 0 {
            index += 1;
            if index * WORD_CELLS >= columns.end {
                return None;
            }
            word = *row.get(index)?;
        }
        let column = index * WORD_CELLS + word.trailing_zeros() as usize;
        (column < columns.end).then_some(column)
    }

    /// The longest range of columns around `x` whose bits are all set in row `y`, as
    /// that of `x` must be.
    #[must_use]
    pub fn run_around(&self, y: usize, x: usize) -> Range<usize> {
        let row = self.row(y);
        let (index, bit) = (x / WORD_CELLS, x % WORD_CELLS);
        let gap_before = |i: usize, mask: u64| match !row[i] & mask {
            0 => None,
            gaps => Some((i + 1) * WORD_CELLS - gaps.leading_zeros() as usize),
        };
        let gap_after = |i: usize, mask: u64| match !row[i] & mask {
            0 => None,
            gaps => Some(i * WORD_CELLS + gaps.trailing_zeros() as usize),
        };
        let start = gap_before(index, u64::MAX >> (WORD_CELLS - 1 - bit))
            .or_else(|| (0..index).rev().find_map(|i| gap_before(i, u64::MAX)));
        let end =
            gap_after(index, u64::MAX << bit).or_else(|| (index + 1..row.len()).find_map(|i| gap_after(i, u64::MAX)));
        start.unwrap_or(0)..end.unwrap_or(self.width)
    }

    /// Clears the bits of the columns `start..end` of row `y`, which must be cells.
    pub fn clear_run(&mut self, y: usize, start: usize, end: usize) {
        if start >= end {
            return;
        }
        let row = self.row_mut(y);
        let (first, last) = (start / WORD_CELLS, (end - 1) / WORD_CELLS);
        let from_start = u64::MAX << (start % WORD_CELLS);
        let to_end = u64::MAX >> (WORD_CELLS - 1 - (end - 1) % WORD_CELLS);
        if first == last {
            row[first] &= !(from_start & to_end);
        } else {
            row[first] &= !from_start;
            row[first + 1..last].fill(0);
            row[last] &= !to_end;
        }
    }

    /// A rectangle that holds all bits set, as wide as the words that they are in; empty where
    /// none is.
    #[must_use]
    pub fn bounds(&self) -> CellRect {
        let rows = self.words.chunks_exact(self.row_words.max(1)).enumerate();
        let used = rows.filter_map(|(y, row)| {
            let is_set = |word: &u64| *word != 0;
            let (first, last) = (row.iter().position(is_set)?, row.iter().rposition(is_set)?);
            let x = first * WORD_CELLS;
            Some(CellRect { x, y, width: ((last + 1) * WORD_CELLS).min(self.width) - x, height: 1 })
        });
        used.fold(CellRect::default(), CellRect::union)
    }

    /// Keeps the bits that are set in another plane of the same size too.
    pub fn intersect(&mut self, other: &Self) {
        for (word, other) in self.words.iter_mut().zip(&other.words) {
            *word &= other;
        }
    }

    /// Clears the bits that are set in another plane of the same size.
    pub fn subtract(&mut self, other: &Self) {
        for (word, other) in self.words.iter_mut().zip(&other.words) {
            *word &= !other;
        }
    }

    /// What the plane takes in memory, bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.words.capacity() * size_of::<u64>()
    }

    /// Number of bits set.
    #[must_use]
    pub fn count(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    fn place(&self, cell: Cell) -> Option<(usize, u64)> {
        let (x, y) = (usize::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
        (x < self.width && y < self.height).then(|| (y * self.row_words + x / WORD_CELLS, 1 << (x % WORD_CELLS)))
    }
}

#[cfg(test)]
#[path = "plane_tests.rs"]
mod tests;
