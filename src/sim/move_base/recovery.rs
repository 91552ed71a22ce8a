//! The recovery behaviours: move_base's defaults, in their order.

use super::local_planner::LocalPlanner;
use crate::geometry::{Pose, Twist, shortest_angle};
use std::f64::consts::PI;

/// One of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Recovery {
    /// clear_costmap_recovery: obstacles beyond a distance in metres are forgotten. The
    /// static layer stays.
    Clear(f64),
    /// rotate_recovery.
    Rotate,
}

/// `conservative_reset`, `rotate_recovery`, `aggressive_reset`, `rotate_recovery`.
pub const RECOVERIES: [Recovery; 4] = [Recovery::Clear(3.0), Recovery::Rotate, Recovery::Clear(1.84), Recovery::Rotate];

/// Rotates at 0.4 to 1 rad/s, as fast as 3.2 rad/s2 can stop.
const SPEED_RPS: (f64, f64) = (0.4, 1.0);
const ACCELERATION_RPS2: f64 = 3.2;
/// Done this near to where it began, radians (rotate_recovery's default).
const TOLERANCE_RAD: f64 = 0.1;
/// How far apart outlines are checked, radians.
const GRANULARITY_RAD: f64 = 0.017;

/// A full turn under way.
#[derive(Clone, Copy, Debug)]
pub struct Rotation {
    start_yaw: f64,
    got_half: bool,
}

impl Rotation {
    /// From a heading in the odometry's frame.
    pub const fn new(start_yaw: f64) -> Self {
        Self { start_yaw, got_half: false }
    }

    /// The velocity until the next tick; `None` when it is done, or refused because the
    /// outline would touch something on the way.
    pub fn advance(&mut self, pose_in_odom: &Pose, local: &LocalPlanner) -> Option<Twist> {
        let to_start = shortest_angle(pose_in_odom.yaw, self.start_yaw).abs();
        let left = if self.got_half {
            if to_start <= TOLERANCE_RAD {
                return None;
            }
            to_start
        } else {
            let to_half = shortest_angle(pose_in_odom.yaw, self.start_yaw + PI).abs();
            self.got_half = to_half < TOLERANCE_RAD;
            PI + to_half
        };
        let steps = (left / GRANULARITY_RAD).ceil() as u32;
        let turned = |step| pose_in_odom.yaw + f64::from(step) * GRANULARITY_RAD;
        let is_blocked = |step| local.touches(&Pose::new(pose_in_odom.x, pose_in_odom.y, turned(step)));
        if (0..steps).any(is_blocked) {
            return None;
        }
        let speed = (2.0 * ACCELERATION_RPS2 * left).sqrt().clamp(SPEED_RPS.0, SPEED_RPS.1);
        Some(Twist::new(0.0, speed))
    }
}

/// What led to the last recovery.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trigger {
    /// No plan.
    Planning,
    /// No valid velocity.
    Controlling,
    /// No way made.
    Oscillation,
}

/// The words of an aborted goal.
pub const fn abort_text(trigger: Trigger) -> &'static str {
    match trigger {
        Trigger::Planning => "Failed to find a valid plan. Even after executing recovery behaviors.",
        Trigger::Controlling => "Failed to find a valid control. Even after executing recovery behaviors.",
        Trigger::Oscillation => "Robot is oscillating. Even after executing recovery behaviors.",
    }
}
