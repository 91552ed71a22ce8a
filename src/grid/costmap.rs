//! Costs of standing in a cell: costmap_2d's static and inflation layers.

use super::{Cell, GridInfo, OccupancyGrid, Thresholds, near, squared_distance_cells};
use crate::geometry::Point;
use serde::{Deserialize, Serialize};

/// Cost of open space.
pub const FREE_COST: u8 = 0;
/// Cost within the inscribed radius of an obstacle: the robot's centre here is a
/// collision (costmap_2d's `INSCRIBED_INFLATED_OBSTACLE`).
pub const INSCRIBED_COST: u8 = 253;
/// Cost of an obstacle itself (costmap_2d's `LETHAL_OBSTACLE`).
pub const LETHAL_COST: u8 = 254;
/// Cost of a cell that nobody has seen (costmap_2d's `NO_INFORMATION`).
pub const UNKNOWN_COST: u8 = 255;

/// Costs reach no farther than this, whatever the radius: the table stays small.
const MAX_REACH_CELLS: f64 = 1000.0;

/// Parameters of the inflation layer, with costmap_2d's names.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Inflation {
    /// Radius in metres of the largest disc inside the footprint.
    pub inscribed_radius_m: f64,
    /// How far from an obstacle costs reach, metres.
    pub inflation_radius_m: f64,
    /// Rate of the exponential decay beyond the inscribed radius, per metre.
    pub cost_scaling_factor: f64,
}

impl Inflation {
    /// Cost at a distance in metres from the nearest obstacle, as
    /// `InflationLayer::computeCost` has it: lethal at 0, inscribed up to the
    /// inscribed radius, then `252 exp(-cost_scaling_factor (d - inscribed))`.
    #[must_use]
    pub fn cost(&self, distance_m: f64) -> u8 {
        if distance_m <= 0.0 {
            LETHAL_COST
        } else if distance_m <= self.inscribed_radius_m {
            INSCRIBED_COST
        } else {
            let decay = (-self.cost_scaling_factor * (distance_m - self.inscribed_radius_m)).exp();
            (f64::from(INSCRIBED_COST - 1) * decay) as u8
        }
    }

    /// How far costs reach, in whole cells: rounded up, as costmap_2d does.
    fn reach_cells(&self, resolution_m: f64) -> u32 {
        let radius_m = self.inflation_radius_m.max(self.inscribed_radius_m);
        (radius_m / resolution_m).ceil().clamp(0.0, MAX_REACH_CELLS) as u32
    }

    /// Costs by squared distance in cells, as far as they reach.
    fn table(&self, resolution_m: f64) -> Vec<u8> {
        let last = self.reach_cells(resolution_m).pow(2);
        (0..=last).map(|squared| self.cost(f64::from(squared).sqrt() * resolution_m)).collect()
    }
}

/// One cost a cell, row-major as the grid it was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Costmap {
    info: GridInfo,
    costs: Vec<u8>,
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
        if inflation.reach_cells(info.resolution_m()) as usize > near::LONGEST_LIMIT {
            let squared = squared_distance_cells(&info, |index| is_obstacle(grid.data()[index]));
            let inflated = squared.iter().map(|&squared| table.get(squared as usize).copied().unwrap_or(FREE_COST));
            let mut costs: Vec<u8> = inflated.collect();
            leave_unknown(&mut costs, grid.data(), *thresholds);
            return Self { info, costs };
        }
        let mut obstacles: Vec<u8> =
            grid.data().iter().map(|&value| if is_obstacle(value) { 0 } else { u8::MAX }).collect();
        let mut rows = grid.data().chunks_exact(info.width());
        let mut costs = Vec::with_capacity(info.len());
        near::for_each_row(info.width(), &mut obstacles, &table, |inflated| {
            let from = costs.len();
            costs.extend_from_slice(inflated);
            leave_unknown(&mut costs[from..], rows.next().unwrap_or_default(), *thresholds);
        });
        Self { info, costs }
    }

    /// A costmap from costs already known, such as a published one; `None` when the
    /// number of costs does not fill the grid.
    #[must_use]
    pub fn from_costs(info: GridInfo, costs: Vec<u8>) -> Option<Self> {
        (costs.len() == info.len()).then_some(Self { info, costs })
    }

    /// A costmap of as many costs as the grid has cells.
    pub(super) const fn of(info: GridInfo, costs: Vec<u8>) -> Self {
        Self { info, costs }
    }

    /// Size, resolution and place.
    #[must_use]
    pub const fn info(&self) -> &GridInfo {
        &self.info
    }

    /// All costs, row-major.
    #[must_use]
    pub fn costs(&self) -> &[u8] {
        &self.costs
    }

    /// Cost of a cell; outside is unknown.
    #[must_use]
    pub fn cost(&self, cell: Cell) -> u8 {
        self.info.index(cell).and_then(|i| self.costs.get(i)).copied().unwrap_or(UNKNOWN_COST)
    }

    /// Whether the robot's centre may be in a cell: known, and farther from every
    /// obstacle than the inscribed radius.
    #[must_use]
    pub fn is_passable(&self, cell: Cell) -> bool {
        self.cost(cell) < INSCRIBED_COST
    }

    /// Cost at a point of the map frame; outside is unknown.
    #[must_use]
    pub fn cost_at(&self, point_in_map: Point) -> u8 {
        self.cost(self.info.cell_at(point_in_map))
    }
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

    const INFLATION: Inflation =
        Inflation { inscribed_radius_m: 1.0, inflation_radius_m: 3.0, cost_scaling_factor: 1.0 };

    #[test]
    fn costs_decay_as_costmap_2d_computes_them() {
        let grid = OccupancyGrid::from_ascii("#......").unwrap();
        let costmap = Costmap::inflate(&grid, &Thresholds::default(), &INFLATION);
        // 252 e^-1 = 92.7, 252 e^-2 = 34.1; beyond the inflation radius nothing.
        assert_eq!(costmap.costs(), &[254, 253, 92, 34, 0, 0, 0]);
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
