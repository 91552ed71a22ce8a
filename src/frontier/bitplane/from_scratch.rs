//! The wavefront's frontiers from bit planes, all of them from scratch.
//!
//! The same question as [`Wavefront`](crate::frontier::Wavefront) asks, answered without a search
//! from cell to cell. The grid is packed into one bit a cell; the neighbours of 64 cells
//! at once are a few shifts; what the robot can get to is filled row by row
//! (`bits::connectivity::row_fill`), and what hangs together is found by union-find over runs of cells,
//! after He, Chao and Suzuki (2008). The frontier as an expression of bits is the
//! definition of Topiwala, Inani and Kathpal (2018) written for words. The result is the
//! textbook's to the cell, in the same order.
//!
//! O(cells) with a small constant for packing, plus O(runs). The whole grid is read,
//! also where nothing is known. Nothing but the result is allocated while the size of
//! the map stays the same and its runs do not become more.

use super::lazy_fill::LazyFill;
use crate::bits::connectivity::Connectivity;
use crate::bits::neighbours::neighbours_of_row;
use crate::bits::{BitPlane, BitPlanes, BitWork, with_bit_instructions};
use crate::frontier::grouping::cell_lists::FrontierCells;
use crate::frontier::grouping::clusters::Clusters;
use crate::frontier::{DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, Reachability};
use crate::grid::{Cell, Neighbourhood};
use std::sync::Arc;

/// The detector, with the buffers it keeps between maps.
///
/// The cells of all frontiers are one list, of which each frontier has a part:
///
/// ```
/// use frontier_explorer::frontier::{DetectionInput, DetectorParams, FromScratch};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Cell, OccupancyGrid};
///
/// let grid = OccupancyGrid::from_ascii("??##?\n.....").unwrap();
/// let mut detector = FromScratch::new(DetectorParams::default());
/// let found = detector.detect_cells(&DetectionInput::new(&grid, Pose::new(2.5, 0.5, 0.0)))?;
/// let frontiers: Vec<&[Cell]> = found.iter().collect();
/// assert_eq!(frontiers, [&[Cell::new(0, 1), Cell::new(1, 1)][..], &[Cell::new(4, 1)]]);
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FromScratch {
    params: DetectorParams,
    /// By what frontier cells are of one frontier.
    grouping: Neighbourhood,
    planes: BitPlanes,
    /// The cells that the search walks on.
    entered: BitPlane,
    lazy_fill: LazyFill,
    /// The last map was done with by the fill alone.
    was_lazy: bool,
    connected: Connectivity,
    clusters: Clusters,
    found: Arc<FrontierCells>,
    /// A row of neighbours.
    row: Vec<u64>,
}

impl FromScratch {
    /// A detector with these parameters.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        Self::with_grouping(params, params.neighbours)
    }

    /// One that marks frontier cells by the parameters' neighbours and groups them by others.
    pub(super) fn with_grouping(params: DetectorParams, grouping: Neighbourhood) -> Self {
        Self {
            params,
            grouping,
            planes: BitPlanes::default(),
            entered: BitPlane::default(),
            lazy_fill: LazyFill::new(grouping),
            was_lazy: false,
            connected: Connectivity::by(params.search_neighbours()),
            clusters: Clusters::default(),
            found: Arc::default(),
            row: Vec::new(),
        }
    }

    /// The frontiers as lists of cells, without a copy of each. What comes out is the
    /// same as from [`FrontierDetector::detect`], and nothing is allocated once the
    /// buffers have grown to what such maps need.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map.
    pub fn detect_cells(&mut self, input: &DetectionInput<'_>) -> Result<&FrontierCells, DetectError> {
        Ok(self.detect_shared(input)?)
    }

    pub(super) fn detect_shared(&mut self, input: &DetectionInput<'_>) -> Result<&Arc<FrontierCells>, DetectError> {
        let Self { params, planes, entered, lazy_fill, .. } = self;
        let found = FrontierCells::anew(&mut self.found);
        let seed = params.seed(input.grid, &input.robot_in_map)?;
        self.was_lazy = lazy_fill.search(input.grid, params, seed, planes, entered, found).is_some();
        if !self.was_lazy {
            let Self { params, planes, .. } = self;
            planes.pack(input.grid, &params.thresholds);
            match params.reachability {
                Reachability::WallsBlock => self.mark_where_walls_block(seed),
                Reachability::Textbook => self.mark_as_the_textbook(seed),
            }
            let min_cells = self.params.min_cells(input.grid.info());
            let found = FrontierCells::anew(&mut self.found);
            self.clusters.collect(self.planes.unknown(), self.grouping, min_cells, found);
        }
        Ok(&self.found)
    }

    /// Whether the robot reached so little of the last map that all of it was never looked at.
    pub(super) const fn was_lazy(&self) -> bool {
        self.was_lazy
    }

    /// What the detector's own state takes in memory, bytes; the frontiers last found
    /// are not part of it.
    #[must_use]
    pub fn memory_bytes(&self) -> usize {
        self.planes.memory_bytes()
            + self.entered.memory_bytes()
            + self.lazy_fill.memory_bytes()
            + self.connected.memory_bytes()
            + self.clusters.memory_bytes()
            + self.row.capacity() * size_of::<u64>()
    }

    /// Frontier cells where walls block: unknown beside free space connected to the seed.
    /// They take the place of the unknown cells.
    fn mark_where_walls_block(&mut self, seed: Cell) {
        let Self { params, planes, entered, connected, row, .. } = self;
        let (free, unknown) = planes.both_mut();
        connected.find(free, seed, entered);
        row.resize(unknown.row_words(), 0);
        with_bit_instructions(KeepBeside { plane: unknown, source: entered, neighbours: params.neighbours, row });
    }

    /// Frontier cells by the paper's line 27: the search walks over all that has a free
    /// neighbour, and over the seed. They take the place of the unknown cells.
    fn mark_as_the_textbook(&mut self, seed: Cell) {
        let Self { params, planes, entered, connected, .. } = self;
        let (free, unknown) = planes.both_mut();
        entered.resize(free.width(), free.height());
        for y in 0..free.height() {
            neighbours_of_row(free, params.neighbours, y, 0..free.row_words(), entered.row_mut(y));
        }
        entered.insert(seed);
        // The free cells have served, and what is walked over takes their place.
        connected.find(entered, seed, free);
        unknown.intersect(free);
    }
}

/// Keeps the cells of a plane that have a neighbour in another of its size.
struct KeepBeside<'a> {
    plane: &'a mut BitPlane,
    source: &'a BitPlane,
    neighbours: Neighbourhood,
    /// Room for a row.
    row: &'a mut [u64],
}

impl BitWork for KeepBeside<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { plane, source, neighbours, row } = self;
        for y in 0..plane.height() {
            neighbours_of_row(source, neighbours, y, 0..row.len(), row);
            for (word, beside) in plane.row_mut(y).iter_mut().zip(&*row) {
                *word &= beside;
            }
        }
    }
}

impl FrontierDetector for FromScratch {
    fn name(&self) -> &'static str {
        "bitplane, from scratch"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        Ok(Frontier::all_of(self.detect_shared(input)?))
    }
}

#[cfg(test)]
#[path = "from_scratch_tests.rs"]
mod tests;
