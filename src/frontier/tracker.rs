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

/// What became of a frontier.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FrontierEvent {
    /// It overlaps none of the last map.
    Appeared(FrontierId),
    /// It overlaps none of the new map.
    Vanished(FrontierId),
    /// It overlaps several of the new map.
    Split {
        /// The frontier of the last map.
        from: FrontierId,
        /// Those of the new map in their order; one of them may bear its name still.
        into: Vec<FrontierId>,
    },
    /// Several of the last map overlap the same one.
    Merged {
        /// Those of the last map in ascending order; names not used in the new map have
        /// ended here.
        from: Vec<FrontierId>,
        /// The frontier of the new map.
        into: FrontierId,
    },
}

/// The names of the frontiers of one detection.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tracked {
    /// The name of each frontier, in the detection's order.
    pub ids: Vec<FrontierId>,
    /// What changed: splits, merges, appearances, then disappearances, each in a fixed order.
    pub events: Vec<FrontierEvent>,
    /// The names of the last map that no frontier bears any longer, in ascending order.
    pub ended: Vec<FrontierId>,
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

    /// Names the frontiers of a new map, whose cells lie in `info`. The map may have
    /// another size, origin or resolution than the last one.
    pub fn update(&mut self, frontiers: &[Frontier], info: &GridInfo) -> Tracked {
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
        let tracked = Tracked { events: events(&overlaps, old_ids, &ids), ended: ended(old_ids, &ids), ids };
        let cells = frontiers.iter().enumerate().flat_map(|(i, f)| f.cells.iter().map(move |&cell| (cell, i)));
        self.last = Some(Last { info: *info, ids: tracked.ids.clone(), cells: cells.collect() });
        tracked
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
        let same_yaw = (info.origin_in_map().yaw - lattice.origin_in_map().yaw).abs() < 1e-9;
        let same_resolution = (info.resolution_m() / lattice.resolution_m() - 1.0).abs() < 1e-9;
        if same_yaw && same_resolution {
            let (x, y) = lattice.to_grid_units(info.origin_in_map().position());
            Self::Shift(x.round() as i32, y.round() as i32)
        } else {
            Self::Centre(info, lattice)
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

fn events(overlaps: &[Overlap], old_ids: &[FrontierId], ids: &[FrontierId]) -> Vec<FrontierEvent> {
    let mut events = Vec::new();
    for group in overlaps.chunk_by(|a, b| a.old == b.old) {
        if let [first, _, ..] = group {
            let into = group.iter().map(|o| ids[o.new]).collect();
            events.push(FrontierEvent::Split { from: old_ids[first.old], into });
        }
    }
    let mut by_new = overlaps.to_vec();
    by_new.sort_unstable_by_key(|o| (o.new, old_ids[o.old]));
    for group in by_new.chunk_by(|a, b| a.new == b.new) {
        if let [first, _, ..] = group {
            let from = group.iter().map(|o| old_ids[o.old]).collect();
            events.push(FrontierEvent::Merged { from, into: ids[first.new] });
        }
    }
    let (mut met_old, mut met_new) = (vec![false; old_ids.len()], vec![false; ids.len()]);
    for overlap in overlaps {
        met_old[overlap.old] = true;
        met_new[overlap.new] = true;
    }
    let unmet = |met: &[bool], ids: &[FrontierId]| -> Vec<FrontierId> {
        let mut unmet: Vec<_> = ids.iter().zip(met).filter(|(_, met)| !**met).map(|(&id, _)| id).collect();
        unmet.sort_unstable();
        unmet
    };
    events.extend(unmet(&met_new, ids).into_iter().map(FrontierEvent::Appeared));
    events.extend(unmet(&met_old, old_ids).into_iter().map(FrontierEvent::Vanished));
    events
}

fn ended(old_ids: &[FrontierId], ids: &[FrontierId]) -> Vec<FrontierId> {
    let mut current = ids.to_vec();
    current.sort_unstable();
    let mut ended: Vec<_> = old_ids.iter().copied().filter(|id| current.binary_search(id).is_err()).collect();
    ended.sort_unstable();
    ended
}

#[cfg(test)]
#[path = "tracker_tests.rs"]
mod tests;
