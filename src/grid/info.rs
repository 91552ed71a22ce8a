//! Where a grid lies in the world: the one place of all cell/world mathematics.

use super::Cell;
use crate::geometry::{Point, Pose, shortest_angle};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The most cells a grid may have: 16384 x 16384.
pub const MAX_CELLS: u64 = 1 << 28;
/// How large a cell may be, metres: what lies beyond is no map of a place.
const CELL_M: std::ops::RangeInclusive<f64> = 1e-3..=1e3;
/// The farthest that a grid may lie, metres: twice round the earth.
const FARTHEST_M: f64 = 1e8;
/// So far a cell may be off and be the same, as a share of it: origins are computed anew.
const SAME_CELL: f64 = 1e-3;
/// Grids farther apart than this share no lattice: no cell of either overflows when it is moved.
const FARTHEST_CELLS: f64 = 1e6;
/// So much resolutions (as a share) and rotations (radians) of one lattice may differ.
const SAME_AXES: f64 = 1e-6;
/// Where in a cell goals lie, from its corner along both axes.
const GOAL_IN_CELL: f64 = 0.55;
/// Offsets to the four cells that share a side, in a fixed order.
pub const NEIGHBOURS_4: [(i32, i32); 4] = [(1, 0), (-1, 0), (0, 1), (0, -1)];

/// Offsets to the eight cells that share a side or a corner, sides first.
pub const NEIGHBOURS_8: [(i32, i32); 8] = [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1)];

/// Which cells count as adjacent; 4 and 8 in configuration files.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "u8", into = "u8")]
#[schemars(extend("enum" = [4, 8]))]
pub enum Neighbourhood {
    /// Cells that share a side.
    Four,
    /// Cells that share a side or a corner.
    #[default]
    Eight,
}

impl Neighbourhood {
    /// The offsets to the adjacent cells.
    #[must_use]
    pub const fn offsets(self) -> &'static [(i32, i32)] {
        match self {
            Self::Four => &NEIGHBOURS_4,
            Self::Eight => &NEIGHBOURS_8,
        }
    }
}

impl TryFrom<u8> for Neighbourhood {
    type Error = String;

    fn try_from(count: u8) -> Result<Self, String> {
        match count {
            4 => Ok(Self::Four),
            8 => Ok(Self::Eight),
            _ => Err(format!("{count} neighbours: must be 4 or 8")),
        }
    }
}

impl From<Neighbourhood> for u8 {
    fn from(neighbourhood: Neighbourhood) -> Self {
        match neighbourhood {
            Neighbourhood::Four => 4,
            Neighbourhood::Eight => 8,
        }
    }
}

/// Why numbers do not describe a grid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GridInfoError {
    /// The edge length of a cell is not usable.
    #[error("resolution {0} m per cell: must be within 0.001 to 1000")]
    Resolution(f64),
    /// No cells, or more than fit in memory.
    #[error("a grid of {width} x {height} cells: must have at least 1 and at most {MAX_CELLS} cells")]
    Size {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// An origin that is not finite, or nowhere.
    #[error("grid origin ({0}, {1}, {2}): must be metres, at most {FARTHEST_M}, and finite radians")]
    Origin(f64, f64, f64),
}

/// Size, resolution and place of a grid: `nav_msgs/MapMetaData`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridInfo {
    width: u32,
    height: u32,
    resolution_m: f64,
    origin_in_map: Pose,
    cos_yaw: f64,
    sin_yaw: f64,
}

impl GridInfo {
    /// A grid of `width` x `height` cells of `resolution_m` metres, whose cell (0, 0)
    /// has its outer corner at `origin_in_map` and whose axes are turned by its yaw.
    ///
    /// # Errors
    /// [`GridInfoError`] for a size of no cells or more than [`MAX_CELLS`], cells of
    /// no size that can be, an origin that is not finite or farther than any place.
    pub fn new(width: u32, height: u32, resolution_m: f64, origin_in_map: Pose) -> Result<Self, GridInfoError> {
        let cells = u64::from(width) * u64::from(height);
        if cells == 0 || cells > MAX_CELLS {
            return Err(GridInfoError::Size { width, height });
        }
        if !CELL_M.contains(&resolution_m) {
            return Err(GridInfoError::Resolution(resolution_m));
        }
        if !origin_in_map.is_finite() || origin_in_map.x.abs().max(origin_in_map.y.abs()) > FARTHEST_M {
            return Err(GridInfoError::Origin(origin_in_map.x, origin_in_map.y, origin_in_map.yaw));
        }
        let (sin_yaw, cos_yaw) = origin_in_map.yaw.sin_cos();
        Ok(Self { width, height, resolution_m, origin_in_map, cos_yaw, sin_yaw })
    }

    /// Columns.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width as usize
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height as usize
    }

    /// Number of cells.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.width() * self.height()
    }

    /// Never: a grid has at least one cell.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        false
    }

    /// Edge length of a cell in metres.
    #[must_use]
    pub const fn resolution_m(&self) -> f64 {
        self.resolution_m
    }

    /// Area of a cell in square metres.
    #[must_use]
    pub fn cell_area_m2(&self) -> f64 {
        self.resolution_m * self.resolution_m
    }

    /// The outer corner of cell (0, 0) and the grid's rotation, in the map frame.
    #[must_use]
    pub const fn origin_in_map(&self) -> Pose {
        self.origin_in_map
    }

    /// Whether a cell belongs to the grid.
    #[must_use]
    pub const fn contains(&self, cell: Cell) -> bool {
        cell.x >= 0 && cell.y >= 0 && (cell.x as u32) < self.width && (cell.y as u32) < self.height
    }

    /// Row-major index of a cell, `None` outside the grid.
    #[must_use]
    pub const fn index(&self, cell: Cell) -> Option<usize> {
        if self.contains(cell) { Some(cell.y as usize * self.width as usize + cell.x as usize) } else { None }
    }

    /// The cell with a row-major index; of an index beyond the grid, a cell outside.
    #[must_use]
    pub const fn cell(&self, index: usize) -> Cell {
        Cell::new((index % self.width as usize) as i32, (index / self.width as usize) as i32)
    }

    /// The cells adjacent to `cell` that belong to the grid, in a fixed order.
    pub fn neighbours(&self, cell: Cell, neighbourhood: Neighbourhood) -> impl Iterator<Item = Cell> + use<> {
        let info = *self;
        neighbourhood.offsets().iter().map(move |&offset| cell.offset(offset)).filter(move |&c| info.contains(c))
    }

    /// Position in the grid's own frame in cells: (0, 0) is the origin corner, the
    /// centre of cell (x, y) is (x + 0.5, y + 0.5).
    #[must_use]
    pub fn to_grid_units(&self, point_in_map: Point) -> (f64, f64) {
        let dx = point_in_map.x - self.origin_in_map.x;
        let dy = point_in_map.y - self.origin_in_map.y;
        (
            (dx * self.cos_yaw + dy * self.sin_yaw) / self.resolution_m,
            (dy * self.cos_yaw - dx * self.sin_yaw) / self.resolution_m,
        )
    }

    /// The inverse of [`Self::to_grid_units`].
    #[must_use]
    pub fn from_grid_units(&self, x_cells: f64, y_cells: f64) -> Point {
        let (x, y) = (x_cells * self.resolution_m, y_cells * self.resolution_m);
        Point::new(
            self.origin_in_map.x + x * self.cos_yaw - y * self.sin_yaw,
            self.origin_in_map.y + x * self.sin_yaw + y * self.cos_yaw,
        )
    }

    /// The cell that holds a point of the map frame; it may lie outside the grid.
    /// Points beyond 2^30 cells are held at that bound.
    #[must_use]
    pub fn cell_at(&self, point_in_map: Point) -> Cell {
        let (x, y) = self.to_grid_units(point_in_map);
        Cell::of_units(x, y)
    }

    /// Centre of a cell in the map frame, also for cells outside the grid.
    #[must_use]
    pub fn center(&self, cell: Cell) -> Point {
        self.from_grid_units(f64::from(cell.x) + 0.5, f64::from(cell.y) + 0.5)
    }

    /// The point of a cell that is sent as a goal: a twentieth of a cell beyond the centre
    /// along both axes. GlobalPlanner takes half a cell off and truncates, so that the
    /// centre itself falls into the cell before wherever rounding has its way.
    #[must_use]
    pub fn goal_point(&self, cell: Cell) -> Point {
        self.from_grid_units(f64::from(cell.x) + GOAL_IN_CELL, f64::from(cell.y) + GOAL_IN_CELL)
    }

    /// Columns and rows by which the cells of another grid are moved in this one: whole cells of
    /// the same size along the same axes, whatever the last digits of the origins say. `None`
    /// when they lie otherwise. The cells need not lie within this grid.
    #[must_use]
    pub fn offset_of(&self, other: &Self) -> Option<(i32, i32)> {
        let is_near = |value: f64| (value - value.round()).abs() < SAME_CELL && value.abs() < FARTHEST_CELLS;
        let (dx, dy) = self.to_grid_units(other.origin_in_map.position());
        let same_size = (other.resolution_m / self.resolution_m - 1.0).abs() < SAME_AXES;
        let same_axes = shortest_angle(other.origin_in_map.yaw, self.origin_in_map.yaw).abs() < SAME_AXES;
        (same_size && same_axes && is_near(dx) && is_near(dy)).then(|| (dx.round() as i32, dy.round() as i32))
    }

    /// The column and row of the first cell of another grid, all of whose cells are such of this one
    /// too; `None` where one is not.
    #[must_use]
    pub fn corner_of(&self, other: &Self) -> Option<(usize, usize)> {
        let (x, y) = self.offset_of(other)?;
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x + other.width() <= self.width() && y + other.height() <= self.height()).then_some((x, y))
    }

    /// A length in metres as a number of cells.
    #[must_use]
    pub fn cells(&self, length_m: f64) -> f64 {
        length_m / self.resolution_m
    }
}

#[cfg(test)]
#[path = "info_tests.rs"]
mod tests;
