//! What all detectors let the user set.

use super::{CannyParams, DbscanParams, DetectError, FastParams, ImageParams};
use crate::geometry::Pose;
use crate::grid::{Cell, CellRect, CellState, GridInfo, Neighbourhood, OccupancyGrid, ThresholdError, Thresholds};
use crate::range::{OutOfRange, Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How far from the robot's own cell a free cell is looked for, metres: sensor noise
/// marks the cells under a robot now and then.
const SEED_RADIUS_M: f64 = 0.5;

/// Which frontier cells count as within the robot's reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Reachability {
    /// The paper's own rule. Topiwala 2018, Fig. 4, line 27: the search walks over any
    /// cell with a free neighbour, and so through walls one or two cells thick. The
    /// detectors that scan the whole grid report all that they find.
    Textbook,
    /// Only over free cells that share a side: walls block, and so do two diagonal
    /// wall cells.
    #[default]
    WallsBlock,
}

/// Parameters of a detector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DetectorParams {
    /// Which cells are adjacent.
    pub neighbours: Neighbourhood,
    /// What counts as reachable.
    pub reachability: Reachability,
    /// Smaller frontiers are dropped; number of cells times resolution, metres.
    pub min_size_m: f64,
    /// Where free ends and occupied begins.
    pub thresholds: Thresholds,
    /// What the image detector alone reads.
    pub image: ImageParams,
    /// What the dbscan detector alone reads.
    pub dbscan: DbscanParams,
    /// What the canny detector alone reads.
    pub canny: CannyParams,
    /// What the fast detector alone reads.
    pub fast: FastParams,
}

/// A detector parameter that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DetectorParamsError {
    /// A number out of its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Thresholds out of order.
    #[error(transparent)]
    Thresholds(#[from] ThresholdError),
}

impl DetectorParams {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`DetectorParamsError`] that names the value and its range.
    pub fn validate(&self) -> Result<(), DetectorParamsError> {
        Ranged::check_all(self.numbers())?;
        Ok(self.thresholds.validate()?)
    }

    /// The numbers with their ranges, but for the thresholds.
    pub(crate) fn numbers(&self) -> Vec<Ranged> {
        let min_size = Range::NOT_NEGATIVE.of("detector.min_size_m", self.min_size_m);
        let of_one = self.image.numbers().into_iter().chain(self.dbscan.numbers()).chain(self.canny.numbers());
        [min_size].into_iter().chain(of_one).collect()
    }

    /// Which cells the search from the robot goes on to.
    pub(super) const fn search_neighbours(&self) -> Neighbourhood {
        match self.reachability {
            Reachability::WallsBlock => Neighbourhood::Four,
            Reachability::Textbook => self.neighbours,
        }
    }

    /// The smallest number of cells that a frontier must have, at least one.
    #[must_use]
    pub fn min_cells(&self, info: &GridInfo) -> usize {
        // A size that is a whole number of cells means that number, whatever the
        // rounding of the division.
        ((info.cells(self.min_size_m) - 1e-6).ceil() as usize).max(1)
    }

    /// The free cell from which the search starts: the robot's own, or the nearest.
    ///
    /// # Errors
    /// [`DetectError`] when the robot is off the map or nowhere near free space.
    pub fn seed(&self, grid: &OccupancyGrid, robot_in_map: &Pose) -> Result<Cell, DetectError> {
        let info = grid.info();
        let robot = info.cell_at(robot_in_map.position());
        let (x, y) = (robot_in_map.x, robot_in_map.y);
        // A pose that is no number would round to cell (0, 0).
        if !(robot_in_map.is_finite() && info.contains(robot)) {
            let origin = info.origin_in_map();
            let (width, height) = (info.width(), info.height());
            return Err(DetectError::RobotOutsideMap { x, y, width, height, min_x: origin.x, min_y: origin.y });
        }
        let reach = info.cells(SEED_RADIUS_M).ceil() as i32;
        let near = CellRect::around(robot, reach, info);
        near.rows(info)
            .flat_map(|y| near.columns(info).map(move |x| Cell::new(x as i32, y as i32)))
            .filter(|&cell| grid.state(cell, &self.thresholds) == CellState::Free)
            .map(|cell| (cell.distance_squared(robot), cell.y, cell.x, cell))
            .filter(|candidate| candidate.0 <= i64::from(reach).pow(2))
            .min()
            .map(|(.., cell)| cell)
            .ok_or(DetectError::NoFreeCellNear { x, y, radius_m: SEED_RADIUS_M })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridInfo;

    #[test]
    fn a_whole_number_of_cells_is_that_number() {
        let info = GridInfo::new(10, 10, 0.05, Pose::default()).unwrap();
        for (min_size_m, expected) in [(0.0, 1), (0.05, 1), (0.051, 2), (0.3, 6), (0.15, 3)] {
            let params = DetectorParams { min_size_m, ..DetectorParams::default() };
            assert_eq!(params.min_cells(&info), expected, "{min_size_m}");
        }
    }

    #[test]
    fn a_robot_in_a_wall_starts_beside_it() {
        let mut grid = OccupancyGrid::filled(GridInfo::new(40, 5, 0.1, Pose::default()).unwrap(), 100);
        grid.set(Cell::new(7, 2), 0);
        let params = DetectorParams::default();
        assert_eq!(params.seed(&grid, &Pose::new(0.45, 0.25, 0.0)), Ok(Cell::new(7, 2)));
        let lost = params.seed(&grid, &Pose::new(3.45, 0.25, 0.0));
        assert!(matches!(lost, Err(DetectError::NoFreeCellNear { .. })));
        let outside = params.seed(&grid, &Pose::new(9.0, 0.25, 0.0));
        assert!(matches!(outside, Err(DetectError::RobotOutsideMap { .. })));
    }
}
