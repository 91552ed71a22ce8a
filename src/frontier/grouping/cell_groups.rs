//! Groups a list of frontier cells into connected components.

use crate::bits::union_find::unite;
use crate::frontier::grouping::cell_lists::FrontierCells;
use crate::grid::{Cell, Neighbourhood};

/// Groups cells, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(crate) struct Grouper {
    /// Of each cell the index of one of the same frontier that is not after it.
    parents: Vec<u32>,
    /// Of each first cell the number of cells, then the place of the next.
    slots: Vec<u32>,
}

impl Grouper {
    /// Groups cells in row-major order, each there once, into frontiers of at least
    /// `min_cells` cells. O(cells), up to the factor of a union-find.
    pub fn group(&mut self, cells: &[Cell], neighbourhood: Neighbourhood, min_cells: usize, found: &mut FrontierCells) {
        let Self { parents, slots } = self;
        parents.clear();
        parents.extend(0..cells.len() as u32);
        connect(cells, neighbourhood, parents);
        slots.clear();
        slots.resize(cells.len(), 0);
        // Parents come first, so that each knows its root when its children ask.
        for i in 0..parents.len() {
            parents[i] = parents[parents[i] as usize];
            slots[parents[i] as usize] += 1;
        }
        found.clear();
        for (i, slot) in slots.iter_mut().enumerate() {
            let is_kept = parents[i] as usize == i && *slot as usize >= min_cells;
            *slot = if is_kept { found.push(*slot) } else { u32::MAX };
        }
        for (cell, &root) in cells.iter().zip(&*parents) {
            let slot = &mut slots[root as usize];
            if *slot != u32::MAX {
                found.put(*slot, *cell);
                *slot += 1;
            }
        }
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        (self.parents.capacity() + self.slots.capacity()) * size_of::<u32>()
    }
}

/// Unites cells that are adjacent.
fn connect(cells: &[Cell], neighbourhood: Neighbourhood, parents: &mut [u32]) {
    let margin = i32::from(neighbourhood == Neighbourhood::Eight);
    let mut below = 0;
    for (i, cell) in cells.iter().enumerate() {
        if i > 0 && cells[i - 1] == cell.offset((-1, 0)) {
            unite(parents, i as u32 - 1, i as u32);
        }
        let first = cell.offset((-margin, -1));
        while (cells[below].y, cells[below].x) < (first.y, first.x) {
            below += 1;
        }
        let touching = cells[below..i].iter().take_while(|c| c.y == first.y && c.x <= cell.x + margin).count();
        for other in below..below + touching {
            unite(parents, other as u32, i as u32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grouped(cells: &[(i32, i32)], neighbourhood: Neighbourhood, min_cells: usize) -> Vec<Vec<(i32, i32)>> {
        let cells: Vec<Cell> = cells.iter().map(|&(x, y)| Cell::new(x, y)).collect();
        let mut found = FrontierCells::default();
        Grouper::default().group(&cells, neighbourhood, min_cells, &mut found);
        found.iter().map(|cells| cells.iter().map(|c| (c.x, c.y)).collect()).collect()
    }

    #[test]
    fn adjacent_cells_are_grouped_in_the_order_of_their_first() {
        // Two legs that meet below, and one cell at a corner of the second.
        let cells = [(0, 0), (2, 0), (7, 0), (0, 1), (2, 1), (0, 2), (1, 2), (2, 2), (3, 3)];
        let legs = vec![(0, 0), (2, 0), (0, 1), (2, 1), (0, 2), (1, 2), (2, 2)];
        let with_corner: Vec<_> = legs.iter().copied().chain([(3, 3)]).collect();
        assert_eq!(grouped(&cells, Neighbourhood::Four, 1), [legs, vec![(7, 0)], vec![(3, 3)]]);
        assert_eq!(grouped(&cells, Neighbourhood::Eight, 1), [with_corner.clone(), vec![(7, 0)]]);
        assert_eq!(grouped(&cells, Neighbourhood::Eight, 2), [with_corner]);
        assert_eq!(grouped(&[], Neighbourhood::Eight, 1), Vec::<Vec<_>>::new());
    }
}
