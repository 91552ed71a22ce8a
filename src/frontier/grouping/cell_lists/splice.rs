//! Replaces a few frontiers in the list of all and moves the others once at most.

use super::FrontierCells;
use crate::grid::Cell;
use std::ops::Range;

/// What is to be done to a list of frontiers, with the buffers of it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Splice {
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

impl FrontierCells {
    /// Drops frontiers and puts others, which come in the order of first cells, among the
    /// rest. What is kept is moved once, and not at all before the first that is dropped or
    /// new.
    pub(crate) fn splice<'a>(&mut self, splice: &mut Splice, fresh: impl Iterator<Item = &'a [Cell]> + Clone) {
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
        self.blocks.clear();
        self.places.clear();
        (self.cells, self.frontiers) = (0, 0);
        let dropped = std::mem::take(&mut self.dropped);
        let mut to_drop = dropped.iter().map(|&index| index as usize).peekable();
        // The first of the list of which nothing has been said.
        let mut next = 0;
        for new in fresh {
            let place = new.first().map_or(0, |&first| found.count_before(first));
            while let Some(index) = to_drop.next_if(|&index| index < place) {
                self.keep(found, next..index);
                next = index + 1;
            }
            self.keep(found, next..place);
            next = next.max(place);
            self.places.push((self.frontiers, self.cells));
            self.frontiers += 1;
            self.cells += new.len();
        }
        for index in to_drop {
            self.keep(found, next..index);
            next = index + 1;
        }
        self.keep(found, next..found.len());
        self.dropped = dropped;
    }

    /// Frontiers of a list come next, if these are any.
    fn keep(&mut self, found: &FrontierCells, frontiers: Range<usize>) {
        if frontiers.is_empty() {
            return;
        }
        let cells = found.start(frontiers.start)..found.start(frontiers.end);
        let (to_frontier, to_cell) = (self.frontiers, self.cells);
        self.frontiers += frontiers.len();
        self.cells += cells.len();
        self.blocks.push(Block { frontiers, cells, to_frontier, to_cell });
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.dropped.capacity() * size_of::<u32>()
            + self.blocks.capacity() * size_of::<Block>()
            + self.places.capacity() * size_of::<(usize, usize)>()
    }
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
