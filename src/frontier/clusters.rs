//! Frontiers from a plane of frontier cells: its components, each with its cells.

use super::contacts::Starts;
use super::labels::Labels;
use super::window::Window;
use super::{CellSide, Frontier};
use crate::grid::{BitPlane, Cell, Neighbourhood, WORD_CELLS};

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

/// Groups the cells of planes into frontiers, with the buffers it keeps.
#[derive(Clone, Debug, Default)]
pub(super) struct Clusters {
    labels: Labels,
    /// Of each component the number of its cells, then where its next cell goes.
    slots: Vec<u32>,
}

impl Clusters {
    /// The components of a plane that have at least `min_cells` cells.
    pub fn collect(
        &mut self,
        plane: &BitPlane,
        neighbourhood: Neighbourhood,
        min_cells: usize,
        found: &mut FrontierCells,
    ) {
        self.labels.label(plane, &Window::of(plane), neighbourhood);
        self.slots.clear();
        self.slots.resize(self.labels.components(), 0);
        for_each_cell(plane, &self.labels, |_, component| self.slots[component as usize] += 1);
        found.ends.clear();
        let mut end = 0;
        for slot in &mut self.slots {
            let count = *slot;
            if count as usize >= min_cells {
                *slot = end;
                end += count;
                found.ends.push(end);
            } else {
                *slot = u32::MAX;
            }
        }
        // What is dropped is written behind the end, one on top of the other, which
        // is faster than to ask for each cell.
        for slot in self.slots.iter_mut().filter(|slot| **slot == u32::MAX) {
            *slot = end;
        }
        let spare = min_cells.min(plane.width() * plane.height());
        found.cells.resize(end as usize + spare, Cell::new(0, 0));
        for_each_cell(plane, &self.labels, |cell, component| {
            let slot = &mut self.slots[component as usize];
            found.cells[*slot as usize] = cell;
            *slot += 1;
        });
        found.cells.truncate(end as usize);
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.labels.memory_bytes() + self.slots.capacity() * size_of::<u32>()
    }
}

/// All cells of a labelled plane in row-major order, each with its component.
#[inline]
fn for_each_cell(plane: &BitPlane, labels: &Labels, mut visit: impl FnMut(Cell, u32)) {
    for y in 0..plane.height() {
        let components = labels.row(y);
        if components.is_empty() {
            continue;
        }
        // Runs begun so far in the row.
        let mut begun = 0;
        let mut starts = Starts::default();
        for (index, &word) in plane.row(y).iter().enumerate() {
            let begins = starts.of(word);
            let mut rest = word;
            while rest != 0 {
                let bit = rest.trailing_zeros();
                begun += (begins >> bit & 1) as usize;
                visit(Cell::new((index * WORD_CELLS) as i32 + bit as i32, y as i32), components[begun - 1]);
                rest &= rest - 1;
            }
        }
    }
}
