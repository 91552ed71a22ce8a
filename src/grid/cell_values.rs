//! Grids of one value a cell, and where two of them differ.

use super::{CellRect, Costmap, GridInfo, Growth, OccupancyGrid, UNKNOWN_COST};

/// One value a cell, row by row.
pub trait CellValues: Clone {
    /// Of what kind the values are.
    type Value: Copy + PartialEq;

    /// The value of a cell that nobody has seen.
    const UNKNOWN: Self::Value;

    /// Values for each cell of a grid, row-major.
    fn of_values(info: GridInfo, values: Vec<Self::Value>) -> Self;

    /// Size and place.
    fn info(&self) -> &GridInfo;

    /// All values, row-major.
    fn values(&self) -> &[Self::Value];

    /// All values for writing, row-major.
    fn values_mut(&mut self) -> &mut [Self::Value];

    /// Takes over the values of a rectangle of another state of the same size.
    fn copy_rect(&mut self, from: &Self, rect: &CellRect) {
        let info = *from.info();
        let (rows, columns) = (rect.rows(&info), rect.columns(&info));
        let width = info.width();
        let lines = self.values_mut().chunks_exact_mut(width).zip(from.values().chunks_exact(width));
        for (to, from) in lines.skip(rows.start).take(rows.len()) {
            to[columns.clone()].copy_from_slice(&from[columns.clone()]);
        }
    }
}

impl CellValues for OccupancyGrid {
    type Value = i8;

    const UNKNOWN: i8 = Self::UNKNOWN;

    fn of_values(info: GridInfo, values: Vec<i8>) -> Self {
        Self::of(info, values)
    }

    fn info(&self) -> &GridInfo {
        self.info()
    }

    fn values(&self) -> &[i8] {
        self.data()
    }

    fn values_mut(&mut self) -> &mut [i8] {
        self.data_mut()
    }
}

impl CellValues for Costmap {
    type Value = u8;

    const UNKNOWN: u8 = UNKNOWN_COST;

    fn of_values(info: GridInfo, values: Vec<u8>) -> Self {
        Self::of(info, values)
    }

    fn info(&self) -> &GridInfo {
        self.info()
    }

    fn values(&self) -> &[u8] {
        self.costs()
    }

    fn values_mut(&mut self) -> &mut [u8] {
        self.costs_mut()
    }
}

/// The smallest rectangle that holds all cells in which two states of one size differ; `None`
/// where they are equal.
pub fn changed_rect<T: CellValues>(old: &T, new: &T) -> Option<CellRect> {
    Growth::none(new.info()).changed([old.values(), new.values()], &CellRect::of(new.info()))
}
