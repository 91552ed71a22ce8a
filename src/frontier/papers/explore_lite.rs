//! Frontiers as explore_lite's `FrontierSearch` has them: unknown cells that share a side
//! with a free one, grown together over sides and corners.
//!
//! The textbook lets a corner suffice for both. In maps whose walls are dotted, with
//! unknown cells between the dots, that makes frontiers along walls: a corner reaches
//! through where a side does not. What is marked is found from bit planes
//! (`bitplane`), what hangs together by a flood over the frontier cells.
//! O(cells) with a small constant, plus O(frontier cells).

use crate::frontier::bitplane::Bitplane;
use crate::frontier::papers::states::group;
use crate::frontier::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, number};
use crate::grid::{Cell, Neighbourhood};

/// The detector.
///
/// A corner does not make a frontier cell, as it does for [`Wavefront`](crate::frontier::Wavefront):
///
/// ```
/// use frontier_explorer::frontier::{DetectionInput, DetectorParams, ExploreLiteSearch, FrontierDetector, Wavefront};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::OccupancyGrid;
///
/// let grid = OccupancyGrid::from_ascii(
///     "##?
///      ..#",
/// ).unwrap();
/// let (input, params) = (DetectionInput::new(&grid, Pose::new(0.5, 0.5, 0.0)), DetectorParams::default());
/// assert_eq!(Wavefront::new(params).detect(&input)?.len(), 1);
/// assert_eq!(ExploreLiteSearch::new(params).detect(&input)?.len(), 0);
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ExploreLiteSearch {
    params: DetectorParams,
    marked: Bitplane,
}

impl ExploreLiteSearch {
    /// A detector with these parameters; `neighbours` is not asked for.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        let by_sides = DetectorParams { neighbours: Neighbourhood::Four, min_size_m: 0.0, ..params };
        Self { params, marked: Bitplane::new(by_sides) }
    }
}

impl FrontierDetector for ExploreLiteSearch {
    fn name(&self) -> &'static str {
        "explore_lite"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let info = input.grid.info();
        let marked = self.marked.detect(input)?;
        let mut cells: Vec<Cell> = marked.iter().flat_map(|frontier| frontier.cells.iter().copied()).collect();
        cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        let mut frontiers = group(info, &cells, Neighbourhood::Eight);
        let least = self.params.min_cells(info);
        frontiers.retain(|cells| cells.len() >= least);
        Ok(number(frontiers, CellSide::Unknown))
    }

    fn forget(&mut self) {
        self.marked.forget();
    }
}
