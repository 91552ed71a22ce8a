//! What the scanning detectors work on: the state of every cell of a grid, one byte
//! each, with a margin of one cell so that neighbours need no bounds check; and the
//! cells that the robot can get to. O(cells) to make, a few nanoseconds each.

use crate::frontier::{DetectError, DetectionInput, DetectorParams, Reachability};
use crate::grid::{Cell, CellState, GridInfo, Neighbourhood, OccupancyGrid, Thresholds};

/// Unknown.
pub(crate) const UNKNOWN: u8 = 0;
/// Free, and within reach where that is asked for.
pub(crate) const OPEN: u8 = 1;
/// Occupied.
pub(crate) const OCCUPIED: u8 = 2;
/// Free, and walls lie between it and the robot.
pub(crate) const BEYOND: u8 = 3;
/// Not a cell of the grid: it is nobody's neighbour.
const OUTSIDE: u8 = 4;

/// The states of all cells.
pub(crate) struct Plane {
    info: GridInfo,
    /// Cells of a row with its margin.
    stride: usize,
    states: Vec<u8>,
}

impl Plane {
    /// The states of a detection's grid as its parameters see them.
    ///
    /// # Errors
    /// [`DetectError`] when the robot is off the map or nowhere near free space.
    pub(crate) fn of(input: &DetectionInput<'_>, params: &DetectorParams) -> Result<Self, DetectError> {
        let seed = params.seed(input.grid, &input.robot_in_map)?;
        let mut plane = Self::new(input.grid, &params.thresholds);
        if params.reachability == Reachability::WallsBlock {
            plane.keep_connected(seed);
        }
        Ok(plane)
    }

    /// The states of a grid, wherever the robot is.
    pub(crate) fn new(grid: &OccupancyGrid, thresholds: &Thresholds) -> Self {
        let info = *grid.info();
        let table: [u8; 256] = std::array::from_fn(|value| match thresholds.classify(value as u8 as i8) {
            CellState::Unknown => UNKNOWN,
            CellState::Free => OPEN,
            CellState::Occupied | CellState::Unsettled => OCCUPIED,
        });
        let stride = info.width() + 2;
        let mut states = vec![OUTSIDE; stride * (info.height() + 2)];
        for (to, from) in states.chunks_exact_mut(stride).skip(1).zip(grid.data().chunks_exact(info.width())) {
            for (state, &value) in to.iter_mut().skip(1).zip(from) {
                *state = table[usize::from(value as u8)];
            }
        }
        Self { info, stride, states }
    }

    /// The state of a cell; the margin and all beyond it are no state of the above.
    pub(crate) fn state(&self, cell: Cell) -> u8 {
        self.info.index(cell).map_or(OUTSIDE, |_| self.states[self.position(cell)])
    }

    /// The open cells beside an unknown one, row-major: the frontier cells of Yamauchi.
    pub(crate) fn open_beside_unknown(&self, neighbours: Neighbourhood) -> Vec<Cell> {
        let mut cells = Vec::new();
        let width = self.info.width();
        let rows: Vec<&[u8]> = self.states.chunks_exact(self.stride).collect();
        for (y, three) in rows.windows(3).enumerate() {
            let [below, here, above] = three else { continue };
            for x in 1..=width {
                if here[x] != OPEN {
                    continue;
                }
                let sides = [here[x - 1], here[x + 1], below[x], above[x]].contains(&UNKNOWN);
                let corners = || [below[x - 1], below[x + 1], above[x - 1], above[x + 1]].contains(&UNKNOWN);
                if sides || (neighbours == Neighbourhood::Eight && corners()) {
                    cells.push(Cell::new(x as i32 - 1, y as i32));
                }
            }
        }
        cells
    }

    /// Only free cells that are connected to the seed through their sides stay open.
    fn keep_connected(&mut self, seed: Cell) {
        const REACHED: u8 = 5;
        let mut todo = vec![self.position(seed)];
        while let Some(position) = todo.pop() {
            if self.states[position] != OPEN {
                continue;
            }
            // Along the row to both ends, then on from each run above and below it.
            let mut left = position;
            while self.states[left - 1] == OPEN {
                left -= 1;
            }
            let mut right = position;
            while self.states[right + 1] == OPEN {
                right += 1;
            }
            self.states[left..=right].fill(REACHED);
            for start in [left - self.stride, left + self.stride] {
                let mut before = OUTSIDE;
                for next in start..=start + (right - left) {
                    let state = self.states[next];
                    if state == OPEN && before != OPEN {
                        todo.push(next);
                    }
                    before = state;
                }
            }
        }
        for state in &mut self.states {
            *state = match *state {
                OPEN => BEYOND,
                REACHED => OPEN,
                other => other,
            };
        }
    }

    /// Where a cell of the grid is in `states`.
    const fn position(&self, cell: Cell) -> usize {
        (cell.y as usize + 1) * self.stride + cell.x as usize + 1
    }
}

/// The cells that a row-major mask has set, in that order.
pub(crate) fn set_cells(info: &GridInfo, mask: &[bool]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for (y, row) in (0..).zip(mask.chunks_exact(info.width())) {
        // Most stretches of most maps have nothing set.
        for (x, stretch) in (0..).step_by(64).zip(row.chunks(64)) {
            if stretch.contains(&true) {
                let set = (x..).zip(stretch).filter(|(_, set)| **set);
                cells.extend(set.map(|(x, _)| Cell::new(x, y)));
            }
        }
    }
    cells
}

/// Groups cells by adjacency. Cells outside the grid are left out; the groups come in
/// the order of their first cells in the list. O(cells).
pub(crate) fn group(info: &GridInfo, cells: &[Cell], neighbours: Neighbourhood) -> Vec<Vec<Cell>> {
    let mut waiting = vec![false; info.len()];
    for index in cells.iter().filter_map(|&cell| info.index(cell)) {
        waiting[index] = true;
    }
    let mut take = |cell: Cell| info.index(cell).is_some_and(|index| std::mem::take(&mut waiting[index]));
    let mut groups = Vec::new();
    for &first in cells {
        if !take(first) {
            continue;
        }
        let mut group = vec![first];
        let mut next = 0;
        while let Some(&cell) = group.get(next) {
            group.extend(info.neighbours(cell, neighbours).filter(|&n| take(n)));
            next += 1;
        }
        groups.push(group);
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn adjacent_cells_are_grouped() {
        let grid = OccupancyGrid::from_ascii("....\n....\n....").unwrap();
        let cells = [Cell::new(0, 0), Cell::new(1, 1), Cell::new(3, 0), Cell::new(3, 1), Cell::new(9, 9)];
        let eight = group(grid.info(), &cells, Neighbourhood::Eight);
        assert_eq!(eight, [vec![Cell::new(0, 0), Cell::new(1, 1)], vec![Cell::new(3, 0), Cell::new(3, 1)]]);
        assert_eq!(group(grid.info(), &cells, Neighbourhood::Four).len(), 3);
    }

    proptest! {
        /// Against a search cell by cell.
        #[test]
        fn what_stays_open_is_connected_to_the_seed(
            (width, values) in (1usize..20, 1usize..20)
                .prop_flat_map(|(w, h)| (Just(w), proptest::collection::vec(prop_oneof![Just(0i8), Just(100), Just(-1)], w * h))),
            seed: prop::sample::Index,
        ) {
            let height = values.len() / width;
            let info = GridInfo::new(width as u32, height as u32, 1.0, crate::geometry::Pose::default()).unwrap();
            let mut grid = OccupancyGrid::new(info, values).unwrap();
            let seed = info.cell(seed.index(info.len()));
            grid.set(seed, 0);
            let free = |c: &Cell| grid.get(*c) == Some(0);
            let free_cells: Vec<Cell> = (0..info.len()).map(|i| info.cell(i)).filter(free).collect();
            let component = group(&info, &free_cells, Neighbourhood::Four).into_iter().find(|g| g.contains(&seed)).unwrap();
            let mut plane = Plane::new(&grid, &Thresholds::default());
            plane.keep_connected(seed);
            for cell in free_cells {
                prop_assert_eq!(plane.state(cell) == OPEN, component.contains(&cell));
            }
        }
    }
}
