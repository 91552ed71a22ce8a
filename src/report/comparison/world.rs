//! The worlds of a comparison: their starts and a small picture of each.

use super::rounding::rounded;
use crate::geometry::{Point, Pose};
use crate::grid::{OccupancyGrid, Thresholds};
use crate::report::canvas::Canvas;
use crate::report::theme::Theme;
use crate::report::view::{Bounds, SizeLimits, View};
use crate::report::{MARGIN_CELLS, ReportError};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::{Deserialize, Serialize};

/// Trajectories are drawn over this, side by side: it need not be large.
const SIZE: SizeLimits = SizeLimits { min_width_px: 240, max_side_px: 420 };

/// A world in which presets are compared.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ComparedWorld {
    /// What reports call it; no other world of the plan has this name.
    pub name: String,
    /// Where runs begin, metres and radians in the map frame.
    pub starts: Vec<Pose>,
    /// What it looks like.
    pub picture: WorldPicture,
}

/// A picture of a world, and where in the map frame it lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorldPicture {
    /// The PNG file.
    pub png_base64: String,
    /// Its width.
    pub width_px: usize,
    /// Its height.
    pub height_px: usize,
    /// The lowest x that it shows, metres.
    pub left_m: f64,
    /// The highest y that it shows, metres.
    pub top_m: f64,
    /// Edge length of a pixel, metres.
    pub m_per_px: f64,
}

impl WorldPicture {
    /// Of a ground truth.
    ///
    /// # Errors
    /// [`ReportError::Png`] when the encoder fails.
    pub fn of(truth: &OccupancyGrid) -> Result<Self, ReportError> {
        let bounds = Bounds::of_known(truth, MARGIN_CELLS);
        let mut canvas = Canvas::new(View::fit(bounds, truth.info().resolution_m(), SIZE));
        canvas.draw_grid(truth, &Thresholds::default());
        let view = canvas.view();
        Ok(Self {
            png_base64: STANDARD.encode(canvas.to_png(Theme::Clear)?),
            width_px: view.width_px(),
            height_px: view.height_px(),
            left_m: rounded(bounds.min.x),
            top_m: rounded(bounds.max.y),
            m_per_px: rounded(view.m_per_px()),
        })
    }

    /// Where a point of the map frame is, in pixels right and down of the outer corner
    /// of the first pixel.
    #[must_use]
    pub fn to_px(&self, point_in_map: Point) -> (f64, f64) {
        ((point_in_map.x - self.left_m) / self.m_per_px, (self.top_m - point_in_map.y) / self.m_per_px)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_where_the_picture_shows_them() {
        let truth = OccupancyGrid::from_ascii("########\n#......#\n#......#\n########").unwrap();
        let picture = WorldPicture::of(&truth).unwrap();
        let margin = f64::from(MARGIN_CELLS);
        let scale = 1.0 / picture.m_per_px;
        let (x, y) = picture.to_px(Point::new(0.0, 4.0));
        assert!((x - margin * scale).abs() < 1e-3 && (y - margin * scale).abs() < 1e-3, "{x} {y}");
        let (x, y) = picture.to_px(Point::new(8.0 + margin, -margin));
        assert!((x - picture.width_px as f64).abs() < 1.0 && (y - picture.height_px as f64).abs() < 1.0, "{x} {y}");
    }
}
