//! The pose of a body in the plane, and angle arithmetic.

use super::Point;
use nalgebra::{Isometry2, Vector2};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// A position in metres and a heading in radians, in a frame named by its user.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Pose {
    /// Metres along the frame's x axis.
    pub x: f64,
    /// Metres along the frame's y axis.
    pub y: f64,
    /// Heading in radians, counter-clockwise from the x axis.
    #[serde(default)]
    pub yaw: f64,
}

impl Pose {
    /// A pose from metres and radians.
    #[must_use]
    pub const fn new(x: f64, y: f64, yaw: f64) -> Self {
        Self { x, y, yaw }
    }

    /// A pose at `position` that faces `target`; yaw 0 when the two coincide.
    #[must_use]
    pub fn facing(position: Point, target: Point) -> Self {
        let ahead = target - position;
        Self::new(position.x, position.y, ahead.y.atan2(ahead.x))
    }

    /// The position alone.
    #[must_use]
    pub fn position(&self) -> Point {
        Point::new(self.x, self.y)
    }

    /// Whether all three numbers are finite.
    #[must_use]
    pub fn is_finite(&self) -> bool {
        self.x.is_finite() && self.y.is_finite() && self.yaw.is_finite()
    }

    /// Euclidean distance in metres to a point of the same frame.
    #[must_use]
    pub fn distance_to(&self, point: Point) -> f64 {
        nalgebra::distance(&self.position(), &point)
    }

    /// This pose as the transform `parent_from_body`.
    #[must_use]
    pub fn isometry(&self) -> Isometry2<f64> {
        Isometry2::new(Vector2::new(self.x, self.y), self.yaw)
    }

    /// The pose that a transform `parent_from_body` stands for.
    #[must_use]
    pub fn from_isometry(isometry: &Isometry2<f64>) -> Self {
        let t = isometry.translation.vector;
        Self::new(t.x, t.y, isometry.rotation.angle())
    }

    /// Takes a point of the body's frame into the parent frame.
    #[must_use]
    pub fn transform(&self, point_in_body: Point) -> Point {
        self.isometry() * point_in_body
    }

    /// The pose `body_in_parent * other_in_body`.
    #[must_use]
    pub fn compose(&self, other_in_body: &Self) -> Self {
        Self::from_isometry(&(self.isometry() * other_in_body.isometry()))
    }

    /// The transform back: the parent's pose seen from the body.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self::from_isometry(&self.isometry().inverse())
    }
}

/// The same angle within (-pi, pi].
#[must_use]
pub fn normalize_angle(angle_rad: f64) -> f64 {
    let wrapped = angle_rad.rem_euclid(TAU);
    if wrapped > PI { wrapped - TAU } else { wrapped }
}

/// The signed turn in (-pi, pi] that leads from one heading to another.
#[must_use]
pub fn shortest_angle(from_rad: f64, to_rad: f64) -> f64 {
    normalize_angle(to_rad - from_rad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn angles_wrap_into_the_half_open_turn() {
        for (angle, expected) in [(0.0, 0.0), (3.0 * PI, PI), (-PI, PI), (-0.5, -0.5), (7.0, 7.0 - TAU)] {
            assert!((normalize_angle(angle) - expected).abs() < 1e-12, "{angle}");
        }
        assert!((shortest_angle(3.0, -3.0) - (TAU - 6.0)).abs() < 1e-12);
    }

    #[test]
    fn a_pose_and_its_inverse_cancel() {
        let pose = Pose::new(2.0, -1.0, 0.7);
        let identity = pose.compose(&pose.inverse());
        assert!(identity.x.abs() < 1e-12 && identity.y.abs() < 1e-12 && identity.yaw.abs() < 1e-12);
    }

    #[test]
    fn a_quarter_turn_takes_x_to_y() {
        let point = Pose::new(1.0, 2.0, FRAC_PI_2).transform(Point::new(3.0, 0.0));
        assert!((point - Point::new(1.0, 5.0)).norm() < 1e-12);
    }

    #[test]
    fn facing_looks_at_the_target() {
        let pose = Pose::facing(Point::new(1.0, 1.0), Point::new(1.0, 3.0));
        assert!((pose.yaw - FRAC_PI_2).abs() < 1e-12);
    }
}
