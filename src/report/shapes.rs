//! Lines and marks on a canvas: everything is made of one shape, the capsule (all
//! pixels whose centres lie within a radius of a segment).

use super::canvas::Canvas;
use super::theme::Ink;
use crate::geometry::{Point, Polygon, Pose};

/// A place in the picture, in pixels right and down.
type Px = (f64, f64);

impl Canvas {
    /// Fills all pixels within `radius_px` of the segment `a`..`b`, at least the one
    /// under `a`.
    fn capsule(&mut self, a: Px, b: Px, radius_px: f64, index: u8) {
        let finite = [a.0, a.1, b.0, b.1].iter().all(|v| v.is_finite());
        let (width, height) = (self.view().width_px() as f64, self.view().height_px() as f64);
        let (left, right) = (a.0.min(b.0) - radius_px, a.0.max(b.0) + radius_px);
        let (top, bottom) = (a.1.min(b.1) - radius_px, a.1.max(b.1) + radius_px);
        if !finite || right < 0.0 || bottom < 0.0 || left >= width || top >= height {
            return;
        }
        let along = (b.0 - a.0, b.1 - a.1);
        let length_squared = along.0 * along.0 + along.1 * along.1;
        let limit = radius_px * radius_px;
        for y in top.max(0.0) as usize..=bottom.min(height - 1.0) as usize {
            for x in left.max(0.0) as usize..=right.min(width - 1.0) as usize {
                let (dx, dy) = (x as f64 + 0.5 - a.0, y as f64 + 0.5 - a.1);
                let t = (dx * along.0 + dy * along.1) / length_squared.max(1e-12);
                let t = t.clamp(0.0, 1.0);
                let (ex, ey) = (dx - t * along.0, dy - t * along.1);
                if ex * ex + ey * ey <= limit {
                    self.put(x, y, index);
                }
            }
        }
        if a.0 >= 0.0 && a.1 >= 0.0 {
            self.put(a.0 as usize, a.1 as usize, index);
        }
    }

    /// A line through points of the map frame.
    pub fn polyline(&mut self, points_in_map: &[Point], width_px: f64, ink: Ink) {
        self.line_with(points_in_map, width_px, |_| ink.index());
    }

    /// A line whose colour runs through the gradient from its first point to its last.
    pub fn gradient_line(&mut self, points_in_map: &[Point], width_px: f64) {
        let last = points_in_map.len().saturating_sub(1).max(1) as f64;
        self.line_with(points_in_map, width_px, |i| Ink::along(i as f64 / last));
    }

    /// A line coloured by the number of the point that it leads to. Points within a
    /// pixel of the last drawn one are passed over: trajectories have very many.
    fn line_with(&mut self, points_in_map: &[Point], width_px: f64, index: impl Fn(usize) -> u8) {
        let Some(&first) = points_in_map.first() else { return };
        let last = points_in_map.len() - 1;
        let mut from = self.view().to_px(first);
        self.capsule(from, from, width_px / 2.0, index(0));
        for (i, &point) in points_in_map.iter().enumerate().skip(1) {
            let to = self.view().to_px(point);
            if (to.0 - from.0).hypot(to.1 - from.1) >= 1.0 || i == last {
                self.capsule(from, to, width_px / 2.0, index(i));
                from = to;
            }
        }
    }

    /// The outline of a region.
    pub fn outline(&mut self, region: &Polygon, width_px: f64, ink: Ink) {
        let mut ring = region.corners().to_vec();
        ring.extend(region.corners().first());
        self.polyline(&ring, width_px, ink);
    }

    /// A disc around a point of the map frame.
    pub fn disc(&mut self, center_in_map: Point, radius_px: f64, ink: Ink) {
        let center = self.view().to_px(center_in_map);
        self.capsule(center, center, radius_px, ink.index());
    }

    /// A robot: a disc with a rim, a nose and a tick that show where it is heading.
    pub fn robot(&mut self, pose_in_map: &Pose) {
        let unit = self.view().mark_px();
        let (x, y) = self.view().to_px(pose_in_map.position());
        let radius = 2.0 * unit;
        let (sin, cos) = pose_in_map.yaw.sin_cos();
        let ahead = |share: f64| (x + radius * share * cos, y - radius * share * sin);
        for (ink, rim) in [(Ink::Halo, unit * 0.6), (Ink::Robot, 0.0)] {
            self.capsule((x, y), (x, y), radius + rim, ink.index());
            self.capsule(ahead(0.6), ahead(1.4), unit * 0.8 + rim, ink.index());
        }
        self.capsule(ahead(0.2), ahead(1.4), unit * 0.35, Ink::Halo.index());
    }

    /// Where a run began: a ring.
    pub fn start(&mut self, point_in_map: Point) {
        let unit = self.view().mark_px();
        self.disc(point_in_map, 2.6 * unit, Ink::Halo);
        self.disc(point_in_map, 2.0 * unit, Ink::Robot);
        self.disc(point_in_map, 1.1 * unit, Ink::Halo);
    }

    /// A goal: a diagonal cross with arms of `size` times the unit of marks.
    pub fn cross(&mut self, point_in_map: Point, size: f64, ink: Ink) {
        let unit = self.view().mark_px();
        let (x, y) = self.view().to_px(point_in_map);
        let arm = size * unit;
        for (ink, radius) in [(Ink::Halo, unit * 0.45 + 1.5), (ink, unit * 0.45)] {
            self.capsule((x - arm, y - arm), (x + arm, y + arm), radius, ink.index());
            self.capsule((x - arm, y + arm), (x + arm, y - arm), radius, ink.index());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridInfo;
    use crate::report::view::{Bounds, SizeLimits, View};

    /// A canvas of 20 x 20 m at 30 pixels per metre.
    fn canvas() -> Canvas {
        let info = GridInfo::new(20, 20, 1.0, Pose::default()).unwrap();
        Canvas::new(View::fit(Bounds::of_grid(&info), 1.0, SizeLimits::STILL))
    }

    fn at(canvas: &Canvas, x: f64, y: f64) -> Option<u8> {
        canvas.view().pixel_at(Point::new(x, y)).and_then(|(x, y)| canvas.get(x, y))
    }

    #[test]
    fn a_robot_that_faces_up_has_its_nose_above() {
        let mut canvas = canvas();
        canvas.robot(&Pose::new(10.0, 10.0, std::f64::consts::FRAC_PI_2));
        let reach_m = 3.3 * canvas.view().mark_px() * canvas.view().m_per_px();
        assert_eq!(at(&canvas, 10.0, 10.0 + reach_m), Some(Ink::Robot.index()));
        assert_ne!(at(&canvas, 10.0, 10.0 - reach_m), Some(Ink::Robot.index()));
    }

    #[test]
    fn a_line_has_its_width_and_leaves_the_picture_quietly() {
        let mut canvas = canvas();
        let line = [Point::new(-50.0, 5.0), Point::new(50.0, 5.0), Point::new(f64::NAN, 5.0)];
        canvas.polyline(&line, 4.0, Ink::Path);
        let inked = canvas.pixels().iter().filter(|&&p| p == Ink::Path.index()).count();
        assert_eq!(inked, 600 * 4);
    }

    #[test]
    fn a_gradient_runs_from_first_to_last() {
        let mut canvas = canvas();
        canvas.gradient_line(&(1..=19).map(|x| Point::new(f64::from(x), 3.0)).collect::<Vec<_>>(), 3.0);
        assert!(at(&canvas, 1.0, 3.0) < Some(Ink::along(0.1)));
        assert_eq!(at(&canvas, 19.0, 3.0), Some(Ink::along(1.0)));
        assert!(at(&canvas, 10.0, 3.0) > at(&canvas, 5.0, 3.0));
    }
}
