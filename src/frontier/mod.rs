//! Frontiers and the detectors that find them (floor 1): one file for each detector.

mod bitplane;
mod flood;
mod params;
mod representative;
mod runs;
mod wavefront;

pub use bitplane::Bitplane;
pub use params::{DetectorParams, DetectorParamsError, Reachability};
pub use representative::Representative;
pub use wavefront::Wavefront;

use crate::geometry::{Point, Pose};
use crate::grid::{Cell, GridInfo, OccupancyGrid};
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
    pub cells: Vec<Cell>,
    /// On which side of the boundary they lie.
    pub side: CellSide,
}

impl Frontier {
    /// The frontier's size as explore_lite measures it: number of cells times the
    /// resolution, metres.
    #[must_use]
    pub fn size_m(&self, info: &GridInfo) -> f64 {
        self.cells.len() as f64 * info.resolution_m()
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

    /// All frontiers that the robot can get to, ordered by their first cell.
    ///
    /// # Errors
    /// [`DetectError`] when the question has no answer on this map.
    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError>;
}

/// The detectors by name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DetectorKind {
    /// The textbook Wavefront Frontier Detector.
    Wavefront,
    /// The same frontiers from bit planes, at the speed of memory.
    #[default]
    Bitplane,
}

impl DetectorKind {
    /// All detectors, for tables of tests, help and benchmarks.
    pub const ALL: &'static [Self] = &[Self::Wavefront, Self::Bitplane];

    /// Its name in configuration files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Wavefront => "wavefront",
            Self::Bitplane => "bitplane",
        }
    }

    /// A detector of this kind.
    #[must_use]
    pub fn build(self, params: &DetectorParams) -> Box<dyn FrontierDetector> {
        match self {
            Self::Wavefront => Box::new(Wavefront::new(*params)),
            Self::Bitplane => Box::new(Bitplane::new(*params)),
        }
    }
}

/// Orders frontiers by their first cell and numbers them.
pub(crate) fn number(mut frontiers: Vec<Vec<Cell>>, side: CellSide) -> Vec<Frontier> {
    for cells in &mut frontiers {
        cells.sort_unstable_by_key(|cell| (cell.y, cell.x));
    }
    frontiers.sort_unstable_by_key(|cells| cells.first().map(|cell| (cell.y, cell.x)));
    frontiers.into_iter().zip(0..).map(|(cells, id)| Frontier { id, cells, side }).collect()
}
