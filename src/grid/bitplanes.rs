//! One bit a cell: the grid as planes of 64-cell words, for work on many cells at once.
//!
//! Cell `(x, y)` is bit `x % 64` of word `x / 64` of row `y`. Rows are padded to whole
//! words and the padding is zero in every plane. Packing compares eight cells at a time
//! within one integer (Lamport, "Multiple Byte Processing with Full-Word Instructions",
//! CACM 1975) and gathers the results with the 8 x 8 bit transpose of Warren, "Hacker's
//! Delight" (2012), 7-3. O(cells); nothing is allocated while the size stays the same.

use super::{Cell, GridInfo, OccupancyGrid, Thresholds};
use std::ops::Range;

/// Cells in a word.
pub const WORD_CELLS: usize = 64;

/// One bit for each cell of a grid.
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

    /// Becomes a copy of another plane.
    pub fn copy_from(&mut self, other: &Self) {
        self.resize(other.width, other.height);
        self.words.copy_from_slice(&other.words);
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

/// An occupancy grid as three planes, of which each cell is in exactly one.
#[derive(Clone, Debug, Default)]
pub struct BitPlanes {
    free: BitPlane,
    unknown: BitPlane,
    occupied: BitPlane,
}

impl BitPlanes {
    /// Takes in a grid. The thresholds must satisfy [`Thresholds::validate`].
    pub fn pack(&mut self, grid: &OccupancyGrid, thresholds: &Thresholds) {
        let info: &GridInfo = grid.info();
        for plane in [&mut self.free, &mut self.unknown, &mut self.occupied] {
            plane.resize(info.width(), info.height());
        }
        let packer = Packer::new(thresholds);
        let last_mask = self.free.last_word_mask();
        for (y, cells) in grid.data().chunks_exact(info.width()).enumerate() {
            let (free, unknown, occupied) = (self.free.row_mut(y), self.unknown.row_mut(y), self.occupied.row_mut(y));
            let (whole, rest) = cells.as_chunks::<WORD_CELLS>();
            let outputs = free.iter_mut().zip(unknown.iter_mut()).zip(occupied.iter_mut());
            for (cells, ((free, unknown), occupied)) in whole.iter().zip(outputs) {
                (*free, *occupied) = packer.pack(cells);
                *unknown = !(*free | *occupied);
            }
            if !rest.is_empty() {
                let mut padded = [OccupancyGrid::UNKNOWN; WORD_CELLS];
                padded[..rest.len()].copy_from_slice(rest);
                let last = whole.len();
                (free[last], occupied[last]) = packer.pack(&padded);
                unknown[last] = !(free[last] | occupied[last]) & last_mask;
            }
        }
    }

    /// The free cells.
    #[must_use]
    pub const fn free(&self) -> &BitPlane {
        &self.free
    }

    /// The unknown cells.
    #[must_use]
    pub const fn unknown(&self) -> &BitPlane {
        &self.unknown
    }

    /// The occupied cells.
    #[must_use]
    pub const fn occupied(&self) -> &BitPlane {
        &self.occupied
    }
}

/// The lowest bit of each byte.
const LOW_BITS: u64 = 0x0101_0101_0101_0101;
/// The highest bit of each byte: the sign of its cell.
const HIGH_BITS: u64 = LOW_BITS << 7;

/// Compares the cells of a word with the thresholds.
struct Packer {
    /// Added to seven bits of each byte, carries into the eighth above `free_max`.
    beyond_free: u64,
    /// The same from `occupied_min` on.
    from_occupied: u64,
}

impl Packer {
    fn new(thresholds: &Thresholds) -> Self {
        let bytes = |value: u8| u64::from(value) * LOW_BITS;
        Self {
            beyond_free: bytes(127 - thresholds.free_max.max(0).cast_unsigned()),
            from_occupied: bytes(128 - thresholds.occupied_min.max(1).cast_unsigned()),
        }
    }

    /// The free and the occupied cells of a word. Sixteen cells are taken in at a time
    /// as a pair of integers, which the compiler holds in one vector register; the two
    /// halves then hold the even and the odd bytes of the transposed word.
    #[inline]
    fn pack(&self, cells: &[i8; WORD_CELLS]) -> (u64, u64) {
        let (mut free, mut occupied) = ([0; 2], [0; 2]);
        for (i, pair) in cells.as_chunks::<16>().0.iter().enumerate() {
            for (half, eight) in pair.as_chunks::<8>().0.iter().enumerate() {
                let values = u64::from_le_bytes(eight.map(i8::cast_unsigned));
                let magnitudes = values & !HIGH_BITS;
                free[half] |= (!(values | (magnitudes + self.beyond_free)) & HIGH_BITS) >> (7 - 2 * i);
                occupied[half] |= ((magnitudes + self.from_occupied) & !values & HIGH_BITS) >> (7 - 2 * i);
            }
        }
        (transposed(free[0] | free[1] << 1), transposed(occupied[0] | occupied[1] << 1))
    }
}

/// Swaps bit `8 r + c` with bit `8 c + r` for all `r` and `c` below 8.
#[inline]
const fn transposed(bits: u64) -> u64 {
    let swap = (bits ^ (bits >> 7)) & 0x00AA_00AA_00AA_00AA;
    let bits = bits ^ swap ^ (swap << 7);
    let swap = (bits ^ (bits >> 14)) & 0x0000_CCCC_0000_CCCC;
    let bits = bits ^ swap ^ (swap << 14);
    let swap = (bits ^ (bits >> 28)) & 0x0000_0000_F0F0_F0F0;
    bits ^ swap ^ (swap << 28)
}

#[cfg(test)]
#[path = "bitplanes_tests.rs"]
mod tests;
