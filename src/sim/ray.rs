//! A straight ray through square cells, in grid units.
//!
//! Amanatides and Woo, "A Fast Voxel Traversal Algorithm for Ray Tracing"
//! (Eurographics 1987), as [`crate::grid::traverse`], with two differences: the ray
//! can be taken up at any distance along it, and every crossing is computed from the
//! start rather than summed up. Lidar and mapper so see the same crossings, bit for
//! bit, whichever cells they skip.

/// A ray: where it starts and leads, in cells.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    start: [f64; 2],
    direction: [f64; 2],
    inverse: [f64; 2],
    /// 1 or -1 along each axis.
    step: [f64; 2],
    /// From a cell's lower corner to the side where the ray leaves it, 0 or 1.
    side: [f64; 2],
}

/// A place along a ray: the cell it is in and where it leaves the cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Walk {
    /// Distance from the start at which the cell is entered, in cells.
    pub(super) entered: f64,
    /// The cell's sides at which the ray leaves its column and its row.
    border: [f64; 2],
    /// Distances from the start to those sides, in cells.
    next: [f64; 2],
}

impl Ray {
    /// A ray from a point in cells along a unit vector.
    pub(super) fn new((x, y): (f64, f64), (dx, dy): (f64, f64)) -> Self {
        let forward = |d: f64| if d < 0.0 { (-1.0, 0.0) } else { (1.0, 1.0) };
        let ((step_x, side_x), (step_y, side_y)) = (forward(dx), forward(dy));
        Self {
            start: [x, y],
            direction: [dx, dy],
            // Of a ray that never leaves its column the crossing is at +infinity,
            // also when the direction is a negative zero.
            inverse: [1.0 / (dx + 0.0), 1.0 / (dy + 0.0)],
            step: [step_x, step_y],
            side: [side_x, side_y],
        }
    }

    /// The cell at a distance along the ray, in cells, and the way on from there.
    #[inline]
    pub(super) fn at(&self, distance: f64) -> (i64, i64, Walk) {
        let x = floor(self.start[0] + self.direction[0] * distance);
        let y = floor(self.start[1] + self.direction[1] * distance);
        let border = [x + self.side[0], y + self.side[1]];
        let next = [self.crossing(0, border[0]), self.crossing(1, border[1])];
        (x as i64, y as i64, Walk { entered: distance, border, next })
    }

    /// The point at a distance along the ray, in cells.
    pub(super) fn point(&self, distance: f64) -> (f64, f64) {
        (self.start[0] + self.direction[0] * distance, self.start[1] + self.direction[1] * distance)
    }

    /// Whether it stays within a tolerance, in cells, of a border between columns or between
    /// rows for a length.
    pub(super) fn follows_border(&self, length: f64, tolerance: f64) -> bool {
        let near_border = |x: f64| (x - floor(x + tolerance)).abs() <= tolerance;
        let mut axes = self.direction.iter().zip(&self.start);
        axes.any(|(direction, &start)| (direction * length).abs() <= tolerance && near_border(start))
    }

    /// 1 or -1: the next column, the next row.
    pub(super) fn steps(&self) -> (isize, isize) {
        (self.step[0] as isize, self.step[1] as isize)
    }

    /// Goes on to the next cell; true when that is the next column's, false when it
    /// is the next row's.
    #[inline(always)]
    pub(super) fn advance(&self, walk: &mut Walk) -> bool {
        let column = walk.next[0] < walk.next[1];
        if column {
            walk.entered = walk.next[0];
            walk.border[0] += self.step[0];
            walk.next[0] = self.crossing(0, walk.border[0]);
        } else {
            walk.entered = walk.next[1];
            walk.border[1] += self.step[1];
            walk.next[1] = self.crossing(1, walk.border[1]);
        }
        column
    }

    #[inline(always)]
    fn crossing(&self, axis: usize, border: f64) -> f64 {
        (border - self.start[axis]) * self.inverse[axis]
    }
}

/// The largest whole number not above another. `f64::floor` is a call into the C
/// library on processors of the baseline, and this is where the time goes.
#[inline(always)]
fn floor(x: f64) -> f64 {
    let whole = x as i64 as f64;
    if whole > x { whole - 1.0 } else { whole }
}

impl Walk {
    /// Distance from the start at which the ray leaves the cell, in cells.
    #[inline(always)]
    pub(super) fn left(&self) -> f64 {
        self.next[0].min(self.next[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Cell, Traversal};
    use proptest::prelude::*;

    #[test]
    fn a_border_is_followed_by_rays_on_it_alone() {
        let follows = |start, yaw: f64| Ray::new(start, (yaw.cos(), yaw.sin())).follows_border(40.0, 1e-9);
        let (up, along) = (std::f64::consts::FRAC_PI_2, 0.0);
        assert!(follows((3.0, 0.5), up) && follows((3.0 - 1e-12, 0.5), -up) && follows((0.5, -2.0 + 1e-12), along));
        assert!(!follows((3.0, 0.5), along) && !follows((3.0, 0.5), up + 1e-6) && !follows((3.5, 2.0), up));
    }

    proptest! {
        #[test]
        fn passes_the_cells_that_the_textbook_passes(
            x in -5.0f64..5.0, y in -5.0f64..5.0, heading in -4.0f64..4.0, length in 0.0f64..60.0,
        ) {
            let (sin, cos) = heading.sin_cos();
            let ray = Ray::new((x, y), (cos, sin));
            let (mut cx, mut cy, mut walk) = ray.at(0.0);
            for (cell, entered) in Traversal::new((x, y), (cos, sin), length) {
                prop_assert_eq!(Cell::new(cx as i32, cy as i32), cell);
                prop_assert!((walk.entered - entered).abs() < 1e-9);
                let (step_x, step_y) = ray.steps();
                if ray.advance(&mut walk) { cx += step_x as i64 } else { cy += step_y as i64 }
            }
        }
    }

    #[test]
    fn level_and_upright_rays_keep_their_row_and_column() {
        for (direction, expected) in
            [((1.0, 0.0), (3, 0)), ((-1.0, -0.0), (-3, 0)), ((0.0, 1.0), (0, 3)), ((-0.0, -1.0), (0, -3))]
        {
            let ray = Ray::new((0.5, 0.5), direction);
            let (mut x, mut y, mut walk) = ray.at(0.0);
            for _ in 0..3 {
                if ray.advance(&mut walk) { x += ray.steps().0 as i64 } else { y += ray.steps().1 as i64 }
            }
            assert_eq!((x, y), expected);
        }
    }
}
