//! The smallest circle around points.
//!
//! Welzl, "Smallest enclosing disks (balls and ellipsoids)" (1991), in its iterative
//! form: a point outside the circle so far lies on the rim of the next one. The points
//! are reduced to the corners of their convex hull first (Andrew's monotone chain), so
//! that the order in which they come makes no difference to time or result.
//! O(n log n) for n points; the second part is O(h) to O(h^3) for h corners, and h is
//! small for cells of a grid.

use super::Point;

/// Relative slack with which a point counts as inside: what rounding may take away.
const SLACK: f64 = 1e-10;

/// A circle in the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Circle {
    /// Its centre, metres.
    pub center: Point,
    /// Its radius, metres.
    pub radius_m: f64,
}

impl Circle {
    /// The smallest circle that holds all points; `None` without any point, or when a
    /// coordinate is not finite.
    #[must_use]
    pub fn enclosing(points: &[Point]) -> Option<Self> {
        if points.is_empty() || points.iter().any(|p| !(p.x.is_finite() && p.y.is_finite())) {
            return None;
        }
        let hull = convex_hull(points);
        let (first, rest) = hull.split_first()?;
        let mut circle = Self { center: *first, radius_m: 0.0 };
        for (i, &a) in rest.iter().enumerate() {
            if !circle.holds(a) {
                circle = Self::with_one_on_rim(&hull[..=i], a);
            }
        }
        Some(circle)
    }

    /// The smallest circle around the points that has `a` on its rim.
    fn with_one_on_rim(points: &[Point], a: Point) -> Self {
        let mut circle = Self { center: a, radius_m: 0.0 };
        for (j, &b) in points.iter().enumerate() {
            if !circle.holds(b) {
                circle = Self::with_two_on_rim(&points[..j], a, b);
            }
        }
        circle
    }

    /// The smallest circle around the points that has `a` and `b` on its rim.
    fn with_two_on_rim(points: &[Point], a: Point, b: Point) -> Self {
        let mut circle = Self::between(a, b);
        for &c in points {
            if !circle.holds(c) {
                circle = Self::through(a, b, c).unwrap_or(circle);
            }
        }
        circle
    }

    /// The circle with these two points as a diameter.
    fn between(a: Point, b: Point) -> Self {
        Self { center: nalgebra::center(&a, &b), radius_m: 0.5 * nalgebra::distance(&a, &b) }
    }

    /// The circle through three points; `None` when they are on one line.
    fn through(a: Point, b: Point, c: Point) -> Option<Self> {
        let (ab, ac) = (b - a, c - a);
        let twice_area = ab.x * ac.y - ab.y * ac.x;
        let (ab2, ac2) = (ab.norm_squared(), ac.norm_squared());
        let x = (ac.y * ab2 - ab.y * ac2) / (2.0 * twice_area);
        let y = (ab.x * ac2 - ac.x * ab2) / (2.0 * twice_area);
        (x.is_finite() && y.is_finite()).then(|| Self { center: Point::new(a.x + x, a.y + y), radius_m: x.hypot(y) })
    }

    /// Whether a point lies inside or, but for rounding, on the rim.
    #[must_use]
    pub fn holds(&self, point: Point) -> bool {
        let scale = self.radius_m + self.center.coords.amax() * f64::EPSILON;
        nalgebra::distance(&self.center, &point) <= self.radius_m + SLACK * scale
    }
}

/// The corners of the convex hull, counter-clockwise from the leftmost.
fn convex_hull(points: &[Point]) -> Vec<Point> {
    let mut sorted = points.to_vec();
    sorted.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let mut hull = half_hull(sorted.iter().copied());
    hull.pop();
    hull.extend(half_hull(sorted.iter().rev().copied()));
    hull.pop();
    hull
}

/// One chain of the hull, from the first point to the last, turning left only.
fn half_hull(sorted: impl Iterator<Item = Point>) -> Vec<Point> {
    let mut chain: Vec<Point> = Vec::new();
    for point in sorted {
        while let [.., a, b] = chain.as_slice() {
            let (ab, ap) = (b - a, point - a);
            if ab.x * ap.y - ab.y * ap.x > 0.0 {
                break;
            }
            chain.pop();
        }
        chain.push(point);
    }
    chain
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check(points: &[(f64, f64)], expected: (f64, f64, f64)) {
        let points: Vec<Point> = points.iter().map(|&(x, y)| Point::new(x, y)).collect();
        let circle = Circle::enclosing(&points).unwrap();
        let (x, y, radius) = expected;
        let off = (circle.center - Point::new(x, y)).norm().max((circle.radius_m - radius).abs());
        assert!(off < 1e-9, "{circle:?}");
    }

    #[test]
    fn known_circles() {
        check(&[(3.0, -2.0)], (3.0, -2.0, 0.0));
        check(&[(3.0, -2.0), (3.0, -2.0)], (3.0, -2.0, 0.0));
        check(&[(0.0, 0.0), (4.0, 0.0)], (2.0, 0.0, 2.0));
        check(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (9.0, 0.0)], (4.5, 0.0, 4.5));
        check(&[(0.0, 0.0), (0.0, 2.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.5)], (1.0, 1.0, 2f64.sqrt()));
        // A flat triangle is held by the circle over its longest side.
        check(&[(0.0, 0.0), (10.0, 0.0), (5.0, 1.0)], (5.0, 0.0, 5.0));
    }

    #[test]
    fn nothing_and_no_numbers_have_no_circle() {
        assert_eq!(Circle::enclosing(&[]), None);
        assert_eq!(Circle::enclosing(&[Point::new(0.0, f64::NAN)]), None);
    }

    proptest! {
        /// Against all circles over two points and through three.
        #[test]
        fn holds_all_points_and_none_is_smaller(
            points in proptest::collection::vec((-20i32..20, -20i32..20), 1..14),
        ) {
            let points: Vec<Point> = points.iter().map(|&(x, y)| Point::new(f64::from(x), f64::from(y))).collect();
            let circle = Circle::enclosing(&points).unwrap();
            prop_assert!(points.iter().all(|&p| nalgebra::distance(&circle.center, &p) <= circle.radius_m + 1e-6));
            for &a in &points {
                for &b in &points {
                    for other in points.iter().filter_map(|&c| Circle::through(a, b, c)).chain([Circle::between(a, b)]) {
                        let holds_all = points.iter().all(|&p| other.holds(p));
                        prop_assert!(!holds_all || circle.radius_m <= other.radius_m + 1e-6);
                    }
                }
            }
        }
    }
}
