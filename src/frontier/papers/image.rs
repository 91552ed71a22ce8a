//! Frontiers by image processing, each with its minimum enclosing circle.
//!
//! Liang, Wang and Li, "Autonomous Exploration Based on Image Processing" (2020), eqs.
//! 1 to 6: the obstacle layer is eroded with a rectangle B, which widens the obstacles
//! of the map (M_e); a cell of M_e is a frontier point when a step between free and
//! unknown lies between it and its left or lower neighbour; the frontier points are
//! dilated with B, and each connected component of the result is a frontier with the
//! minimum enclosing circle of its cells. O(cells of the grid), on planes of bits, and for
//! each cell of half of B a small part of that.
//!
//! | parameter | unit | paper |
//! |---|---|---|
//! | `element_m` | side of the square B, metres | not said |
//! | `neighbours` | what is connected after the dilation | not said; 8 is OpenCV's default |
//!
//! The cells of a frontier are its points of eq. 5, on either side of the boundary. The
//! circle is that of the dilated component, between centres of cells, and so has a
//! radius of about half of B at least. B has an odd number of cells: its half is
//! rounded. The paper takes 65 as free (`occupied_min: 66, free_max: 65`). With
//! [`Reachability::WallsBlock`](super::Reachability) only steps at free cells
//! connected to the robot's count; obstacles are not widened for that connection.

use crate::bits::BitPlane;
use crate::bits::runs::Run;
use crate::frontier::papers::territory::{Territory, components, with_neighbours};
use crate::frontier::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, order};
use crate::geometry::{Circle, Point};
use crate::grid::{Cell, GridInfo, Neighbourhood};

/// The detector.
///
/// Each frontier comes with the circle that [`RadiusDistance`](crate::selection::RadiusDistance)
/// weighs. B is one cell here; of a boundary the cells on its right or upper side count:
///
/// ```
/// use frontier_explorer::frontier::{CellSide, DetectionInput, DetectorParams, FrontierDetector, ImageDetector};
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::grid::OccupancyGrid;
///
/// let grid = OccupancyGrid::from_ascii(
///     "...??
///      ...??
///      ...??",
/// ).unwrap();
/// let input = DetectionInput::new(&grid, Pose::new(0.5, 1.5, 0.0));
/// let found = ImageDetector::new(DetectorParams::default()).detect(&input)?;
/// let circle = found[0].circle.unwrap();
/// assert_eq!((found.len(), found[0].cells.len(), found[0].side), (1, 3, CellSide::Either));
/// assert_eq!((circle.center, circle.radius_m), (Point::new(3.5, 1.5), 1.0));
/// # Ok::<(), frontier_explorer::frontier::DetectError>(())
/// ```
#[derive(Clone, Debug)]
pub struct ImageDetector {
    params: DetectorParams,
}

impl ImageDetector {
    /// A detector with these parameters.
    #[must_use]
    pub const fn new(params: DetectorParams) -> Self {
        Self { params }
    }
}

impl FrontierDetector for ImageDetector {
    fn name(&self) -> &'static str {
        "image"
    }

    fn detect(&mut self, input: &DetectionInput<'_>) -> Result<Vec<Frontier>, DetectError> {
        let info = input.grid.info();
        let territory = Territory::of(input, &self.params)?;
        let half = self.params.image.half_cells(info);
        // Eroding S is dilating its complement, the obstacles.
        let obstacles = dilated(&territory.planes.occupied(), half);
        let mut open = territory.open;
        let mut unknown = territory.planes.unknown().clone();
        open.subtract(&obstacles);
        unknown.subtract(&obstacles);
        let points = frontier_points(&open, &unknown);
        let min_cells = self.params.min_cells(info);
        let frontiers = components(&dilated(&points, half), self.params.neighbours).into_iter().map(|component| {
            let circle = circle_of_runs(info, &component);
            Frontier { id: 0, cells: set_cells(&points, &component).into(), side: CellSide::Either, circle }
        });
        Ok(order(frontiers.filter(|f| f.cells.len() >= min_cells).collect()))
    }
}

/// Eq. 5: the cells with a step between open and unknown to the left of or below them.
fn frontier_points(open: &BitPlane, unknown: &BitPlane) -> BitPlane {
    let mut points = BitPlane::new(open.width(), open.height());
    for y in 0..points.height() {
        let (open_row, unknown_row) = (open.row(y), unknown.row(y));
        let (mut open_left, mut unknown_left) = (0, 0);
        for ((point, &open), &unknown) in points.row_mut(y).iter_mut().zip(open_row).zip(unknown_row) {
            *point = open & (unknown << 1 | unknown_left >> 63) | unknown & (open << 1 | open_left >> 63);
            (open_left, unknown_left) = (open, unknown);
        }
        let Some(below) = y.checked_sub(1) else { continue };
        let below = open.row(below).iter().zip(unknown.row(below));
        let here = points.row_mut(y).iter_mut().zip(open_row.iter().zip(unknown_row));
        for ((point, (open, unknown)), (open_below, unknown_below)) in here.zip(below) {
            *point |= open & unknown_below | unknown & open_below;
        }
    }
    points
}

/// A plane dilated with a square that reaches `half` cells to each side.
fn dilated(plane: &BitPlane, half: u8) -> BitPlane {
    let grown = |plane: BitPlane, _| with_neighbours(&plane, Neighbourhood::Eight);
    (0..half).fold(plane.clone(), grown)
}

/// The set cells among those of runs, row-major.
fn set_cells(plane: &BitPlane, runs: &[(usize, Run)]) -> Vec<Cell> {
    let mut cells = Vec::new();
    for &(y, run) in runs {
        let mut from = run.start as usize;
        while let Some(x) = plane.first_in(y, from..run.end as usize) {
            cells.push(Cell::new(x as i32, y as i32));
            from = x + 1;
        }
    }
    cells
}

/// The minimum enclosing circle of the centres of a component's cells, in the map frame.
fn circle_of_runs(info: &GridInfo, runs: &[(usize, Run)]) -> Option<Circle> {
    // Only the ends of each row can be on the rim.
    let rows = runs.chunk_by(|a, b| a.0 == b.0).filter_map(|row| row.first().zip(row.last()));
    let ends = rows.flat_map(|(&(y, first), &(_, last))| [first.start, last.end - 1].map(|x| (x, y)));
    let points: Vec<Point> = ends.map(|(x, y)| info.center(Cell::new(x as i32, y as i32))).collect();
    Circle::enclosing(&points)
}

mod params;
#[cfg(test)]
#[path = "image_tests.rs"]
mod tests;

pub use params::ImageParams;
