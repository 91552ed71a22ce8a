//! Which rectangle of the map frame a picture shows, and at what scale.
//!
//! Image row 0 is the highest y: this and [`super::canvas`] are the only places that
//! turn it over.

use crate::geometry::Point;
use crate::grid::{Cell, GridInfo, OccupancyGrid};

/// A rectangle along the axes of the map frame, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Lowest corner.
    pub min: Point,
    /// Highest corner.
    pub max: Point,
}

impl Bounds {
    /// The rectangle around a whole grid.
    #[must_use]
    pub fn of_grid(info: &GridInfo) -> Self {
        Self::of_cells(info, (0.0, 0.0), (info.width() as f64, info.height() as f64))
    }

    /// The rectangle around all cells of a grid that were ever seen, with a margin in
    /// cells; around the whole grid if none was. A map that a SLAM allocates far
    /// beyond what it has seen fills the picture all the same.
    #[must_use]
    pub fn of_known(grid: &OccupancyGrid, margin_cells: u32) -> Self {
        let info = grid.info();
        let (mut first, mut last) = ((usize::MAX, usize::MAX), (0, 0));
        for (y, row) in grid.data().chunks_exact(info.width()).enumerate() {
            let Some(left) = row.iter().position(|&value| value >= 0) else { continue };
            let right = row.iter().rposition(|&value| value >= 0).unwrap_or(left);
            first = (first.0.min(left), first.1.min(y));
            last = (last.0.max(right), y);
        }
        if first.1 == usize::MAX {
            return Self::of_grid(info);
        }
        let margin = f64::from(margin_cells);
        Self::of_cells(
            info,
            (first.0 as f64 - margin, first.1 as f64 - margin),
            (last.0 as f64 + 1.0 + margin, last.1 as f64 + 1.0 + margin),
        )
    }

    /// The rectangle around a range of grid units.
    fn of_cells(info: &GridInfo, low: (f64, f64), high: (f64, f64)) -> Self {
        let start = info.from_grid_units(low.0, low.1);
        let around = Self { min: start, max: start };
        [(high.0, low.1), (low.0, high.1), high]
            .into_iter()
            .fold(around, |bounds, (x, y)| bounds.including(info.from_grid_units(x, y)))
    }

    /// The rectangle around this one and a point. A point that is not finite changes
    /// nothing.
    #[must_use]
    pub fn including(self, point: Point) -> Self {
        if !(point.x.is_finite() && point.y.is_finite()) {
            return self;
        }
        Self {
            min: Point::new(self.min.x.min(point.x), self.min.y.min(point.y)),
            max: Point::new(self.max.x.max(point.x), self.max.y.max(point.y)),
        }
    }

    /// The rectangle around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        self.including(other.min).including(other.max)
    }
}

/// How large a picture should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SizeLimits {
    /// Smaller pictures are enlarged by a whole factor until they are this wide,
    /// unless they would get too high.
    pub min_width_px: u32,
    /// Larger ones are reduced until neither side is longer.
    pub max_side_px: u32,
}

impl SizeLimits {
    /// For a still picture.
    pub const STILL: Self = Self { min_width_px: 600, max_side_px: 1600 };
    /// For an animation.
    pub const ANIMATION: Self = Self { min_width_px: 400, max_side_px: 640 };
}

/// The rectangle of the map frame that a picture shows, pixel by pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    top_left_in_map: Point,
    m_per_px: f64,
    width_px: usize,
    height_px: usize,
}

impl View {
    /// A view of `bounds` of a map with cells of `resolution_m`, within the limits.
    #[must_use]
    pub fn fit(bounds: Bounds, resolution_m: f64, limits: SizeLimits) -> Self {
        let max_side = f64::from(limits.max_side_px.max(1));
        let size = bounds.max - bounds.min;
        let cells = |length_m: f64| (length_m / resolution_m).max(1.0);
        let (columns, rows) = (cells(size.x), cells(size.y));
        let longest = columns.max(rows);
        let scale = if longest > max_side {
            max_side / longest
        } else {
            let wanted = (f64::from(limits.min_width_px) / columns).ceil();
            wanted.min((max_side / longest).floor()).max(1.0)
        };
        // A hair is taken off so that 3 cells that sum up to 3.0000001 are 3 pixels.
        let pixels = |cells: f64| ((cells * scale - 1e-6).ceil()).clamp(1.0, max_side) as usize;
        Self {
            top_left_in_map: Point::new(bounds.min.x, bounds.max.y),
            m_per_px: resolution_m / scale,
            width_px: pixels(columns),
            height_px: pixels(rows),
        }
    }

    /// Width of the picture.
    #[must_use]
    pub const fn width_px(&self) -> usize {
        self.width_px
    }

    /// Height of the picture.
    #[must_use]
    pub const fn height_px(&self) -> usize {
        self.height_px
    }

    /// Edge length of a pixel, metres.
    #[must_use]
    pub const fn m_per_px(&self) -> f64 {
        self.m_per_px
    }

    /// Where a point of the map frame is, in pixels right and down of the outer
    /// corner of the first pixel; it may lie outside.
    #[must_use]
    pub fn to_px(self, point_in_map: Point) -> (f64, f64) {
        (
            (point_in_map.x - self.top_left_in_map.x) / self.m_per_px,
            (self.top_left_in_map.y - point_in_map.y) / self.m_per_px,
        )
    }

    /// The centre of a pixel in the map frame.
    #[must_use]
    pub fn center_in_map(&self, x_px: usize, y_px: usize) -> Point {
        Point::new(
            self.top_left_in_map.x + (x_px as f64 + 0.5) * self.m_per_px,
            self.top_left_in_map.y - (y_px as f64 + 0.5) * self.m_per_px,
        )
    }

    /// The pixel that holds a point, `None` outside the picture.
    #[must_use]
    pub fn pixel_at(&self, point_in_map: Point) -> Option<(usize, usize)> {
        let (x, y) = self.to_px(point_in_map);
        let inside = x >= 0.0 && y >= 0.0 && x < self.width_px as f64 && y < self.height_px as f64;
        inside.then_some((x as usize, y as usize))
    }

    /// The pixel that holds a cell's centre, `None` outside the picture.
    #[must_use]
    pub fn pixel_of(&self, info: &GridInfo, cell: Cell) -> Option<(usize, usize)> {
        self.pixel_at(info.center(cell))
    }

    /// The unit in pixels in which marks are measured, so that they look alike in
    /// small and large pictures.
    #[must_use]
    pub fn mark_px(&self) -> f64 {
        (self.width_px.max(self.height_px) as f64 / 200.0).clamp(2.0, 7.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;

    fn view(width: u32, height: u32, limits: SizeLimits) -> View {
        let info = GridInfo::new(width, height, 0.05, Pose::new(-3.0, 2.0, 0.0)).unwrap();
        View::fit(Bounds::of_grid(&info), 0.05, limits)
    }

    #[test]
    fn small_maps_are_enlarged_by_whole_factors() {
        let view = view(100, 80, SizeLimits::STILL);
        assert_eq!((view.width_px(), view.height_px()), (600, 480));
        assert!((view.m_per_px() - 0.05 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn large_maps_are_reduced() {
        let view = view(4000, 1000, SizeLimits::STILL);
        assert_eq!((view.width_px(), view.height_px()), (1600, 400));
    }

    #[test]
    fn a_narrow_corridor_does_not_get_too_high() {
        let view = view(10, 500, SizeLimits::STILL);
        assert_eq!((view.width_px(), view.height_px()), (30, 1500));
    }

    #[test]
    fn row_zero_is_the_highest_y() {
        let view = view(100, 80, SizeLimits::STILL);
        assert_eq!(view.pixel_at(Point::new(-2.999, 5.999)), Some((0, 0)));
        assert_eq!(view.pixel_at(Point::new(1.999, 2.001)), Some((599, 479)));
        assert_eq!(view.pixel_at(Point::new(2.001, 2.001)), None);
        assert_eq!(view.pixel_at(view.center_in_map(17, 33)), Some((17, 33)));
    }

    #[test]
    fn only_what_was_seen_is_shown() {
        let grid = OccupancyGrid::from_ascii("????\n??.?\n??#?\n????").unwrap();
        let known = Bounds::of_known(&grid, 0);
        assert_eq!((known.min, known.max), (Point::new(2.0, 1.0), Point::new(3.0, 3.0)));
        let unseen = OccupancyGrid::from_ascii("??\n??").unwrap();
        assert_eq!(Bounds::of_known(&unseen, 0), Bounds::of_grid(unseen.info()));
    }
}
