//! An occupancy grid as two planes of bits, free and unknown, packed whole or where it changed.
//!
//! O(cells); nothing is allocated while the size stays the same.

use super::{BitPlane, Classifier, WORD_CELLS, prefetch};
use crate::grid::{GridInfo, OccupancyGrid, Thresholds};
use std::ops::Range;

/// The memory of so many cells is asked for before it is needed; that of more comes by itself,
/// as it is read from beginning to end.
const MOST_TOUCHED: usize = 1 << 18;

/// An occupancy grid as planes. Each cell is in exactly one of three, of which two are
/// kept: what is neither free nor unknown is occupied, or seen and
/// not settled.
#[derive(Clone, Debug, Default)]
pub struct BitPlanes {
    free: BitPlane,
    unknown: BitPlane,
    /// A row of either plane on its way in.
    row_free: Vec<u64>,
    row_unknown: Vec<u64>,
}

impl BitPlanes {
    /// Takes in a grid. The thresholds must satisfy [`Thresholds::validate`].
    pub fn pack(&mut self, grid: &OccupancyGrid, thresholds: &Thresholds) {
        let info = grid.info();
        self.resize(info);
        let classifier = Classifier::new(thresholds);
        for (y, cells) in grid.data().chunks_exact(info.width()).enumerate() {
            classifier.classify(cells, self.free.row_mut(y), self.unknown.row_mut(y));
        }
    }

    /// Takes on the size of a grid; see [`BitPlane::resize`].
    pub fn resize(&mut self, info: &GridInfo) {
        self.free.resize(info.width(), info.height());
        self.unknown.resize(info.width(), info.height());
    }

    /// Takes in word `index` of row `y` of a grid of the planes' size.
    pub fn pack_word(&mut self, grid: &OccupancyGrid, classifier: &Classifier, y: usize, index: usize) {
        let width = grid.info().width();
        let columns = index * WORD_CELLS..width.min((index + 1) * WORD_CELLS);
        if let Some(cells) = grid.data().get(y * width + columns.start..y * width + columns.end) {
            let (free, unknown) = (&mut self.free.row_mut(y)[index..], &mut self.unknown.row_mut(y)[index..]);
            classifier.classify(cells, free, unknown);
        }
    }

    /// Grows to a size; see [`BitPlane::grow`].
    pub fn grow(&mut self, width: usize, height: usize, by: (usize, usize)) {
        self.free.grow(width, height, by);
        self.unknown.grow(width, height, by);
    }

    /// Takes in the words `words` of the rows `rows` of the planes, in which the first cell of a
    /// grid lies at the column and row `corner`; beyond the grid no bit is set. Tells of each row
    /// that changed which of its words did, from the first to one past the last, and whether
    /// other cells of it are free.
    pub fn repack(
        &mut self,
        grid: &OccupancyGrid,
        thresholds: &Thresholds,
        corner: (usize, usize),
        rows: Range<usize>,
        words: Range<usize>,
        mut changed: impl FnMut(usize, Range<usize>, bool),
    ) {
        let (width, height) = (grid.info().width(), grid.info().height());
        let classifier = Classifier::new(thresholds);
        self.row_free.resize(words.len(), 0);
        self.row_unknown.resize(words.len(), 0);
        let column = |word: usize| (word * WORD_CELLS).saturating_sub(corner.0).min(width);
        let columns = column(words.start)..column(words.end);
        let lead = corner.0.saturating_sub(words.start * WORD_CELLS);
        let cells_of = |y: usize| {
            let row = y.checked_sub(corner.1).filter(|&row| row < height)?;
            grid.data().get(row * width + columns.start..row * width + columns.end)
        };
        if columns.len() * rows.len() <= MOST_TOUCHED {
            prefetch(rows.clone().filter_map(cells_of));
            for plane in [&self.free, &self.unknown] {
                prefetch(rows.clone().map(|y| &plane.row(y)[words.clone()]));
            }
        }
        for y in rows {
            let cells = cells_of(y).unwrap_or_default();
            classifier.classify_behind(lead, cells, &mut self.row_free, &mut self.row_unknown);
            let free = &mut self.free.row_mut(y)[words.clone()];
            let unknown = &mut self.unknown.row_mut(y)[words.clone()];
            let is_free_other = *free != self.row_free[..];
            if !is_free_other && *unknown == self.row_unknown[..] {
                continue;
            }
            let pairs = free.iter().zip(&self.row_free).zip(unknown.iter().zip(&self.row_unknown));
            let mut differ = pairs.map(|((a, b), (c, d))| a != b || c != d);
            let first = differ.position(|differs| differs).unwrap_or(0);
            let last = differ.rposition(|differs| differs).map_or(first, |after| first + 1 + after);
            free.copy_from_slice(&self.row_free);
            unknown.copy_from_slice(&self.row_unknown);
            changed(y, words.start + first..words.start + last + 1, is_free_other);
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

    /// The unknown cells, for a detector that goes on to work in their place.
    #[must_use]
    pub const fn unknown_mut(&mut self) -> &mut BitPlane {
        &mut self.unknown
    }

    /// The free and the unknown cells, for the same.
    #[must_use]
    pub const fn both_mut(&mut self) -> (&mut BitPlane, &mut BitPlane) {
        (&mut self.free, &mut self.unknown)
    }

    /// The occupied cells, as a plane of its own.
    #[must_use]
    pub fn occupied(&self) -> BitPlane {
        let mut occupied = BitPlane::new(self.free.width(), self.free.height());
        let mask = occupied.last_word_mask();
        for y in 0..occupied.height() {
            let row = occupied.row_mut(y);
            for (word, (free, unknown)) in row.iter_mut().zip(self.free.row(y).iter().zip(self.unknown.row(y))) {
                *word = !(free | unknown);
            }
            if let Some(last) = row.last_mut() {
                *last &= mask;
            }
        }
        occupied
    }

    /// What the planes take in memory, bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        let rows = (self.row_free.capacity() + self.row_unknown.capacity()) * size_of::<u64>();
        self.free.memory_bytes() + self.unknown.memory_bytes() + rows
    }
}

#[cfg(test)]
#[path = "planes_tests.rs"]
mod tests;
