//! The ground truth that the simulated robot lives in.
//!
//! Stage's view of a map: every cell that is not free is a solid block, unknown cells
//! and everything outside the map too. Two fields are prepared once: the distance to
//! the nearest solid cell (Felzenszwalb and Huttenlocher 2012, exact), which answers
//! collision checks, and how far a ray may leap from a cell without meeting anything,
//! which makes ray casting fast and leaves it exact.

use super::ray::Ray;
use crate::geometry::{Point, Pose};
use crate::grid::{Cell, CellState, GridInfo, GridInfoError, OccupancyGrid, Thresholds, squared_distance_cells};

/// Why a map cannot be lived in, or not from this start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// No cell is free.
    #[error("the world of {width} x {height} cells has no free cell: must have at least one")]
    NoFreeCell {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The map with a solid rim around it is too large.
    #[error(transparent)]
    Info(#[from] GridInfoError),
    /// A start that is no finite pose.
    #[error("the start ({x}, {y}, {yaw}): must be finite metres and radians")]
    StartNotFinite {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// Radians.
        yaw: f64,
    },
    /// The start lies beyond the map.
    #[error("the start ({x:.2}, {y:.2}) m lies outside the world")]
    StartOutside {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
    },
    /// The robot does not fit where it shall start.
    #[error(
        "the start ({x:.2}, {y:.2}) m has {clearance_m:.3} m to the nearest solid cell: the robot needs more than {needed_m:.3} m"
    )]
    StartBlocked {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// Metres from the start's cell to the nearest solid one, centre to centre.
        clearance_m: f64,
        /// Metres that suffice: the inscribed radius of the footprint, or its
        /// circumscribed one where the heading at the start is what does not fit.
        needed_m: f64,
    },
}

/// Half a cell's diagonal for the ray's start, half for the solid cell, and a little
/// for rounding, in cells.
const LEAP_SLACK: f64 = 1.5;

/// A world of solid and free cells.
#[derive(Clone, Debug)]
pub struct World {
    info: GridInfo,
    /// Columns of the fields below, which have a solid rim one cell wide around.
    stride: usize,
    /// Squared distance to the nearest solid cell, in cells.
    clearance: Vec<u32>,
    /// 0 in solid cells, else 1 + the cells that a ray may leap from anywhere in it.
    leap: Vec<u8>,
    free_cells: usize,
}

impl World {
    /// A world from a ground truth map.
    ///
    /// # Errors
    /// [`WorldError`] for a map without a free cell or too large for a rim.
    pub fn new(truth: &OccupancyGrid, thresholds: &Thresholds) -> Result<Self, WorldError> {
        let info = *truth.info();
        let (width, height) = (info.width(), info.height());
        let rimmed = GridInfo::new(width as u32 + 2, height as u32 + 2, info.resolution_m(), info.origin_in_map())?;
        let stride = rimmed.width();
        let mut solid = vec![true; rimmed.len()];
        for (index, &value) in truth.data().iter().enumerate() {
            let inner = (index / width + 1) * stride + index % width + 1;
            solid[inner] = thresholds.classify(value) != CellState::Free;
        }
        let free_cells = solid.iter().filter(|&&s| !s).count();
        if free_cells == 0 {
            return Err(WorldError::NoFreeCell { width, height });
        }
        let clearance = squared_distance_cells(&rimmed, |i| solid[i]);
        let leap = clearance.iter().map(|&squared| leap_of(squared)).collect();
        Ok(Self { info, stride, clearance, leap, free_cells })
    }

    /// Size, resolution and place.
    #[must_use]
    pub const fn info(&self) -> &GridInfo {
        &self.info
    }

    /// Number of free cells.
    #[must_use]
    pub const fn free_cells(&self) -> usize {
        self.free_cells
    }

    /// Whether a cell is solid; outside the world all are.
    #[must_use]
    pub fn is_solid(&self, cell: Cell) -> bool {
        self.clearance_squared_cells(cell) == 0
    }

    /// Squared distance in cells from a cell to the nearest solid one, centre to
    /// centre; 0 in solid cells and outside.
    #[must_use]
    pub fn clearance_squared_cells(&self, cell: Cell) -> u32 {
        if !self.info.contains(cell) {
            return 0;
        }
        let index = (cell.y as usize + 1) * self.stride + cell.x as usize + 1;
        self.clearance.get(index).copied().unwrap_or(0)
    }

    /// Distance in metres from the cell that holds a point to the nearest solid
    /// cell, centre to centre: what a costmap of the same map measures.
    #[must_use]
    pub fn clearance_m(&self, point: Point) -> f64 {
        f64::from(self.clearance_squared_cells(self.info.cell_at(point))).sqrt() * self.info.resolution_m()
    }

    /// Whether a disc of this radius can stand with its centre in a cell: the rule of
    /// [`crate::grid::Costmap::is_passable`] on the ground truth.
    #[must_use]
    pub fn disc_fits(&self, cell: Cell, radius_m: f64) -> bool {
        f64::from(self.clearance_squared_cells(cell)).sqrt() * self.info.resolution_m() > radius_m
    }

    /// The centre of the free cell that is farthest from all solid ones, the first of
    /// several in row-major order: where a robot starts that is not told where.
    #[must_use]
    pub fn most_open_spot(&self) -> Pose {
        let cells = (0..self.info.len()).map(|index| self.info.cell(index));
        let most_open = cells.max_by_key(|&cell| (self.clearance_squared_cells(cell), -cell.y, -cell.x));
        let center = self.info.center(most_open.unwrap_or(Cell::new(0, 0)));
        Pose::new(center.x, center.y, 0.0)
    }

    /// Distance in metres along a heading at which a ray enters the first solid cell,
    /// if that is at most `limit_m`; 0 from within one.
    #[must_use]
    pub fn cast(&self, from: Point, heading_rad: f64, limit_m: f64) -> Option<f64> {
        let (sin, cos) = (heading_rad - self.info.origin_in_map().yaw).sin_cos();
        let resolution_m = self.info.resolution_m();
        let entered = self.cast_cells(self.info.to_grid_units(from), (cos, sin), limit_m / resolution_m)?;
        let distance_m = entered * resolution_m;
        (distance_m <= limit_m).then_some(distance_m)
    }

    /// The same in grid units: a start in cells, a unit vector, a limit in cells. The
    /// limit is generous by a rounding error.
    pub(super) fn cast_cells(&self, start: (f64, f64), direction: (f64, f64), limit: f64) -> Option<f64> {
        let ray = Ray::new(start, direction);
        let (step_x, step_y) = ray.steps();
        let row = step_y * self.stride as isize;
        let limit = limit * (1.0 + 1e-12);
        let mut distance = 0.0;
        loop {
            let (x, y, mut walk) = ray.at(distance);
            if x < -1 || y < -1 || x > self.info.width() as i64 || y > self.info.height() as i64 {
                return Some(distance);
            }
            let mut index = (y + 1) as usize * self.stride + (x + 1) as usize;
            loop {
                match self.leap.get(index).copied().unwrap_or(0) {
                    0 if walk.entered > limit => return None,
                    0 => return Some(walk.entered),
                    leap if leap >= LEAP_WORTHWHILE => {
                        // A ray along a border may be put back by rounding: it must get on.
                        distance = walk.entered.max(distance) + f64::from(leap - 1);
                        break;
                    }
                    _ => index = index.wrapping_add_signed(if ray.advance(&mut walk) { step_x } else { row }),
                }
            }
            if distance > limit {
                return None;
            }
        }
    }
}

/// Below this a step is cheaper than a leap.
const LEAP_WORTHWHILE: u8 = 4;

fn leap_of(clearance_squared: u32) -> u8 {
    if clearance_squared == 0 {
        return 0;
    }
    let open = (f64::from(clearance_squared).sqrt() - LEAP_SLACK).clamp(0.0, 254.0);
    1 + open as u8
}

#[cfg(test)]
#[path = "world_tests.rs"]
mod tests;
