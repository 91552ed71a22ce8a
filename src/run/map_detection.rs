//! One detection on a map as a preset asks for it: the frontiers, their goals and a picture of them.

use crate::config::RobotConfig;
use crate::explore::ExplorerSettings;
use crate::frontier::{DetectError, DetectionInput, Frontier, FrontierDetector};
use crate::geometry::{Point, Pose};
use crate::grid::{Costmap, OccupancyGrid};
use crate::report::{Overlay, OverlayFrontier, ReportError, Theme};

/// What is looked at.
pub struct MapDetection<'a> {
    /// How to explore.
    pub settings: &'a ExplorerSettings,
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// Where the robot is.
    pub robot_in_map: Pose,
}

impl MapDetection<'_> {
    /// The frontiers, each with the point in the map frame that stands for it, as a detector
    /// finds them on the map and on the costmap that it is for a robot.
    ///
    /// # Errors
    /// [`DetectError`] where the question has no answer on this map.
    pub fn detect(
        &self,
        detector: &mut dyn FrontierDetector,
        robot: &RobotConfig,
    ) -> Result<Vec<(Frontier, Point)>, DetectError> {
        let costmap = Costmap::inflate(self.grid, &self.settings.thresholds, &robot.inflation());
        let input = DetectionInput { costmap: Some(&costmap), ..DetectionInput::new(self.grid, self.robot_in_map) };
        let (representative, robot) = (self.settings.goal.representative, self.robot_in_map.position());
        let with_goal = |frontier: Frontier| {
            let goal = representative.of(&frontier, self.grid.info(), robot);
            (frontier, goal)
        };
        Ok(detector.detect(&input)?.into_iter().map(with_goal).collect())
    }

    /// Frontiers and their goals on the map, as a PNG file.
    ///
    /// # Errors
    /// [`ReportError::Png`] when the encoder fails.
    pub fn draw(&self, found: &[(Frontier, Point)], theme: Theme) -> Result<Vec<u8>, ReportError> {
        let shown = found.iter().map(|(f, goal)| OverlayFrontier { cells: &f.cells, goal: Some(*goal), taboo: false });
        let overlay = Overlay {
            grid: self.grid,
            thresholds: &self.settings.thresholds,
            frontiers: &shown.collect::<Vec<_>>(),
            robot_in_map: Some(self.robot_in_map),
            region: self.settings.region.as_ref(),
            no_go: &self.settings.no_go,
            theme,
        };
        overlay.to_png()
    }
}
