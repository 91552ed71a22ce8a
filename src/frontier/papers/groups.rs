//! Lists of cells: those that a mask has set, and groups of adjacent ones.

use crate::grid::{Cell, GridInfo, Neighbourhood};

/// The cells that a row-major mask has set, in that order.
pub(crate) fn set_cells(info: &GridInfo, mask: &[bool]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (y, row) in (0..).zip(mask.chunks_exact(info.width())) {
        // Most stretches of most maps have nothing set.
        for (x, stretch) in (0..).step_by(64).zip(row.chunks(64)) {
            if stretch.contains(&true) {
                let set = (x..).zip(stretch).filter(|(_, set)| **set);
                cells.extend(set.map(|(x, _)| Cell::new(x, y)));
            }
        }
    }
    cells
}

/// Groups cells by adjacency. Cells outside the grid are left out; the groups come in
/// the order of their first cells in the list. O(cells).
pub(crate) fn group(info: &GridInfo, cells: &[Cell], neighbours: Neighbourhood) -> Vec<Vec<Cell>> {
    let mut waiting = vec![false; info.len()];
    for index in cells.iter().filter_map(|&cell| info.index(cell)) {
        waiting[index] = true;
    }
    let mut take = |cell: Cell| info.index(cell).is_some_and(|index| std::mem::take(&mut waiting[index]));
    let mut groups = Vec::new();
    for &first in cells {
        if !take(first) {
            continue;
        }
        let mut group = vec![first];
        let mut next = 0;
        while let Some(&cell) = group.get(next) {
            group.extend(info.neighbours(cell, neighbours).filter(|&n| take(n)));
            next += 1;
        }
        groups.push(group);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::OccupancyGrid;

    #[test]
    fn adjacent_cells_are_grouped() {
        let grid = OccupancyGrid::from_ascii("....\n....\n....").unwrap();
        let cells = [Cell::new(0, 0), Cell::new(1, 1), Cell::new(3, 0), Cell::new(3, 1), Cell::new(9, 9)];
        let eight = group(grid.info(), &cells, Neighbourhood::Eight);
        assert_eq!(eight, [vec![Cell::new(0, 0), Cell::new(1, 1)], vec![Cell::new(3, 0), Cell::new(3, 1)]]);
        assert_eq!(group(grid.info(), &cells, Neighbourhood::Four).len(), 3);
    }
}
