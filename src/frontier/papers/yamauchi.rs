//! The frontiers of the paper that gave them their name.
//!
//! Yamauchi, "A Frontier-Based Approach for Autonomous Exploration" (CIRA 1997): the
//! whole grid is scanned for open cells beside an unknown one; adjacent ones form a
//! region, and a region above a certain size, roughly the robot's, is a frontier.
//! O(cells of the grid).
//!
//! Parameters: `neighbours` for "beside" and "adjacent", `min_size_m` for the size. The
//! paper reports every region and leaves it to the planner to find out which are
//! accessible: that is [`Reachability::Textbook`](super::Reachability). With
//! [`Reachability::WallsBlock`](super::Reachability) only the open cells connected to
//! the robot's count; a region on two sides of a diagonal wall loses its far part.

use crate::frontier::papers::territory::{Territory, cells_of, components};
use crate::frontier::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, number};
use crate::grid::Cell;

/// The detector.
///
/// The cells of a frontier are free ones. The paper leaves it to the planner to find out which
/// regions can be reached, here that behind three cells of wall:
///
/// ```
/// use frontier_explorer::frontier::{CellSide, DetectionInput, DetectorParams, FrontierDetector, Reachability, Yamauchi};
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Cell, OccupancyGrid};
///
/// let grid = OccupancyGrid::from_ascii("?..###.?").unwrap();
/// let input = DetectionInput::new(&grid, Pose::new(2.5, 0.5, 0.0));
/// let mut params = DetectorParams::default();
/// let within_reach = Yamauchi::new(params).detect(&input)?;
/// assert_eq!((within_reach.len(), within_reach[0].cells[0]), (1, Cell::new(1, 0)));
/// params.reachability = Reachability::Textbook;
/// let all = Yamauchi::new(params).detect(&input)?;
/// assert_eq!((all.len(), all[1].cells[0], all[1].side), (2, Cell::new(6, 0), CellSide::Free));
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Yamauchi {
    params: DetectorParams,
}

impl Yamauchi {
    /// A detector with these parameters.
    #[must_use]
    pub const fn new(params: DetectorParams) -> Self {
        Self { params }
    }
}

impl FrontierDetector for Yamauchi {
    fn name(&self) -> &'static str {
        "yamauchi"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let territory = Territory::of(input, &self.params)?;
        let frontier = territory.open_beside_unknown(self.params.neighbours);
        let mut regions: Vec<Vec<Cell>> =
            components(&frontier, self.params.neighbours).iter().map(|runs| cells_of(runs)).collect();
        let min_cells = self.params.min_cells(input.grid.info());
        regions.retain(|region| region.len() >= min_cells);
        Ok(number(regions, CellSide::Free))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontier::Reachability;
    use crate::geometry::Pose;
    use crate::grid::{Neighbourhood, OccupancyGrid};

    fn check(drawing: &str, reachability: Reachability, neighbours: Neighbourhood, expected: &[&[(i32, i32)]]) {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let params = DetectorParams { reachability, neighbours, ..DetectorParams::default() };
        let found = Yamauchi::new(params).detect(&DetectionInput::new(&grid, Pose::new(1.5, 1.5, 0.0))).unwrap();
        let cells: Vec<Vec<(i32, i32)>> = found.iter().map(|f| f.cells.iter().map(|c| (c.x, c.y)).collect()).collect();
        assert_eq!(cells, expected);
    }

    #[test]
    fn free_cells_beside_the_unknown_are_the_frontier() {
        let door = "######?\n#.....?\n#....#?\n######?";
        check(door, Reachability::Textbook, Neighbourhood::Four, &[&[(5, 2)]]);
        let open = "??????\n?....?\n?....?\n??????";
        let ring: &[(i32, i32)] = &[(1, 1), (2, 1), (3, 1), (4, 1), (1, 2), (2, 2), (3, 2), (4, 2)];
        check(open, Reachability::Textbook, Neighbourhood::Eight, &[ring]);
    }

    #[test]
    fn the_paper_reports_what_lies_behind_a_wall_and_walls_block_does_not() {
        let two = "#######\n?..#..?\n?..#..?\n#######";
        check(two, Reachability::Textbook, Neighbourhood::Eight, &[&[(1, 1), (1, 2)], &[(5, 1), (5, 2)]]);
        check(two, Reachability::WallsBlock, Neighbourhood::Eight, &[&[(1, 1), (1, 2)]]);
    }
}
