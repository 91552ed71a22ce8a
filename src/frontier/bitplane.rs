//! The wavefront's frontiers from bit planes, at the speed of memory.
//!
//! The same question as [`Wavefront`](super::Wavefront) asks, answered without a search
//! from cell to cell. The grid is packed into one bit a cell; the neighbours of 64 cells
//! at once are a few shifts; what is connected is found by union-find over runs of cells
//! in rows, after He, Chao and Suzuki (2008). The frontier as an expression of bits is
//! the definition of Topiwala, Inani and Kathpal (2018) written for words. The result is
//! the textbook's to the cell, in the same order.
//!
//! O(cells) with a small constant for packing, plus O(runs). The whole grid is read,
//! also where nothing is known. Nothing but the result is allocated while the size of
//! the map stays the same and its runs do not become more.

use super::flood::Flood;
use super::runs::Runs;
use super::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, Reachability};
use crate::grid::{BitPlane, BitPlanes, Cell, Neighbourhood};

/// A fill may take one run for so many words of a plane, about as long as a copy of
/// the plane takes.
const WORDS_PER_FILLED_RUN: usize = 32;
/// A fill may take this many runs in any case.
const MIN_FILLED_RUNS: usize = 64;
/// The place in the result of a component that is not in it.
const DROPPED: usize = usize::MAX;

/// The detector, with the buffers it keeps between maps.
#[derive(Clone, Debug)]
pub struct Bitplane {
    params: DetectorParams,
    planes: BitPlanes,
    /// The cells that the search could walk on, then those that it does.
    entered: BitPlane,
    frontier: BitPlane,
    runs: Runs,
    flood: Flood,
    row: RowBuffers,
    /// Of each component of the frontier, by its first run: the number of its cells.
    component_cells: Vec<usize>,
}

impl Bitplane {
    /// A detector with these parameters.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        Self {
            params,
            planes: BitPlanes::default(),
            entered: BitPlane::default(),
            frontier: BitPlane::default(),
            runs: Runs::default(),
            flood: Flood::default(),
            row: RowBuffers::default(),
            component_cells: Vec::new(),
        }
    }

    /// Frontier cells where walls block: unknown beside free space connected to the seed.
    fn mark_where_walls_block(&mut self, seed: Cell) {
        self.entered.copy_from(self.planes.free());
        self.keep_connected(seed, Neighbourhood::Four);
        self.row.neighbours_of(&self.entered, self.params.neighbours, &mut self.frontier);
        self.frontier.intersect(self.planes.unknown());
    }

    /// Frontier cells by the paper's line 27: the search walks over all that has a free
    /// neighbour, and over the seed.
    fn mark_as_the_textbook(&mut self, seed: Cell) {
        self.row.neighbours_of(self.planes.free(), self.params.neighbours, &mut self.entered);
        self.entered.insert(seed);
        self.keep_connected(seed, self.params.neighbours);
        self.frontier.copy_from(&self.entered);
        self.frontier.intersect(self.planes.unknown());
    }

    /// Clears among the entered cells what is not connected to the seed: by a fill as
    /// long as that costs little beside reading the planes, else by labelling all runs.
    fn keep_connected(&mut self, seed: Cell, neighbourhood: Neighbourhood) {
        let max_runs = self.entered.words().len() / WORDS_PER_FILLED_RUN + MIN_FILLED_RUNS;
        let unconnected = &mut self.frontier;
        unconnected.copy_from(&self.entered);
        if self.flood.clear_connected(unconnected, seed, neighbourhood, max_runs).is_some() {
            self.entered.subtract(unconnected);
        } else {
            self.runs.label(&self.entered, neighbourhood);
            self.runs.clear_others(&mut self.entered, self.runs.component_at(seed));
        }
    }

    /// The components of the frontier that are large enough. Runs come in row-major
    /// order and a component is named by its first, so nothing needs sorting.
    fn collect(&mut self, min_cells: usize) -> Vec<Frontier> {
        self.runs.label(&self.frontier, self.params.neighbours);
        self.component_cells.clear();
        self.component_cells.resize(self.runs.len(), 0);
        let component_cells = &mut self.component_cells;
        self.runs.iter().for_each(|(_, run, component)| component_cells[component as usize] += run.len());
        let mut frontiers: Vec<Frontier> = Vec::new();
        for (index, (y, run, component)) in self.runs.iter().enumerate() {
            let component = component as usize;
            // The slot of a component's size holds its place in the result once its
            // first run has been met.
            if component == index {
                let count = self.component_cells[index];
                self.component_cells[index] = if count < min_cells { DROPPED } else { frontiers.len() };
                if count >= min_cells {
                    let id = frontiers.len() as u64;
                    frontiers.push(Frontier {
                        id,
                        cells: Vec::with_capacity(count),
                        side: CellSide::Unknown,
                        circle: None,
                    });
                }
            }
            if let Some(frontier) = frontiers.get_mut(self.component_cells[component]) {
                frontier.cells.extend((run.start..run.end).map(|x| Cell::new(x as i32, y as i32)));
            }
        }
        frontiers
    }
}

impl FrontierDetector for Bitplane {
    fn name(&self) -> &'static str {
        "bitplane"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let seed = self.params.seed(input.grid, &input.robot_in_map)?;
        self.planes.pack(input.grid, &self.params.thresholds);
        match self.params.reachability {
            Reachability::WallsBlock => self.mark_where_walls_block(seed),
            Reachability::Textbook => self.mark_as_the_textbook(seed),
        }
        Ok(self.collect(self.params.min_cells(input.grid.info())))
    }
}

/// Rows of words between which neighbours are computed.
#[derive(Clone, Debug, Default)]
struct RowBuffers {
    /// What stands above the first row and below the last.
    empty: Vec<u64>,
    /// Cells whose left and right neighbours count, with an empty word at either end.
    centre: Vec<u64>,
}

impl RowBuffers {
    /// The cells that have a neighbour in `source`, whatever they are themselves.
    fn neighbours_of(&mut self, source: &BitPlane, neighbourhood: Neighbourhood, target: &mut BitPlane) {
        target.resize(source.width(), source.height());
        self.empty.resize(source.row_words(), 0);
        self.centre.clear();
        self.centre.resize(source.row_words() + 2, 0);
        let corners = if neighbourhood == Neighbourhood::Eight { u64::MAX } else { 0 };
        for y in 0..source.height() {
            let below = if y > 0 { source.row(y - 1) } else { &self.empty };
            let above = if y + 1 < source.height() { source.row(y + 1) } else { &self.empty };
            let vertical = below.iter().zip(above).map(|(below, above)| below | above);
            let target_row = target.row_mut(y);
            let centre = self.centre[1..].iter_mut().zip(source.row(y)).zip(target_row.iter_mut());
            for (vertical, ((centre, own), target)) in vertical.zip(centre) {
                *centre = own | (vertical & corners);
                *target = vertical;
            }
            for (target, words) in target_row.iter_mut().zip(self.centre.windows(3)) {
                *target |= words[1] << 1 | words[0] >> 63 | words[1] >> 1 | words[2] << 63;
            }
            if let Some(last) = target_row.last_mut() {
                *last &= source.last_word_mask();
            }
        }
    }
}

#[cfg(test)]
#[path = "bitplane_tests.rs"]
mod tests;
