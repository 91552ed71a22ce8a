//! What a detector looks at and what it finds.

use super::{Cells, FrontierCells};
use crate::geometry::{Circle, Point, Pose};
use crate::grid::{Cell, Changes, Costmap, GridInfo, OccupancyGrid};
use crate::scan::LaserScan;
use serde::Serialize;
use std::sync::Arc;

/// On which side of the boundary the cells of a frontier lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum CellSide {
    /// Unknown cells with a free neighbour (Topiwala 2018).
    Unknown,
    /// Free cells with an unknown neighbour (Yamauchi 1997).
    Free,
    /// Cells of either side (Liang 2020).
    Either,
}

/// One connected cluster of frontier cells of one grid. Cells are indices into that
/// grid: what must survive a new map is in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Frontier {
    /// Distinguishes the frontiers of a detection.
    pub id: u64,
    /// The cells in row-major order, at least one.
    pub cells: Cells,
    /// On which side of the boundary they lie.
    pub side: CellSide,
    /// A circle around it in the map frame, from the detectors that measure one.
    pub circle: Option<Circle>,
}

impl Frontier {
    /// Frontiers of unknown cells, which share the lists that hold their cells.
    #[must_use]
    pub fn all_of(lists: &Arc<FrontierCells>) -> Vec<Self> {
        let frontier = |(id, i)| Self { id, cells: Cells::of(lists, i), side: CellSide::Unknown, circle: None };
        (0..).zip(0..lists.len()).map(frontier).collect()
    }

    /// The frontier's size as explore_lite measures it: number of cells times the
    /// resolution, metres.
    #[must_use]
    pub fn size_m(&self, info: &GridInfo) -> f64 {
        self.cells.len() as f64 * info.resolution_m()
    }

    /// The circle of the detector, or the smallest around the cells' centres.
    #[must_use]
    pub fn enclosing_circle(&self, info: &GridInfo) -> Option<Circle> {
        self.circle.or_else(|| enclosing_circle(info, &self.cells))
    }

    /// The mean of the cells' centres in the map frame.
    #[must_use]
    pub fn centroid(&self, info: &GridInfo) -> Point {
        let (x, y) = self.cells.iter().fold((0.0, 0.0), |(x, y), c| (x + f64::from(c.x), y + f64::from(c.y)));
        let count = self.cells.len().max(1) as f64;
        info.from_grid_units(x / count + 0.5, y / count + 0.5)
    }
}

/// The minimum enclosing circle of the cells' centres, in the map frame.
fn enclosing_circle(info: &GridInfo, cells: &[Cell]) -> Option<Circle> {
    let mut sorted = cells.to_vec();
    sorted.sort_unstable_by_key(|cell| (cell.y, cell.x));
    // Only the ends of each row can be on the rim.
    let ends = sorted.chunk_by(|a, b| a.y == b.y).flat_map(|row| row.first().into_iter().chain(row.last()));
    let points: Vec<Point> = ends.map(|&cell| info.center(cell)).collect();
    Circle::enclosing(&points)
}

/// What a detector looks at.
#[derive(Clone, Copy, Debug)]
pub struct DetectionInput<'a> {
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// Where the robot is.
    pub robot_in_map: Pose,
    /// The costmap of the robot's navigation, or ours, if there is one; its cells need
    /// not be those of the map.
    pub costmap: Option<&'a Costmap>,
    /// The newest scan, with the lidar's pose in the map frame.
    pub scan: Option<(&'a Pose, &'a LaserScan)>,
    /// The map's version and what changed since earlier ones, for the detectors that keep
    /// something; `None` where that is not known.
    pub changes: Option<&'a Changes>,
}

impl<'a> DetectionInput<'a> {
    /// A map and a robot alone.
    #[must_use]
    pub const fn new(grid: &'a OccupancyGrid, robot_in_map: Pose) -> Self {
        Self { grid, robot_in_map, costmap: None, scan: None, changes: None }
    }
}

/// Why no detection is possible; never to be taken for "no frontier is left".
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DetectError {
    /// The robot's pose lies beyond the grid.
    #[error(
        "the robot at ({x:.2}, {y:.2}) m is outside the map of {width} x {height} cells from ({min_x:.2}, {min_y:.2}) m"
    )]
    RobotOutsideMap {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// Columns of the map.
        width: usize,
        /// Rows of the map.
        height: usize,
        /// Origin of the map, metres.
        min_x: f64,
        /// Origin of the map, metres.
        min_y: f64,
    },
    /// The robot stands in a wall or in the unknown, farther from free space than
    /// noise explains.
    #[error("no free cell lies within {radius_m} m of the robot at ({x:.2}, {y:.2}) m")]
    NoFreeCellNear {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// How far was searched, metres.
        radius_m: f64,
    },
}

/// Finds the frontiers of a grid.
pub trait FrontierDetector: Send {
    /// The detector's name in configuration files.
    fn name(&self) -> &'static str;

    /// All frontiers, those that the robot can get to alone where [`Reachability`](super::Reachability) asks
    /// for it, ordered by their first cell.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map.
    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError>;

    /// Forgets the maps seen so far, so that the next detection is one from scratch; buffers may
    /// stay. Nothing to do for detectors that keep nothing.
    fn forget(&mut self) {}
}

/// Frontiers of these cells, in order.
pub(crate) fn number(frontiers: Vec<Vec<Cell>>, side: CellSide) -> Vec<Frontier> {
    let frontier = |mut cells: Vec<Cell>| {
        cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
        Frontier { id: 0, cells: cells.into(), side, circle: None }
    };
    order(frontiers.into_iter().map(frontier).collect())
}

/// Orders frontiers by their first cell and numbers them.
pub(crate) fn order(mut frontiers: Vec<Frontier>) -> Vec<Frontier> {
    frontiers.sort_unstable_by_key(|frontier| frontier.cells.first().map(|cell| (cell.y, cell.x)));
    for (frontier, id) in frontiers.iter_mut().zip(0..) {
        frontier.id = id;
    }
    frontiers
}
