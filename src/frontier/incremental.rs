//! The wavefront's frontiers, repaired where the map changed.
//!
//! The result is that of [`Bitplane`](super::Bitplane) and of the textbook, to the cell and
//! in the same order; the cost is that of what changed. The new map is packed and compared
//! with the last one, 64 cells at a time, or only in the rectangle that is known to have
//! changed; what is connected is repaired tile by tile ([`super::reach`]), the frontier's
//! cells where reach or territory changed, and the groups that had a cell there.
//!
//! O(cells compared + tiles + what changed + cells of all frontiers), the last with the
//! constant of a copy. A map of another size starts over.

use super::clusters::Clusters;
use super::found::FrontierCells;
use super::reach::{Changed, Reach};
use super::regroup::Regroup;
use super::shifts::neighbours_of_row;
use super::tiles::Tiling;
use super::window::Window;
use super::{DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, Reachability};
use crate::grid::{BitPlane, BitPlanes, BitWork, Cell, CellRect, GridInfo, Neighbourhood, with_bit_instructions};
use std::ops::Range;
use std::sync::Arc;

/// The detector, with what it knows of the last map.
#[derive(Clone, Debug)]
pub struct Incremental {
    params: DetectorParams,
    planes: BitPlanes,
    /// By the textbook: the cells that the search could walk on.
    open: BitPlane,
    reach: Reach,
    tiling: Tiling,
    frontier: BitPlane,
    /// Words that changed: the row, and which of it.
    changed: Vec<(usize, Range<usize>)>,
    /// Tiles whose territory or reach changed.
    stale: Vec<bool>,
    /// Of each tile, where its reach changed.
    reach_changed: Vec<Changed>,
    /// Tiles with other frontier cells than before.
    regroup: Vec<bool>,
    /// The smallest number of cells of the frontiers found; `None` if all are to be found
    /// anew.
    min_cells: Option<usize>,
    clusters: Clusters,
    groups: Regroup,
    found: Arc<FrontierCells>,
    seeds: Vec<Cell>,
    row: Vec<u64>,
}

impl Incremental {
    /// A detector with these parameters that has seen no map.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        let connected_by = match params.reachability {
            Reachability::WallsBlock => Neighbourhood::Four,
            Reachability::Textbook => params.neighbours,
        };
        Self {
            params,
            planes: BitPlanes::default(),
            open: BitPlane::default(),
            reach: Reach::new(connected_by),
            tiling: Tiling::default(),
            frontier: BitPlane::default(),
            changed: Vec::new(),
            stale: Vec::new(),
            reach_changed: Vec::new(),
            regroup: Vec::new(),
            min_cells: None,
            clusters: Clusters::default(),
            groups: Regroup::default(),
            found: Arc::default(),
            seeds: Vec::new(),
            row: Vec::new(),
        }
    }

    /// Detects on a map of which at most the cells of a rectangle are others than at the
    /// last call, as after a `map_msgs/OccupancyGridUpdate`; `None` if that is not known.
    /// A change that is not in the rectangle is not seen. Nothing is allocated once the
    /// buffers have grown to what such maps need.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map; its changes are
    /// remembered for the next.
    pub fn update(
        &mut self,
        input: &DetectionInput<'_>,
        changed: Option<CellRect>,
    ) -> Result<&FrontierCells, DetectError> {
        let info = input.grid.info();
        self.take_in(input, changed);
        let seed = self.params.seed(input.grid, &input.robot_in_map)?;
        self.find_seeds(seed, info);
        let plane = match self.params.reachability {
            Reachability::WallsBlock => self.planes.free(),
            Reachability::Textbook => &self.open,
        };
        self.reach.update(plane, &self.seeds, &mut self.reach_changed);
        self.mark_stale();
        self.find_frontier_cells();
        let min_cells = self.params.min_cells(info);
        let (frontier, neighbours) = (&mut self.frontier, self.params.neighbours);
        let repaired = self.min_cells == Some(min_cells)
            && self.groups.update(
                frontier,
                &self.tiling,
                &self.regroup,
                neighbours,
                min_cells,
                Arc::make_mut(&mut self.found),
            );
        if !repaired {
            let found = FrontierCells::anew(&mut self.found);
            self.clusters.collect(frontier, neighbours, min_cells, found);
            self.min_cells = Some(min_cells);
        }
        self.regroup.fill(false);
        Ok(&self.found)
    }

    /// What the detector's own state takes in memory, bytes; the frontiers last found are
    /// not part of it.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.planes.memory_bytes()
            + self.open.memory_bytes()
            + self.frontier.memory_bytes()
            + self.reach.memory_bytes()
            + self.clusters.memory_bytes()
            + self.groups.memory_bytes()
            + self.changed.capacity() * size_of::<(usize, Range<usize>)>()
            + self.stale.capacity()
            + self.reach_changed.capacity() * size_of::<Changed>()
            + self.regroup.capacity()
            + self.row.capacity() * size_of::<u64>()
            + self.seeds.capacity() * size_of::<Cell>()
    }

    /// Packs what changed and tells those whom it concerns.
    fn take_in(&mut self, input: &DetectionInput<'_>, changed: Option<CellRect>) {
        let info = input.grid.info();
        self.changed.clear();
        if (self.planes.free().width(), self.planes.free().height()) != (info.width(), info.height()) {
            self.start_over(info);
            self.planes.pack(input.grid, &self.params.thresholds);
            if self.params.reachability == Reachability::Textbook {
                (0..info.height()).for_each(|y| self.open_row(y, 0..self.planes.free().row_words()));
            }
            return;
        }
        let rect = changed.unwrap_or_else(|| CellRect::of(info));
        let list = &mut self.changed;
        let thresholds = &self.params.thresholds;
        self.planes.repack(input.grid, thresholds, rect.rows(info), rect.words(info), |y, words| list.push((y, words)));
        for index in 0..self.changed.len() {
            let (y, words) = self.changed[index].clone();
            for word in words.clone() {
                self.stale[self.tiling.at(y, word)] = true;
            }
            match self.params.reachability {
                Reachability::WallsBlock => words.for_each(|word| self.reach.touch(y, word)),
                Reachability::Textbook => {
                    let words = words.start.saturating_sub(1)..(words.end + 1).min(self.open.row_words());
                    for y in y.saturating_sub(1)..(y + 2).min(info.height()) {
                        self.open_row(y, words.clone());
                    }
                }
            }
        }
    }

    fn start_over(&mut self, info: &GridInfo) {
        let (width, height) = (info.width(), info.height());
        self.planes.resize(info);
        self.frontier.resize(width, height);
        if self.params.reachability == Reachability::Textbook {
            self.open.resize(width, height);
        }
        self.reach.reset(width, height);
        self.tiling = Tiling::new(self.frontier.row_words(), height);
        for flags in [&mut self.stale, &mut self.regroup] {
            flags.clear();
            flags.resize(self.tiling.len(), true);
        }
        self.reach_changed.resize(self.tiling.len(), Changed::default());
        self.row.resize(self.frontier.row_words(), 0);
        self.min_cells = None;
    }

    /// Finds again which cells of a row have a free neighbour.
    fn open_row(&mut self, y: usize, words: Range<usize>) {
        let row = &mut self.row[words.clone()];
        neighbours_of_row(self.planes.free(), self.params.neighbours, y, words.clone(), row);
        let open = self.open.row_mut(y);
        for (word, &new) in words.zip(&*row) {
            if open[word] != new {
                open[word] = new;
                self.reach.touch(y, word);
            }
        }
    }

    /// The cells from which the search sets out. By the textbook that is the seed, which
    /// it enters whatever stands around it, and so its neighbours too.
    fn find_seeds(&mut self, seed: Cell, info: &GridInfo) {
        self.seeds.clear();
        self.seeds.push(seed);
        if self.params.reachability == Reachability::Textbook && !self.open.contains(seed) {
            self.seeds.extend(info.neighbours(seed, self.params.neighbours));
        }
    }

    /// Where walls block, a frontier cell may lie beside what is reached.
    fn mark_stale(&mut self) {
        let beside: &[(isize, isize)] = match self.params.reachability {
            Reachability::Textbook => &[(0, 0)],
            Reachability::WallsBlock => &[(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)],
        };
        for (tile, changed) in self.reach_changed.iter().enumerate().filter(|(_, changed)| changed.any) {
            let touched = beside.iter().filter(|&&offset| changed.touches(offset));
            for near in touched.filter_map(|&offset| self.tiling.beside(tile, offset)) {
                self.stale[near] = true;
            }
        }
    }

    /// Finds again the frontier cells of the tiles that are stale.
    fn find_frontier_cells(&mut self) {
        let beside = match self.params.reachability {
            Reachability::Textbook => None,
            Reachability::WallsBlock => Some(self.params.neighbours),
        };
        for tile in 0..self.tiling.len() {
            if std::mem::take(&mut self.stale[tile]) {
                let window = self.tiling.window(tile);
                let (reached, unknown) = (self.reach.plane(), self.planes.unknown());
                let row = &mut self.row[window.words.clone()];
                let frontier = &mut self.frontier;
                self.regroup[tile] |=
                    with_bit_instructions(FindCells { reached, unknown, beside, window, row, frontier });
            }
        }
    }
}

/// Finds the frontier cells of a window: the unknown ones that are reached, or beside what
/// is. Whether they are others than before.
struct FindCells<'a> {
    reached: &'a BitPlane,
    unknown: &'a BitPlane,
    beside: Option<Neighbourhood>,
    window: Window,
    /// Room for a row of the window.
    row: &'a mut [u64],
    frontier: &'a mut BitPlane,
}

impl BitWork for FindCells<'_> {
    type Output = bool;

    #[inline(always)]
    fn run(self) -> bool {
        let Self { reached, unknown, beside, window, row, frontier } = self;
        let mut differ = 0;
        for y in window.rows.clone() {
            match beside {
                Some(neighbours) => neighbours_of_row(reached, neighbours, y, window.words.clone(), row),
                None => row.copy_from_slice(window.row(reached, y)),
            }
            let known = &mut frontier.row_mut(y)[window.words.clone()];
            for ((row, unknown), known) in row.iter().zip(window.row(unknown, y)).zip(known) {
                let found = row & unknown;
                differ |= *known ^ found;
                *known = found;
            }
        }
        differ != 0
    }
}

impl FrontierDetector for Incremental {
    fn name(&self) -> &'static str {
        "incremental"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        self.update(input, None)?;
        Ok(FrontierCells::share(&self.found))
    }
}

#[cfg(test)]
#[path = "incremental_tests.rs"]
mod tests;
