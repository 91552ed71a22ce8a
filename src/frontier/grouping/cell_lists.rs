//! The frontiers of one detection: the cells of all in one list, and where each frontier ends.

mod splice;

use crate::grid::Cell;
pub(crate) use splice::Splice;
use std::ops::Range;
use std::sync::Arc;

/// The cells of frontiers, one after the other in one list: what a detector finds,
/// without a list for each.
#[derive(Clone, Debug, Default)]
pub struct FrontierCells {
    cells: Vec<Cell>,
    /// Where the cells of each frontier end.
    ends: Vec<u32>,
}

/// Where cells are put in place.
pub(crate) struct Room<'a> {
    /// The cells of all frontiers, and some more.
    pub cells: &'a mut [Cell],
    /// What is known of each frontier.
    pub notes: &'a mut [u32],
    /// Where the cells of each frontier end.
    pub ends: &'a mut [u32],
}

impl FrontierCells {
    /// One frontier alone.
    pub(crate) fn of_one(cells: Vec<Cell>) -> Self {
        Self { ends: vec![cells.len() as u32], cells }
    }

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

    /// Names all cells by the columns and rows of another grid, in which they lie so far on.
    pub(crate) fn shift(&mut self, by: (i32, i32)) {
        if by != (0, 0) {
            self.cells.iter_mut().for_each(|cell| *cell = cell.offset(by));
        }
    }

    /// Forgets all.
    pub(crate) fn clear(&mut self) {
        self.cells.clear();
        self.ends.clear();
    }

    /// Makes room for a frontier of so many cells; where its first goes.
    pub(crate) fn push(&mut self, cells: u32) -> u32 {
        let start = self.cells.len() as u32;
        self.cells.resize((start + cells) as usize, Cell::new(0, 0));
        self.ends.push(start + cells);
        start
    }

    /// How many frontiers begin before a cell, in row-major order.
    pub(crate) fn count_before(&self, cell: Cell) -> usize {
        let (mut low, mut high) = (0, self.len());
        while low < high {
            let middle = usize::midpoint(low, high);
            let begins_before =
                self.frontier(middle).first().is_some_and(|first| (first.y, first.x) < (cell.y, cell.x));
            if begins_before { low = middle + 1 } else { high = middle }
        }
        low
    }

    /// Where the cells of a frontier begin.
    fn start(&self, index: usize) -> usize {
        if index > 0 { self.ends[index - 1] as usize } else { 0 }
    }

    /// Where the cells of a frontier are among all.
    pub(crate) fn range(&self, index: usize) -> Range<usize> {
        self.start(index)..self.ends[index] as usize
    }

    /// The cells of a frontier.
    pub(crate) fn frontier(&self, index: usize) -> &[Cell] {
        &self.cells[self.range(index)]
    }

    /// A list for what is known of each frontier while their cells are put in place; it takes
    /// the room of the ends.
    pub(crate) fn notes(&mut self) -> &mut Vec<u32> {
        &mut self.ends
    }

    /// Makes room for so many cells, for `more` scratch cells behind them, and for the ends of all
    /// frontiers that have notes but the first.
    pub(crate) fn prepare(&mut self, cells: usize, more: usize) -> Room<'_> {
        let notes = self.ends.len();
        self.cells.resize(cells + more, Cell::new(0, 0));
        self.ends.resize(2 * notes - 1, 0);
        let (notes, ends) = self.ends.split_at_mut(notes);
        Room { cells: &mut self.cells, notes, ends }
    }

    /// Drops the cells beyond so many and the notes.
    pub(crate) fn finish(&mut self, cells: usize) {
        self.cells.truncate(cells);
        self.ends.drain(..=self.ends.len() / 2);
    }

    /// Puts a cell in its place.
    pub(crate) fn put(&mut self, place: u32, cell: Cell) {
        self.cells[place as usize] = cell;
    }

    /// All cells, those of one frontier after those of another.
    pub(crate) fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Lists for what is found anew, of which nothing is to be read: these, or others if
    /// frontiers made of them are still about.
    pub(crate) fn anew(shared: &mut Arc<Self>) -> &mut Self {
        if Arc::get_mut(shared).is_none() {
            let with_room =
                Self { cells: Vec::with_capacity(shared.cells.len()), ends: Vec::with_capacity(shared.ends.len()) };
            *shared = Arc::new(with_room);
        }
        Arc::make_mut(shared)
    }
}
