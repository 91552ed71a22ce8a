//! The part of an endless lattice of cells that a map covers so far.
//!
//! gmapping enlarges its map when the robot nears the edge: width, height and origin
//! change, the lattice does not. All cells here are counted on the lattice; the
//! window turns them into indices.

use crate::geometry::{Point, Pose};
use crate::grid::{CellRect, GridInfo, GridInfoError};

/// A rectangle of lattice cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MapWindow {
    /// One cell at the lattice's anchor: its arithmetic is the lattice's.
    lattice: GridInfo,
    /// The first column and row.
    first: (i64, i64),
    width: u32,
    height: u32,
}

impl MapWindow {
    /// The window that reaches `reach_m` to every side of a point, on the lattice
    /// with a cell corner at `anchor`.
    pub(super) fn around(center: Point, reach_m: f64, anchor: Point, resolution_m: f64) -> Result<Self, GridInfoError> {
        let lattice = GridInfo::new(1, 1, resolution_m, Pose::new(anchor.x, anchor.y, 0.0))?;
        let (x, y) = lattice.to_grid_units(center);
        let reach = (reach_m / resolution_m).ceil();
        let first = ((x - reach).floor() as i64, (y - reach).floor() as i64);
        let last = ((x + reach).floor() as i64, (y + reach).floor() as i64);
        Self { lattice, first, width: 1, height: 1 }.resized(first, last)
    }

    /// Position on the lattice in cells.
    pub(super) fn to_lattice(self, point: Point) -> (f64, f64) {
        self.lattice.to_grid_units(point)
    }

    /// Edge length of a cell in metres.
    pub(super) const fn resolution_m(&self) -> f64 {
        self.lattice.resolution_m()
    }

    /// Columns.
    pub(super) const fn width(&self) -> usize {
        self.width as usize
    }

    /// Number of cells.
    pub(super) const fn len(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// Row-major index of a lattice cell, `None` outside the window.
    #[inline]
    pub(super) fn index(&self, x: i64, y: i64) -> Option<usize> {
        let (column, row) = (x - self.first.0, y - self.first.1);
        let inside = column >= 0 && row >= 0 && column < i64::from(self.width) && row < i64::from(self.height);
        inside.then(|| row as usize * self.width as usize + column as usize)
    }

    /// The cells from `low` to `high`, which must be in the window.
    pub(super) const fn rect(&self, low: (i64, i64), high: (i64, i64)) -> CellRect {
        CellRect {
            x: (low.0 - self.first.0) as usize,
            y: (low.1 - self.first.1) as usize,
            width: (high.0 - low.0 + 1) as usize,
            height: (high.1 - low.1 + 1) as usize,
        }
    }

    /// Cells of this window by the columns and rows of a larger one.
    pub(super) const fn moved_to(&self, rect: CellRect, larger: &Self) -> CellRect {
        let (columns, rows) = (self.first.0 - larger.first.0, self.first.1 - larger.first.1);
        CellRect { x: rect.x + columns as usize, y: rect.y + rows as usize, ..rect }
    }

    /// The window as the place of a grid.
    pub(super) fn info(&self) -> Result<GridInfo, GridInfoError> {
        let corner = self.lattice.from_grid_units(self.first.0 as f64, self.first.1 as f64);
        GridInfo::new(self.width, self.height, self.resolution_m(), Pose::new(corner.x, corner.y, 0.0))
    }

    /// The window grown by multiples of `chunk` cells on the sides where it must, so
    /// that it holds the cells from `low` to `high`.
    pub(super) fn grown_to(&self, low: (i64, i64), high: (i64, i64), chunk: i64) -> Result<Self, GridInfoError> {
        let chunk = chunk.max(1);
        let whole = |missing: i64| {
            missing.max(0).div_euclid(chunk) * chunk + if missing.max(0) % chunk > 0 { chunk } else { 0 }
        };
        let last = (self.first.0 + i64::from(self.width) - 1, self.first.1 + i64::from(self.height) - 1);
        self.resized(
            (self.first.0 - whole(self.first.0 - low.0), self.first.1 - whole(self.first.1 - low.1)),
            (last.0 + whole(high.0 - last.0), last.1 + whole(high.1 - last.1)),
        )
    }

    /// The values of this window laid out for a larger one.
    pub(super) fn copy_into<T: Copy>(&self, values: &[T], larger: &Self, blank: T) -> Vec<T> {
        let mut copy = vec![blank; larger.len()];
        for (row, line) in values.chunks_exact(self.width as usize).enumerate() {
            let start = larger.index(self.first.0, self.first.1 + row as i64);
            if let Some(target) = start.and_then(|i| copy.get_mut(i..i + line.len())) {
                target.copy_from_slice(line);
            }
        }
        copy
    }

    fn resized(&self, first: (i64, i64), last: (i64, i64)) -> Result<Self, GridInfoError> {
        let size = |a: i64, b: i64| u32::try_from(b - a + 1).unwrap_or(u32::MAX);
        let window = Self { first, width: size(first.0, last.0), height: size(first.1, last.1), ..*self };
        window.info()?;
        Ok(window)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window() -> MapWindow {
        MapWindow::around(Point::new(0.01, 0.01), 0.5, Point::new(-0.02, 0.0), 0.1).unwrap()
    }

    #[test]
    fn the_first_window_lies_on_the_lattice() {
        let info = window().info().unwrap();
        assert_eq!((info.width(), info.height()), (11, 11));
        assert!((info.origin_in_map().x + 0.52).abs() < 1e-12 && (info.origin_in_map().y + 0.5).abs() < 1e-12);
    }

    #[test]
    fn it_grows_by_chunks_and_only_where_needed() {
        let old = window();
        let new = old.grown_to((-6, 0), (0, 26), 4).unwrap();
        assert_eq!((new.first, new.width, new.height), ((-9, -5), 15, 35));
        assert_eq!(old.grown_to((-5, -5), (5, 5), 4).unwrap(), old);
        let values: Vec<usize> = (0..old.len()).collect();
        let copy = old.copy_into(&values, &new, usize::MAX);
        for (x, y) in [(-5, -5), (5, 5), (0, 3)] {
            assert_eq!(copy[new.index(x, y).unwrap()], old.index(x, y).unwrap());
        }
        assert_eq!(copy[new.index(-6, 0).unwrap()], usize::MAX);
    }

    #[test]
    fn an_endless_map_is_refused() {
        let error = window().grown_to((-1_000_000, 0), (0, 1_000_000), 100).unwrap_err();
        assert!(matches!(error, GridInfoError::Size { .. }));
    }
}
