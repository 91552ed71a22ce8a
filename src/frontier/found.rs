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

    /// Drops frontiers and puts others, which come in the order of first cells, among the
    /// rest. What is kept is moved once, and not at all before the first that is dropped or
    /// new.
    pub(super) fn splice<'a>(&mut self, splice: &mut Splice, fresh: impl Iterator<Item = &'a [Cell]> + Clone) {
        splice.plan(self, fresh.clone());
        let Splice { blocks, places, cells, frontiers, .. } = &*splice;
        self.cells.resize((*cells).max(self.cells.len()), Cell::new(0, 0));
        self.ends.resize((*frontiers).max(self.ends.len()), 0);
        move_all(&mut self.cells, blocks.iter().map(|block| (&block.cells, block.to_cell)));
        move_all(&mut self.ends, blocks.iter().map(|block| (&block.frontiers, block.to_frontier)));
        for Block { frontiers, cells, to_frontier, to_cell } in blocks {
            let moved = &mut self.ends[*to_frontier..to_frontier + frontiers.len()];
            moved.iter_mut().for_each(|end| *end = (*end as usize - cells.start + to_cell) as u32);
        }
        for (cells, &(frontier, place)) in fresh.zip(places) {
            self.cells[place..place + cells.len()].copy_from_slice(cells);
            self.ends[frontier] = (place + cells.len()) as u32;
        }
        self.cells.truncate(*cells);
        self.ends.truncate(*frontiers);
    }

    /// How many frontiers begin before a cell, in row-major order.
    pub(super) fn count_before(&self, cell: Cell) -> usize {
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

    /// The cells of a frontier.
    pub(super) fn frontier(&self, index: usize) -> &[Cell] {
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

/// What is to be done to a list of frontiers, with the buffers of it.
#[derive(Clone, Debug, Default)]
pub(super) struct Splice {
    /// Which are dropped, in order.
    dropped: Vec<u32>,
    /// Those that are kept, as they stand beside each other.
    blocks: Vec<Block>,
    /// Of each new one which it becomes and where its cells go.
    places: Vec<(usize, usize)>,
    /// How many cells and frontiers there are in the end.
    cells: usize,
    frontiers: usize,
}

/// Frontiers that stay beside each other.
#[derive(Clone, Debug)]
struct Block {
    frontiers: Range<usize>,
    cells: Range<usize>,
    to_frontier: usize,
    to_cell: usize,
}

/// Moves parts of a list that do not pass each other: downwards from the first on and upwards
/// from the last on, so that nothing is written over that has still to be moved.
fn move_all<'a, T: Copy>(list: &mut [T], moves: impl DoubleEndedIterator<Item = (&'a Range<usize>, usize)> + Clone) {
    for (from, to) in moves.clone().filter(|(from, to)| *to < from.start) {
        list.copy_within(from.clone(), to);
    }
    for (from, to) in moves.rev().filter(|(from, to)| *to > from.start) {
        list.copy_within(from.clone(), to);
    }
}

impl Splice {
    /// Forgets what was to be done.
    pub fn forget(&mut self) {
        self.dropped.clear();
    }

    /// Drops a frontier that comes after those dropped so far.
    pub fn drop(&mut self, index: usize) {
        self.dropped.push(index as u32);
    }

    /// Finds out what goes where.
    fn plan<'a>(&mut self, found: &FrontierCells, fresh: impl Iterator<Item = &'a [Cell]>) {
        let Self { dropped, blocks, places, cells, frontiers } = self;
        blocks.clear();
        places.clear();
        (*cells, *frontiers) = (0, 0);
        let mut next = 0;
        let mut keep_to = |next: &mut usize, end: usize, frontiers: &mut usize, cells: &mut usize| {
            if *next < end {
                let block = Block {
                    frontiers: *next..end,
                    cells: found.start(*next)..found.start(end),
                    to_frontier: *frontiers,
                    to_cell: *cells,
                };
                *frontiers += end - *next;
                *cells += block.cells.len();
                blocks.push(block);
                *next = end;
            }
        };
        let mut dropped = dropped.iter().map(|&index| index as usize).peekable();
        for new in fresh {
            let place = new.first().map_or(0, |&first| found.count_before(first));
            while let Some(index) = dropped.next_if(|&index| index < place) {
                keep_to(&mut next, index, frontiers, cells);
                next = index + 1;
            }
            keep_to(&mut next, place, frontiers, cells);
            places.push((*frontiers, *cells));
            *frontiers += 1;
            *cells += new.len();
        }
        for index in dropped {
            keep_to(&mut next, index, frontiers, cells);
            next = index + 1;
        }
        keep_to(&mut next, found.len(), frontiers, cells);
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.dropped.capacity() * size_of::<u32>()
            + self.blocks.capacity() * size_of::<Block>()
            + self.places.capacity() * size_of::<(usize, usize)>()
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
            let mut splice = Splice::default();
            let kinds_listed = (0..).zip(list.iter().map(|cells| kinds[cells[0].x as usize]));
            kinds_listed.filter(|&(_, kind)| kind == 1).for_each(|(index, _)| splice.drop(index));
            list.splice(&mut splice, fresh.iter().collect::<Vec<_>>().into_iter());
            let expected = of_kinds(&[0, 2]);
            prop_assert_eq!((list.cells, list.ends), (expected.cells, expected.ends));
        }
    }
}
