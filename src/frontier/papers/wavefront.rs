//! The Wavefront Frontier Detector, as the textbook has it.
//!
//! Topiwala, Inani and Kathpal, "Frontier Based Exploration for Autonomous Robot"
//! (2018), Fig. 4, after Keidar and Kaminka 2012: an outer breadth-first search over
//! known space, an inner one that collects a frontier as soon as one of its cells is
//! met, and four marks that keep a cell from being searched twice. Only cells in
//! known space and on its rim are touched. O(cells touched).
//!
//! This is the oracle of the faster detectors.
//!
//! With [`Reachability::Textbook`] it keeps the paper's line 27 to the letter: the outer
//! search enqueues any cell that has a free neighbour, unknown and occupied ones too, and
//! so steps through walls one or two cells thick. One thing differs: the paper closes the
//! cells of a collected frontier for the outer search (line 25), which then does not go on
//! from them, so that what it reaches depends on the order of its queue. Here it does go
//! on, and the result depends on the map and the robot's cell alone.
//!
//! With [`Reachability::WallsBlock`] a cell counts as open space only if it is connected to
//! the robot's through the sides of free cells.

use crate::frontier::{
    CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, Reachability, number,
};
use crate::grid::{Cell, CellState, GridInfo, Neighbourhood, OccupancyGrid};
use std::collections::VecDeque;

/// The paper's four marks, as bits: a cell of the outer search may also be one of the
/// inner.
const MAP_OPEN: u8 = 1;
const MAP_CLOSE: u8 = 2;
const FRONTIER_OPEN: u8 = 4;
const FRONTIER_CLOSE: u8 = 8;

/// The detector.
///
/// The cells of a frontier lie in the unknown. By the textbook the search steps through a wall of
/// one cell, and finds what lies behind:
///
/// ```
/// use frontier_explorer::frontier::{DetectionInput, DetectorParams, FrontierDetector, Reachability, Wavefront};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Cell, OccupancyGrid};
///
/// let grid = OccupancyGrid::from_ascii("..#..?").unwrap();
/// let input = DetectionInput::new(&grid, Pose::new(0.5, 0.5, 0.0));
/// let found = |reachability| {
///     let params = DetectorParams { reachability, ..DetectorParams::default() };
///     Wavefront::new(params).detect(&input)
/// };
/// assert!(found(Reachability::WallsBlock)?.is_empty());
/// let behind = found(Reachability::Textbook)?;
/// assert_eq!((behind.len(), behind[0].cells[0]), (1, Cell::new(5, 0)));
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Wavefront {
    params: DetectorParams,
}

impl Wavefront {
    /// A detector with these parameters.
    #[must_use]
    pub const fn new(params: DetectorParams) -> Self {
        Self { params }
    }
}

impl FrontierDetector for Wavefront {
    fn name(&self) -> &'static str {
        "wavefront"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let seed = self.params.seed(input.grid, &input.robot_in_map)?;
        let mut frontiers = Wave::new(input.grid, &self.params, seed).spread(seed);
        let min_cells = self.params.min_cells(input.grid.info());
        frontiers.retain(|cells| cells.len() >= min_cells);
        Ok(number(frontiers, CellSide::Unknown))
    }
}

/// One run of the two searches.
struct Wave<'a> {
    grid: &'a OccupancyGrid,
    info: GridInfo,
    params: &'a DetectorParams,
    marks: Vec<u8>,
    /// Where walls block: which free cells are connected to the seed.
    reach: Option<Vec<bool>>,
}

impl<'a> Wave<'a> {
    fn new(grid: &'a OccupancyGrid, params: &'a DetectorParams, seed: Cell) -> Self {
        let mut wave = Self { grid, info: *grid.info(), params, marks: vec![0; grid.info().len()], reach: None };
        if params.reachability == Reachability::WallsBlock {
            wave.reach = Some(wave.connected_free_cells(seed));
        }
        wave
    }

    /// The free cells connected to the seed through their sides.
    fn connected_free_cells(&self, seed: Cell) -> Vec<bool> {
        let mut reach = vec![false; self.info.len()];
        let mut queue = VecDeque::from([seed]);
        while let Some(cell) = queue.pop_front() {
            for next in self.info.neighbours(cell, Neighbourhood::Four).chain([cell]) {
                if let Some(index) = self.info.index(next)
                    && !reach[index]
                    && self.is_open(next)
                {
                    reach[index] = true;
                    queue.push_back(next);
                }
            }
        }
        reach
    }

    /// The outer search: all frontiers in the order in which the wave meets them.
    fn spread(&mut self, seed: Cell) -> Vec<Vec<Cell>> {
        let mut frontiers = Vec::new();
        let mut queue = VecDeque::from([seed]);
        self.mark(seed, MAP_OPEN);
        while let Some(cell) = queue.pop_front() {
            if !self.is_marked(cell, FRONTIER_CLOSE) && self.is_frontier(cell) {
                frontiers.push(self.collect(cell));
            }
            for next in self.info.neighbours(cell, self.params.neighbours) {
                if !self.is_marked(next, MAP_OPEN | MAP_CLOSE) && self.may_enter(next) {
                    queue.push_back(next);
                    self.mark(next, MAP_OPEN);
                }
            }
            self.mark(cell, MAP_CLOSE);
        }
        frontiers
    }

    /// The inner search: the whole frontier of which `first` is a cell.
    fn collect(&mut self, first: Cell) -> Vec<Cell> {
        let mut frontier = Vec::new();
        let mut queue = VecDeque::from([first]);
        self.mark(first, FRONTIER_OPEN);
        while let Some(cell) = queue.pop_front() {
            if self.is_frontier(cell) {
                frontier.push(cell);
                for next in self.info.neighbours(cell, self.params.neighbours) {
                    if !self.is_marked(next, FRONTIER_OPEN | FRONTIER_CLOSE | MAP_CLOSE) {
                        queue.push_back(next);
                        self.mark(next, FRONTIER_OPEN);
                    }
                }
            }
            self.mark(cell, FRONTIER_CLOSE);
        }
        frontier
    }

    /// Whether the outer search goes on to a cell: line 27 of the paper.
    fn may_enter(&self, next: Cell) -> bool {
        match self.params.reachability {
            Reachability::Textbook => self.has_open_neighbour(next),
            Reachability::WallsBlock => self.is_open(next) || self.is_frontier(next),
        }
    }

    /// An unknown cell with an open neighbour.
    fn is_frontier(&self, cell: Cell) -> bool {
        self.state(cell) == CellState::Unknown && self.has_open_neighbour(cell)
    }

    fn has_open_neighbour(&self, cell: Cell) -> bool {
        self.info.neighbours(cell, self.params.neighbours).any(|next| self.is_open(next))
    }

    /// Open space: free and, where walls block and the reach is known, within it.
    fn is_open(&self, cell: Cell) -> bool {
        self.state(cell) == CellState::Free
            && match (&self.reach, self.info.index(cell)) {
                (Some(reach), Some(index)) => reach[index],
                _ => true,
            }
    }

    fn state(&self, cell: Cell) -> CellState {
        self.grid.state(cell, &self.params.thresholds)
    }

    fn is_marked(&self, cell: Cell, marks: u8) -> bool {
        self.info.index(cell).is_some_and(|index| self.marks[index] & marks != 0)
    }

    fn mark(&mut self, cell: Cell, mark: u8) {
        if let Some(index) = self.info.index(cell) {
            self.marks[index] |= mark;
        }
    }
}

#[cfg(test)]
#[path = "wavefront_tests.rs"]
mod tests;
