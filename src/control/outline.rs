//! How far a point is from the robot's outline.

use crate::geometry::{Footprint, Point};
use nalgebra::Vector2;

/// The outline in the base frame, ready for many questions.
#[derive(Clone, Debug)]
pub enum Outline {
    /// A disc around the origin, by its radius in metres.
    Disc(f64),
    /// A convex polygon as the half planes that bound it: outward normal, and metres
    /// from the origin to the side.
    Convex(Vec<(Vector2<f64>, f64)>),
}

impl Outline {
    /// The outline of a footprint.
    pub fn new(footprint: &Footprint) -> Self {
        match footprint {
            Footprint::RadiusM(radius_m) => Self::Disc(*radius_m),
            Footprint::PolygonM(corners) => {
                let next = corners.iter().cycle().skip(1);
                let sides = corners.iter().zip(next).filter_map(|(&[ax, ay], &[bx, by])| {
                    let normal = Vector2::new(by - ay, ax - bx).try_normalize(1e-9)?;
                    let offset_m = normal.dot(&Vector2::new(ax, ay));
                    // Corners may come either way round; the origin lies inside.
                    Some(if offset_m < 0.0 { (-normal, -offset_m) } else { (normal, offset_m) })
                });
                Self::Convex(sides.collect())
            }
        }
    }

    /// Metres from the outline to a point, negative inside. Beside a corner of a
    /// polygon it is the distance to the farther side's line, which is less.
    pub fn distance_m(&self, point_in_base: Point) -> f64 {
        match self {
            Self::Disc(radius_m) => point_in_base.coords.norm() - radius_m,
            Self::Convex(sides) => sides
                .iter()
                .map(|(normal, offset_m)| normal.dot(&point_in_base.coords) - offset_m)
                .fold(f64::NEG_INFINITY, f64::max),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_signed_and_the_corners_order_does_not_matter() {
        let mut corners = vec![[-0.2, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.2, 0.1]];
        for _ in 0..2 {
            let outline = Outline::new(&Footprint::PolygonM(corners.clone()));
            for (x, y, expected) in [(0.0, 0.0, -0.1), (0.3, 0.0, 0.2), (-0.5, 0.05, 0.3), (0.0, 0.15, 0.05)] {
                assert!((outline.distance_m(Point::new(x, y)) - expected).abs() < 1e-12, "{x} {y}");
            }
            corners.reverse();
        }
        assert!((Outline::new(&Footprint::RadiusM(0.2)).distance_m(Point::new(0.3, 0.4)) - 0.3).abs() < 1e-12);
    }
}
