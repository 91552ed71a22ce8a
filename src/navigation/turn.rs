//! Turning on the spot by more than half a circle: the look around of Yamauchi 1997
//! and Topiwala 2018.

use crate::geometry::{Pose, Twist, shortest_angle};

/// A rest smaller than this is none, radians.
const DONE_RAD: f64 = 0.05;

/// A turn under way: counts what the heading has changed, so that a full turn is one.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// 1 counter-clockwise, -1 clockwise.
    direction: f64,
    remaining_rad: f64,
    speed_rps: f64,
    last_yaw: Option<f64>,
}

impl Turn {
    /// A turn by an angle, counter-clockwise positive.
    pub const fn new(angle_rad: f64, speed_rps: f64) -> Self {
        Self {
            direction: if angle_rad < 0.0 { -1.0 } else { 1.0 },
            remaining_rad: angle_rad,
            speed_rps,
            last_yaw: None,
        }
    }

    /// The command until the next tick, and whether the turn is done.
    pub fn update(&mut self, pose: &Pose) -> (Twist, bool) {
        if let Some(last) = self.last_yaw {
            self.remaining_rad -= shortest_angle(last, pose.yaw);
        }
        self.last_yaw = Some(pose.yaw);
        // Done once the rest is small, or past. A robot that still turns the other way has only
        // more before it.
        let left_rad = self.remaining_rad * self.direction;
        if left_rad < DONE_RAD {
            return (Twist::ZERO, true);
        }
        let speed = (2.0 * left_rad).clamp(0.1, self.speed_rps.max(0.1));
        (Twist::new(0.0, speed * self.direction), false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_full_turn_ends_where_it_began() {
        // Also where the robot comes turning the other way, and takes a while to stop.
        for (angle, speed_before) in [(TAU, 0.0), (-TAU, 0.0), (1.0, 0.0), (TAU, -1.5), (-TAU, 1.5), (0.7, -1.5)] {
            let mut turn = Turn::new(angle, 1.0);
            let (mut pose, mut twist) = (Pose::new(0.0, 0.0, 2.0), Twist::new(0.0, speed_before));
            let (mut turned, mut ticks) = (0.0, 0);
            loop {
                let (wanted, done) = turn.update(&pose);
                if done {
                    break;
                }
                twist.angular_rps += (wanted.angular_rps - twist.angular_rps).clamp(-0.5, 0.5);
                pose = twist.advance(&pose, 0.1);
                turned += twist.angular_rps * 0.1;
                ticks += 1;
                assert!(ticks < 200);
            }
            assert!((turned - angle).abs() < 0.1, "{turned} of {angle} from {speed_before} rad/s");
        }
    }
}
