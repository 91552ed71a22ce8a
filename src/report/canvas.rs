//! An indexed raster of a rectangle of the map frame, and how maps get onto it.
//!
//! Pixels are palette indices (see [`Ink`]). Where a picture is smaller than its map,
//! a pixel shows the most important of its cells, so that thin walls stay.

use super::theme::{Ink, Rgb, Theme};
use super::view::View;
use crate::grid::{Cell, CellState, GridInfo, OccupancyGrid, Thresholds};

/// A picture under work.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    view: View,
    pixels: Vec<u8>,
}

/// The ink for each occupancy value, by the value as `u8`.
fn inks(thresholds: &Thresholds) -> [u8; 256] {
    std::array::from_fn(|byte| match thresholds.classify(byte as u8 as i8) {
        CellState::Unknown | CellState::Unsettled => Ink::Unknown.index(),
        CellState::Free => Ink::Free.index(),
        CellState::Occupied => Ink::Occupied.index(),
    })
}

impl Canvas {
    /// An empty picture: all unknown.
    #[must_use]
    pub fn new(view: View) -> Self {
        Self { view, pixels: vec![Ink::Unknown.index(); view.width_px() * view.height_px()] }
    }

    /// What is shown where.
    #[must_use]
    pub const fn view(&self) -> &View {
        &self.view
    }

    /// All palette indices, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[u8] {
        &self.pixels
    }

    /// The palette index of a pixel, `None` outside.
    #[must_use]
    pub fn get(&self, x_px: usize, y_px: usize) -> Option<u8> {
        let inside = x_px < self.view.width_px() && y_px < self.view.height_px();
        inside.then(|| self.pixels.get(y_px * self.view.width_px() + x_px).copied()).flatten()
    }

    /// Sets a pixel; outside the picture nothing happens.
    pub(super) fn put(&mut self, x_px: usize, y_px: usize, index: u8) {
        if x_px < self.view.width_px()
            && let Some(pixel) = self.pixels.get_mut(y_px * self.view.width_px() + x_px)
        {
            *pixel = index;
        }
    }

    /// Makes all of it unknown again.
    pub fn clear(&mut self) {
        self.pixels.fill(Ink::Unknown.index());
    }

    /// Pixels of one row between two columns; empty outside.
    pub(super) fn span(&self, y_px: usize, x_px: std::ops::Range<usize>) -> &[u8] {
        let width = self.view.width_px();
        let (start, end) = (x_px.start.min(width), x_px.end.min(width));
        self.pixels.get(y_px * width + start..y_px * width + end).unwrap_or_default()
    }

    /// Pixels of one row between two columns, for writing; empty outside.
    pub(super) fn span_mut(&mut self, y_px: usize, x_px: std::ops::Range<usize>) -> &mut [u8] {
        let width = self.view.width_px();
        let (start, end) = (x_px.start.min(width), x_px.end.min(width));
        self.pixels.get_mut(y_px * width + start..y_px * width + end).unwrap_or_default()
    }

    /// Draws a map. Over what is there, the more important of unknown, free and
    /// occupied stays.
    pub fn draw_grid(&mut self, grid: &OccupancyGrid, thresholds: &Thresholds) {
        let inks = inks(thresholds);
        let reduced = self.view.m_per_px() > grid.info().resolution_m() * (1.0 + 1e-9);
        let turned = grid.info().origin_in_map().yaw != 0.0;
        if reduced && !turned {
            self.gather_rows(grid, &inks);
            return;
        }
        self.sample(grid, &inks);
        if reduced {
            self.raise_cells(grid, &inks);
        }
    }

    /// Every pixel takes the cell at its centre.
    fn sample(&mut self, grid: &OccupancyGrid, inks: &[u8; 256]) {
        let (view, info) = (self.view, *grid.info());
        for (y, row) in self.pixels.chunks_exact_mut(view.width_px()).enumerate() {
            for (x, pixel) in row.iter_mut().enumerate() {
                let value = grid.get(info.cell_at(view.center_in_map(x, y)));
                *pixel = value.map_or(*pixel, |value| (*pixel).max(ink_of(inks, value)));
            }
        }
    }

    /// Every cell raises the pixel that holds its centre.
    fn raise_cells(&mut self, grid: &OccupancyGrid, inks: &[u8; 256]) {
        for (i, &value) in grid.data().iter().enumerate() {
            if let Some((x, y)) = self.view.pixel_of(grid.info(), grid.info().cell(i)) {
                let ink = ink_of(inks, value).max(self.get(x, y).unwrap_or_default());
                self.put(x, y, ink);
            }
        }
    }

    /// The same for a grid along the axes, where columns and rows can be found once.
    fn gather_rows(&mut self, grid: &OccupancyGrid, inks: &[u8; 256]) {
        let (view, info) = (self.view, *grid.info());
        let column = |x: usize| view.to_px(info.center(Cell::new(x as i32, 0))).0;
        let inside = |x: usize| (0.0..view.width_px() as f64).contains(&column(x));
        let Some(first) = (0..info.width()).find(|&x| inside(x)) else { return };
        let columns: Vec<usize> =
            (first..info.width()).take_while(|&x| inside(x)).map(|x| column(x) as usize).collect();
        for (y, values) in grid.data().chunks_exact(info.width()).enumerate() {
            let y_px = view.to_px(info.center(Cell::new(0, y as i32))).1;
            if !(0.0..view.height_px() as f64).contains(&y_px) {
                continue;
            }
            let row = self.span_mut(y_px as usize, 0..view.width_px());
            for (&value, &x_px) in values.iter().skip(first).zip(&columns) {
                if let Some(pixel) = row.get_mut(x_px) {
                    *pixel = (*pixel).max(ink_of(inks, value));
                }
            }
        }
    }

    /// Fills cells of a grid with an ink. Where cells are smaller than pixels, their
    /// pixels' neighbours are filled too unless they show obstacles: a line of one
    /// pixel would hardly be seen.
    pub fn fill_cells(&mut self, info: &GridInfo, cells: impl IntoIterator<Item = Cell>, ink: Ink) {
        let px_per_cell = info.resolution_m() / self.view.m_per_px();
        for cell in cells {
            if px_per_cell < 2.0 {
                self.fill_small(info, cell, ink);
            } else {
                self.fill_large(info, cell, px_per_cell, ink);
            }
        }
    }

    /// A cell of about one pixel: that pixel and the four beside it.
    fn fill_small(&mut self, info: &GridInfo, cell: Cell, ink: Ink) {
        let Some((x, y)) = self.view.pixel_of(info, cell) else { return };
        self.put(x, y, ink.index());
        for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
            let (Some(x), Some(y)) = (x.checked_add_signed(dx), y.checked_add_signed(dy)) else { continue };
            if self.get(x, y).is_some_and(|below| below <= Ink::Free.index()) {
                self.put(x, y, ink.index());
            }
        }
    }

    /// A cell of several pixels: all whose centres lie in it.
    fn fill_large(&mut self, info: &GridInfo, cell: Cell, px_per_cell: f64, ink: Ink) {
        let (x, y) = self.view.to_px(info.center(cell));
        let reach = px_per_cell * std::f64::consts::FRAC_1_SQRT_2 + 1.0;
        let range = |center: f64, limit: usize| {
            let start = (center - reach).max(0.0) as usize;
            start..((center + reach).max(0.0).ceil() as usize).min(limit)
        };
        for y_px in range(y, self.view.height_px()) {
            for x_px in range(x, self.view.width_px()) {
                if info.cell_at(self.view.center_in_map(x_px, y_px)) == cell {
                    self.put(x_px, y_px, ink.index());
                }
            }
        }
    }

    /// The picture as a PNG file of 8-bit RGB.
    ///
    /// # Errors
    /// [`super::ReportError::Png`] when the encoder fails.
    pub fn to_png(&self, theme: Theme) -> Result<Vec<u8>, super::ReportError> {
        use image::ImageEncoder as _;
        use image::codecs::png::{CompressionType, FilterType, PngEncoder};

        let palette = theme.palette();
        let color = |index: u8| palette.get(usize::from(index)).copied().unwrap_or_default();
        let rgb: Vec<u8> = self.pixels.iter().flat_map(|&index| -> Rgb { color(index) }).collect();
        let mut bytes = Vec::new();
        PngEncoder::new_with_quality(&mut bytes, CompressionType::Default, FilterType::NoFilter).write_image(
            &rgb,
            self.view.width_px() as u32,
            self.view.height_px() as u32,
            image::ExtendedColorType::Rgb8,
        )?;
        Ok(bytes)
    }
}

/// The ink of an occupancy value.
fn ink_of(inks: &[u8; 256], value: i8) -> u8 {
    inks.get(usize::from(value as u8)).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Pose};
    use crate::report::view::{Bounds, SizeLimits};

    fn drawn(grid: &OccupancyGrid, max_side_px: u32) -> Canvas {
        let limits = SizeLimits { min_width_px: 1, max_side_px };
        let mut canvas = Canvas::new(View::fit(Bounds::of_grid(grid.info()), grid.info().resolution_m(), limits));
        canvas.draw_grid(grid, &Thresholds::default());
        canvas
    }

    #[test]
    fn the_first_drawn_line_is_image_row_zero() {
        let grid = OccupancyGrid::from_ascii("?#.\n...").unwrap();
        assert_eq!(drawn(&grid, 100).pixels(), &[0, 2, 1, 1, 1, 1]);
    }

    #[test]
    fn a_thin_wall_survives_reduction_turned_or_not() {
        let mut grid = OccupancyGrid::filled(GridInfo::new(90, 90, 0.05, Pose::default()).unwrap(), 0);
        (0..90).for_each(|y| grid.set(Cell::new(44, y), 100));
        let canvas = drawn(&grid, 30);
        assert!(canvas.pixels().chunks(30).all(|row| row.contains(&2)));
        let turned = GridInfo::new(90, 90, 0.05, Pose::new(0.0, 0.0, 0.5)).unwrap();
        let canvas = drawn(&OccupancyGrid::new(turned, grid.data().to_vec()).unwrap(), 30);
        let wall = (0..90).map(|y| canvas.view().pixel_of(&turned, Cell::new(44, y)).unwrap());
        assert!(wall.into_iter().all(|(x, y)| canvas.get(x, y) == Some(2)));
    }

    #[test]
    fn a_quarter_turned_map_is_drawn_turned() {
        let plain = OccupancyGrid::from_ascii("#..\n??.").unwrap();
        let info = GridInfo::new(3, 2, 1.0, Pose::new(0.0, 0.0, std::f64::consts::FRAC_PI_2)).unwrap();
        let canvas = drawn(&OccupancyGrid::new(info, plain.data().to_vec()).unwrap(), 10);
        let point = canvas.view().pixel_at(Point::new(-1.5, 0.5)).unwrap();
        assert_eq!(canvas.get(point.0, point.1), Some(2));
        let point = canvas.view().pixel_at(Point::new(-0.5, 2.5)).unwrap();
        assert_eq!(canvas.get(point.0, point.1), Some(1));
    }

    #[test]
    fn enlarged_cells_are_filled_exactly() {
        let grid = OccupancyGrid::from_ascii("...\n...").unwrap();
        let mut canvas = Canvas::new(View::fit(Bounds::of_grid(grid.info()), 1.0, SizeLimits::STILL));
        canvas.draw_grid(&grid, &Thresholds::default());
        canvas.fill_cells(grid.info(), [Cell::new(1, 0), Cell::new(7, 7)], Ink::Frontier);
        let green = canvas.pixels().iter().filter(|&&p| p == Ink::Frontier.index()).count();
        assert_eq!(green, 200 * 200);
        assert_eq!(canvas.get(200, 200), Some(Ink::Frontier.index()));
        assert_eq!(canvas.get(199, 200), Some(Ink::Free.index()));
        assert_eq!(canvas.get(200, 199), Some(Ink::Free.index()));
    }
}
