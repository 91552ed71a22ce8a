//! Turning on the spot by more than half a circle: the look around of Yamauchi 1997
//! and Topiwala 2018.

use crate::geometry::{Pose, Twist, shortest_angle};

/// A turn under way: counts what the heading has changed, so that a full turn is one.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    remaining_rad: f64,
    speed_rps: f64,
    last_yaw: Option<f64>,
}

impl Turn {
    /// A turn by an angle, counter-clockwise positive.
    pub const fn new(angle_rad: f64, speed_rps: f64) -> Self {
        Self { remaining_rad: angle_rad, speed_rps, last_yaw: None }
    }

    /// The command until the next tick, and whether the turn is done.
    pub fn update(&mut self, pose: &Pose, twist: &Twist) -> (Twist, bool) {
        if let Some(last) = self.last_yaw {
            self.remaining_rad -= shortest_angle(last, pose.yaw);
        }
        let wanted_sign = self.remaining_rad.signum();
        let first = self.last_yaw.replace(pose.yaw).is_none();
        // Done once the rest is small, or it went past while turning that way.
        let overshot = !first && twist.angular_rps != 0.0 && wanted_sign != twist.angular_rps.signum();
        if self.remaining_rad.abs() < 0.05 || overshot {
            return (Twist::ZERO, true);
        }
        let speed = (2.0 * self.remaining_rad.abs()).clamp(0.1, self.speed_rps.max(0.1));
        (Twist::new(0.0, speed * wanted_sign), false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_full_turn_ends_where_it_began() {
        for angle in [TAU, -TAU, 1.0] {
            let mut turn = Turn::new(angle, 1.0);
            let (mut pose, mut twist, mut turned, mut ticks) = (Pose::new(0.0, 0.0, 2.0), Twist::ZERO, 0.0, 0);
            loop {
                let (wanted, done) = turn.update(&pose, &twist);
                if done {
                    break;
                }
                twist = wanted;
                pose = twist.advance(&pose, 0.1);
                turned += twist.angular_rps * 0.1;
                ticks += 1;
                assert!(ticks < 200);
            }
            assert!((turned - angle).abs() < 0.1, "{turned} of {angle}");
        }
    }
}
