//! Where the wheels believe the robot is.
//!
//! The odometry motion model of *Probabilistic Robotics* (Thrun, Burgard, Fox 2005),
//! table 5.6 (`sample_motion_model_odometry`): a motion is a turn, a straight drive
//! and another turn, and each is mistaken by a gaussian whose variance grows with the
//! squares of what was turned and driven. As in AMCL, driving backwards counts as
//! such and not as two half turns.

use crate::geometry::{Pose, Twist, shortest_angle};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg32;
use serde::{Deserialize, Serialize};

/// Which sequence of the seed the odometry's errors are drawn from.
const STREAM: u64 = 0x0d0;

/// The four alphas, as standard deviations over a motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct OdometryNoise {
    /// Alpha 1: radians of turning error a radian turned.
    pub turn_by_turn: f64,
    /// Alpha 2: radians of turning error a metre driven.
    pub turn_by_drive: f64,
    /// Alpha 3: metres of driving error a metre driven.
    pub drive_by_drive: f64,
    /// Alpha 4: metres of driving error a radian turned.
    pub drive_by_turn: f64,
}

impl OdometryNoise {
    /// Wheels that never slip.
    pub const NONE: Self = Self { turn_by_turn: 0.0, turn_by_drive: 0.0, drive_by_drive: 0.0, drive_by_turn: 0.0 };

    /// Wheels that slip so that a SLAM which matches every 0.3 m is corrected by as much
    /// as gmapping was in recorded runs. Errors are drawn for each of many short steps and
    /// mostly cancel, so that these are larger than gmapping's own `srr` and the like.
    pub const SLIPPING: Self = Self { turn_by_turn: 0.3, turn_by_drive: 0.2, drive_by_drive: 0.4, drive_by_turn: 0.3 };
}

/// Dead reckoning with errors.
#[derive(Clone, Debug)]
pub struct Odometry {
    noise: OdometryNoise,
    random: Pcg32,
    pose_in_odom: Pose,
}

impl Odometry {
    /// Odometry that starts at its frame's origin; `seed` decides the errors.
    #[must_use]
    pub fn new(noise: OdometryNoise, seed: u64) -> Self {
        Self { noise, random: Pcg32::new(seed, STREAM), pose_in_odom: Pose::default() }
    }

    /// The pose that the wheels were counted to, in the odometry's frame.
    #[must_use]
    pub const fn pose_in_odom(&self) -> Pose {
        self.pose_in_odom
    }

    /// Counts the motion of a body that held a twist for `dt_s` seconds.
    pub fn advance(&mut self, twist: &Twist, dt_s: f64) {
        if self.noise == OdometryNoise::NONE {
            self.pose_in_odom = twist.advance(&self.pose_in_odom, dt_s);
            return;
        }
        let moved = twist.advance(&Pose::default(), dt_s);
        let straight_m = moved.x.hypot(moved.y).copysign(twist.linear_mps);
        // An arc leaves along its chord, half of its turn aside.
        let first_rad = 0.5 * twist.angular_rps * dt_s;
        let second_rad = shortest_angle(first_rad, moved.yaw);
        let n = self.noise;
        let first = first_rad + self.error(n.turn_by_turn * first_rad, n.turn_by_drive * straight_m);
        let turned_rad = first_rad.hypot(second_rad);
        let straight = straight_m + self.error(n.drive_by_drive * straight_m, n.drive_by_turn * turned_rad);
        let second = second_rad + self.error(n.turn_by_turn * second_rad, n.turn_by_drive * straight_m);
        let heading = self.pose_in_odom.yaw + first;
        self.pose_in_odom = Pose::new(
            self.pose_in_odom.x + straight * heading.cos(),
            self.pose_in_odom.y + straight * heading.sin(),
            crate::geometry::normalize_angle(heading + second),
        );
    }

    /// A gaussian whose variance is the sum of two.
    fn error(&mut self, a: f64, b: f64) -> f64 {
        let deviation: f64 = StandardNormal.sample(&mut self.random);
        a.hypot(b) * deviation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE: OdometryNoise =
        OdometryNoise { turn_by_turn: 0.1, turn_by_drive: 0.1, drive_by_drive: 0.1, drive_by_turn: 0.1 };

    fn drive(noise: OdometryNoise, seed: u64) -> Pose {
        let mut odometry = Odometry::new(noise, seed);
        for step in 0..200 {
            let twist = Twist::new(if step < 150 { 0.4 } else { -0.2 }, 0.3);
            odometry.advance(&twist, 0.02);
        }
        odometry.pose_in_odom()
    }

    #[test]
    fn without_noise_it_is_the_motion_itself() {
        let tiny = OdometryNoise { turn_by_turn: 1e-12, ..OdometryNoise::NONE };
        let (exact, sampled) = (drive(OdometryNoise::NONE, 0), drive(tiny, 0));
        assert!((exact.x - sampled.x).abs() < 1e-9 && (exact.y - sampled.y).abs() < 1e-9);
        assert!((exact.yaw - sampled.yaw).abs() < 1e-9);
    }

    #[test]
    fn the_seed_decides_the_error() {
        assert_eq!(drive(NOISE, 3), drive(NOISE, 3));
        assert_ne!(drive(NOISE, 3), drive(NOISE, 4));
        assert_ne!(drive(NOISE, 3), drive(OdometryNoise::NONE, 3));
    }

    #[test]
    fn standing_still_adds_no_error() {
        let mut odometry = Odometry::new(NOISE, 1);
        odometry.advance(&Twist::ZERO, 1.0);
        assert_eq!(odometry.pose_in_odom(), Pose::default());
    }
}
