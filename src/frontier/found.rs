//! What detectors find: frontiers as lists of cells, in one list.

use super::cells::Cells;
use super::{CellSide, Frontier};
use crate::grid::Cell;
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
pub(super) struct Room<'a> {
    /// The cells of all frontiers, and some more.
    pub cells: &'a mut [Cell],
    /// What is known of each frontier.
    pub notes: &'a mut [u32],
    /// Where the cells of each frontier end.
    pub ends: &'a mut [u32],
}

impl FrontierCells {
    /// One frontier alone.
    pub(super) fn of_one(cells: Vec<Cell>) -> Self {
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

    /// Drops the frontiers that are not kept, and puts others among the rest in the order of
    /// first cells. In place: what lies before the first that is dropped or new stays there.
    pub(super) fn replace<'a, F>(&mut self, is_kept: impl Fn(&[Cell]) -> bool, fresh: F)
    where
        F: DoubleEndedIterator<Item = &'a [Cell]> + ExactSizeIterator + Clone,
    {
        self.keep(is_kept);
        let (mut kept, mut new) = (self.len(), fresh.len());
        let mut kept_end = self.cells.len();
        self.cells.resize(kept_end + fresh.clone().map(<[Cell]>::len).sum::<usize>(), Cell::new(0, 0));
        self.ends.resize(kept + new, 0);
        // From the last on, so that nothing is written over what has still to be moved.
        let mut place = self.cells.len();
        for cells in fresh.rev() {
            let before = self.count_before(kept, cells);
            let moved = self.start(before)..kept_end;
            let by = place - kept_end;
            self.cells.copy_within(moved.clone(), moved.start + by);
            for i in (before..kept).rev() {
                self.ends[i + new] = self.ends[i] + by as u32;
            }
            (kept, kept_end, place) = (before, moved.start, moved.start + by);
            self.ends[kept + new - 1] = place as u32;
            place -= cells.len();
            self.cells[place..place + cells.len()].copy_from_slice(cells);
            new -= 1;
        }
    }

    /// Closes the gaps that frontiers leave which are not kept.
    fn keep(&mut self, is_kept: impl Fn(&[Cell]) -> bool) {
        let (mut kept, mut end) = (0, 0);
        // Neighbours that are kept are moved together.
        let mut block = 0..0;
        for i in 0..self.len() {
            let cells = block.end..self.ends[i] as usize;
            if is_kept(&self.cells[cells.clone()]) {
                self.ends[kept] = (end + cells.end - block.start) as u32;
                kept += 1;
                block.end = cells.end;
            } else {
                end = self.move_down(&block, end);
                block = cells.end..cells.end;
            }
        }
        end = self.move_down(&block, end);
        self.cells.truncate(end);
        self.ends.truncate(kept);
    }

    /// Moves cells to a place not after their own; where they end there.
    fn move_down(&mut self, cells: &Range<usize>, place: usize) -> usize {
        if place < cells.start {
            self.cells.copy_within(cells.clone(), place);
        }
        place + cells.len()
    }

    /// How many of the first so many frontiers begin before another.
    fn count_before(&self, count: usize, other: &[Cell]) -> usize {
        let order = |cells: &[Cell]| cells.first().map(|cell| (cell.y, cell.x));
        let (mut low, mut high) = (0, count);
        while low < high {
            let middle = usize::midpoint(low, high);
            if order(self.frontier(middle)) < order(other) { low = middle + 1 } else { high = middle }
        }
        low
    }

    /// Where the cells of a frontier begin.
    fn start(&self, index: usize) -> usize {
        if index > 0 { self.ends[index - 1] as usize } else { 0 }
    }

    fn frontier(&self, index: usize) -> &[Cell] {
        &self.cells[self.start(index)..self.ends[index] as usize]
    }

    /// A list for what is known of each frontier while their cells are put in place; it takes
    /// the room of the ends.
    pub(super) fn notes(&mut self) -> &mut Vec<u32> {
        &mut self.ends
    }

    /// Makes room for so many cells, and some more that serve as one pleases, and for the ends
    /// of all frontiers but the first that there are notes of.
    pub(super) fn prepare(&mut self, cells: usize, more: usize) -> Room<'_> {
        let notes = self.ends.len();
        self.cells.resize(cells + more, Cell::new(0, 0));
        self.ends.resize(2 * notes - 1, 0);
        let (notes, ends) = self.ends.split_at_mut(notes);
        Room { cells: &mut self.cells, notes, ends }
    }

    /// Drops the cells beyond so many and the notes.
    pub(super) fn finish(&mut self, cells: usize) {
        self.cells.truncate(cells);
        self.ends.drain(..=self.ends.len() / 2);
    }

    /// Puts a cell in its place.
    pub(super) fn put(&mut self, place: u32, cell: Cell) {
        self.cells[place as usize] = cell;
    }

    /// All cells, those of one frontier after those of another.
    pub(super) fn cells(&self) -> &[Cell] {
        &self.cells
    }

    /// Lists for what is found anew, of which nothing is to be read: these, or others if
    /// frontiers made of them are still about.
    pub(super) fn anew(shared: &mut Arc<Self>) -> &mut Self {
        if Arc::get_mut(shared).is_none() {
            let with_room =
                Self { cells: Vec::with_capacity(shared.cells.len()), ends: Vec::with_capacity(shared.ends.len()) };
            *shared = Arc::new(with_room);
        }
        Arc::make_mut(shared)
    }

    /// Frontiers of unknown cells.
    #[must_use]
    pub fn to_frontiers(&self) -> Vec<Frontier> {
        Self::share(&Arc::new(self.clone()))
    }

    /// Frontiers of unknown cells, which share these lists.
    pub(super) fn share(shared: &Arc<Self>) -> Vec<Frontier> {
        let frontier = |(id, i): (u64, usize)| {
            let cells = Cells::part_of(shared, shared.start(i)..shared.ends[i] as usize);
            Frontier { id, cells, side: CellSide::Unknown, circle: None }
        };
        (0..).zip(0..shared.len()).map(frontier).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Frontiers of one to three cells whose first cells are in these columns.
    fn found(columns: impl Iterator<Item = i32>) -> FrontierCells {
        let mut found = FrontierCells::default();
        for column in columns {
            let first = found.push(column as u32 % 3 + 1);
            (first..found.ends[found.len() - 1]).for_each(|place| found.put(place, Cell::new(column, 0)));
        }
        found
    }

    proptest! {
        #[test]
        fn what_is_replaced_is_as_if_listed_anew(kinds in proptest::collection::vec(0..3, 0..40)) {
            // Kept, dropped and new ones in any order.
            let of_kinds = |wanted: &[i32]| {
                let wanted = wanted.to_vec();
                found((0..).zip(&kinds).filter(|(_, kind)| wanted.contains(kind)).map(|(column, _)| column))
            };
            let mut list = of_kinds(&[0, 1]);
            let fresh = of_kinds(&[2]);
            list.replace(|cells| kinds[cells[0].x as usize] == 0, fresh.iter().collect::<Vec<_>>().into_iter());
            let expected = of_kinds(&[0, 2]);
            prop_assert_eq!((list.cells, list.ends), (expected.cells, expected.ends));
        }
    }
}
