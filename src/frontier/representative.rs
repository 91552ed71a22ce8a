//! The one point that stands for a frontier.

use super::Frontier;
use crate::geometry::Point;
use crate::grid::{Cell, GridInfo};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the point is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Representative {
    /// The member nearest to the coordinate-wise median (Topiwala 2018): unlike the
    /// centroid it cannot lie in a wall.
    #[default]
    Median,
    /// The mean of the cells (Yamauchi 1997, Northwestern): it can lie in a wall, and
    /// then the nearest place to stand serves.
    Centroid,
    /// The member nearest to the robot.
    NearestMember,
    /// The member nearest to the mean (Alghfeli).
    CentralMember,
    /// The centre of the minimum enclosing circle (Liang 2020): it can lie in a wall.
    CircleCenter,
}

impl Representative {
    /// The point in the map frame.
    #[must_use]
    pub fn of(self, frontier: &Frontier, info: &GridInfo, robot_in_map: Point) -> Point {
        let nearest_to = |target: Point| nearest_member(&frontier.cells, info.to_grid_units(target));
        match self {
            Self::Median => info.center(median_member(&frontier.cells)),
            Self::Centroid => frontier.centroid(info),
            Self::NearestMember => nearest_to(robot_in_map).map_or(robot_in_map, |cell| info.center(cell)),
            Self::CentralMember => {
                let mean = frontier.centroid(info);
                nearest_to(mean).map_or(mean, |cell| info.center(cell))
            }
            Self::CircleCenter => frontier.enclosing_circle(info).map_or(frontier.centroid(info), |c| c.center),
        }
    }
}

/// The member whose centre is nearest to a point in grid units; ties, also those that
/// rounding would break, go to the first in row-major order.
fn nearest_member(cells: &[Cell], (x, y): (f64, f64)) -> Option<Cell> {
    let distance = |cell: &Cell| (f64::from(cell.x) + 0.5 - x).hypot(f64::from(cell.y) + 0.5 - y);
    let nearest = cells.iter().map(distance).min_by(f64::total_cmp)?;
    cells.iter().copied().filter(|cell| distance(cell) <= nearest + 1e-9).min_by_key(|cell| (cell.y, cell.x))
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
    use crate::frontier::CellSide;
    use crate::geometry::Pose;

    #[test]
    fn each_point_of_a_bend_in_a_turned_map() {
        let info = GridInfo::new(10, 10, 0.5, Pose::new(3.0, -2.0, 0.8)).unwrap();
        // Along the bottom to a corner and up: the mean, (3.5, 1), is in none of its cells.
        let cells: Vec<Cell> = (0..6).map(|x| Cell::new(x, 0)).chain((1..5).map(|y| Cell::new(5, y))).collect();
        let frontier = Frontier { id: 0, cells: cells.into(), side: CellSide::Free, circle: None };
        let robot = info.center(Cell::new(9, 4));
        for (representative, x, y) in [
            (Representative::Median, 4.0, 0.0),
            (Representative::Centroid, 3.5, 1.0),
            (Representative::NearestMember, 5.0, 4.0),
            (Representative::CentralMember, 3.0, 0.0),
            (Representative::CircleCenter, 2.5, 2.0),
        ] {
            let expected = info.from_grid_units(x + 0.5, y + 0.5);
            let point = representative.of(&frontier, &info, robot);
            assert!((point - expected).norm() < 1e-9, "{representative:?}: {:?}", info.to_grid_units(point));
        }
    }

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
