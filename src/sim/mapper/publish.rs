//! The map as others see it.

use super::{Mapper, MapperError};
use crate::grid::{CellRect, Growth, Live, OccupancyGrid, Snapshot};
use crate::sim::MapStyle;
use std::sync::Arc;

impl Mapper {
    /// The map as it is known now.
    ///
    /// # Errors
    /// Never for a map that was made and grown without one.
    pub fn map(&self) -> Result<OccupancyGrid, MapperError> {
        let info = self.window.info()?;
        let mut grid = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
        self.write(&mut grid, &CellRect::of(&info));
        Ok(grid)
    }

    /// The same from the map that was published last, with what changed since. O(cells around the
    /// scans since then), and a copy if somebody still reads all maps of before.
    ///
    /// # Errors
    /// As [`Self::map`].
    pub fn publish(&mut self) -> Result<Snapshot<OccupancyGrid>, MapperError> {
        let info = self.window.info()?;
        let touched = std::mem::take(&mut self.touched);
        let published = match self.published.take() {
            Some(mut live) if *live.newest().info() == info => {
                if !touched.is_empty() {
                    live.change(touched, |grid| self.write(grid, &touched));
                }
                live
            }
            Some(mut live) => {
                match Growth::of(live.newest().info(), &info) {
                    Some(growth) => live.grow(&growth, touched, 0, |grid, part| self.write(grid, part)),
                    None => live.replace_unlike(Arc::new(self.map()?)),
                }
                live
            }
            None => Live::new(Arc::new(self.map()?)),
        };
        Ok(self.published.insert(published).snapshot())
    }

    /// Writes the values of the cells of a part that are seen. A map is published every second:
    /// for a simple value this is arithmetic on many cells at a time.
    fn write(&self, grid: &mut OccupancyGrid, part: &CellRect) {
        match self.config.style {
            MapStyle::Gmapping => {
                let (occupied, free) = (OccupancyGrid::OCCUPIED, OccupancyGrid::FREE);
                self.write_as(grid, part, |log_odds| if log_odds > 0.0 { occupied } else { free });
            }
            MapStyle::Cartographer => {
                self.write_as(grid, part, |log_odds| (100.0 / (1.0 + (-log_odds).exp())).round() as i8);
            }
        }
    }

    #[inline(always)]
    fn write_as(&self, grid: &mut OccupancyGrid, part: &CellRect, value: impl Fn(f32) -> i8) {
        let (rows, columns) = (part.rows(grid.info()), part.columns(grid.info()));
        let width = grid.info().width();
        let lines = grid.data_mut().chunks_exact_mut(width).zip(self.cells.chunks_exact(width));
        for (slots, cells) in lines.skip(rows.start).take(rows.len()) {
            for (slot, cell) in slots[columns.clone()].iter_mut().zip(&cells[columns.clone()]) {
                *slot = if cell.mark == 0 { OccupancyGrid::UNKNOWN } else { value(cell.log_odds) };
            }
        }
    }
}
