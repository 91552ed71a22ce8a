//! The wavefront's frontiers, repaired where the map changed.
//!
//! The result is that of [`FromScratch`](super::FromScratch) and of the textbook, to the cell and
//! in the same order; the cost is that of what changed. The new map is packed and compared
//! with the last one, 64 cells at a time, or only in the rectangle that is known to have
//! changed; what is connected is repaired tile by tile (`bits::connectivity::tile_graph`), the frontier's
//! cells where reach or territory changed, and the groups that had a cell there.
//!
//! O(cells compared + tiles + what changed + cells of all frontiers), the last with the
//! constant of a copy. A map that grew or shrank by whole cells, on whichever sides, keeps what lies
//! at the same place ([`placement`](crate::bits::placement)); any other one of another size starts over.

mod take_in;

use super::find_cells::FindCells;
use crate::bits::connectivity::tile_graph::TileGraph;
use crate::bits::placement::Placement;
use crate::bits::word_spans::WordSpans;
use crate::bits::{BitPlane, BitPlanes, prefetch, with_bit_instructions};
use crate::frontier::grouping::cell_lists::FrontierCells;
use crate::frontier::grouping::clusters::Clusters;
use crate::frontier::grouping::repair::Regroup;
use crate::frontier::{DetectError, DetectionInput, DetectorParams, Reachability};
use crate::grid::{Cell, CellRect, GridInfo, Neighbourhood};
use std::sync::Arc;

/// The detector, with what it knows of the last map.
///
/// It looks where it is told that the map changed, and nowhere else:
///
/// ```
/// use frontier_explorer::frontier::{DetectionInput, DetectorParams, Repair};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Cell, CellRect, OccupancyGrid};
///
/// let mut grid = OccupancyGrid::from_ascii("?.....?").unwrap();
/// let robot = Pose::new(3.5, 0.5, 0.0);
/// let mut detector = Repair::new(DetectorParams::default());
/// assert_eq!(detector.update(&DetectionInput::new(&grid, robot), None)?.iter().count(), 2);
/// grid.set(Cell::new(0, 0), OccupancyGrid::OCCUPIED);
/// let changed = CellRect { x: 0, y: 0, width: 1, height: 1 };
/// assert_eq!(detector.update(&DetectionInput::new(&grid, robot), Some(changed))?.iter().count(), 1);
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Repair {
    params: DetectorParams,
    /// By what frontier cells are of one frontier.
    grouping: Neighbourhood,
    /// Where the last map lies in the planes.
    placed: Option<Placement>,
    planes: BitPlanes,
    /// By the textbook: the cells that the search could walk on.
    open: BitPlane,
    reach: TileGraph,
    frontier: BitPlane,
    /// Words of the map that changed.
    changed: WordSpans,
    /// Words of which the frontier cells are to be found again.
    stale: WordSpans,
    /// Words with other frontier cells than before.
    regroup: WordSpans,
    /// The smallest number of cells of the frontiers found; `None` if all are to be found
    /// anew.
    min_cells: Option<usize>,
    clusters: Clusters,
    groups: Regroup,
    found: Arc<FrontierCells>,
    seeds: Vec<Cell>,
    row: Vec<u64>,
}

impl Repair {
    /// A detector with these parameters that has seen no map.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        Self::with_grouping(params, params.neighbours)
    }

    /// One that marks frontier cells by the parameters' neighbours and groups them by others.
    pub(super) fn with_grouping(params: DetectorParams, grouping: Neighbourhood) -> Self {
        Self {
            params,
            grouping,
            placed: None,
            planes: BitPlanes::default(),
            open: BitPlane::default(),
            reach: TileGraph::new(params.search_neighbours()),
            frontier: BitPlane::default(),
            changed: WordSpans::default(),
            stale: WordSpans::default(),
            regroup: WordSpans::default(),
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
    /// A change that is not in the rectangle is not seen, unless the cell was not on the last map:
    /// a map that grew by whole cells may come with nothing told but what changed of the old part.
    /// Nothing is allocated once the buffers have grown to what such maps need.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map; its changes are
    /// remembered for the next.
    pub fn update(
        &mut self,
        input: &DetectionInput<'_>,
        changed: Option<CellRect>,
    ) -> Result<&FrontierCells, DetectError> {
        Ok(self.update_shared(input, changed)?)
    }

    pub(super) fn update_shared(
        &mut self,
        input: &DetectionInput<'_>,
        changed: Option<CellRect>,
    ) -> Result<&Arc<FrontierCells>, DetectError> {
        let info = input.grid.info();
        let placement = self.take_in(input, changed);
        let seed = self.params.seed(input.grid, &input.robot_in_map)?;
        self.find_seeds(seed, info, &placement);
        let plane = match self.params.reachability {
            Reachability::WallsBlock => self.planes.free(),
            Reachability::Textbook => &self.open,
        };
        self.reach.update(plane, &self.seeds);
        self.find_frontier_cells();
        let min_cells = self.params.min_cells(info);
        let (frontier, neighbours) = (&mut self.frontier, self.grouping);
        let repaired = self.min_cells == Some(min_cells) && {
            let (changed, found) = (&self.regroup, Arc::make_mut(&mut self.found));
            self.groups.update(frontier, changed, placement.offset(), neighbours, min_cells, found)
        };
        if !repaired {
            let found = FrontierCells::anew(&mut self.found);
            self.clusters.collect(frontier, neighbours, min_cells, found);
            found.shift(placement.offset_in_map());
            self.min_cells = Some(min_cells);
        }
        self.regroup.clear();
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
            + [&self.changed, &self.stale, &self.regroup].map(WordSpans::memory_bytes).iter().sum::<usize>()
            + self.row.capacity() * size_of::<u64>()
            + self.seeds.capacity() * size_of::<Cell>()
    }

    /// The cells of the planes from which the search sets out. By the textbook that is the seed,
    /// which it enters whatever stands around it, and so its neighbours too.
    fn find_seeds(&mut self, seed: Cell, info: &GridInfo, placement: &Placement) {
        let in_planes = |cell: Cell| cell.offset(placement.offset());
        self.seeds.clear();
        self.seeds.push(in_planes(seed));
        if self.params.reachability == Reachability::Textbook && !self.open.contains(in_planes(seed)) {
            self.seeds.extend(info.neighbours(seed, self.params.neighbours).map(in_planes));
        }
    }

    /// Finds again the frontier cells where the map or what is reached changed; where walls
    /// block, they lie beside what is reached.
    fn find_frontier_cells(&mut self) {
        let beside = match self.params.reachability {
            Reachability::Textbook => None,
            Reachability::WallsBlock => Some(self.params.neighbours),
        };
        for (y, span) in self.reach.changed().iter() {
            match beside {
                Some(_) => self.stale.add_with_margin(y, span),
                None => self.stale.add(y, span),
            }
        }
        let Self { stale, row, frontier, regroup, .. } = self;
        let (reached, unknown) = (self.reach.plane(), self.planes.unknown());
        for plane in [unknown, frontier] {
            prefetch(stale.iter().map(|(y, span)| &plane.row(y)[span.words()]));
        }
        with_bit_instructions(FindCells { reached, unknown, beside, stale, row, frontier, regroup });
        self.stale.clear();
    }
}

#[cfg(test)]
#[path = "repair_tests.rs"]
mod tests;
