//! A rectangle of cells.

use super::{Cell, GridInfo};
use std::ops::Range;

/// The part of a grid that a `map_msgs/OccupancyGridUpdate` covers: from column `x` and
/// row `y`, `width` columns and `height` rows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CellRect {
    /// The first column.
    pub x: usize,
    /// The first row.
    pub y: usize,
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
}

impl CellRect {
    /// All of a grid.
    #[must_use]
    pub const fn of(info: &GridInfo) -> Self {
        Self { x: 0, y: 0, width: info.width(), height: info.height() }
    }

    /// A single cell; `None` where its column or row is negative.
    #[must_use]
    pub fn of_cell(cell: Cell) -> Option<Self> {
        let (x, y) = (usize::try_from(cell.x).ok()?, usize::try_from(cell.y).ok()?);
        Some(Self { x, y, width: 1, height: 1 })
    }

    /// The cells of a grid that lie at most so many columns and rows from one, which may lie outside.
    #[must_use]
    pub fn around(center: Cell, cells: i32, info: &GridInfo) -> Self {
        let span = |at: i32, size: usize| {
            let end = at.saturating_add(cells).saturating_add(1).clamp(0, size as i32);
            let start = at.saturating_sub(cells).clamp(0, end);
            (start as usize, (end - start) as usize)
        };
        let ((x, width), (y, height)) = (span(center.x, info.width()), span(center.y, info.height()));
        Self { x, y, width, height }
    }

    /// The smallest rectangle that holds this one and another; one without cells counts
    /// for nothing.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return if self.is_empty() { other } else { self };
        }
        let (x, y) = (self.x.min(other.x), self.y.min(other.y));
        let right = (self.x.saturating_add(self.width)).max(other.x.saturating_add(other.width));
        let top = (self.y.saturating_add(self.height)).max(other.y.saturating_add(other.height));
        Self { x, y, width: right - x, height: top - y }
    }

    /// The same cells by the columns and rows of another grid, in which they lie so many columns
    /// and rows further on; those outside of it are left out.
    #[must_use]
    pub fn moved(self, (dx, dy): (i32, i32), info: &GridInfo) -> Self {
        let within = |from: usize, length: usize, by: i32, limit: usize| {
            let clamp = |at: i64| at.clamp(0, limit as i64) as usize;
            (clamp(from as i64 + i64::from(by)), clamp((from + length) as i64 + i64::from(by)))
        };
        let (left, right) = within(self.x, self.width, dx, info.width());
        let (bottom, top) = within(self.y, self.height, dy, info.height());
        Self { x: left, y: bottom, width: right - left, height: top - bottom }
    }

    /// With so many cells more on every side, as far as there are any; one without cells stays so.
    #[must_use]
    pub fn grown(self, cells: usize, info: &GridInfo) -> Self {
        if self.is_empty() {
            return self;
        }
        let (x, y) = (self.x.saturating_sub(cells), self.y.saturating_sub(cells));
        let right = (self.x + self.width + cells).min(info.width());
        let top = (self.y + self.height + cells).min(info.height());
        Self { x, y, width: right - x, height: top - y }
    }

    /// Whether it has no cell.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.width == 0 || self.height == 0
    }

    /// Its columns within a grid.
    #[must_use]
    pub fn columns(&self, info: &GridInfo) -> Range<usize> {
        let end = self.x.saturating_add(self.width).min(info.width());
        self.x.min(end)..end
    }

    /// Its rows within a grid.
    #[must_use]
    pub fn rows(&self, info: &GridInfo) -> Range<usize> {
        let end = self.y.saturating_add(self.height).min(info.height());
        self.y.min(end)..end
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;

    #[test]
    fn what_lies_around_a_cell_ends_with_the_grid() {
        let info = GridInfo::new(9, 7, 1.0, Pose::default()).unwrap();
        let around = |x, y, cells| CellRect::around(Cell::new(x, y), cells, &info);
        assert_eq!(around(4, 3, 1), CellRect { x: 3, y: 2, width: 3, height: 3 });
        assert_eq!(around(-1, 6, 2), CellRect { x: 0, y: 4, width: 2, height: 3 });
        assert_eq!(around(4, 3, i32::MAX), CellRect::of(&info));
        assert!([around(-3, 3, 2), around(4, 9, 2), around(i32::MIN, i32::MAX, 5)].iter().all(CellRect::is_empty));
    }

    #[test]
    fn rows_and_columns_stay_within_the_grid() {
        let info = GridInfo::new(130, 20, 1.0, Pose::default()).unwrap();
        let rect = |x, y, width, height| CellRect { x, y, width, height };
        assert_eq!(CellRect::of(&info).rows(&info), 0..20);
        assert_eq!((rect(63, 3, 2, 4).rows(&info), rect(63, 3, 2, 4).columns(&info)), (3..7, 63..65));
        assert_eq!((rect(64, 19, 99, 9).rows(&info), rect(64, 19, 99, 9).columns(&info)), (19..20, 64..130));
        let far = rect(usize::MAX, usize::MAX, usize::MAX, usize::MAX);
        assert!(far.rows(&info).is_empty() && far.columns(&info).is_empty());
        assert_eq!(rect(5, 6, 2, 2).union(rect(1, 7, 3, 9)), rect(1, 6, 6, 10));
        assert_eq!(rect(5, 6, 2, 2).union(rect(1, 7, 0, 9)), rect(5, 6, 2, 2));
        assert_eq!(rect(5, 6, 9, 2).moved((-7, 3), &info), rect(0, 9, 7, 2));
        assert_eq!(rect(125, 18, 9, 2).moved((3, 5), &info), rect(128, 20, 2, 0));
    }
}
