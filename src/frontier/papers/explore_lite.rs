//! Frontiers as explore_lite's `FrontierSearch` has them: unknown cells that share a side
//! with a free one, grown together over sides and corners.
//!
//! The textbook lets a corner suffice for both. In maps whose walls are dotted, with
//! unknown cells between the dots, that makes frontiers along walls: a corner reaches
//! through where a side does not. Found by [`Bitplane`], and repaired where the map changed.

use crate::frontier::bitplane::Bitplane;
use crate::frontier::{DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector};
use crate::grid::Neighbourhood;

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
pub struct ExploreLiteSearch(Bitplane);

impl ExploreLiteSearch {
    /// A detector with these parameters; `neighbours` is not asked for.
    #[must_use]
    pub fn new(params: DetectorParams) -> Self {
        let by_sides = DetectorParams { neighbours: Neighbourhood::Four, ..params };
        Self(Bitplane::with_grouping(by_sides, Neighbourhood::Eight))
    }
}

impl FrontierDetector for ExploreLiteSearch {
    fn name(&self) -> &'static str {
        "explore_lite"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        self.0.detect(input)
    }

    fn forget(&mut self) {
        self.0.forget();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontier::papers::groups::group;
    use crate::frontier::random_maps::noise;
    use crate::frontier::{CellSide, number};
    use crate::geometry::Pose;
    use crate::grid::Cell;
    use proptest::prelude::*;

    proptest! {
        /// Cells marked by sides and grouped anew over corners, on a map that changes.
        #[test]
        fn cells_marked_by_sides_hang_together_over_corners(
            (mut grid, seed) in noise(90, 30),
            edits in proptest::collection::vec((any::<prop::sample::Index>(), 1usize..40, -1i8..=1), 1..6),
            min_size_m in prop_oneof![Just(0.0), Just(3.0)],
        ) {
            let info = *grid.info();
            let params = DetectorParams { min_size_m, ..DetectorParams::default() };
            let single = DetectorParams { neighbours: Neighbourhood::Four, min_size_m: 0.0, ..params };
            let (mut detector, mut marked) = (ExploreLiteSearch::new(params), Bitplane::new(single));
            let robot = Pose::facing(info.center(seed), info.center(seed));
            for (from, count, value) in edits {
                for index in (from.index(info.len())..info.len()).take(count) {
                    grid.set(info.cell(index), [-1, 0, 100][(value + 1) as usize]);
                }
                let input = DetectionInput::new(&grid, robot);
                let expected = marked.detect(&input).map(|marked| {
                    let cells: Vec<Cell> = marked.iter().flat_map(|frontier| frontier.cells.iter().copied()).collect();
                    let mut groups = group(&info, &cells, Neighbourhood::Eight);
                    groups.retain(|cells| cells.len() >= params.min_cells(&info));
                    number(groups, CellSide::Unknown)
                });
                prop_assert_eq!(detector.detect(&input), expected);
            }
        }
    }
}
