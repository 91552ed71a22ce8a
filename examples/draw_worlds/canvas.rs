//! A floor plan in metres, drawn into an occupancy grid.
//!
//! Everything is unknown until a floor is laid. Rectangles go from their lower left
//! corner to their upper right one; edges fall on the nearest cell border.

use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Cell, GridInfo, GridInfoError, OccupancyGrid};

/// Edge length of a cell in metres.
pub const RESOLUTION_M: f64 = 0.05;

/// A plan in the making.
pub struct Canvas {
    grid: OccupancyGrid,
    half_wall_m: f64,
}

impl Canvas {
    /// An unknown place of this size in metres, with its lower left corner at (0, 0);
    /// walls are drawn `wall_m` thick.
    pub fn new(width_m: f64, height_m: f64, wall_m: f64) -> Result<Self, GridInfoError> {
        let info = GridInfo::new(cells(width_m) as u32, cells(height_m) as u32, RESOLUTION_M, Pose::default())?;
        let grid = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
        Ok(Self { grid, half_wall_m: 0.5 * wall_m })
    }

    /// A building: floor inside, a wall of `wall_m` around it that belongs to the
    /// rectangle.
    pub fn building(&mut self, [x0, y0, x1, y1]: [f64; 4], wall_m: f64) {
        self.fill([x0, y0, x1, y1], OccupancyGrid::OCCUPIED);
        self.floor([x0 + wall_m, y0 + wall_m, x1 - wall_m, y1 - wall_m]);
    }

    /// Free floor, also to break a niche into a wall.
    pub fn floor(&mut self, corners: [f64; 4]) {
        self.fill(corners, OccupancyGrid::FREE);
    }

    /// A wall along a horizontal or vertical line, half its thickness to either side.
    pub fn wall(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.fill(self.line(from, to), OccupancyGrid::OCCUPIED);
    }

    /// An opening in a wall along a part of its line.
    pub fn door(&mut self, from: (f64, f64), to: (f64, f64)) {
        self.fill(self.line(from, to), OccupancyGrid::FREE);
    }

    /// A piece of furniture: lower left corner, then width and depth.
    pub fn block(&mut self, x: f64, y: f64, width: f64, depth: f64) {
        self.fill([x, y, x + width, y + depth], OccupancyGrid::OCCUPIED);
    }

    /// A round piece of furniture.
    pub fn disc(&mut self, x: f64, y: f64, radius: f64) {
        let reach = cells(radius) + 1;
        for row in cells(y) - reach..cells(y) + reach {
            for column in cells(x) - reach..cells(x) + reach {
                let centre = self.grid.info().center(Cell::new(column, row));
                if nalgebra::distance(&centre, &Point::new(x, y)) <= radius {
                    self.grid.set(Cell::new(column, row), OccupancyGrid::OCCUPIED);
                }
            }
        }
    }

    /// The finished plan.
    pub fn finish(self) -> OccupancyGrid {
        self.grid
    }

    /// The rectangle of a wall: as long as its line, as wide as walls are.
    fn line(&self, from: (f64, f64), to: (f64, f64)) -> [f64; 4] {
        let half = self.half_wall_m;
        if (from.0 - to.0).abs() < (from.1 - to.1).abs() {
            [from.0 - half, from.1, to.0 + half, to.1]
        } else {
            [from.0, from.1 - half, to.0, to.1 + half]
        }
    }

    fn fill(&mut self, [x0, y0, x1, y1]: [f64; 4], value: i8) {
        for row in cells(y0)..cells(y1) {
            for column in cells(x0)..cells(x1) {
                self.grid.set(Cell::new(column, row), value);
            }
        }
    }
}

/// Metres as a number of cells.
fn cells(metres: f64) -> i32 {
    (metres / RESOLUTION_M).round() as i32
}
