//! Velocities of a differential-drive body and what it is able to do.

use super::Pose;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A velocity command or state: `geometry_msgs/Twist` of a robot that cannot slide.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// Forward speed in metres per second.
    pub linear_mps: f64,
    /// Turning speed in radians per second, counter-clockwise positive.
    pub angular_rps: f64,
}

impl Twist {
    /// Standing still.
    pub const ZERO: Self = Self { linear_mps: 0.0, angular_rps: 0.0 };

    /// A twist from metres and radians per second.
    #[must_use]
    pub const fn new(linear_mps: f64, angular_rps: f64) -> Self {
        Self { linear_mps, angular_rps }
    }

    /// Where a body at `pose` is after holding this twist for `dt_s` seconds:
    /// exact motion along the arc, not an Euler step.
    #[must_use]
    pub fn advance(&self, pose: &Pose, dt_s: f64) -> Pose {
        let turned = self.angular_rps * dt_s;
        let driven = self.linear_mps * dt_s;
        // The chord of an arc of length `driven`, which tends to `driven` itself.
        let half = 0.5 * turned;
        let chord = if half.abs() < 1e-9 { driven } else { driven * half.sin() / half };
        let heading = pose.yaw + half;
        Pose::new(
            pose.x + chord * heading.cos(),
            pose.y + chord * heading.sin(),
            super::normalize_angle(pose.yaw + turned),
        )
    }

    /// Whether the body neither drives nor turns, to within a millimetre and a
    /// milliradian per second.
    #[must_use]
    pub fn is_still(&self) -> bool {
        self.linear_mps.abs() < 1e-3 && self.angular_rps.abs() < 1e-3
    }
}

/// Speed and acceleration limits of a differential-drive robot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionLimits {
    /// Largest forward speed, metres per second.
    pub max_linear_mps: f64,
    /// Largest turning speed either way, radians per second.
    pub max_angular_rps: f64,
    /// Largest change of the forward speed, metres per second squared.
    pub max_linear_mps2: f64,
    /// Largest change of the turning speed, radians per second squared.
    pub max_angular_rps2: f64,
}

impl MotionLimits {
    /// The twist nearest to `wanted` that can be reached from `current` in `dt_s`
    /// seconds under the acceleration and speed limits. It never drives backwards
    /// faster than it may drive forwards.
    #[must_use]
    pub fn reachable(&self, current: &Twist, wanted: &Twist, dt_s: f64) -> Twist {
        let step = |from: f64, to: f64, top: f64, acceleration: f64| {
            let to = to.clamp(-top, top);
            from + (to - from).clamp(-acceleration * dt_s, acceleration * dt_s)
        };
        Twist::new(
            step(current.linear_mps, wanted.linear_mps, self.max_linear_mps, self.max_linear_mps2),
            step(current.angular_rps, wanted.angular_rps, self.max_angular_rps, self.max_angular_rps2),
        )
    }

    /// Metres needed to stop from `speed_mps` at the full deceleration.
    #[must_use]
    pub fn stopping_distance_m(&self, speed_mps: f64) -> f64 {
        speed_mps * speed_mps / (2.0 * self.max_linear_mps2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const LIMITS: MotionLimits =
        MotionLimits { max_linear_mps: 0.5, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 };

    #[test]
    fn half_a_circle_ends_a_diameter_aside() {
        let pose = Twist::new(1.0, 1.0).advance(&Pose::default(), PI);
        assert!(pose.x.abs() < 1e-9 && (pose.y - 2.0).abs() < 1e-9 && (pose.yaw - PI).abs() < 1e-9);
    }

    #[test]
    fn accelerations_and_speeds_are_limited() {
        let twist = LIMITS.reachable(&Twist::ZERO, &Twist::new(9.0, -9.0), 0.1);
        assert_eq!(twist, Twist::new(0.1, -0.4));
        let fast = LIMITS.reachable(&Twist::new(0.45, 0.0), &Twist::new(9.0, 0.0), 0.1);
        assert_eq!(fast.linear_mps, 0.5);
    }

    #[test]
    fn stopping_distance_is_half_v_squared_over_a() {
        assert!((LIMITS.stopping_distance_m(0.5) - 0.125).abs() < 1e-12);
    }
}
