//! The cells that are connected with one, nearest steps first, found as they are asked for.

use super::{Cell, GridInfo, Neighbourhood};
use std::collections::{HashSet, VecDeque};

impl GridInfo {
    /// The cells that can be reached from `seed` over neighbours that are open, in the order of
    /// a breadth-first search; the seed comes first whether it is open or not. It looks no
    /// further than it is asked: O(cells taken).
    pub fn flood<'a>(
        &'a self,
        seed: Cell,
        neighbours: Neighbourhood,
        is_open: impl Fn(Cell) -> bool + 'a,
    ) -> impl Iterator<Item = Cell> + 'a {
        let (mut queue, mut met) = (VecDeque::from([seed]), HashSet::from([seed]));
        std::iter::from_fn(move || {
            let cell = queue.pop_front()?;
            queue.extend(self.neighbours(cell, neighbours).filter(|&next| is_open(next) && met.insert(next)));
            Some(cell)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::OccupancyGrid;

    #[test]
    fn a_flood_takes_what_is_open_and_corners_where_they_count() {
        let grid = OccupancyGrid::from_ascii("..#.\n##.#\n....").unwrap();
        let info = grid.info();
        let from = |seed: Cell, neighbours| -> Vec<Cell> {
            info.flood(seed, neighbours, |cell| grid.get(cell) == Some(0)).collect()
        };
        let sides = from(Cell::new(0, 0), Neighbourhood::Four);
        assert_eq!((sides.len(), sides[0], sides[1]), (5, Cell::new(0, 0), Cell::new(1, 0)));
        assert_eq!(from(Cell::new(0, 0), Neighbourhood::Eight).len(), 8);
        assert_eq!(from(Cell::new(3, 1), Neighbourhood::Four).len(), 7, "the seed may be a wall");
    }
}
