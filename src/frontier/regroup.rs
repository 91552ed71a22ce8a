//! The frontiers of a plane of which some tiles changed.

use super::clusters::FrontierCells;
use super::group::Grouper;
use super::tiles::Tiling;
use crate::grid::{BitPlane, Cell, Neighbourhood, WORD_CELLS};

/// Repairs lists of frontiers, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Regroup {
    grouper: Grouper,
    cells: Vec<Cell>,
    fresh: FrontierCells,
    next: FrontierCells,
}

impl Regroup {
    /// Finds again the frontiers that have a cell in a tile that changed or touch one that
    /// has; the others are kept. Of the plane nothing is changed in the end.
    pub fn update(
        &mut self,
        plane: &mut BitPlane,
        tiling: &Tiling,
        changed: &[bool],
        neighbourhood: Neighbourhood,
        min_cells: usize,
        found: &mut FrontierCells,
    ) {
        let is_changed = |cell: &Cell| changed[tiling.at(cell.y as usize, cell.x as usize / WORD_CELLS)];
        self.cells.clear();
        for tile in (0..tiling.len()).filter(|&tile| changed[tile]) {
            let window = tiling.window(tile);
            for y in window.rows.clone() {
                for index in window.words.clone() {
                    while let bits @ 1.. = plane.row(y)[index] {
                        let x = index * WORD_CELLS + bits.trailing_zeros() as usize;
                        self.take(plane, Cell::new(x as i32, y as i32), neighbourhood);
                    }
                }
            }
        }
        // What is left of the frontiers that lost a cell, or were joined by one.
        for cells in found.iter().filter(|cells| cells.iter().any(is_changed)) {
            for &cell in cells {
                self.take(plane, cell, neighbourhood);
            }
        }
        self.cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        self.grouper.group(&self.cells, neighbourhood, min_cells, &mut self.fresh);
        // A frontier all of whose cells are still waiting was not touched.
        self.next.clear();
        let mut fresh = self.fresh.iter().peekable();
        let untouched = |cells: &&[Cell]| cells.first().is_some_and(|&cell| plane.contains(cell));
        let order = |cells: &[Cell]| cells.first().map(|cell| (cell.y, cell.x));
        for kept in found.iter().filter(untouched) {
            while let Some(new) = fresh.next_if(|new| order(new) < order(kept)) {
                self.next.append(new);
            }
            self.next.append(kept);
        }
        fresh.for_each(|new| self.next.append(new));
        std::mem::swap(&mut self.next, found);
        for &cell in &self.cells {
            plane.insert(cell);
        }
    }

    /// Takes a cell that is still set out of the plane, and all that are connected to it.
    fn take(&mut self, plane: &mut BitPlane, cell: Cell, neighbourhood: Neighbourhood) {
        if !plane.remove(cell) {
            return;
        }
        let mut next = self.cells.len();
        self.cells.push(cell);
        while let Some(&cell) = self.cells.get(next) {
            next += 1;
            for &offset in neighbourhood.offsets() {
                let beside = cell.offset(offset);
                if plane.remove(beside) {
                    self.cells.push(beside);
                }
            }
        }
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.cells.capacity() * size_of::<Cell>()
            + self.grouper.memory_bytes()
            + self.fresh.memory_bytes()
            + self.next.memory_bytes()
    }
}
