//! Costs of standing in a cell: costmap_2d's static and inflation layers.

use super::{Cell, CellRect, GridInfo, OccupancyGrid, Thresholds, near, squared_distance_cells};
use crate::geometry::Point;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Cost of open space.
pub const FREE_COST: u8 = 0;
/// Cost within the inscribed radius of an obstacle: the robot's centre here is a
/// collision (costmap_2d's `INSCRIBED_INFLATED_OBSTACLE`).
pub const INSCRIBED_COST: u8 = 253;
/// The highest cost of a cell that the robot's centre may be in.
pub const HIGHEST_COST: u8 = 252;
/// From this cost up to the highest, the robot's centre may be in a cell and the robot cannot
/// turn there.
pub const NARROW_COST: u8 = 200;
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
        let mut costs = vec![FREE_COST; info.len()];
        let all = CellRect::of(&info);
        inflate_rect(grid, thresholds, &table, [all, all], &mut costs);
        Self { info, costs }
    }

    /// The costmap of `new`, of which this is the one of an earlier state: the same as
    /// [`Self::inflate`] gives with the same settings, for the price of what changed.
    #[must_use]
    pub fn reinflate(
        &self,
        old: &OccupancyGrid,
        new: &OccupancyGrid,
        thresholds: &Thresholds,
        inflation: &Inflation,
    ) -> Self {
        let info = *new.info();
        let reach = inflation.reach_cells(info.resolution_m()) as usize;
        if (&info, &info) != (old.info(), &self.info) || reach > near::LONGEST_LIMIT {
            return Self::inflate(new, thresholds, inflation);
        }
        let mut costs = self.costs.clone();
        if let Some(changed) = new.changed_rect(old) {
            // What changes costs, and what has a say in these.
            let anew = changed.grown(reach, &info);
            let table = inflation.table(info.resolution_m());
            inflate_rect(new, thresholds, &table, [anew, anew.grown(reach, &info)], &mut costs);
        }
        Self { info, costs }
    }

    /// A costmap from costs already known, such as a published one; `None` when the
    /// number of costs does not fill the grid.
    #[must_use]
    pub fn from_costs(info: GridInfo, costs: Vec<u8>) -> Option<Self> {
        (costs.len() == info.len()).then_some(Self { info, costs })
    }

    /// The same costmap for a robot that keeps to where it can turn: what is passable and
    /// narrow, as by [`Inflation::clear_radius_m`], is not. `None` where that
    /// changes nothing.
    #[must_use]
    pub fn without_narrow(&self) -> Option<Self> {
        let is_narrow = |cost: u8| (NARROW_COST..INSCRIBED_COST).contains(&cost);
        if !self.costs.iter().any(|&cost| is_narrow(cost)) {
            return None;
        }
        let costs = self.costs.iter().map(|&cost| if is_narrow(cost) { INSCRIBED_COST } else { cost });
        Some(Self { info: self.info, costs: costs.collect() })
    }

    /// The same costmap where another one of the same ground knows of more: its lethal and
    /// inscribed cells are such here too, and its costs count where they are higher: they say
    /// nothing about room to turn. What it does not know says nothing.
    #[must_use]
    pub fn with_obstacles_of(&self, other: &Self) -> Self {
        let higher = |own: u8, theirs: u8| match (own, theirs) {
            (_, UNKNOWN_COST) => own,
            (UNKNOWN_COST, INSCRIBED_COST | LETHAL_COST) => theirs,
            (UNKNOWN_COST, _) => own,
            (_, INSCRIBED_COST | LETHAL_COST) => own.max(theirs),
            _ => own.max(theirs.min(NARROW_COST - 1)),
        };
        let costs = if self.info == other.info {
            self.costs.iter().zip(&other.costs).map(|(&own, &theirs)| higher(own, theirs)).collect()
        } else {
            let theirs = |index| other.cost_at(self.info.center(self.info.cell(index)));
            self.costs.iter().enumerate().map(|(index, &own)| higher(own, theirs(index))).collect()
        };
        Self { info: self.info, costs }
    }

    /// The same costmap with other costs in some cells; those outside are left out.
    #[must_use]
    pub fn with_costs(&self, others: &HashMap<Cell, u8>) -> Self {
        let mut costs = self.costs.clone();
        for (&cell, &cost) in others {
            if let Some(place) = self.info.index(cell).and_then(|index| costs.get_mut(index)) {
                *place = cost;
            }
        }
        Self { info: self.info, costs }
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
    use crate::geometry::Pose;
    use proptest::prelude::*;

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
        let theirs = Costmap::from_costs(*grid.info(), vec![0, 0, 0, 253, 252, 0]).unwrap();
        assert_eq!(roomy.with_obstacles_of(&theirs).costs(), &[254, 253, 253, 253, 199, 26]);
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

    proptest! {
        #[test]
        fn what_changed_is_inflated_as_if_all_were(
            (width, old, changes) in (1usize..60, 1usize..60).prop_flat_map(|(w, h)| {
                let value = prop_oneof![8 => Just(0i8), 2 => Just(-1), 1 => Just(100)];
                let change = (0..w * h, prop_oneof![Just(0i8), Just(-1), Just(100)]);
                (Just(w), proptest::collection::vec(value, w * h), proptest::collection::vec(change, 0..4))
            }),
            radius_m in 0.0f64..20.0,
        ) {
            let info = GridInfo::new(width as u32, (old.len() / width) as u32, 1.0, Pose::default()).unwrap();
            let old = OccupancyGrid::new(info, old).unwrap();
            let mut new = old.clone();
            changes.iter().for_each(|&(index, value)| new.set(info.cell(index), value));
            let (thresholds, inflation) = (Thresholds::default(), Inflation { inflation_radius_m: radius_m, ..INFLATION });
            let before = Costmap::inflate(&old, &thresholds, &inflation);
            let after = before.reinflate(&old, &new, &thresholds, &inflation);
            prop_assert_eq!(after, Costmap::inflate(&new, &thresholds, &inflation));
        }
    }

    #[test]
    fn a_grown_map_is_inflated_anew() {
        let (old, new) = (OccupancyGrid::from_ascii("#..").unwrap(), OccupancyGrid::from_ascii("#....").unwrap());
        let before = Costmap::inflate(&old, &Thresholds::default(), &INFLATION);
        let after = before.reinflate(&old, &new, &Thresholds::default(), &INFLATION);
        assert_eq!(after, Costmap::inflate(&new, &Thresholds::default(), &INFLATION));
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
