//! The outline of a robot seen from above, as move_base's costmaps take it.

use super::{Point, Pose};
use crate::range::Range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// No robot is larger, metres: an outline of points for each cell has its limit.
const LARGEST_M: f64 = 100.0;

/// Why a footprint cannot be one.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FootprintError {
    /// A radius that no robot has.
    #[error("footprint.radius_m is {0}: must be {words}", words = Footprint::RADIUS.words)]
    Radius(f64),
    /// Too few corners, or a corner that is not finite.
    #[error("a footprint polygon needs at least 3 finite corners, and {0} usable ones were given")]
    Corners(usize),
    /// A corner that no robot has.
    #[error("a footprint polygon's corner ({0}, {1}): must be at most {LARGEST_M} m away along each axis")]
    Far(f64, f64),
    /// The body's centre, around which it turns, lies outside.
    #[error("the footprint polygon must contain the base frame's origin")]
    OriginOutside,
}

/// The robot's outline in its base frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Footprint {
    /// A disc around the base frame's origin, by its radius in metres.
    RadiusM(f64),
    /// A convex polygon around the base frame's origin: at least 3 corners `[x, y]` in metres.
    PolygonM(Vec<[f64; 2]>),
}

impl Footprint {
    /// What the radius may be.
    pub(crate) const RADIUS: Range = Range::above(0.0, LARGEST_M, "above 0 and at most 100");

    /// Checks the numbers.
    ///
    /// # Errors
    /// [`FootprintError`] that names what is wrong.
    pub fn validate(&self) -> Result<(), FootprintError> {
        match self {
            Self::RadiusM(radius) if Self::RADIUS.holds(*radius) => Ok(()),
            Self::RadiusM(radius) => Err(FootprintError::Radius(*radius)),
            Self::PolygonM(corners) => {
                let finite = corners.iter().flatten().all(|c| c.is_finite());
                let polygon = if finite { super::Polygon::try_from(corners.clone()).ok() } else { None };
                let polygon = polygon.ok_or(FootprintError::Corners(corners.len().min(2)))?;
                if let Some(&[x, y]) = corners.iter().find(|corner| corner.iter().any(|c| c.abs() > LARGEST_M)) {
                    return Err(FootprintError::Far(x, y));
                }
                if polygon.contains(Point::origin()) { Ok(()) } else { Err(FootprintError::OriginOutside) }
            }
        }
    }

    /// Radius in metres of the largest disc around the origin inside the outline
    /// (costmap_2d's inscribed radius): nearer than this to an obstacle is a
    /// collision whatever the heading.
    #[must_use]
    pub fn inscribed_radius_m(&self) -> f64 {
        match self {
            Self::RadiusM(radius) => *radius,
            Self::PolygonM(corners) => {
                edges(corners).map(|(a, b)| distance_to_segment(a, b)).fold(f64::INFINITY, f64::min)
            }
        }
    }

    /// Radius in metres of the smallest disc around the origin that holds the
    /// outline: farther than this from every obstacle is free whatever the heading.
    #[must_use]
    pub fn circumscribed_radius_m(&self) -> f64 {
        match self {
            Self::RadiusM(radius) => *radius,
            Self::PolygonM(corners) => corners.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
        }
    }

    /// Half the width in metres of the narrowest passage that the robot drives through
    /// straight ahead with its base frame in the middle.
    #[must_use]
    pub fn passage_radius_m(&self) -> f64 {
        match self {
            Self::RadiusM(radius) => *radius,
            Self::PolygonM(corners) => corners.iter().map(|[_, y]| y.abs()).fold(0.0, f64::max),
        }
    }

    /// Points on the outline at `pose`, at most `spacing_m` apart: where a
    /// collision check looks.
    #[must_use]
    pub fn outline(&self, pose: &Pose, spacing_m: f64) -> Vec<Point> {
        match self {
            Self::RadiusM(radius) => {
                let count = (std::f64::consts::TAU * radius / spacing_m).ceil().max(8.0) as usize;
                (0..count)
                    .map(|i| {
                        let angle = std::f64::consts::TAU * i as f64 / count as f64;
                        Point::new(pose.x + radius * angle.cos(), pose.y + radius * angle.sin())
                    })
                    .collect()
            }
            Self::PolygonM(corners) => edges(corners)
                .flat_map(|(a, b)| {
                    let count = (nalgebra::distance(&a, &b) / spacing_m).ceil().max(1.0) as usize;
                    (0..count).map(move |i| a + (b - a) * (i as f64 / count as f64))
                })
                .map(|point_in_base| pose.transform(point_in_base))
                .collect(),
        }
    }
}

/// The polygon's sides, the closing one included.
fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = (Point, Point)> + '_ {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(a, b)| (Point::new(a[0], a[1]), Point::new(b[0], b[1])))
}

/// Metres from the origin to the segment `a`..`b`.
fn distance_to_segment(a: Point, b: Point) -> f64 {
    let along = b - a;
    let length_squared = along.norm_squared();
    let t = if length_squared > 0.0 { (-a.coords.dot(&along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (a + along * t).coords.norm()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_has_two_radii() {
        let waffle = Footprint::PolygonM(vec![[-0.205, -0.155], [-0.205, 0.155], [0.077, 0.155], [0.077, -0.155]]);
        waffle.validate().unwrap();
        assert!((waffle.inscribed_radius_m() - 0.077).abs() < 1e-12);
        assert!((waffle.circumscribed_radius_m() - 0.205_f64.hypot(0.155)).abs() < 1e-12);
    }

    #[test]
    fn the_outline_stays_between_the_radii() {
        let square = Footprint::PolygonM(vec![[-0.2, -0.2], [0.2, -0.2], [0.2, 0.2], [-0.2, 0.2]]);
        for footprint in [square, Footprint::RadiusM(0.3)] {
            let outline = footprint.outline(&Pose::new(1.0, 2.0, 0.4), 0.05);
            assert!(outline.len() >= 32);
            for point in outline {
                let distance = nalgebra::distance(&point, &Point::new(1.0, 2.0));
                assert!(distance >= footprint.inscribed_radius_m() - 1e-9);
                assert!(distance <= footprint.circumscribed_radius_m() + 1e-9);
            }
        }
    }

    #[test]
    fn impossible_footprints_are_refused() {
        assert!(matches!(Footprint::RadiusM(0.0).validate(), Err(FootprintError::Radius(_))));
        assert!(matches!(Footprint::PolygonM(vec![[0.0, 0.0]]).validate(), Err(FootprintError::Corners(_))));
        assert!(Footprint::RadiusM(1e9).validate().is_err());
        let vast = Footprint::PolygonM(vec![[-1.0, -1.0], [1e9, 0.0], [-1.0, 1.0]]);
        let error = vast.validate().unwrap_err().to_string();
        assert!(error.contains("(1000000000, 0): must be at most 100 m away"), "{error}");
        let aside = Footprint::PolygonM(vec![[1.0, 1.0], [2.0, 1.0], [2.0, 2.0]]);
        assert_eq!(aside.validate(), Err(FootprintError::OriginOutside));
    }
}
