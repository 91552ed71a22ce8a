//! The cheapest ways from one cell to all others: Dijkstra's search, with the steps left
//! out that cannot be part of a way that is needed.
//!
//! N. Sturtevant and S. Rabin, "Canonical Orderings on Grids" (IJCAI 2016): in open
//! space a cell has many cheapest ways that differ in the order of their steps alone.
//! One of them is enough, the one whose diagonal steps come first, so that a cell
//! entered straight on is left straight on, and one entered diagonally in three
//! directions. That holds where a cell and the one before it have nothing but open space
//! around them. Elsewhere five of the eight directions are left: the cells beside the
//! way just come are nearer to the cell before. The costs are those of
//! [`super::search`]. O(cells) with buckets (Dial 1969, as in [`super::bucket_queue`]);
//! every step costs at least [`STRAIGHT`], so a bucket is complete when its turn comes.

use super::lattice::{DIAGONAL, MAX_STEP, STRAIGHT, step_costs};
use super::search::UNREACHED;
use crate::grid::{Costmap, FREE_COST, INSCRIBED_COST, UNKNOWN_COST};

/// Open space all around: a mark in place of the cost [`FREE_COST`].
const SPACIOUS: u8 = 255;
/// All eight directions, those of [`crate::grid::NEIGHBOURS_8`].
const ALL: u8 = 0xff;

const EAST: u8 = 1;
const WEST: u8 = 1 << 1;
const NORTH: u8 = 1 << 2;
const SOUTH: u8 = 1 << 3;
const NORTH_EAST: u8 = 1 << 4;
const NORTH_WEST: u8 = 1 << 5;
const SOUTH_EAST: u8 = 1 << 6;
const SOUTH_WEST: u8 = 1 << 7;

/// The directions worth going on in, by the direction in which a cell was entered.
const ONWARD: [u8; 8] = [
    ALL & !(WEST | NORTH_WEST | SOUTH_WEST),
    ALL & !(EAST | NORTH_EAST | SOUTH_EAST),
    ALL & !(SOUTH | SOUTH_EAST | SOUTH_WEST),
    ALL & !(NORTH | NORTH_EAST | NORTH_WEST),
    ALL & !(WEST | SOUTH | SOUTH_WEST),
    ALL & !(EAST | SOUTH | SOUTH_EAST),
    ALL & !(WEST | NORTH | NORTH_WEST),
    ALL & !(EAST | NORTH | NORTH_EAST),
];
/// Those in open space.
const ONWARD_IN_SPACE: [u8; 8] = [
    EAST,
    WEST,
    NORTH,
    SOUTH,
    NORTH | EAST | NORTH_EAST,
    NORTH | WEST | NORTH_WEST,
    SOUTH | EAST | SOUTH_EAST,
    SOUTH | WEST | SOUTH_WEST,
];

/// Keys wait at most [`MAX_STEP`] ahead of the one whose turn it is.
const RING: usize = (MAX_STEP as usize + 1).next_power_of_two();

/// The search with its memory.
#[derive(Clone, Debug, Default)]
pub struct CanonicalSearch {
    width: usize,
    /// Cells in a row with the margin, whose first and last column is closed.
    stride: usize,
    /// Cost of each cell, with a closed margin all round.
    costs: Vec<u8>,
    /// In which directions each cell can be left.
    open: Vec<u8>,
    /// In which directions each cell is still to be left.
    onward: Vec<u8>,
    /// Cost of the way to each cell.
    ways: Vec<u32>,
    buckets: Vec<Vec<u32>>,
}

impl CanonicalSearch {
    /// Searches everywhere from the cell with a row-major index, which is passable.
    pub fn run(&mut self, costmap: &Costmap, start: usize) {
        self.prepare(costmap);
        let start = self.place(start);
        let Some(way) = self.ways.get_mut(start) else { return };
        *way = 0;
        self.onward[start] = self.open[start];
        self.buckets.iter_mut().for_each(Vec::clear);
        self.buckets.resize(RING, Vec::new());
        self.buckets[0].push(start as u32);
        let mut waiting = 1;
        let mut key = 0;
        while waiting > 0 {
            let mut bucket = std::mem::take(&mut self.buckets[key as usize % RING]);
            waiting -= bucket.len();
            for &place in &bucket {
                // Otherwise it was reached more cheaply since.
                if self.ways[place as usize] == key {
                    waiting += self.expand(place as usize, key);
                }
            }
            bucket.clear();
            self.buckets[key as usize % RING] = bucket;
            key += 1;
        }
    }

    /// Cost of the cheapest way to a cell in lattice units, `None` when there is none.
    #[must_use]
    pub fn cost(&self, index: usize) -> Option<u32> {
        self.ways.get(self.place(index)).copied().filter(|&cost| cost != UNREACHED)
    }

    /// Where a cell with a row-major index is with the margin.
    const fn place(&self, index: usize) -> usize {
        (index / self.width + 1) * self.stride + index % self.width + 1
    }

    /// Takes the steps from a cell; returns how many cells wait for it.
    #[inline]
    fn expand(&mut self, from: usize, key: u32) -> usize {
        let stride = self.stride as isize;
        let offsets = [1, -1, stride, -stride, stride + 1, stride - 1, 1 - stride, -1 - stride];
        let here = self.costs[from];
        let is_spacious = here == SPACIOUS;
        let mut directions = self.onward[from];
        let mut waiting = 0;
        while directions != 0 {
            let direction = directions.trailing_zeros() as usize;
            directions &= directions - 1;
            let to = from.wrapping_add_signed(offsets[direction]);
            let there = self.costs[to];
            let (way, onward) = if is_spacious {
                let step = if direction < 4 { STRAIGHT } else { DIAGONAL };
                let onward = if there == SPACIOUS { ONWARD_IN_SPACE } else { ONWARD };
                (key + step, onward[direction])
            } else {
                let there = if there == SPACIOUS { FREE_COST } else { there };
                let step = step_costs(direction)[usize::from(here) + usize::from(there)];
                (key + step, ONWARD[direction])
            };
            let known = self.ways[to];
            if way < known {
                self.ways[to] = way;
                self.onward[to] = onward & self.open[to];
                self.buckets[way as usize % RING].push(to as u32);
                waiting += 1;
            } else if way == known {
                // Ways that cost the same may go on in different directions.
                self.onward[to] |= onward & self.open[to];
            }
        }
        waiting
    }

    /// Lays out the costs with a margin and finds out which steps are open.
    fn prepare(&mut self, costmap: &Costmap) {
        let (width, height) = (costmap.info().width(), costmap.info().height());
        let stride = width + 2;
        let len = stride * (height + 2);
        self.width = width;
        self.stride = stride;
        self.costs.clear();
        self.costs.resize(len, UNKNOWN_COST);
        let rows = self.costs.chunks_exact_mut(stride).skip(1);
        for (row, costs) in rows.zip(costmap.costs().chunks_exact(width)) {
            row[1..=width].copy_from_slice(costs);
        }
        self.onward.clear();
        self.onward.resize(len, 0);
        self.ways.clear();
        self.ways.resize(len, UNREACHED);
        self.open.clear();
        self.open.resize(len, 0);
        let mut is_spacious = vec![0; len];
        for y in 1..=height {
            let row = |y: usize| &self.costs[y * stride..(y + 1) * stride];
            let at = y * stride + 1..y * stride + 1 + width;
            let rows = [row(y - 1), row(y), row(y + 1)];
            open_directions(rows, &mut self.open[at.clone()], &mut is_spacious[at]);
        }
        for (cost, spacious) in self.costs.iter_mut().zip(is_spacious) {
            *cost |= spacious;
        }
    }
}

/// The open directions of the inner cells of the middle one of three rows, and
/// [`SPACIOUS`] for those with nothing but open space around them. Arithmetic without
/// branches, which the compiler turns into vector code.
fn open_directions(rows: [&[u8]; 3], open: &mut [u8], is_spacious: &mut [u8]) {
    let width = open.len();
    let part = |row: usize, from: usize| &rows[row][from..from + width];
    let (s_w, s, s_e) = (part(0, 0), part(0, 1), part(0, 2));
    let (w, here, e) = (part(1, 0), part(1, 1), part(1, 2));
    let (n_w, n, n_e) = (part(2, 0), part(2, 1), part(2, 2));
    let is_open = |cost: u8| u8::from(cost < INSCRIBED_COST);
    for x in 0..width {
        let (east, west, north, south) = (is_open(e[x]), is_open(w[x]), is_open(n[x]), is_open(s[x]));
        let sides = east | west << 1 | north << 2 | south << 3;
        let north_corners = (north & east & is_open(n_e[x])) << 4 | (north & west & is_open(n_w[x])) << 5;
        let south_corners = (south & east & is_open(s_e[x])) << 6 | (south & west & is_open(s_w[x])) << 7;
        open[x] = sides | north_corners | south_corners;
        let around = here[x] | e[x] | w[x] | n[x] | s[x] | n_e[x] | n_w[x] | s_e[x] | s_w[x];
        is_spacious[x] = u8::from(around == FREE_COST) * SPACIOUS;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{GridInfo, Inflation, OccupancyGrid, Thresholds};
    use crate::planning::lattice::Lattice;
    use crate::planning::search::Search;
    use proptest::prelude::*;

    fn costs_are_those_of_the_plain_search(costmap: &Costmap, start: usize) {
        let (mut plain, mut canonical) = (Search::default(), CanonicalSearch::default());
        plain.run(&Lattice::new(costmap), start, None, false);
        canonical.run(costmap, start);
        for index in 0..costmap.info().len() {
            assert_eq!(canonical.cost(index), plain.cost(index), "{:?}", costmap.info().cell(index));
        }
    }

    proptest! {
        #[test]
        fn rough_ground_costs_the_same(
            width in 1u32..24,
            costs in proptest::collection::vec(prop_oneof![2 => Just(0u8), 3 => 0u8..253, 1 => 253u8..=255], 400),
            start in 0usize..400,
        ) {
            let info = GridInfo::new(width, 400 / width, 1.0, Pose::default()).unwrap();
            let mut costs = costs[..info.len()].to_vec();
            let start = start % info.len();
            costs[start] = 0;
            costs_are_those_of_the_plain_search(&Costmap::from_costs(info, costs).unwrap(), start);
        }

        #[test]
        fn open_space_between_obstacles_costs_the_same(
            obstacles in proptest::collection::vec((0usize..40, 0usize..40), 0..30),
            inflation_radius_m in 0.0f64..4.0,
            start in 0usize..1600,
        ) {
            let info = GridInfo::new(40, 40, 1.0, Pose::default()).unwrap();
            let mut values = vec![0; info.len()];
            for (x, y) in obstacles {
                values[y * 40 + x] = 100;
            }
            values[start] = 0;
            let grid = OccupancyGrid::new(info, values).unwrap();
            let inflation = Inflation { inscribed_radius_m: 0.5, inflation_radius_m, cost_scaling_factor: 1.0 };
            let costmap = Costmap::inflate(&grid, &Thresholds::default(), &inflation);
            costs_are_those_of_the_plain_search(&costmap, start);
        }
    }
}
