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

use super::plane::{OCCUPIED, OPEN, Plane, UNKNOWN, group};
use super::{CellSide, DetectError, DetectionInput, DetectorParams, Frontier, FrontierDetector, order};
use crate::geometry::{Circle, Point};
use crate::grid::{Cell, GridInfo};
use crate::range::OutOfRange;
use image::{GrayImage, Luma};
use imageproc::distance_transform::Norm;
use imageproc::morphology::dilate_mut;
use serde::{Deserialize, Serialize};

/// Set in a mask.
const SET: u8 = 255;
/// Half of B in cells where the resolution would ask for more: what imageproc holds.
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
        let mut obstacles = mask(&info, plane.rows().flat_map(|row| row.iter().map(|&s| s == OCCUPIED)));
        dilate(&mut obstacles, half);
        let points = frontier_points(&plane, &obstacles);
        let mut is_point = vec![false; info.len()];
        for index in points.iter().filter_map(|&p| info.index(p)) {
            is_point[index] = true;
        }
        let mut dilated = mask(&info, is_point.iter().copied());
        dilate(&mut dilated, half);
        let cells: Vec<Cell> = set_cells(&info, &dilated);
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

/// Eq. 5: the cells with a step between open and unknown to the left or below.
fn frontier_points(plane: &Plane, obstacles: &GrayImage) -> Vec<Cell> {
    let width = plane.info().width();
    let states = |(row, wide): (&[u8], &[u8])| -> Vec<u8> {
        row.iter().zip(wide).map(|(&state, &blocked)| if blocked == SET { OCCUPIED } else { state }).collect()
    };
    let is_step = |a: u8, b: u8| (a == OPEN && b == UNKNOWN) || (a == UNKNOWN && b == OPEN);
    let mut points = Vec::new();
    let mut below: Vec<u8> = Vec::new();
    for (row, y) in plane.rows().zip(obstacles.as_raw().chunks_exact(width)).map(states).zip(0..) {
        let mut left = OCCUPIED;
        for (x, &here) in row.iter().enumerate() {
            if is_step(left, here) || below.get(x).is_some_and(|&lower| is_step(lower, here)) {
                points.push(Cell::new(x as i32, y));
            }
            left = here;
        }
        below = row;
    }
    points
}

/// A picture of the grid, row 0 first: the operations used here do not mind that a
/// viewer would show it upside down.
fn mask(info: &GridInfo, is_set: impl Iterator<Item = bool>) -> GrayImage {
    let mut image = GrayImage::new(info.width() as u32, info.height() as u32);
    for (pixel, set) in image.pixels_mut().zip(is_set) {
        *pixel = Luma([if set { SET } else { 0 }]);
    }
    image
}

/// Dilates with a square that reaches `half` cells to each side.
fn dilate(mask: &mut GrayImage, half: u8) {
    // Where nothing is set imageproc takes width + height for the distance, and a small
    // picture comes out full.
    if half > 0 && mask.as_raw().contains(&SET) {
        dilate_mut(mask, Norm::LInf, half);
    }
}

fn set_cells(info: &GridInfo, mask: &GrayImage) -> Vec<Cell> {
    let set = mask.as_raw().iter().enumerate().filter(|(_, pixel)| **pixel == SET);
    set.map(|(index, _)| info.cell(index)).collect()
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
