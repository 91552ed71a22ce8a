//! A rectangle of new values: `map_msgs/OccupancyGridUpdate`.

use super::{Cell, CellRect, GridInfo, Live, OccupancyGrid, changed_rect};

/// A rectangle of cells, lowest row first, to be laid on a grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GridPatch {
    /// Its lower left cell.
    pub corner: Cell,
    /// Cells to the right.
    pub width: u32,
    /// Cells upward.
    pub height: u32,
    /// `width * height` values, row by row.
    pub data: Vec<i8>,
}

/// A patch that does not fit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GridPatchError {
    /// Width and height do not tell how many values there are.
    #[error("an update of {width} x {height} cells with {values} values: must be width times height")]
    Length {
        /// As given.
        width: u32,
        /// As given.
        height: u32,
        /// How many values came.
        values: usize,
    },
    /// It reaches over the border.
    #[error(
        "an update of {width} x {height} cells at ({x}, {y}) does not lie in the grid of {grid_width} x {grid_height}"
    )]
    Outside {
        /// Lower left cell.
        x: i32,
        /// Lower left cell.
        y: i32,
        /// As given.
        width: u32,
        /// As given.
        height: u32,
        /// The grid's.
        grid_width: usize,
        /// The grid's.
        grid_height: usize,
    },
}

impl OccupancyGrid {
    /// Lays a rectangle of new values on the grid.
    ///
    /// # Errors
    /// [`GridPatchError`] when it does not fit; the grid is then as before.
    pub fn apply(&mut self, patch: &GridPatch) -> Result<(), GridPatchError> {
        let rect = patch.place_in(self.info())?;
        self.lay(patch, &rect);
        Ok(())
    }

    /// Writes a patch where it lies.
    fn lay(&mut self, patch: &GridPatch, rect: &CellRect) {
        if rect.is_empty() {
            return;
        }
        let grid_width = self.info().width();
        let rows = self.data_mut().chunks_exact_mut(grid_width).skip(rect.y);
        for (row, new) in rows.zip(patch.data.chunks_exact(rect.width)) {
            if let Some(part) = row.get_mut(rect.x..rect.x + rect.width) {
                part.copy_from_slice(new);
            }
        }
    }
}

impl GridPatch {
    /// Where it lies in a grid.
    ///
    /// # Errors
    /// [`GridPatchError`] when it does not fit.
    fn place_in(&self, info: &GridInfo) -> Result<CellRect, GridPatchError> {
        let Self { corner: Cell { x, y }, width, height, .. } = *self;
        if u64::from(width) * u64::from(height) != self.data.len() as u64 {
            return Err(GridPatchError::Length { width, height, values: self.data.len() });
        }
        let (grid_width, grid_height) = (info.width(), info.height());
        let fits = |from: i32, length: u32, limit: usize| {
            usize::try_from(from).is_ok_and(|from| from + length as usize <= limit)
        };
        if !(fits(x, width, grid_width) && fits(y, height, grid_height)) {
            return Err(GridPatchError::Outside { x, y, width, height, grid_width, grid_height });
        }
        Ok(CellRect { x: x as usize, y: y as usize, width: width as usize, height: height as usize })
    }

    /// The smallest rectangle of `new` that holds all in which it differs from `old`, a grid
    /// of the same size; `None` where they are equal.
    #[must_use]
    pub fn difference(old: &OccupancyGrid, new: &OccupancyGrid) -> Option<Self> {
        let CellRect { x, y, width, height } = changed_rect(old, new)?;
        let rows = new.data().chunks_exact(new.info().width()).skip(y).take(height);
        Some(Self {
            corner: Cell::new(x as i32, y as i32),
            width: width as u32,
            height: height as u32,
            data: rows.flat_map(|row| &row[x..x + width]).copied().collect(),
        })
    }
}

impl Live<OccupancyGrid> {
    /// The next version: the newest state with a rectangle of new values laid on it. O(cells of
    /// the rectangle), where an earlier state is not read any longer.
    ///
    /// # Errors
    /// [`GridPatchError`] when it does not fit; then there is no new version.
    pub fn apply(&mut self, patch: &GridPatch) -> Result<(), GridPatchError> {
        let rect = patch.place_in(self.newest().info())?;
        self.change(rect, |grid| grid.lay(patch, &rect));
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::GridInfo;

    fn grid() -> OccupancyGrid {
        OccupancyGrid::filled(GridInfo::new(4, 3, 0.05, Pose::default()).unwrap(), -1)
    }

    fn patch(x: i32, y: i32, width: u32, height: u32) -> GridPatch {
        GridPatch { corner: Cell::new(x, y), width, height, data: (0..(width * height) as i8).collect() }
    }

    #[test]
    fn rows_do_not_shear() {
        let mut grid = grid();
        grid.apply(&patch(1, 1, 2, 2)).unwrap();
        assert_eq!(grid.data(), [-1, -1, -1, -1, -1, 0, 1, -1, -1, 2, 3, -1]);
        grid.apply(&patch(0, 0, 0, 2)).unwrap();
        grid.apply(&patch(0, 0, 4, 3)).unwrap();
        assert_eq!(grid.data(), [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]);
    }

    #[test]
    fn a_difference_laid_on_the_old_grid_gives_the_new_one() {
        let old = grid();
        assert_eq!(GridPatch::difference(&old, &old), None);
        let mut new = old.clone();
        new.set(Cell::new(1, 2), 100);
        new.set(Cell::new(3, 1), 0);
        let difference = GridPatch::difference(&old, &new).unwrap();
        assert_eq!((difference.corner, difference.width, difference.height), (Cell::new(1, 1), 3, 2));
        let mut patched = old;
        patched.apply(&difference).unwrap();
        assert_eq!(patched, new);
    }

    #[test]
    fn what_does_not_fit_changes_nothing() {
        let mut unchanged = grid();
        for (x, y, w, h) in [(-1, 0, 2, 2), (3, 0, 2, 1), (0, 2, 1, 2), (0, -1, 1, 1), (i32::MAX, 0, 1, 1)] {
            assert!(matches!(unchanged.apply(&patch(x, y, w, h)), Err(GridPatchError::Outside { .. })), "{x} {y}");
        }
        let short = GridPatch { data: vec![0; 3], ..patch(0, 0, 2, 2) };
        let error = unchanged.apply(&short).unwrap_err().to_string();
        assert_eq!(error, "an update of 2 x 2 cells with 3 values: must be width times height");
        assert_eq!(unchanged, grid());
    }
}
