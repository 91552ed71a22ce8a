//! The picture of a finished run: the final map with the way driven on it.

use super::canvas::Canvas;
use super::theme::{Ink, Theme};
use super::view::{Bounds, SizeLimits, View};
use super::{MARGIN_CELLS, ReportError};
use crate::geometry::{Point, Polygon, Pose};
use crate::grid::{OccupancyGrid, Thresholds};

/// A goal that the robot was sent to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureGoal {
    /// Where, in the map frame.
    pub point_in_map: Point,
    /// Whether it was given up.
    pub failed: bool,
}

/// What is to be shown of a run.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    /// The final map.
    pub grid: &'a OccupancyGrid,
    /// What counts as free and as occupied in it.
    pub thresholds: &'a Thresholds,
    /// The way driven, in the map frame.
    pub trajectory: &'a [Point],
    /// Where the run began.
    pub start_in_map: Option<Pose>,
    /// Where it ended.
    pub end_in_map: Option<Pose>,
    /// Where the robot was sent.
    pub goals: &'a [PictureGoal],
    /// The region to explore, if there was one.
    pub region: Option<&'a Polygon>,
    /// The areas that are not entered.
    pub no_go: &'a [Polygon],
    /// Colours.
    pub theme: Theme,
}

impl Picture<'_> {
    /// Draws it: the trajectory runs from light to dark.
    #[must_use]
    pub(super) fn draw(&self) -> Canvas {
        let known = Bounds::of_known(self.grid, MARGIN_CELLS);
        let bounds = self.trajectory.iter().fold(known, |bounds, &point| bounds.including(point));
        let mut canvas = Canvas::new(View::fit(bounds, self.grid.info().resolution_m(), SizeLimits::STILL));
        let unit = canvas.view().mark_px();
        canvas.draw_grid(self.grid, self.thresholds);
        if let Some(region) = self.region {
            canvas.outline(region, unit * 0.7, Ink::Region);
        }
        for area in self.no_go {
            canvas.outline(area, unit * 0.7, Ink::Taboo);
        }
        canvas.gradient_line(self.trajectory, unit * 0.8);
        for goal in self.goals {
            canvas.cross(goal.point_in_map, 0.9, if goal.failed { Ink::Taboo } else { Ink::Goal });
        }
        if let Some(pose) = self.start_in_map {
            canvas.start(pose.position());
        }
        if let Some(pose) = &self.end_in_map {
            canvas.robot(pose);
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
    fn a_run_is_drawn_alike_twice() {
        let grid = OccupancyGrid::from_ascii("########\n#......#\n#......#\n########").unwrap();
        let trajectory = [Point::new(1.5, 1.5), Point::new(6.5, 2.5)];
        let picture = Picture {
            grid: &grid,
            thresholds: &Thresholds::default(),
            trajectory: &trajectory,
            start_in_map: Some(Pose::new(1.5, 1.5, 0.0)),
            end_in_map: None,
            goals: &[PictureGoal { point_in_map: Point::new(5.5, 1.5), failed: true }],
            region: None,
            no_go: &[Polygon::try_from(vec![[3.0, 1.0], [4.0, 1.0], [4.0, 3.0]]).unwrap()],
            theme: Theme::Clear,
        };
        let canvas = picture.draw();
        let at = |x, y| canvas.view().pixel_at(Point::new(x, y)).and_then(|(x, y)| canvas.get(x, y));
        assert_eq!(at(6.5, 2.5), Some(Ink::along(1.0)));
        assert_eq!(at(5.5, 1.5), Some(Ink::Taboo.index()));
        assert_eq!(at(1.5, 1.5), Some(Ink::Halo.index()));
        assert_eq!(at(4.0, 2.5), Some(Ink::Taboo.index()), "the side of a no-go area");
        assert_eq!(picture.to_png().unwrap(), picture.to_png().unwrap());
    }
}
