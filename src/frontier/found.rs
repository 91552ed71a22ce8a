//! What detectors find: frontiers as lists of cells, in one list.

use super::{CellSide, Frontier};
use crate::grid::Cell;

/// The cells of frontiers, one after the other in one list: what a detector finds,
/// without a list for each.
#[derive(Clone, Debug, Default)]
pub struct FrontierCells {
    cells: Vec<Cell>,
    /// Where the cells of each frontier end.
    ends: Vec<u32>,
}

impl FrontierCells {
    /// Number of frontiers.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no frontier.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The cells of each frontier in row-major order; the frontiers in the order of their
    /// first cells.
    pub fn iter(&self) -> impl Iterator<Item = &[Cell]> {
        let starts = std::iter::once(0).chain(self.ends.iter().copied());
        starts.zip(&self.ends).map(|(start, &end)| &self.cells[start as usize..end as usize])
    }

    /// What the lists take in memory, bytes.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>() + self.ends.capacity() * size_of::<u32>()
    }

    /// Forgets all.
    pub(super) fn clear(&mut self) {
        self.cells.clear();
        self.ends.clear();
    }

    /// Makes room for a frontier of so many cells; where its first goes.
    pub(super) fn push(&mut self, cells: u32) -> u32 {
        let start = self.cells.len() as u32;
        self.cells.resize((start + cells) as usize, Cell::new(0, 0));
        self.ends.push(start + cells);
        start
    }

    /// Adds a frontier.
    pub(super) fn append(&mut self, cells: &[Cell]) {
        self.cells.extend_from_slice(cells);
        self.ends.push(self.cells.len() as u32);
    }

    /// Makes room for so many cells and frontiers, and for a cell at the end and a frontier
    /// at the beginning that serve as one pleases.
    pub(super) fn prepare(&mut self, cells: usize, frontiers: usize) -> (&mut [Cell], &mut [u32]) {
        self.cells.resize(cells + 1, Cell::new(0, 0));
        self.ends.resize(frontiers + 1, 0);
        (&mut self.cells, &mut self.ends)
    }

    /// Drops what serves no longer.
    pub(super) fn finish(&mut self) {
        self.cells.pop();
        self.ends.remove(0);
    }

    /// Puts a cell in its place.
    pub(super) fn put(&mut self, place: u32, cell: Cell) {
        self.cells[place as usize] = cell;
    }

    /// Frontiers of unknown cells.
    #[must_use]
    pub fn to_frontiers(&self) -> Vec<Frontier> {
        let frontier =
            |(id, cells): (u64, &[Cell])| Frontier { id, cells: cells.to_vec(), side: CellSide::Unknown, circle: None };
        (0..).zip(self.iter()).map(frontier).collect()
    }
}
