//! A region of the map, as a user draws it in RViz.

use super::Point;
use geo::{Area, Contains, LineString};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Why a list of corners is no polygon.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PolygonError {
    /// Fewer than three corners.
    #[error("an area needs at least 3 corners, and {0} were given")]
    TooFewCorners(usize),
    /// A coordinate that is no finite number.
    #[error("corner {index} of the area is ({x}, {y}): both must be finite metres")]
    NotFinite {
        /// Which corner, from 0.
        index: usize,
        /// Its x.
        x: f64,
        /// Its y.
        y: f64,
    },
    /// All corners on one line.
    #[error("the corners enclose no area")]
    NoArea,
}

/// A simple polygon in metres; the closing edge is implied.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "Vec<[f64; 2]>", into = "Vec<[f64; 2]>")]
pub struct Polygon {
    corners: Vec<Point>,
    shape: geo::Polygon<f64>,
}

impl Polygon {
    /// A polygon from its corners in order, either way round.
    ///
    /// # Errors
    /// [`PolygonError`] for fewer than three corners, numbers that are not finite,
    /// or corners on one line.
    pub fn new(corners: Vec<Point>) -> Result<Self, PolygonError> {
        if corners.len() < 3 {
            return Err(PolygonError::TooFewCorners(corners.len()));
        }
        if let Some((index, bad)) = corners.iter().enumerate().find(|(_, c)| !(c.x.is_finite() && c.y.is_finite())) {
            return Err(PolygonError::NotFinite { index, x: bad.x, y: bad.y });
        }
        let ring: LineString<f64> = corners.iter().map(|c| (c.x, c.y)).collect();
        let shape = geo::Polygon::new(ring, Vec::new());
        if shape.unsigned_area() < 1e-9 {
            return Err(PolygonError::NoArea);
        }
        Ok(Self { corners, shape })
    }

    /// The corners as given.
    #[must_use]
    pub fn corners(&self) -> &[Point] {
        &self.corners
    }

    /// Whether a point lies strictly inside.
    #[must_use]
    pub fn contains(&self, point: Point) -> bool {
        self.shape.contains(&geo::Point::new(point.x, point.y))
    }
}

/// Where a row at a height runs inside of a polygon, from x to x, by its edges' crossings.
pub(crate) fn spans_at(corners: &[(f64, f64)], y: f64) -> Vec<(f64, f64)> {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossing = |(a, b): (&(f64, f64), &(f64, f64))| {
        ((a.1 <= y) != (b.1 <= y)).then(|| a.0 + (y - a.1) / (b.1 - a.1) * (b.0 - a.0))
    };
    let mut crossings: Vec<f64> = edges.filter_map(crossing).collect();
    crossings.sort_by(f64::total_cmp);
    crossings.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect()
}

impl TryFrom<Vec<[f64; 2]>> for Polygon {
    type Error = PolygonError;

    fn try_from(corners: Vec<[f64; 2]>) -> Result<Self, PolygonError> {
        Self::new(corners.into_iter().map(|[x, y]| Point::new(x, y)).collect())
    }
}

impl From<Polygon> for Vec<[f64; 2]> {
    fn from(polygon: Polygon) -> Self {
        polygon.corners.iter().map(|c| [c.x, c.y]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_l_shape_leaves_its_notch_out() {
        let l =
            Polygon::try_from(vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]).unwrap();
        assert!(l.contains(Point::new(0.5, 1.5)) && l.contains(Point::new(1.5, 0.5)));
        assert!(!l.contains(Point::new(1.5, 1.5)));
    }

    #[test]
    fn bad_corners_are_named() {
        assert_eq!(Polygon::try_from(vec![[0.0, 0.0]]), Err(PolygonError::TooFewCorners(1)));
        assert_eq!(Polygon::try_from(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), Err(PolygonError::NoArea));
        assert!(matches!(
            Polygon::try_from(vec![[0.0, 0.0], [f64::NAN, 1.0], [2.0, 2.0]]),
            Err(PolygonError::NotFinite { index: 1, .. })
        ));
    }
}
