//! The cheapest ways from one cell to all others: Dijkstra's search, with the steps left
//! out that cannot be part of a way that is needed.
//!
//! N. Sturtevant and S. Rabin, "Canonical Orderings on Grids" (IJCAI 2016): in open
//! space a cell has many cheapest ways that differ in the order of their steps alone.
//! One of them is enough, the one whose diagonal steps come first, so that a cell
//! entered straight on is left straight on, and one entered diagonally in three
//! directions. Where costs differ, less can be left out: see [`super::ground`]. The costs are those of
//! [`super::search`]. O(cells), with buckets as wide as the cheapest step (Denardo and
//! Fox, "Shortest-route methods", Operations Research 1979).

use super::ground::{Ground, ONWARD, ONWARD_FROM_SPACE, survey};
use super::lattice::{MAX_STEP, STRAIGHT, step_costs};
use super::search::UNREACHED;
use crate::grid::{CellRect, Costmap, UNKNOWN_COST};

/// A bucket holds the costs that [`STRAIGHT`] steps span: what one of them adds leads to
/// a later bucket, so that the cells of a bucket can be taken in any order.
const BUCKET: u32 = STRAIGHT;
/// Buckets wait no farther ahead than the dearest step leads.
const RING: usize = (MAX_STEP / BUCKET + 2).next_power_of_two() as usize;

/// What is known of a cell: in one place, as all of it is needed at once.
#[derive(Clone, Copy, Debug)]
struct Node {
    /// Cost of the cheapest way so far.
    way: u32,
    /// The cell's cost in the costmap.
    cost: u8,
    /// In which directions it can be left.
    open: u8,
    /// In which directions it is still to be left.
    onward: u8,
    /// A [`Ground`].
    ground: u8,
}

impl Node {
    const CLOSED: Self = Self { way: UNREACHED, cost: UNKNOWN_COST, open: 0, onward: 0, ground: Ground::Rough as u8 };
}

/// The search with its memory: 8 bytes for each cell of the part that is searched.
#[derive(Clone, Debug, Default)]
pub struct CanonicalSearch {
    /// Columns of the costmap.
    width: usize,
    /// The part of it that is searched.
    part: CellRect,
    /// Cells in a row of the part with the margin.
    stride: usize,
    /// With a closed margin all round.
    nodes: Vec<Node>,
    buckets: [Vec<u32>; RING],
}

impl CanonicalSearch {
    /// Searches everywhere from the cell with a row-major index, which is passable. All that is
    /// connected with it must lie in `part`, which costs what it has cells.
    pub fn run(&mut self, costmap: &Costmap, start: usize, part: &CellRect) {
        self.width = costmap.info().width();
        self.part = *part;
        self.prepare(costmap);
        let Some(start) = self.place(start) else { return };
        let stride = self.stride as isize;
        let offsets = [1, -1, stride, -stride, stride + 1, stride - 1, 1 - stride, -1 - stride];
        let Self { nodes, buckets, .. } = self;
        nodes[start].way = 0;
        nodes[start].onward = nodes[start].open;
        buckets[0].push(start as u32);
        let mut waiting = 1;
        let mut turn = 0;
        while waiting > 0 {
            let slot = turn % RING;
            let mut bucket = std::mem::take(&mut buckets[slot]);
            waiting -= bucket.len();
            for &place in &bucket {
                waiting += expand(nodes, buckets, &offsets, place as usize);
            }
            bucket.clear();
            buckets[slot] = bucket;
            turn += 1;
        }
    }

    /// Cost of the cheapest way to a cell in lattice units, `None` when there is none.
    #[must_use]
    pub fn cost(&self, index: usize) -> Option<u32> {
        self.nodes.get(self.place(index)?).map(|node| node.way).filter(|&way| way != UNREACHED)
    }

    /// Where a cell with a row-major index is in the part with its margin, if it is.
    fn place(&self, index: usize) -> Option<usize> {
        let (x, y) = ((index % self.width).checked_sub(self.part.x)?, (index / self.width).checked_sub(self.part.y)?);
        (x < self.part.width && y < self.part.height).then(|| (y + 1) * self.stride + x + 1)
    }

    /// Lays out the costs with a margin and finds out which steps are open.
    fn prepare(&mut self, costmap: &Costmap) {
        let CellRect { x, y, width, height } = self.part;
        let stride = width + 2;
        self.stride = stride;
        self.buckets.iter_mut().for_each(Vec::clear);
        self.nodes.clear();
        self.nodes.reserve(stride * (height + 2));
        self.nodes.resize(stride, Node::CLOSED);
        let closed_row = vec![UNKNOWN_COST; stride];
        // The rows below, at and above the one in hand, with their margins.
        let mut rows = [closed_row.clone(), closed_row.clone(), closed_row.clone()];
        let mut next = costmap.costs().chunks_exact(self.width).skip(y).take(height).map(|row| &row[x..x + width]);
        let mut take = |row: &mut [u8]| match next.next() {
            Some(costs) => row[1..=width].copy_from_slice(costs),
            None => row.fill(UNKNOWN_COST),
        };
        take(&mut rows[2]);
        let (mut open, mut ground) = (vec![0; width], vec![0; width]);
        for _ in 0..height {
            rows.rotate_left(1);
            take(&mut rows[2]);
            survey(&rows, &mut open, &mut ground);
            let cells = rows[1][1..=width].iter().zip(&open).zip(&ground);
            self.nodes.push(Node::CLOSED);
            self.nodes.extend(cells.map(|((&cost, &open), &ground)| Node { cost, open, ground, ..Node::CLOSED }));
            self.nodes.push(Node::CLOSED);
        }
        self.nodes.resize(stride * (height + 2), Node::CLOSED);
    }
}

/// Takes the steps from a cell that are still to be taken: none when it was in an
/// earlier bucket too. Returns how many cells wait for it.
#[inline]
fn expand(nodes: &mut [Node], buckets: &mut [Vec<u32>; RING], offsets: &[isize; 8], from: usize) -> usize {
    let mut directions = std::mem::take(&mut nodes[from].onward);
    let here = nodes[from];
    let in_space = here.ground == Ground::Space as u8;
    let onward = if in_space { &ONWARD_FROM_SPACE } else { &ONWARD };
    let mut waiting = 0;
    while directions != 0 {
        let direction = (directions.trailing_zeros() & 7) as usize;
        directions &= directions - 1;
        let to = from.wrapping_add_signed(offsets[direction]);
        let there = &mut nodes[to];
        let way = here.way + step_costs(direction)[usize::from(here.cost) + usize::from(there.cost)];
        let onward = onward[usize::from(there.ground)][direction] & there.open;
        if way < there.way {
            if there.way / BUCKET != way / BUCKET {
                buckets[(way / BUCKET) as usize % RING].push(to as u32);
                waiting += 1;
            }
            there.way = way;
            there.onward = onward;
        } else if way == there.way {
            // Ways that cost the same may go on in different directions.
            there.onward |= onward;
        }
    }
    waiting
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{GridInfo, Inflation, OccupancyGrid, Thresholds};
    use crate::planning::lattice::Lattice;
    use crate::planning::reach::{connected, passable};
    use crate::planning::search::Search;
    use proptest::prelude::*;

    fn costs_are_those_of_the_plain_search(costmap: &Costmap, start: usize) {
        let (mut plain, mut canonical) = (Search::default(), CanonicalSearch::default());
        plain.run(&Lattice::new(costmap), start, None, false);
        let reach = connected(&passable(costmap), start);
        canonical.run(costmap, start, &reach.bounds());
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
        fn calm_ground_costs_the_same(
            width in 1u32..40,
            costs in proptest::collection::vec(prop_oneof![30 => 60u8..124, 2 => 0u8..253, 1 => Just(254)], 800),
            start in 0usize..800,
        ) {
            let info = GridInfo::new(width, 800 / width, 1.0, Pose::default()).unwrap();
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
            let inflation = Inflation { inscribed_radius_m: 0.5, clear_radius_m: 0.0, inflation_radius_m, cost_scaling_factor: 1.0 };
            let costmap = Costmap::inflate(&grid, &Thresholds::default(), &inflation);
            costs_are_those_of_the_plain_search(&costmap, start);
        }
    }
}
