//! The picture of one detection: a map with its frontiers and their goals.

use super::canvas::Canvas;
use super::theme::{Ink, Theme};
use super::view::{Bounds, SizeLimits, View};
use super::{MARGIN_CELLS, ReportError};
use crate::geometry::{Point, Polygon, Pose};
use crate::grid::{Cell, OccupancyGrid, Thresholds};

/// A frontier to be shown.
#[derive(Clone, Copy, Debug)]
pub struct OverlayFrontier<'a> {
    /// Its cells, of the grid that is drawn.
    pub cells: &'a [Cell],
    /// The point to drive to for it, in the map frame.
    pub goal: Option<Point>,
    /// Whether it is left alone.
    pub taboo: bool,
}

/// What is to be shown of a detection.
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// What counts as free and as occupied in it.
    pub thresholds: &'a Thresholds,
    /// The frontiers, those on top last.
    pub frontiers: &'a [OverlayFrontier<'a>],
    /// The robot, if it is known where it is.
    pub robot_in_map: Option<Pose>,
    /// The region to explore, if there is one.
    pub region: Option<&'a Polygon>,
    /// The areas that are not entered.
    pub no_go: &'a [Polygon],
    /// Colours.
    pub theme: Theme,
}

impl Overlay<'_> {
    /// Draws it.
    #[must_use]
    pub(super) fn draw(&self) -> Canvas {
        let mut bounds = Bounds::of_known(self.grid, MARGIN_CELLS);
        if let Some(pose) = self.robot_in_map {
            bounds = bounds.including(pose.position());
        }
        let info = self.grid.info();
        let mut canvas = Canvas::new(View::fit(bounds, info.resolution_m(), SizeLimits::STILL));
        canvas.draw_grid(self.grid, self.thresholds);
        for frontier in self.frontiers {
            let ink = if frontier.taboo { Ink::Taboo } else { Ink::Frontier };
            canvas.fill_cells(info, frontier.cells.iter().copied(), ink);
        }
        if let Some(region) = self.region {
            canvas.outline(region, canvas.view().mark_px() * 0.7, Ink::Region);
        }
        for area in self.no_go {
            canvas.outline(area, canvas.view().mark_px() * 0.7, Ink::Taboo);
        }
        if let Some(pose) = &self.robot_in_map {
            canvas.robot(pose);
        }
        // A thousand goals need smaller crosses than ten.
        let size = 1.4 * (40.0 / self.frontiers.len().max(1) as f64).sqrt().clamp(0.3, 1.0);
        for frontier in self.frontiers {
            let ink = if frontier.taboo { Ink::Taboo } else { Ink::Goal };
            if let Some(goal) = frontier.goal {
                canvas.cross(goal, size, ink);
            }
        }
        canvas
    }

    /// Draws it as a PNG file.
    ///
    /// # Errors
    /// [`ReportError::Png`] when the encoder fails.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        self.draw().to_png(self.theme)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frontiers_and_goals_are_where_they_belong() {
        let grid = OccupancyGrid::from_ascii("?????????\n?.......?\n?.......?\n?.......?").unwrap();
        let (top, left) = ([Cell::new(2, 2), Cell::new(3, 2)], [Cell::new(1, 0)]);
        let frontiers = [
            OverlayFrontier { cells: &top, goal: Some(Point::new(6.5, 1.5)), taboo: false },
            OverlayFrontier { cells: &left, goal: None, taboo: true },
        ];
        let overlay = Overlay {
            grid: &grid,
            thresholds: &Thresholds::default(),
            frontiers: &frontiers,
            robot_in_map: None,
            region: None,
            no_go: &[],
            theme: Theme::Clear,
        };
        let canvas = overlay.draw();
        let at = |x, y| canvas.view().pixel_at(Point::new(x, y)).and_then(|(x, y)| canvas.get(x, y));
        assert_eq!(at(2.5, 2.5), Some(Ink::Frontier.index()));
        assert_eq!(at(1.5, 0.5), Some(Ink::Taboo.index()));
        assert_eq!(at(6.5, 1.5), Some(Ink::Goal.index()));
        let decoded = image::load_from_memory(&overlay.to_png().unwrap()).unwrap().to_rgb8();
        let (x, y) = canvas.view().pixel_at(Point::new(2.5, 2.5)).unwrap();
        assert_eq!(decoded.get_pixel(x as u32, y as u32).0, Theme::Clear.color(Ink::Frontier));
    }
}
