//! Which cells the robot can get to, without the ways.

use crate::bits::BitPlane;
use crate::grid::{CellRect, Costmap, INSCRIBED_COST, Known, Since, Snapshot};

/// The cells that the robot's centre may be in, kept from one version of a costmap to the next.
#[derive(Clone, Debug, Default)]
pub struct Passable {
    known: Known,
    plane: BitPlane,
}

impl Passable {
    /// The passable cells of a costmap. O(cells that changed since the last call) where that is
    /// known.
    pub fn update(&mut self, costs: &Snapshot<Costmap>) -> &BitPlane {
        let info = costs.cells.info();
        let since = self.known.renew(&costs.changes, info);
        let size = (info.width(), info.height());
        let set = |plane: &mut BitPlane, part: &CellRect| plane.set_values(part, costs.cells.costs(), is_passable);
        match since {
            Since::Part(changed) => set(&mut self.plane, &changed),
            Since::Grown(growth, changed) => {
                self.plane = self.plane.moved(size, growth.corner());
                growth.outside(0).iter().chain([&changed]).for_each(|part| set(&mut self.plane, part));
            }
            Since::All => {
                self.plane.resize(size.0, size.1);
                set(&mut self.plane, &CellRect::of(info));
            }
        }
        &self.plane
    }
}

/// All passable cells of a costmap. O(cells).
pub fn passable(costmap: &Costmap) -> BitPlane {
    BitPlane::of_values(costmap.info().width(), costmap.costs(), is_passable)
}

const fn is_passable(cost: u8) -> bool {
    cost < INSCRIBED_COST
}

/// The passable cells connected with the one of a row-major index along their sides: row by row,
/// one run of cells at a time (A. R. Smith, "Tint fill", SIGGRAPH 1979), on a plane of bits. A
/// diagonal step of the lattice needs both cells beside it, so these are the cells that
/// the lattice reaches. O(words of the plane + runs reached).
pub fn connected(passable: &BitPlane, start: usize) -> BitPlane {
    let (width, height) = (passable.width(), passable.height());
    let mut open = passable.clone();
    let mut reached = open.clone();
    let mut seeds = vec![(start % width, start / width)];
    while let Some((x, y)) = seeds.pop() {
        if open.first_in(y, x..x + 1).is_none() {
            continue;
        }
        let run = open.run_around(y, x);
        open.clear_run(y, run.start, run.end);
        for beside in [y.wrapping_sub(1), y + 1] {
            if beside >= height {
                continue;
            }
            let mut from = run.start;
            while let Some(seed) = open.first_in(beside, from..run.end) {
                seeds.push((seed, beside));
                from = open.run_around(beside, seed).end;
                if from >= run.end {
                    break;
                }
            }
        }
    }
    reached.subtract(&open);
    reached
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{Cell, GridInfo, Neighbourhood};
    use proptest::prelude::*;

    proptest! {
        /// Against a flood cell by cell.
        #[test]
        fn reaches_what_is_connected(
            width in 1u32..150,
            costs in proptest::collection::vec(prop_oneof![3 => 0u8..253, 1 => 253u8..=255], 900),
            start in 0usize..900,
        ) {
            let info = GridInfo::new(width, 900 / width, 1.0, Pose::default()).unwrap();
            let mut costs = costs[..info.len()].to_vec();
            let start = start % info.len();
            costs[start] = 0;
            let costmap = Costmap::from_costs(info, costs).unwrap();
            let mut flood = vec![info.cell(start)];
            let mut next = 0;
            while let Some(&cell) = flood.get(next) {
                next += 1;
                let around: Vec<Cell> = info.neighbours(cell, Neighbourhood::Four).collect();
                for beside in around {
                    if costmap.is_passable(beside) && !flood.contains(&beside) {
                        flood.push(beside);
                    }
                }
            }
            let reached = connected(&passable(&costmap), start);
            prop_assert_eq!(reached.count(), flood.len());
            prop_assert!(flood.iter().all(|&cell| reached.contains(cell)));
        }
    }
}
