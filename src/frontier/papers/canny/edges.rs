//! Canny's edge detector (IEEE PAMI 1986) at chosen cells of a picture, in integers.
//!
//! A Gaussian of 1.4 cells, Sobel's gradients, suppression of what is no maximum across
//! the edge, hysteresis along it: the steps and scales of `imageproc::edges::canny`.
//! That one takes gradients, square roots and arc tangents of the whole picture, several
//! times as long as a decision may take; here the rows that matter are blurred and the
//! rest is done at the cells asked for. Integers make ties exact: both sides of a
//! straight step are edges. O(pixels) for the blur, O(1) for each cell asked for.

use crate::grid::{Cell, GridInfo, NEIGHBOURS_8};

/// The Gaussian of 1.4 cells, one half with its middle first, in 1024ths.
const KERNEL: [i32; 4] = [294, 229, 106, 30];
/// What the two passes of the blur multiply a grey value by.
const SCALE: f64 = 1024.0 * 1024.0;

/// A blurred picture.
pub(crate) struct Blurred {
    info: GridInfo,
    pixels: Vec<i32>,
}

impl Blurred {
    /// Blurs a picture of one byte a cell, row-major, where the edges at these cells
    /// need it; its rim goes on outside.
    pub(crate) fn new(info: &GridInfo, picture: &[u8], cells: &[Cell]) -> Self {
        let (width, height) = (info.width(), info.height());
        let reach = KERNEL.len() - 1;
        // A gradient looks one row further, and so does its comparison with its neighbours.
        let (first, last) = cells.iter().fold((i32::MAX, 0), |(a, b), cell| (a.min(cell.y - 2), b.max(cell.y + 2)));
        let first = usize::try_from(first).unwrap_or_default();
        let last = (last as usize + 1).min(height);
        let mut pixels = vec![0i32; info.len()];
        // One row blurred across, with the rim going on at both ends.
        let mut across = vec![0i32; width + 2 * reach];
        for (y, out) in pixels.chunks_exact_mut(width).enumerate().take(last).skip(first) {
            let row = |y: usize| &picture[y.min(height - 1) * width..][..width];
            let mut sums = across[reach..reach + width].iter_mut();
            let [here, near, middle, far] = [0, 1, 2, 3].map(|d| row(y + d).iter().zip(row(y.saturating_sub(d))));
            for ((((sum, here), near), middle), far) in sums.by_ref().zip(here).zip(near).zip(middle).zip(far) {
                let pair = |(&above, &below): (&u8, &u8)| i32::from(above) + i32::from(below);
                *sum = KERNEL[0] * i32::from(*here.0)
                    + KERNEL[1] * pair(near)
                    + KERNEL[2] * pair(middle)
                    + KERNEL[3] * pair(far);
            }
            let (left, right) = (across[reach], across[reach + width - 1]);
            across[..reach].fill(left);
            across[reach + width..].fill(right);
            for (pixel, w) in out.iter_mut().zip(across.windows(2 * reach + 1)) {
                *pixel = KERNEL[0] * w[3]
                    + KERNEL[1] * (w[2] + w[4])
                    + KERNEL[2] * (w[1] + w[5])
                    + KERNEL[3] * (w[0] + w[6]);
            }
        }
        Self { info: *info, pixels }
    }

    /// The edge cells among `cells`. An edge goes on from cell to cell of these alone.
    pub(crate) fn edges(&self, cells: &[Cell], low_threshold: f64, high_threshold: f64) -> Vec<Cell> {
        let squared = |threshold: f64| (threshold * SCALE).powi(2);
        let (low, high) = (squared(low_threshold), squared(high_threshold));
        // The cells that are edges if an edge leads to them.
        let mut waiting = vec![false; self.info.len()];
        let mut edges = Vec::new();
        for &cell in cells {
            let strength = self.strength_squared(cell);
            if strength >= high {
                edges.push(cell);
            } else if strength >= low
                && let Some(index) = self.info.index(cell)
            {
                waiting[index] = true;
            }
        }
        let mut next = 0;
        while let Some(&cell) = edges.get(next) {
            for neighbour in NEIGHBOURS_8.iter().map(|&offset| cell.offset(offset)) {
                if self.info.index(neighbour).is_some_and(|index| std::mem::take(&mut waiting[index])) {
                    edges.push(neighbour);
                }
            }
            next += 1;
        }
        edges.sort_unstable_by_key(|cell| (cell.y, cell.x));
        edges
    }

    /// The squared gradient of a cell; 0 where it is no maximum across the edge, and on
    /// the rim of the grid.
    fn strength_squared(&self, cell: Cell) -> f64 {
        const TAN_22_5: f64 = std::f64::consts::SQRT_2 - 1.0;
        let Some((x, y)) = self.gradient(cell) else { return 0.0 };
        let here = x * x + y * y;
        let across = if y.abs() <= TAN_22_5 * x.abs() {
            (1, 0)
        } else if x.abs() <= TAN_22_5 * y.abs() {
            (0, 1)
        } else if x * y > 0.0 {
            (1, 1)
        } else {
            (-1, 1)
        };
        let beside = |(dx, dy)| self.gradient(cell.offset((dx, dy))).map_or(0.0, |(x, y)| x * x + y * y);
        if here < beside(across) || here < beside((-across.0, -across.1)) { 0.0 } else { here }
    }

    /// Sobel's gradient, whole numbers; `None` on the rim and outside.
    fn gradient(&self, cell: Cell) -> Option<(f64, f64)> {
        let width = self.info.width();
        let inner = cell.x > 0 && cell.y > 0 && self.info.contains(cell.offset((1, 1)));
        let index = self.info.index(cell).filter(|_| inner)?;
        let (below, above) = (index - width, index + width);
        let at = |index: usize| f64::from(self.pixels[index]);
        let x = at(below + 1) - at(below - 1) + 2.0 * (at(index + 1) - at(index - 1)) + at(above + 1) - at(above - 1);
        let y = at(above - 1) - at(below - 1) + 2.0 * (at(above) - at(below)) + at(above + 1) - at(below + 1);
        Some((x, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use image::GrayImage;
    use std::collections::BTreeSet;

    /// Rectangles of three greys, as a map has them.
    fn picture(info: &GridInfo) -> Vec<u8> {
        let mut picture = vec![127u8; info.len()];
        for (index, pixel) in picture.iter_mut().enumerate() {
            let cell = info.cell(index);
            let inside = |x: i32, y: i32, wide: i32, high: i32| {
                (x..x + wide).contains(&cell.x) && (y..y + high).contains(&cell.y)
            };
            if inside(10, 10, 30, 20) || inside(35, 15, 20, 25) || cell.distance_squared(Cell::new(20, 40)) < 60 {
                *pixel = 255;
            }
            if inside(8, 10, 2, 20) || inside(20, 15, 6, 6) {
                *pixel = 0;
            }
        }
        picture
    }

    #[test]
    fn agrees_with_imageproc_to_a_cell() {
        let info = GridInfo::new(64, 56, 1.0, Pose::default()).unwrap();
        let picture = picture(&info);
        let all: Vec<Cell> = (0..info.len()).map(|index| info.cell(index)).collect();
        // imageproc leaves out two of the eight directions in which an edge can go on, so
        // that only thresholds without hysteresis can be compared.
        for (low, high) in [(60.0, 60.0), (120.0, 120.0), (200.0, 200.0)] {
            let ours: BTreeSet<Cell> =
                Blurred::new(&info, &picture, &all).edges(&all, f64::from(low), f64::from(high)).into_iter().collect();
            let image = GrayImage::from_raw(64, 56, picture.clone()).unwrap();
            let canny = imageproc::edges::canny(&image, low, high);
            let theirs: BTreeSet<Cell> =
                all.iter().copied().filter(|c| canny[(c.x as u32, c.y as u32)].0 != [0]).collect();
            assert!(ours.len() > 50 && theirs.len() > 50);
            for (some, others) in [(&ours, &theirs), (&theirs, &ours)] {
                let near = |c: &&Cell| others.iter().any(|o| o.distance_squared(**c) <= 2);
                // imageproc rounds the blur to bytes, and a cell at the very threshold
                // falls to this side or that.
                let lonely: Vec<&Cell> = some.iter().filter(|c| !near(c)).collect();
                assert!(lonely.len() * 100 <= some.len(), "{low} {high}: {lonely:?}");
            }
        }
    }

    #[test]
    fn a_weak_edge_counts_where_a_strong_one_leads_to_it() {
        // Black, grey and white from left to right above, grey and white alone below: the
        // step down the middle is strong in its upper part only.
        let info = GridInfo::new(30, 40, 1.0, Pose::default()).unwrap();
        let grey = |cell: Cell| match (cell.x < 15, cell.y < 20) {
            (true, true) => 0,
            (true, false) => 127,
            (false, _) => 255,
        };
        let picture: Vec<u8> = (0..info.len()).map(|index| grey(info.cell(index))).collect();
        let all: Vec<Cell> = (0..info.len()).map(|index| info.cell(index)).collect();
        let blurred = Blurred::new(&info, &picture, &all);
        let top =
            |low, high| blurred.edges(&all, low, high).iter().filter(|c| c.y > 30 && (14..=15).contains(&c.x)).count();
        assert!(top(100.0, 400.0) >= 8, "{}", top(100.0, 400.0));
        assert_eq!(top(300.0, 400.0), 0);
        assert_eq!(top(100.0, 2000.0), 0);
    }

    #[test]
    fn a_straight_step_has_an_edge_on_both_sides_and_the_gradient_that_the_docs_say() {
        let info = GridInfo::new(20, 9, 1.0, Pose::default()).unwrap();
        let picture: Vec<u8> = (0..info.len()).map(|i| if info.cell(i).x < 10 { 255 } else { 127 }).collect();
        let all: Vec<Cell> = (0..info.len()).map(|index| info.cell(index)).collect();
        let blurred = Blurred::new(&info, &picture, &all);
        let columns: BTreeSet<i32> = blurred.edges(&all, 1.0, 250.0).iter().map(|c| c.x).collect();
        assert_eq!(columns, BTreeSet::from([9, 10]));
        let strength = blurred.strength_squared(Cell::new(9, 4)).sqrt() / SCALE;
        assert!((260.0..270.0).contains(&strength), "{strength}");
    }
}
