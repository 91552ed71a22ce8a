//! The occupancy grid: `nav_msgs/OccupancyGrid` without its header.

use super::{Cell, CellState, GridInfo, Thresholds};
use crate::geometry::Point;

/// Data that does not fill the grid it came with.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("an occupancy grid of {width} x {height} cells came with {len} values: must be {expected}")]
pub struct GridError {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Values given.
    pub len: usize,
    /// Values needed.
    pub expected: usize,
}

/// Percent occupied for each cell, row-major from the origin: -1 unknown, 0..=100.
#[derive(Clone, Debug, PartialEq)]
pub struct OccupancyGrid {
    info: GridInfo,
    data: Vec<i8>,
}

impl OccupancyGrid {
    /// The value of a cell that was never seen.
    pub const UNKNOWN: i8 = -1;
    /// The value of a cell that is surely free.
    pub const FREE: i8 = 0;
    /// The value of a cell that is surely occupied.
    pub const OCCUPIED: i8 = 100;

    /// A grid from its place and `width * height` values.
    ///
    /// # Errors
    /// [`GridError`] when the number of values is another.
    pub fn new(info: GridInfo, data: Vec<i8>) -> Result<Self, GridError> {
        if data.len() == info.len() {
            Ok(Self { info, data })
        } else {
            Err(GridError { width: info.width(), height: info.height(), len: data.len(), expected: info.len() })
        }
    }

    /// A grid of as many values as it has cells.
    pub(super) const fn of(info: GridInfo, data: Vec<i8>) -> Self {
        Self { info, data }
    }

    /// A grid with one value everywhere.
    #[must_use]
    pub fn filled(info: GridInfo, value: i8) -> Self {
        Self { info, data: vec![value; info.len()] }
    }

    /// A grid drawn in ASCII, for tests and examples: `.` free, `#` occupied, `?`
    /// unknown, any other character free; the first line is the highest y. Cells are
    /// 1 m and the origin is (0, 0). Short lines are filled with unknown.
    #[must_use]
    pub fn from_ascii(drawing: &str) -> Option<Self> {
        let lines: Vec<&str> = drawing.lines().map(str::trim).filter(|l| !l.is_empty()).collect();
        let width = lines.iter().map(|l| l.chars().count()).max()?;
        let info = GridInfo::new(width as u32, lines.len() as u32, 1.0, crate::geometry::Pose::default()).ok()?;
        let mut grid = Self::filled(info, Self::UNKNOWN);
        for (y, line) in lines.iter().rev().enumerate() {
            for (x, symbol) in line.chars().enumerate() {
                let value = match symbol {
                    '#' => Self::OCCUPIED,
                    '?' => Self::UNKNOWN,
                    _ => Self::FREE,
                };
                grid.set(Cell::new(x as i32, y as i32), value);
            }
        }
        Some(grid)
    }

    /// Size, resolution and place.
    #[must_use]
    pub const fn info(&self) -> &GridInfo {
        &self.info
    }

    /// All values, row-major.
    #[must_use]
    pub fn data(&self) -> &[i8] {
        &self.data
    }

    /// All values for writing, row-major.
    #[must_use]
    pub fn data_mut(&mut self) -> &mut [i8] {
        &mut self.data
    }

    /// The value of a cell, `None` outside.
    #[must_use]
    pub fn get(&self, cell: Cell) -> Option<i8> {
        self.info.index(cell).and_then(|i| self.data.get(i)).copied()
    }

    /// Sets a cell; outside the grid nothing happens.
    pub fn set(&mut self, cell: Cell, value: i8) {
        if let Some(slot) = self.info.index(cell).and_then(|i| self.data.get_mut(i)) {
            *slot = value;
        }
    }

    /// The kind of territory in a cell; outside the grid is unknown.
    #[must_use]
    pub fn state(&self, cell: Cell, thresholds: &Thresholds) -> CellState {
        self.get(cell).map_or(CellState::Unknown, |value| thresholds.classify(value))
    }

    /// The kind of territory at a point of the map frame; outside is unknown.
    #[must_use]
    pub fn state_at(&self, point_in_map: Point, thresholds: &Thresholds) -> CellState {
        self.state(self.info.cell_at(point_in_map), thresholds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;

    #[test]
    fn the_last_drawn_line_is_row_zero() {
        let grid = OccupancyGrid::from_ascii("?#\n..").unwrap();
        assert_eq!(grid.data(), &[0, 0, -1, 100]);
        assert_eq!(grid.get(Cell::new(1, 1)), Some(100));
        assert_eq!(grid.get(Cell::new(2, 0)), None);
    }

    #[test]
    fn data_must_fill_the_grid() {
        let info = GridInfo::new(3, 2, 1.0, Pose::default()).unwrap();
        let error = OccupancyGrid::new(info, vec![0; 5]).unwrap_err();
        assert_eq!(error.to_string(), "an occupancy grid of 3 x 2 cells came with 5 values: must be 6");
    }
}
