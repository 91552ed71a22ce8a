//! Frontiers by image processing, each with its minimum enclosing circle.
//!
//! Liang, Wang and Li, "Autonomous Exploration Based on Image Processing" (2020), eqs.
//! 1 to 6: the obstacle layer is eroded with a rectangle B, which widens the obstacles
//! of the map (M_e); a cell of M_e is a frontier point when a step between free and
//! unknown lies between it and its left or lower neighbour; the frontier points are
//! dilated with B, and each connected component of the result is a frontier with the
//! minimum enclosing circle of its cells. O(cells of the grid) whatever the size of B.
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

use super::plane::{OCCUPIED, OPEN, Plane, UNKNOWN, group, set_cells};
use super::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, order};
use crate::geometry::{Circle, Point};
use crate::grid::{Cell, GridInfo};
use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// Half of B in cells, where the resolution would ask for more: what a byte counts.
const MAX_HALF_CELLS: f64 = 254.0;

/// Parameters of the image processing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ImageParams {
    /// Side of the square structuring element B, metres.
    pub element_m: f64,
}

impl Default for ImageParams {
    fn default() -> Self {
        Self { element_m: 0.3 }
    }
}

impl ImageParams {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        let side = self.element_m;
        OutOfRange::unless((0.0..=5.0).contains(&side), "detector.image.element_m", side, "within 0 to 5 m")
    }

    /// How far B reaches to each side of its centre, cells.
    fn half_cells(&self, info: &GridInfo) -> u8 {
        info.cells(0.5 * self.element_m).round().clamp(0.0, MAX_HALF_CELLS) as u8
    }
}

/// The detector.
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
        let plane = Plane::of(input, &self.params)?;
        let info = *plane.info();
        let half = self.params.image.half_cells(&info);
        // Eroding S is dilating its complement, the obstacles.
        let mut obstacles: Vec<bool> = plane.states().iter().map(|&state| state == OCCUPIED).collect();
        dilate(&mut obstacles, info.width(), half);
        let is_point = frontier_points(&plane, &obstacles);
        let mut dilated = is_point.clone();
        dilate(&mut dilated, info.width(), half);
        let cells = set_cells(&info, &dilated);
        let min_cells = self.params.min_cells(&info);
        let frontiers = group(&info, &cells, self.params.neighbours).into_iter().map(|component| {
            let circle = enclosing_circle(&info, &component);
            let is_point = |cell: &Cell| info.index(*cell).is_some_and(|index| is_point[index]);
            let cells: Vec<Cell> = component.into_iter().filter(is_point).collect();
            Frontier { id: 0, cells, side: CellSide::Either, circle }
        });
        Ok(order(frontiers.filter(|f| f.cells.len() >= min_cells).collect()))
    }
}

/// Eq. 5: whether there is a step between open and unknown to the left of or below each
/// cell, row-major.
fn frontier_points(plane: &Plane, obstacles: &[bool]) -> Vec<bool> {
    let width = plane.info().width();
    let widened = |(&state, &blocked): (&u8, &bool)| if blocked { OCCUPIED } else { state };
    let m_e: Vec<u8> = plane.states().iter().zip(obstacles).map(widened).collect();
    let is_step = |a: u8, b: u8| ((a == OPEN) & (b == UNKNOWN)) | ((a == UNKNOWN) & (b == OPEN));
    let mut points = vec![false; m_e.len()];
    for (points, row) in points.chunks_exact_mut(width).zip(m_e.chunks_exact(width)) {
        let right = row.get(1..).unwrap_or_default();
        for ((point, &left), &here) in points.get_mut(1..).unwrap_or_default().iter_mut().zip(row).zip(right) {
            *point = is_step(left, here);
        }
    }
    let above = points.get_mut(width..).unwrap_or_default().iter_mut();
    for ((point, &here), &below) in above.zip(m_e.get(width..).unwrap_or_default()).zip(&m_e) {
        *point |= is_step(below, here);
    }
    points
}

/// Dilates a mask with rows of `width` with a square that reaches `half` cells to each
/// side, along the rows and then along the columns.
fn dilate(mask: &mut [bool], width: usize, half: u8) {
    let reach = usize::from(half);
    let mut row_before = vec![false; width];
    for row in mask.chunks_exact_mut(width) {
        row_before.copy_from_slice(row);
        let mut done = 0;
        for (x, _) in row_before.iter().enumerate().filter(|(_, set)| **set) {
            let end = (x + reach + 1).min(width);
            row[x.saturating_sub(reach).max(done)..end].fill(true);
            done = end;
        }
    }
    // For how many more rows each column stays set, upwards and then downwards; what
    // was set on the way up is no source on the way down.
    let mut down = mask.to_vec();
    spread(mask.chunks_exact_mut(width), width, half);
    spread(down.chunks_exact_mut(width).rev(), width, half);
    for (cell, &from_above) in mask.iter_mut().zip(&down) {
        *cell |= from_above;
    }
}

/// Sets each cell that comes at most `half` rows after a set one.
fn spread<'a>(rows: impl Iterator<Item = &'a mut [bool]>, width: usize, half: u8) {
    let mut left = vec![0u8; width];
    for row in rows {
        for (cell, left) in row.iter_mut().zip(&mut left) {
            *left = if *cell { half + 1 } else { left.saturating_sub(1) };
            *cell = *left > 0;
        }
    }
}

/// The minimum enclosing circle of the cells' centres, in the map frame.
pub(super) fn enclosing_circle(info: &GridInfo, cells: &[Cell]) -> Option<Circle> {
    let mut sorted = cells.to_vec();
    sorted.sort_unstable_by_key(|cell| (cell.y, cell.x));
    // Only the ends of each row can be on the rim.
    let ends = sorted.chunk_by(|a, b| a.y == b.y).flat_map(|row| row.first().into_iter().chain(row.last()));
    let points: Vec<Point> = ends.map(|&cell| info.center(cell)).collect();
    Circle::enclosing(&points)
}

#[cfg(test)]
#[path = "image_tests.rs"]
mod tests;
