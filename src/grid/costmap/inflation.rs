//! Inflation of obstacles: costmap_2d's static and inflation layers.

use super::{Costmap, FREE_COST, HIGHEST_COST, INSCRIBED_COST, LETHAL_COST, NARROW_COST, UNKNOWN_COST};
use crate::grid::{CellRect, GridInfo, OccupancyGrid, Thresholds, near, squared_distance_cells};
use serde::{Deserialize, Serialize};

/// Costs reach no farther than this, whatever the radius: the table stays small.
const MAX_REACH_CELLS: f64 = 1000.0;

/// Parameters of the inflation layer, with costmap_2d's names.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inflation {
    /// Nearer than this to an obstacle the robot's centre cannot be, metres.
    pub inscribed_radius_m: f64,
    /// From there up to this distance the robot's centre can be, though not with every
    /// heading, or not with the padding that is wanted: such cells cost [`NARROW_COST`] or
    /// more. Metres; nothing where it is less than the inscribed radius.
    pub clear_radius_m: f64,
    /// How far from an obstacle costs reach, metres.
    pub inflation_radius_m: f64,
    /// Rate of the exponential decay beyond both, per metre.
    pub cost_scaling_factor: f64,
}

impl Inflation {
    /// Cost at a distance in metres from the nearest obstacle, as
    /// `InflationLayer::computeCost` has it: lethal at 0, inscribed up to the
    /// inscribed radius, then `252 exp(-cost_scaling_factor (d - inscribed))`. Where there
    /// is a clear radius, costs fall evenly to [`NARROW_COST`] there, so that ways lead along
    /// the middle of what is narrow, and decay from 199 beyond it.
    #[must_use]
    pub fn cost(&self, distance_m: f64) -> u8 {
        if distance_m <= 0.0 {
            LETHAL_COST
        } else if distance_m <= self.inscribed_radius_m {
            INSCRIBED_COST
        } else if distance_m <= self.clear_radius_m {
            let share = (distance_m - self.inscribed_radius_m) / (self.clear_radius_m - self.inscribed_radius_m);
            (f64::from(HIGHEST_COST) - share * f64::from(HIGHEST_COST - NARROW_COST)) as u8
        } else {
            let has_narrow = self.clear_radius_m > self.inscribed_radius_m;
            let highest = if has_narrow { NARROW_COST - 1 } else { HIGHEST_COST };
            let beyond_m = distance_m - self.inscribed_radius_m.max(self.clear_radius_m);
            (f64::from(highest) * (-self.cost_scaling_factor * beyond_m).exp()) as u8
        }
    }

    /// How far costs reach, in whole cells: rounded up, as costmap_2d does.
    fn reach_cells(&self, resolution_m: f64) -> u32 {
        let radius_m = self.inflation_radius_m.max(self.inscribed_radius_m).max(self.clear_radius_m);
        (radius_m / resolution_m).ceil().clamp(0.0, MAX_REACH_CELLS) as u32
    }

    /// How far costs reach, in cells of a grid; `None` where that is too far for a part of it
    /// to be inflated by itself.
    pub(super) fn reach_within(&self, info: &GridInfo) -> Option<usize> {
        let reach = self.reach_cells(info.resolution_m()) as usize;
        (reach <= near::LONGEST_LIMIT).then_some(reach)
    }

    /// Costs by squared distance in cells, as far as they reach.
    fn table(&self, resolution_m: f64) -> Vec<u8> {
        let last = self.reach_cells(resolution_m).pow(2);
        (0..=last).map(|squared| self.cost(f64::from(squared).sqrt() * resolution_m)).collect()
    }
}

impl Costmap {
    /// Inflates the obstacles of an occupancy grid. Unknown cells stay unknown unless
    /// they lie within the inscribed radius of an obstacle, as costmap_2d has it
    /// without `inflate_unknown`.
    #[must_use]
    pub fn inflate(grid: &OccupancyGrid, thresholds: &Thresholds, inflation: &Inflation) -> Self {
        let info = *grid.info();
        let table = inflation.table(info.resolution_m());
        let is_obstacle = |value: i8| value >= thresholds.occupied_min;
        if inflation.reach_within(&info).is_none() {
            let squared = squared_distance_cells(&info, |index| is_obstacle(grid.data()[index]));
            let inflated = squared.iter().map(|&squared| table.get(squared as usize).copied().unwrap_or(FREE_COST));
            let mut costs: Vec<u8> = inflated.collect();
            leave_unknown(&mut costs, grid.data(), *thresholds);
            return Self { info, costs };
        }
        let mut costs = vec![FREE_COST; info.len()];
        let all = CellRect::of(&info);
        inflate_rect(grid, thresholds, &table, [all, all], &mut costs);
        Self { info, costs }
    }

    /// Finds the costs of a rectangle again, of a grid of the same size in which obstacles at
    /// least `reach` cells inside of it changed: the same as [`Self::inflate`] gives there.
    pub(super) fn reinflate(
        &mut self,
        grid: &OccupancyGrid,
        anew: CellRect,
        reach: usize,
        thresholds: &Thresholds,
        inflation: &Inflation,
    ) {
        let table = inflation.table(self.info.resolution_m());
        // What has a say in the costs lies a reach farther out.
        inflate_rect(grid, thresholds, &table, [anew, anew.grown(reach, &self.info)], &mut self.costs);
    }
}

/// Inflates the obstacles in the second rectangle and writes the costs of the first, which
/// lies in it. `table` holds costs by squared distance in cells.
fn inflate_rect(
    grid: &OccupancyGrid,
    thresholds: &Thresholds,
    table: &[u8],
    [anew, seen]: [CellRect; 2],
    costs: &mut [u8],
) {
    let width = grid.info().width();
    let mut obstacles = Vec::with_capacity(seen.width * seen.height);
    for row in grid.data().chunks_exact(width).skip(seen.y).take(seen.height) {
        let values = row[seen.x..seen.x + seen.width].iter();
        obstacles.extend(values.map(|&value| if value >= thresholds.occupied_min { 0 } else { u8::MAX }));
    }
    let rows = anew.y - seen.y..anew.y - seen.y + anew.height;
    let mut y = anew.y;
    near::for_each_row(seen.width, &mut obstacles, rows, table, |inflated| {
        let at = y * width + anew.x..y * width + anew.x + anew.width;
        let costs = &mut costs[at.clone()];
        costs.copy_from_slice(&inflated[anew.x - seen.x..][..anew.width]);
        leave_unknown(costs, &grid.data()[at], *thresholds);
        y += 1;
    });
}

/// Marks the unknown among cells that are no collision. Maps are inflated every second:
/// this is arithmetic on many cells at a time.
fn leave_unknown(costs: &mut [u8], values: &[i8], thresholds: Thresholds) {
    let Thresholds { free_max, occupied_min } = thresholds;
    for (cost, &value) in costs.iter_mut().zip(values) {
        let is_unknown = (value < occupied_min) & ((value < 0) | (value > free_max));
        *cost = if is_unknown & (*cost < INSCRIBED_COST) { UNKNOWN_COST } else { *cost };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Cell;

    const INFLATION: Inflation =
        Inflation { inscribed_radius_m: 1.0, clear_radius_m: 0.0, inflation_radius_m: 3.0, cost_scaling_factor: 1.0 };

    #[test]
    fn costs_decay_as_costmap_2d_computes_them() {
        let grid = OccupancyGrid::from_ascii("#......").unwrap();
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &INFLATION);
        // 252 e^-1 = 92.7, 252 e^-2 = 34.1; beyond the inflation radius nothing.
        assert_eq!(costmap.costs(), &[254, 253, 92, 34, 0, 0, 0]);
    }

    #[test]
    fn what_is_narrow_costs_most_and_least_in_its_middle() {
        let grid = OccupancyGrid::from_ascii("#.....").unwrap();
        let narrow = Inflation { clear_radius_m: 3.0, inflation_radius_m: 9.0, ..INFLATION };
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &narrow);
        // Half way from 252 to 200, then 199 e^-1 = 73.2, 199 e^-2 = 26.9.
        assert_eq!(costmap.costs(), &[254, 253, 226, 200, 73, 26]);
        let roomy = costmap.without_narrow().unwrap();
        assert_eq!(roomy.costs(), &[254, 253, 253, 253, 73, 26]);
    }

    #[test]
    fn costs_that_reach_far_are_the_same() {
        let grid = OccupancyGrid::from_ascii("#......?").unwrap();
        let far = Inflation { inflation_radius_m: 60.0, ..INFLATION };
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &far);
        // 252 e^-3 = 12.5, 252 e^-4 = 4.6, 252 e^-5 = 1.7
        assert_eq!(costmap.costs(), &[254, 253, 92, 34, 12, 4, 1, 255]);
    }

    #[test]
    fn unknown_stays_unknown_outside_the_inscribed_radius() {
        let grid = OccupancyGrid::from_ascii("#????").unwrap();
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &INFLATION);
        assert_eq!(costmap.costs(), &[254, 253, 255, 255, 255]);
    }

    #[test]
    fn diagonal_distances_are_euclidean() {
        let grid = OccupancyGrid::from_ascii("...\n...\n#..").unwrap();
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &INFLATION);
        // sqrt(2) m: 252 e^-0.414 = 166.5
        assert_eq!(costmap.cost(Cell::new(1, 1)), 166);
        assert!(costmap.is_passable(Cell::new(1, 1)) && !costmap.is_passable(Cell::new(1, 0)));
        assert_eq!(costmap.cost(Cell::new(9, 9)), UNKNOWN_COST);
    }
}
