//! The 8-connected lattice that the grid planners share: which steps are allowed and
//! what they cost.
//!
//! A step costs its length times a factor that grows with the costs of the two cells,
//! as navfn weighs a costmap (neutral cost 50, cost factor 0.8). Lengths are integers,
//! 12 along a side and 17 along a diagonal (17/12 = 1.4167 against sqrt 2 = 1.4142), so
//! that sums are exact, every planner finds the same cost, and a bucket queue can
//! order the search.

use crate::grid::{Costmap, INSCRIBED_COST};

/// Length of a step along a side, in lattice units.
pub const STRAIGHT: u32 = 12;
/// Length of a step along a diagonal, in lattice units.
pub const DIAGONAL: u32 = 17;

/// Cost of crossing a free cell in navfn's scale.
const NEUTRAL: u32 = 50;

/// All eight directions as bits, those of [`crate::grid::NEIGHBOURS_8`] from the lowest on.
pub const ALL_DIRECTIONS: u8 = 0xff;

/// No step costs more than this.
pub const MAX_STEP: u32 = step_cost(DIAGONAL, 2 * (INSCRIBED_COST as u32 - 1));

/// Cost of a step of `length` between two cells whose costs add up to `cost_sum`.
const fn step_cost(length: u32, cost_sum: u32) -> u32 {
    // 0.8 * mean = 0.4 * sum, in fifths to stay in integers.
    length * (5 * NEUTRAL + 2 * cost_sum) / (5 * NEUTRAL)
}

/// A step to a neighbour: where it leads, how long it is, in which of the eight
/// directions of [`crate::grid::NEIGHBOURS_8`].
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Row-major index of the neighbour.
    pub to: usize,
    /// What it costs to go there.
    pub cost: u32,
    /// Which of the eight directions.
    pub direction: u8,
}

/// The passable cells of a costmap with their steps. Symmetric: a step back costs the
/// same.
#[derive(Clone, Debug)]
pub struct Lattice<'a> {
    costs: &'a [u8],
    width: usize,
    /// 2^64 / width, rounded up: multiplying by it divides by the width.
    inverse_width: u64,
}

/// Sums of two passable costs: 0..=504.
const COST_SUMS: usize = 2 * (INSCRIBED_COST as usize - 1) + 1;

/// What a step costs by the sum of the two cells' costs, in one of the eight directions.
#[inline]
pub const fn step_costs(direction: usize) -> &'static [u32; COST_SUMS] {
    const SIDE: [u32; COST_SUMS] = table(STRAIGHT);
    const CORNER: [u32; COST_SUMS] = table(DIAGONAL);
    if direction < 4 { &SIDE } else { &CORNER }
}

const fn table(length: u32) -> [u32; COST_SUMS] {
    let mut table = [0; COST_SUMS];
    let mut sum = 0;
    while sum < COST_SUMS {
        table[sum] = step_cost(length, sum as u32);
        sum += 1;
    }
    table
}

impl<'a> Lattice<'a> {
    /// The lattice over a costmap.
    #[must_use]
    pub fn new(costmap: &'a Costmap) -> Self {
        let info = costmap.info();
        Self {
            costs: costmap.costs(),
            width: info.width(),
            inverse_width: (u64::MAX / info.width() as u64).wrapping_add(1),
        }
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.costs.len()
    }

    /// Whether the robot's centre may be in a cell.
    #[must_use]
    pub fn is_open(&self, index: usize) -> bool {
        self.costs[index] < INSCRIBED_COST
    }

    /// Column of a cell: the remainder of a division by the width, which is exact for
    /// indices below 2^32 (Lemire, Kaser and Kurz, "Faster remainder by direct
    /// computation", 2019).
    #[inline]
    const fn column(&self, index: usize) -> usize {
        let fraction = self.inverse_width.wrapping_mul(index as u64);
        ((fraction as u128 * self.width as u128) >> 64) as usize
    }

    /// Calls `visit` with every allowed step from a cell. A diagonal step needs both
    /// cells beside it passable: no corner is cut.
    #[inline]
    pub fn for_each_step(&self, from: usize, visit: impl FnMut(Step)) {
        self.for_each_step_among(ALL_DIRECTIONS, from, visit);
    }

    /// The same with the steps in some directions alone, given as bits.
    #[inline]
    pub fn for_each_step_among(&self, directions: u8, from: usize, mut visit: impl FnMut(Step)) {
        let x = self.column(from);
        let here = self.costs[from];
        let open = |inside: bool, index: usize| inside && self.costs[index] < INSCRIBED_COST;
        let east = open(x + 1 < self.width, from + 1);
        let west = open(x > 0, from.wrapping_sub(1));
        let north = open(from + self.width < self.costs.len(), from + self.width);
        let south = open(from >= self.width, from.wrapping_sub(self.width));
        // In the order of the directions. One loop, so that `visit` is compiled into it.
        let steps = [
            (east, from.wrapping_add(1)),
            (west, from.wrapping_sub(1)),
            (north, from.wrapping_add(self.width)),
            (south, from.wrapping_sub(self.width)),
            (north && east, from.wrapping_add(self.width + 1)),
            (north && west, from.wrapping_add(self.width).wrapping_sub(1)),
            (south && east, from.wrapping_sub(self.width).wrapping_add(1)),
            (south && west, from.wrapping_sub(self.width + 1)),
        ];
        for (direction, &(allowed, to)) in steps.iter().enumerate() {
            if !allowed || directions >> direction & 1 == 0 || self.costs[to] >= INSCRIBED_COST {
                continue;
            }
            let sum = usize::from(here) + usize::from(self.costs[to]);
            let cost = step_costs(direction)[sum.min(COST_SUMS - 1)];
            visit(Step { to, cost, direction: direction as u8 });
        }
    }

    /// The cell that a step in `direction` came from.
    #[must_use]
    pub const fn before(&self, to: usize, direction: u8) -> usize {
        let (dx, dy) = crate::grid::NEIGHBOURS_8[direction as usize & 7];
        let (dx, dy) = (dx as isize, dy as isize);
        to.wrapping_add_signed(-(dy * self.width as isize + dx))
    }

    /// The least that any way between two cells can cost: the octile distance.
    #[must_use]
    pub const fn octile(&self, a: usize, b: usize) -> u32 {
        let dx = (a % self.width).abs_diff(b % self.width) as u32;
        let dy = (a / self.width).abs_diff(b / self.width) as u32;
        let (low, high) = if dx < dy { (dx, dy) } else { (dy, dx) };
        low * DIAGONAL + (high - low) * STRAIGHT
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::GridInfo;

    fn costmap(width: u32, costs: &[u8]) -> Costmap {
        let info = GridInfo::new(width, costs.len() as u32 / width, 1.0, Pose::default()).unwrap();
        Costmap::from_costs(info, costs.to_vec()).unwrap()
    }

    fn steps(lattice: &Lattice<'_>, from: usize) -> Vec<(usize, u32)> {
        let mut steps = Vec::new();
        lattice.for_each_step(from, |s| {
            assert_eq!(lattice.before(s.to, s.direction), from);
            steps.push((s.to, s.cost));
        });
        steps.sort_unstable();
        steps
    }

    #[test]
    fn open_space_costs_its_length() {
        let map = costmap(3, &[0; 9]);
        let lattice = Lattice::new(&map);
        let expected = [(0, 17), (1, 12), (2, 17), (3, 12), (5, 12), (6, 17), (7, 12), (8, 17)];
        assert_eq!(steps(&lattice, 4), expected);
        assert_eq!(steps(&lattice, 0), [(1, 12), (3, 12), (4, 17)]);
        assert_eq!(lattice.octile(0, 5), 12 + 17);
    }

    #[test]
    fn columns_are_remainders() {
        for width in [1_u32, 2, 3, 5, 7, 64, 100, 1165, 16384] {
            let map = costmap(width, &vec![0; width as usize]);
            let lattice = Lattice::new(&map);
            for index in (0..1 << 28).step_by(99_991).chain([0, 1, (1 << 28) - 1]) {
                assert_eq!(lattice.column(index), index % width as usize, "{index} of {width}");
            }
        }
    }

    #[test]
    fn corners_are_not_cut_and_unknown_is_blocked() {
        let map = costmap(2, &[0, 254, 0, 0]);
        assert_eq!(steps(&Lattice::new(&map), 0), [(2, 12)]);
        let map = costmap(2, &[0, 255, 0, 0]);
        assert_eq!(steps(&Lattice::new(&map), 0), [(2, 12)]);
    }

    #[test]
    fn costs_near_obstacles_weigh_as_navfn_weighs_them() {
        // (50 + 0.8 * 252) / 50 = 5.03 times the length.
        let map = costmap(2, &[252, 252]);
        assert_eq!(steps(&Lattice::new(&map), 0), [(1, 60)]);
        assert_eq!(MAX_STEP, 85);
    }
}
