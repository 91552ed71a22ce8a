//! How much may lie behind the frontiers that are left.

use crate::frontier::Frontier;
use crate::grid::{AreaCells, Cell, CellState, Neighbourhood, OccupancyGrid, Thresholds};
use std::collections::{HashSet, VecDeque};

/// So far into the unknown is counted, metres: what a room of the size of a closet needs.
const DEPTH_M: f64 = 1.5;

/// The unknown area that hangs together with the frontiers, at most 1.5 m behind them,
/// square metres; inside of areas, if there are some. O(frontier cells x depth).
#[must_use]
pub fn unknown_behind_m2<'a>(
    frontiers: impl Iterator<Item = &'a Frontier>,
    grid: &OccupancyGrid,
    thresholds: &Thresholds,
    inside: Option<&AreaCells>,
) -> f64 {
    let info = grid.info();
    let depth = info.cells(DEPTH_M).ceil() as u32;
    let is_unknown = |cell: Cell| {
        grid.state(cell, thresholds) == CellState::Unknown && inside.is_none_or(|cells| cells.is_inside(cell))
    };
    let mut met: HashSet<Cell> = HashSet::new();
    let mut queue: VecDeque<(Cell, u32)> = VecDeque::new();
    for &cell in frontiers.flat_map(|frontier| &frontier.cells) {
        let around = info.neighbours(cell, Neighbourhood::Four).chain([cell]);
        queue.extend(around.filter(|&c| is_unknown(c) && met.insert(c)).map(|cell| (cell, 1)));
    }
    while let Some((cell, far)) = queue.pop_front() {
        if far < depth {
            let beside = info.neighbours(cell, Neighbourhood::Four);
            queue.extend(beside.filter(|&c| is_unknown(c) && met.insert(c)).map(|cell| (cell, far + 1)));
        }
    }
    met.len() as f64 * info.cell_area_m2()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frontier::CellSide;

    #[test]
    fn what_hangs_together_with_the_frontier_is_counted_to_a_depth() {
        let grid = OccupancyGrid::from_ascii("..??????\n..??????\n####.???").unwrap();
        let frontier = Frontier {
            id: 0,
            cells: vec![Cell::new(2, 1), Cell::new(2, 2)].into(),
            side: CellSide::Unknown,
            circle: None,
        };
        let area =
            |frontiers: &[&Frontier]| unknown_behind_m2(frontiers.iter().copied(), &grid, &Thresholds::default(), None);
        // Two cells deep at 1 m a cell, from the frontier and what is beside it: columns 2 to 4.
        assert_eq!((area(&[]), area(&[&frontier])), (0.0, 6.0));
        assert_eq!(area(&[&frontier, &frontier]), 6.0, "nothing is counted twice");
    }
}
