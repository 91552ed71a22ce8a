//! Finds the cells of a plane that are connected to a seed: by a row fill, and by tiles where the
//! fill would wind too much.

pub(crate) mod joins;
mod label_cache;
mod nodes;
pub(crate) mod row_fill;
pub(crate) mod tile_graph;
pub(crate) mod tiling;

use crate::bits::BitPlane;
use crate::bits::connectivity::row_fill::RowFill;
use crate::bits::connectivity::tile_graph::TileGraph;
use crate::grid::{Cell, Neighbourhood};

/// Fills from the seed, and where that winds too much joins tiles, which takes the same time
/// whatever the ways are and little memory. The buffers are kept.
#[derive(Clone, Debug)]
pub(crate) struct Connectivity {
    flood: RowFill,
    reach: TileGraph,
}

impl Connectivity {
    /// By the sides of cells alone, or by their corners too.
    pub fn by(neighbourhood: Neighbourhood) -> Self {
        Self { flood: RowFill::default(), reach: TileGraph::new(neighbourhood) }
    }

    /// Finds the cells of `open` that are connected to a seed; none if it is not open.
    pub fn find(&mut self, open: &BitPlane, seed: Cell, reached: &mut BitPlane) {
        if self.flood.fill(open, self.reach.neighbourhood(), seed, reached).is_none() {
            self.reach.find(open, seed, reached);
        }
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        self.flood.memory_bytes() + self.reach.memory_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_way_too_long_for_the_fill_is_found_to_its_end() {
        const HEIGHT: i32 = 200;
        // Up and down, column by column; the last column is shut off.
        let mut expected = BitPlane::new(300, HEIGHT as usize);
        for x in 0..297 {
            let gap = if x % 4 == 1 { 0 } else { HEIGHT - 1 };
            (0..HEIGHT).filter(|&y| x % 2 == 0 || y == gap).for_each(|y| expected.insert(Cell::new(x, y)));
        }
        let mut open = expected.clone();
        (0..HEIGHT).for_each(|y| open.insert(Cell::new(299, y)));
        for neighbourhood in [Neighbourhood::Four, Neighbourhood::Eight] {
            let mut reached = BitPlane::default();
            let seed = Cell::new(150, 7);
            assert_eq!(RowFill::default().fill(&open, neighbourhood, seed, &mut reached), None);
            let mut connected = Connectivity::by(neighbourhood);
            // The second time with buffers that have been used.
            for _ in 0..2 {
                connected.find(&open, seed, &mut reached);
                assert!(reached == expected, "{neighbourhood:?}");
            }
        }
    }
}
