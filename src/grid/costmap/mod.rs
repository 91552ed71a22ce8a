//! One cost for each cell of a map: what it costs the robot's centre to be there, in costmap_2d's scale.

mod believed;
mod hidden;
mod inflation;
mod live;
mod published;

use super::{Cell, GridInfo};
use crate::geometry::Point;
use std::collections::HashMap;

pub use believed::BelievedCosts;
pub use hidden::unknown_share_hidden_by;
pub use inflation::Inflation;
pub(crate) use live::{LiveCostmap, Roomy};

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

/// One cost a cell, row-major as the grid it was made from.
#[derive(Clone, Debug, PartialEq)]
pub struct Costmap {
    info: GridInfo,
    costs: Vec<u8>,
}

impl Costmap {
    /// A costmap from costs already known, such as a published one; `None` when the
    /// number of costs does not fill the grid.
    #[must_use]
    pub fn from_costs(info: GridInfo, costs: Vec<u8>) -> Option<Self> {
        (costs.len() == info.len()).then_some(Self { info, costs })
    }

    /// The same costmap with other costs in some cells; those outside are left out.
    #[must_use]
    pub fn with_costs(&self, others: &HashMap<Cell, u8>) -> Self {
        let mut costmap = self.clone();
        costmap.set_costs(others);
        costmap
    }

    /// Sets the costs of some cells; those outside are left out.
    pub fn set_costs(&mut self, others: &HashMap<Cell, u8>) {
        for (&cell, &cost) in others {
            if let Some(place) = self.info.index(cell).and_then(|index| self.costs.get_mut(index)) {
                *place = cost;
            }
        }
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

    /// All costs for writing, row-major.
    #[must_use]
    pub fn costs_mut(&mut self) -> &mut [u8] {
        &mut self.costs
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
