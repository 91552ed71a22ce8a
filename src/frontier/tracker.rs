//! Which frontier of a new map is which of the last one.
//!
//! Works on the result of any detector: frontiers are matched by the cells that they
//! share, counted on the lattice of the map frame, so that a map that grew and moved its
//! origin changes no name. The pairs with the most shared cells are joined first, one to
//! one; the rest are splits and merges. This is the overlap rule of blob tracking (Rehg,
//! Loughlin and Waters, CVPR 1997, and many since), made deterministic by its ties.
//! O(n log n) in the number of frontier cells.

use super::Frontier;
use crate::grid::{Cell, GridInfo};
use serde::Serialize;

/// Names a frontier for as long as it overlaps itself from map to map. Never used again
/// by the same tracker once its frontier is gone.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[serde(transparent)]
pub struct FrontierId(u64);

impl FrontierId {
    /// The number, counted from 0 in the order of appearance.
    #[must_use]
    pub const fn get(self) -> u64 {
        self.0
    }
}

/// The frontiers of the last map with their names.
#[derive(Clone, Debug, Default)]
pub struct FrontierTracker {
    last: Option<Last>,
    next_id: u64,
}

#[derive(Clone, Debug)]
struct Last {
    info: GridInfo,
    ids: Vec<FrontierId>,
    /// Each cell with the place of its frontier in `ids`.
    cells: Vec<(Cell, usize)>,
}

/// How many cells a frontier of the last map and one of the new map share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Overlap {
    old: usize,
    new: usize,
    cells: usize,
}

impl FrontierTracker {
    /// A tracker that has seen no map.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The names of the frontiers of a new map, in their order; their cells lie in `info`. The map
    /// may have another size, origin or resolution than the last one.
    pub fn update(&mut self, frontiers: &[Frontier], info: &GridInfo) -> Vec<FrontierId> {
        let last = self.last.take();
        let (old_ids, overlaps) =
            last.as_ref().map_or((&[][..], Vec::new()), |last| (&last.ids[..], overlaps(last, frontiers, info)));
        let kept = join(&overlaps, old_ids.len(), frontiers.len());
        let ids: Vec<FrontierId> = kept
            .iter()
            .map(|old| match *old {
                Some(old) => old_ids[old],
                None => {
                    self.next_id += 1;
                    FrontierId(self.next_id - 1)
                }
            })
            .collect();
        let cells = frontiers.iter().enumerate().flat_map(|(i, f)| f.cells.iter().map(move |&cell| (cell, i)));
        self.last = Some(Last { info: *info, ids: ids.clone(), cells: cells.collect() });
        ids
    }
}

/// All pairs that share a cell, ordered by old and new.
fn overlaps(last: &Last, frontiers: &[Frontier], info: &GridInfo) -> Vec<Overlap> {
    // Several cells of a fine lattice fall into one of a coarse lattice; the other way
    // round, cells between would be missed.
    let lattice = if info.resolution_m() > last.info.resolution_m() { info } else { &last.info };
    let new_cells = frontiers.iter().enumerate().flat_map(|(i, f)| f.cells.iter().map(move |&cell| (cell, i)));
    let old = on_lattice(last.cells.iter().copied(), &last.info, lattice);
    let new = on_lattice(new_cells, info, lattice);
    let mut shared = Vec::new();
    let mut from = 0;
    for &(cell, i) in &new {
        while old.get(from).is_some_and(|&(earlier, _)| earlier < cell) {
            from += 1;
        }
        shared.extend(old[from..].iter().take_while(|&&(other, _)| other == cell).map(|&(_, j)| (j, i)));
    }
    shared.sort_unstable();
    let groups = shared.chunk_by(|a, b| a == b);
    groups.filter_map(|g| g.first().map(|&(old, new)| Overlap { old, new, cells: g.len() })).collect()
}

/// The cells of a grid as cells of another's lattice, sorted, each once for each owner.
fn on_lattice(cells: impl Iterator<Item = (Cell, usize)>, info: &GridInfo, lattice: &GridInfo) -> Vec<(Cell, usize)> {
    let moved = Mapping::new(info, lattice);
    let mut cells: Vec<(Cell, usize)> = cells.map(|(cell, owner)| (moved.of(cell), owner)).collect();
    cells.sort_unstable();
    cells.dedup();
    cells
}

/// From the cells of one grid to those of a lattice.
enum Mapping<'a> {
    /// The same axes and resolution: whole cells, whatever the last digits of the
    /// origins say.
    Shift(i32, i32),
    /// By the position of the cell's centre.
    Centre(&'a GridInfo, &'a GridInfo),
}

impl<'a> Mapping<'a> {
    fn new(info: &'a GridInfo, lattice: &'a GridInfo) -> Self {
        match lattice.offset_of(info) {
            Some((x, y)) => Self::Shift(x, y),
            None => Self::Centre(info, lattice),
        }
    }

    fn of(&self, cell: Cell) -> Cell {
        match *self {
            Self::Shift(dx, dy) => Cell::new(cell.x.saturating_add(dx), cell.y.saturating_add(dy)),
            Self::Centre(info, lattice) => lattice.cell_at(info.center(cell)),
        }
    }
}

/// For each new frontier the old one whose name it takes: pairs with the most shared
/// cells first, ties to the older name and then to the first in the new order.
fn join(overlaps: &[Overlap], old_count: usize, new_count: usize) -> Vec<Option<usize>> {
    let mut by_size = overlaps.to_vec();
    by_size.sort_unstable_by_key(|o| (std::cmp::Reverse(o.cells), o.old, o.new));
    let mut taken = vec![false; old_count];
    let mut kept = vec![None; new_count];
    for Overlap { old, new, .. } in by_size {
        if !taken[old] && kept[new].is_none() {
            taken[old] = true;
            kept[new] = Some(old);
        }
    }
    kept
}

#[cfg(test)]
#[path = "tracker_tests.rs"]
mod tests;
