//! Costmaps as `nav_msgs/OccupancyGrid`, in the scale of `costmap_2d_ros`'s publisher:
//! 0 free, 1 to 98 inflated, 99 inscribed, 100 lethal, -1 unknown.

use super::{Costmap, FREE_COST, INSCRIBED_COST, LETHAL_COST, UNKNOWN_COST};
use crate::grid::OccupancyGrid;

impl Costmap {
    /// The costs that a published costmap stands for. The scale of 98 values is
    /// coarser than that of the costs, 252: a cost is at most 3 off.
    #[must_use]
    pub fn from_published(grid: &OccupancyGrid) -> Self {
        let costs = grid.data().iter().map(|&value| cost_of_published(value)).collect();
        Self::of(*grid.info(), costs)
    }

    /// The costs in the published scale.
    #[must_use]
    pub fn to_published(&self) -> OccupancyGrid {
        let mut grid = OccupancyGrid::filled(*self.info(), OccupancyGrid::UNKNOWN);
        for (value, &cost) in grid.data_mut().iter_mut().zip(self.costs()) {
            *value = value_of(cost);
        }
        grid
    }
}

pub(super) const fn cost_of_published(value: i8) -> u8 {
    match value {
        0 => FREE_COST,
        99 => INSCRIBED_COST,
        1..=98 => (1 + (value as u32 - 1) * 251 / 97) as u8,
        100..=i8::MAX => LETHAL_COST,
        i8::MIN..=-1 => UNKNOWN_COST,
    }
}

const fn value_of(cost: u8) -> i8 {
    match cost {
        FREE_COST => 0,
        INSCRIBED_COST => 99,
        LETHAL_COST => 100,
        UNKNOWN_COST => -1,
        _ => (1 + (97 * (cost as u32 - 1)) / 251) as i8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_values_come_back_and_costs_nearly() {
        for value in -1..=100_i8 {
            assert!(value_of(cost_of_published(value)).abs_diff(value) <= 1, "{value}");
        }
        for cost in [0, 253, 254, 255] {
            assert_eq!(cost_of_published(value_of(cost)), cost);
        }
        for cost in 1..=252 {
            assert!(
                cost_of_published(value_of(cost)).abs_diff(cost) <= 3
                    && cost_of_published(value_of(cost)) < INSCRIBED_COST,
                "{cost}"
            );
        }
    }
}
