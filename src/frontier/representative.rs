//! The one point that stands for a frontier.

use super::Frontier;
use crate::geometry::Point;
use crate::grid::{Cell, GridInfo};
use serde::{Deserialize, Serialize};

/// How the point is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Representative {
    /// The member nearest to the coordinate-wise median (Topiwala 2018): unlike the
    /// centroid it cannot lie in a wall.
    #[default]
    Median,
}

impl Representative {
    /// The point in the map frame.
    #[must_use]
    pub fn of(self, frontier: &Frontier, info: &GridInfo) -> Point {
        match self {
            Self::Median => info.center(median_member(&frontier.cells)),
        }
    }
}

/// The member nearest to the coordinate-wise median; ties go to the first in row-major
/// order. The median of an even number of coordinates is the lower one.
fn median_member(cells: &[Cell]) -> Cell {
    let median = |mut values: Vec<i32>| {
        let middle = values.len().saturating_sub(1) / 2;
        if values.is_empty() { 0 } else { *values.select_nth_unstable(middle).1 }
    };
    let center = Cell::new(median(cells.iter().map(|c| c.x).collect()), median(cells.iter().map(|c| c.y).collect()));
    cells.iter().copied().min_by_key(|c| (c.distance_squared(center), c.y, c.x)).unwrap_or(center)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_a_bend_is_one_of_its_cells() {
        // An L: the coordinate-wise median (0, 0) is its corner; the centroid is not in it.
        let bend: Vec<Cell> = (0..5).map(|y| Cell::new(0, y)).chain((1..5).map(|x| Cell::new(x, 0))).collect();
        assert_eq!(median_member(&bend), Cell::new(0, 0));
        let arc = [Cell::new(0, 0), Cell::new(1, 3), Cell::new(5, 4), Cell::new(9, 3), Cell::new(10, 0)];
        assert_eq!(median_member(&arc), Cell::new(5, 4));
    }

    #[test]
    fn ties_go_to_the_first_cell() {
        assert_eq!(median_member(&[Cell::new(0, 1), Cell::new(1, 0)]), Cell::new(1, 0));
        assert_eq!(median_member(&[Cell::new(2, 0), Cell::new(0, 2), Cell::new(0, 0)]), Cell::new(0, 0));
    }
}
