//! How likely a hit is at each place of a map: near to obstacles more than far from them.
//!
//! *Probabilistic Robotics* (Thrun, Burgard, Fox 2005), section 6.4, likelihood fields:
//! `exp(-d^2 / (2 sigma^2))` of the distance to the nearest occupied cell.

use crate::geometry::Point;
use crate::grid::{Cell, GridInfo, OccupancyGrid, Thresholds, squared_distance_cells};

/// Distances beyond this many cells are all the same.
const REACH_CELLS: u32 = 12;

/// A likelihood field.
#[derive(Clone, Debug)]
pub struct LikelihoodField {
    info: GridInfo,
    squares: Vec<u32>,
}

/// The likelihoods of one sigma by squared distance in cells.
#[derive(Clone, Debug)]
pub struct Blur(Vec<f64>);

impl LikelihoodField {
    /// The field of a map.
    #[must_use]
    pub fn of(grid: &OccupancyGrid) -> Self {
        let thresholds = Thresholds::default();
        let is_occupied = |index: usize| grid.data().get(index).is_some_and(|&v| v >= thresholds.occupied_min);
        Self { info: *grid.info(), squares: squared_distance_cells(grid.info(), is_occupied) }
    }

    /// The likelihoods for a standard deviation in metres.
    #[must_use]
    pub fn blur(&self, sigma_m: f64) -> Blur {
        let factor = self.info.resolution_m().powi(2) / (2.0 * sigma_m * sigma_m);
        Blur((0..=REACH_CELLS * REACH_CELLS).map(|square| (-f64::from(square) * factor).exp()).collect())
    }

    /// The likelihood in the cell that a point lies in; 0 far from all obstacles.
    #[must_use]
    pub fn at(&self, blur: &Blur, point: Point) -> f64 {
        self.of_cell(blur, self.info.cell_at(point))
    }

    fn of_cell(&self, blur: &Blur, cell: Cell) -> f64 {
        let square = self.info.index(cell).and_then(|index| self.squares.get(index));
        square.and_then(|&square| blur.0.get(square as usize)).copied().unwrap_or(0.0)
    }

    /// The likelihood between four cell centres, with its slope along x and y per metre.
    #[must_use]
    pub fn smooth(&self, blur: &Blur, point: Point) -> (f64, f64, f64) {
        let (x, y) = self.info.to_grid_units(point);
        let (x, y) = (x - 0.5, y - 0.5);
        let corner = Cell::of_units(x, y);
        let (u, v) = (x - x.floor(), y - y.floor());
        let value = |dx: i32, dy: i32| self.of_cell(blur, corner.offset((dx, dy)));
        let (a, b, c, d) = (value(0, 0), value(1, 0), value(0, 1), value(1, 1));
        let likelihood = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
        let per_m = 1.0 / self.info.resolution_m();
        let slope_x = ((1.0 - v) * (b - a) + v * (d - c)) * per_m;
        let slope_y = ((1.0 - u) * (c - a) + u * (d - b)) * per_m;
        (likelihood, slope_x, slope_y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;

    #[test]
    fn likelihood_falls_with_distance_and_slopes_lead_back() {
        let mut grid = OccupancyGrid::filled(GridInfo::new(40, 40, 0.05, Pose::default()).unwrap(), 0);
        grid.set(Cell::new(20, 20), 100);
        let field = LikelihoodField::of(&grid);
        let blur = field.blur(0.1);
        let center = Point::new(1.025, 1.025);
        assert_eq!(field.at(&blur, center), 1.0);
        let aside = Point::new(1.125, 1.025);
        assert!((field.at(&blur, aside) - (-0.5_f64).exp()).abs() < 1e-9);
        let value = |x, y| field.smooth(&blur, Point::new(x, y)).0;
        let (_, slope_x, slope_y) = field.smooth(&blur, Point::new(1.11, 1.06));
        let numeric =
            ((value(1.111, 1.06) - value(1.109, 1.06)) / 2e-3, (value(1.11, 1.061) - value(1.11, 1.059)) / 2e-3);
        assert!((slope_x - numeric.0).abs() < 1e-6 && (slope_y - numeric.1).abs() < 1e-6, "{slope_x} {slope_y}");
        assert!(slope_x < 0.0 && slope_y < 0.0);
        assert_eq!(field.at(&blur, Point::new(-9.0, 0.0)), 0.0);
    }
}
