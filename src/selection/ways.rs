//! What strategies may ask about the ways over a map, beyond each candidate's own.

use crate::geometry::{Point, Pose, shortest_angle};

/// Answers questions about ways; each answer may cost a search.
pub trait Ways {
    /// How long the way from the robot to a place is, metres, infinite where none is known; and
    /// how far it would have to turn to set out, radians, 0 to pi.
    fn set_out(&mut self, to: Point) -> (f64, f64);

    /// How long the ways from a place to others are, metres; infinite where none is known.
    fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64>;
}

/// Straight lines, for where nothing is in the way.
#[derive(Clone, Copy, Debug)]
pub struct StraightWays {
    /// Where the robot is and where it faces.
    pub robot_in_map: Pose,
}

impl Ways for StraightWays {
    fn set_out(&mut self, to: Point) -> (f64, f64) {
        let heading = Pose::facing(self.robot_in_map.position(), to).yaw;
        (self.robot_in_map.distance_to(to), shortest_angle(self.robot_in_map.yaw, heading).abs())
    }

    fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64> {
        to.iter().map(|point| nalgebra::distance(&from, point)).collect()
    }
}
