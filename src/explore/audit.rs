//! The check before every end: is really nothing left?
//!
//! A preset sees frontiers with its own detector, drops those below its own size and keeps
//! its own list of what failed; nothing of this may make a run end `complete`. The audit
//! asks the textbook's question of the raw map: unknown cells beside free ones that hang
//! together with the robot, longer than the robot is wide.

use super::traits::RobotTraits;
use crate::frontier::{
    Bitplane, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, Reachability,
};
use crate::geometry::Pose;
use crate::grid::{Costmap, Inflation, Neighbourhood, OccupancyGrid, Thresholds};
use crate::planning::{Driven, Fence, PathField};
use crate::robot::MapSnapshot;
use std::sync::Arc;

/// Looks at the raw map with the textbook's eyes.
#[derive(Debug)]
pub struct Audit {
    detector: Bitplane,
    thresholds: Thresholds,
    passage_radius_m: f64,
    min_size_m: f64,
}

impl Audit {
    /// An audit for a robot.
    #[must_use]
    pub fn new(robot: &RobotTraits, thresholds: Thresholds) -> Self {
        let footprint = &robot.body.footprint;
        let min_size_m = 2.0 * footprint.passage_radius_m();
        let params = DetectorParams {
            neighbours: Neighbourhood::Eight,
            reachability: Reachability::WallsBlock,
            min_size_m,
            thresholds,
            ..DetectorParams::default()
        };
        let passage_radius_m = footprint.passage_radius_m();
        Self { detector: Bitplane::new(params), thresholds, passage_radius_m, min_size_m }
    }

    /// The length from which on a frontier counts, metres.
    #[must_use]
    pub const fn min_size_m(&self) -> f64 {
        self.min_size_m
    }

    /// The frontiers that are longer than the robot is wide.
    ///
    /// # Errors
    /// [`DetectError`] when the map gives no answer.
    pub fn frontiers(&mut self, map: &MapSnapshot, robot: Pose) -> Result<Vec<Frontier>, DetectError> {
        self.detector.detect(&DetectionInput { changes: Some(&map.changes), ..DetectionInput::new(&map.grid, robot) })
    }

    /// Where the robot could get to if it needed no room beside its body, neither padding
    /// nor room to turn, and kept to its areas; `None` where it stands in an obstacle.
    #[must_use]
    pub fn widest_reach(
        &self,
        grid: &OccupancyGrid,
        driven: &Driven,
        fence: &mut Fence,
        robot: &Pose,
    ) -> Option<PathField> {
        let inflation = Inflation {
            inscribed_radius_m: self.passage_radius_m,
            clear_radius_m: 0.0,
            inflation_radius_m: 0.0,
            cost_scaling_factor: 1.0,
        };
        let costmap = Arc::new(Costmap::inflate(grid, &self.thresholds, &inflation));
        PathField::reach_only(fence.close(&driven.open(&costmap, robot), robot), robot).ok()
    }
}
