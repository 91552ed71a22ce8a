//! Frontiers and the detectors that find them (floor 1): one file for each detector.

mod bitplane;
mod bits;
mod canny;
mod cells;
mod clusters;
mod connected;
mod contacts;
mod dbscan;
mod explore_lite;
mod fast;
mod flood;
mod found;
mod group;
mod image;
mod incremental;
mod joins;
mod labels;
mod params;
mod plane;
mod pocket;
#[cfg(test)]
#[path = "random_maps_tests.rs"]
mod random_maps;
mod reach;
mod regroup;
mod representative;
mod runs;
mod shifts;
mod spans;
mod tiles;
mod tracker;
mod union_find;
mod wavefront;
mod window;
mod yamauchi;

pub use bitplane::Bitplane;
pub use canny::{Canny, CannyParams};
pub use cells::Cells;
pub use dbscan::{Dbscan, DbscanParams};
pub use explore_lite::ExploreLiteSearch;
pub use fast::{Fast, FastParams};
pub use found::FrontierCells;
pub use image::{ImageDetector, ImageParams};
pub use incremental::Incremental;
pub use params::{DetectorParams, DetectorParamsError, Reachability};
pub use representative::Representative;
pub use tracker::{FrontierEvent, FrontierId, FrontierTracker, Tracked};
pub use wavefront::Wavefront;
pub use yamauchi::Yamauchi;

use crate::geometry::{Circle, Point, Pose};
use crate::grid::{Cell, Costmap, GridInfo, OccupancyGrid};
use crate::scan::LaserScan;
use serde::{Deserialize, Serialize};

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
    /// The frontier's size as explore_lite measures it: number of cells times the
    /// resolution, metres.
    #[must_use]
    pub fn size_m(&self, info: &GridInfo) -> f64 {
        self.cells.len() as f64 * info.resolution_m()
    }

    /// The circle of the detector, or the smallest around the cells' centres.
    #[must_use]
    pub fn enclosing_circle(&self, info: &GridInfo) -> Option<Circle> {
        self.circle.or_else(|| image::enclosing_circle(info, &self.cells))
    }

    /// The mean of the cells' centres in the map frame.
    #[must_use]
    pub fn centroid(&self, info: &GridInfo) -> Point {
        let (x, y) = self.cells.iter().fold((0.0, 0.0), |(x, y), c| (x + f64::from(c.x), y + f64::from(c.y)));
        let count = self.cells.len().max(1) as f64;
        info.from_grid_units(x / count + 0.5, y / count + 0.5)
    }
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
}

impl<'a> DetectionInput<'a> {
    /// A map and a robot alone.
    #[must_use]
    pub const fn new(grid: &'a OccupancyGrid, robot_in_map: Pose) -> Self {
        Self { grid, robot_in_map, costmap: None, scan: None }
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

    /// All frontiers, those that the robot can get to alone where [`Reachability`] asks
    /// for it, ordered by their first cell.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map.
    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError>;
}

/// The detectors by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DetectorKind {
    /// The textbook Wavefront Frontier Detector (Topiwala 2018).
    Wavefront,
    /// The same frontiers from bit planes, at the speed of memory.
    #[default]
    Bitplane,
    /// The same frontiers again, repaired where the map changed.
    Incremental,
    /// explore_lite's own: a side must be free, and corners suffice to hang together.
    ExploreLite,
    /// A scan of the whole grid (Yamauchi 1997).
    Yamauchi,
    /// Image processing with enclosing circles (Liang 2020).
    Image,
    /// Clusters by density (Alghfeli).
    Dbscan,
    /// Canny edges of the map under the costmap (Northwestern).
    Canny,
    /// The newest scan's contour and what is known already (Keidar and Kaminka 2012).
    Fast,
}

impl DetectorKind {
    /// All detectors, for tables of tests, help and benchmarks.
    pub const ALL: &'static [Self] = &[
        Self::Wavefront,
        Self::Bitplane,
        Self::Incremental,
        Self::ExploreLite,
        Self::Yamauchi,
        Self::Image,
        Self::Dbscan,
        Self::Canny,
        Self::Fast,
    ];

    /// Its name in configuration files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wavefront => "wavefront",
            Self::ExploreLite => "explore_lite",
            Self::Yamauchi => "yamauchi",
            Self::Image => "image",
            Self::Dbscan => "dbscan",
            Self::Canny => "canny",
            Self::Fast => "fast",
            Self::Bitplane => "bitplane",
            Self::Incremental => "incremental",
        }
    }

    /// A detector of this kind.
    #[must_use]
    pub fn build(self, params: &DetectorParams) -> Box<dyn FrontierDetector> {
        match self {
            Self::Wavefront => Box::new(Wavefront::new(*params)),
            Self::ExploreLite => Box::new(ExploreLiteSearch::new(*params)),
            Self::Yamauchi => Box::new(Yamauchi::new(*params)),
            Self::Image => Box::new(ImageDetector::new(*params)),
            Self::Dbscan => Box::new(Dbscan::new(*params)),
            Self::Canny => Box::new(Canny::new(*params)),
            Self::Fast => Box::new(Fast::new(*params)),
            Self::Bitplane => Box::new(Bitplane::new(*params)),
            Self::Incremental => Box::new(Incremental::new(*params)),
        }
    }
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
