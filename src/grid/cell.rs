//! A cell of a grid.

/// Cells farther than this from the origin are held there.
const FARTHEST: i32 = 1 << 30;

/// A cell by column and row; it may lie outside a given grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Cell {
    /// Column, from the grid's origin along its x axis.
    pub x: i32,
    /// Row, from the grid's origin along its y axis.
    pub y: i32,
}

impl Cell {
    /// A cell by column and row.
    #[must_use]
    pub const fn new(x: i32, y: i32) -> Self {
        Self { x, y }
    }

    /// The cell that holds a position in cells. One beyond 2^30 cells is held at that bound, so that
    /// the cells beside it, and distances to others, have numbers too.
    #[must_use]
    pub(crate) fn of_units(x_cells: f64, y_cells: f64) -> Self {
        Self { x: floor(x_cells), y: floor(y_cells) }
    }

    /// The cell at an offset from this one.
    #[must_use]
    pub const fn offset(self, (dx, dy): (i32, i32)) -> Self {
        Self { x: self.x + dx, y: self.y + dy }
    }

    /// Squared Euclidean distance to another cell, in cells.
    #[must_use]
    pub const fn distance_squared(self, other: Self) -> i64 {
        let (dx, dy) = ((self.x - other.x) as i64, (self.y - other.y) as i64);
        dx * dx + dy * dy
    }
}

/// The largest whole number that is not greater, held within [`FARTHEST`]: as `value.floor() as i32`,
/// without a call into the mathematics library.
fn floor(value: f64) -> i32 {
    let truncated = (value as i32).clamp(1 - FARTHEST, FARTHEST - 1);
    if f64::from(truncated) > value { truncated - 1 } else { truncated }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floors_are_those_of_the_library() {
        let extreme = [f64::NAN, -1e9, 1e9];
        for value in (-40..40).map(|i| f64::from(i) * 0.25).chain(extreme) {
            assert_eq!(floor(value), value.floor() as i32, "{value}");
        }
    }

    #[test]
    fn the_farthest_cells_have_neighbours_and_distances() {
        let places = [-1e300, f64::NEG_INFINITY, -3e9, 3e9, f64::from(i32::MIN) - 0.5, f64::INFINITY, 1e300];
        for (x, y) in places.iter().flat_map(|&x| places.map(|y| (x, y))) {
            let cell = Cell::of_units(x, y);
            assert_eq!(cell.offset((1, -1)).offset((-1, 1)), cell);
            for (u, v) in places.iter().flat_map(|&u| places.map(|v| (u, v))) {
                assert!(cell.distance_squared(Cell::of_units(u, v)) >= 0);
            }
        }
    }
}
