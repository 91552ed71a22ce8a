//! Which cells a straight ray passes, exactly and in order.
//!
//! Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing"
//! (Eurographics 1987). Unlike Bresenham's line, no cell that the ray touches in
//! its interior is left out. O(1) per cell, no allocation.

use super::{Cell, GridInfo};
use crate::geometry::Point;

/// Iterator over the cells of a ray: see [`traverse`].
#[derive(Clone, Debug)]
pub struct Traversal {
    cell: Cell,
    step: (i32, i32),
    /// Ray parameter in cells at which the next column or row begins.
    next: (f64, f64),
    /// Ray parameter in cells from one column or row to the next.
    delta: (f64, f64),
    /// Ray parameter in cells at which the current cell was entered.
    entered: f64,
    length: f64,
    done: bool,
}

/// The cells from a point along a heading, up to a length in metres, each with the
/// distance in metres at which the ray enters it. Cells outside the grid are
/// reported too: the caller decides where the world ends.
pub fn traverse(info: &GridInfo, from_in_map: Point, heading_in_map_rad: f64, length_m: f64) -> Traversal {
    let (x, y) = info.to_grid_units(from_in_map);
    let (sin, cos) = (heading_in_map_rad - info.origin_in_map().yaw).sin_cos();
    Traversal::new((x, y), (cos, sin), info.cells(length_m))
}

impl Traversal {
    /// A ray in grid units: start in cells, unit direction, length in cells.
    #[must_use]
    pub fn new((x, y): (f64, f64), (dx, dy): (f64, f64), length: f64) -> Self {
        let axis = |position: f64, direction: f64| {
            let cell = position.floor();
            if direction > 0.0 {
                (1, (cell + 1.0 - position) / direction, 1.0 / direction)
            } else if direction < 0.0 {
                (-1, (cell - position) / direction, -1.0 / direction)
            } else {
                (0, f64::INFINITY, f64::INFINITY)
            }
        };
        let (step_x, next_x, delta_x) = axis(x, dx);
        let (step_y, next_y, delta_y) = axis(y, dy);
        Self {
            cell: Cell::of_units(x, y),
            step: (step_x, step_y),
            next: (next_x, next_y),
            delta: (delta_x, delta_y),
            entered: 0.0,
            length,
            done: !(length >= 0.0 && length.is_finite()),
        }
    }
}

impl Iterator for Traversal {
    /// The cell, and how far along the ray it is entered, in cells.
    type Item = (Cell, f64);

    #[inline]
    fn next(&mut self) -> Option<(Cell, f64)> {
        if self.done {
            return None;
        }
        let item = (self.cell, self.entered);
        if self.next.0 < self.next.1 {
            self.entered = self.next.0;
            self.next.0 += self.delta.0;
            self.cell.x = self.cell.x.wrapping_add(self.step.0);
        } else {
            self.entered = self.next.1;
            self.next.1 += self.delta.1;
            self.cell.y = self.cell.y.wrapping_add(self.step.1);
        }
        self.done = self.entered > self.length;
        Some(item)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use proptest::prelude::*;

    #[test]
    fn a_level_ray_passes_one_row() {
        let info = GridInfo::new(10, 10, 0.5, Pose::default()).unwrap();
        let cells: Vec<_> = traverse(&info, Point::new(0.25, 0.25), 0.0, 1.6).collect();
        assert_eq!(
            cells,
            [(Cell::new(0, 0), 0.0), (Cell::new(1, 0), 0.5), (Cell::new(2, 0), 1.5), (Cell::new(3, 0), 2.5)]
        );
    }

    #[test]
    fn a_ray_without_length_or_with_a_bad_one_ends() {
        assert_eq!(Traversal::new((0.5, 0.5), (1.0, 0.0), 0.0).count(), 1);
        assert_eq!(Traversal::new((0.5, 0.5), (1.0, 0.0), f64::NAN).count(), 0);
        assert_eq!(Traversal::new((0.5, 0.5), (1.0, 0.0), f64::INFINITY).count(), 0);
    }

    proptest! {
        #[test]
        fn cells_are_adjacent_and_lie_on_the_ray(
            x in -5.0f64..5.0, y in -5.0f64..5.0, heading in -4.0f64..4.0, length in 0.0f64..40.0,
        ) {
            let (sin, cos) = heading.sin_cos();
            let cells: Vec<_> = Traversal::new((x, y), (cos, sin), length).collect();
            for pair in cells.windows(2) {
                let (a, b) = (pair[0].0, pair[1].0);
                prop_assert_eq!((a.x - b.x).abs() + (a.y - b.y).abs(), 1);
                // The middle of the stretch inside a cell lies in that cell.
                let middle = 0.5 * (pair[0].1 + pair[1].1);
                if pair[1].1 - pair[0].1 > 1e-9 {
                    prop_assert_eq!(a.x, (x + cos * middle).floor() as i32);
                    prop_assert_eq!(a.y, (y + sin * middle).floor() as i32);
                }
            }
            let end = cells.last().map(|c| c.1).unwrap_or_default();
            prop_assert!(end <= length && length - end <= 1.5);
        }
    }
}
