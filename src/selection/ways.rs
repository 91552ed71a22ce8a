//! What strategies may ask about the ways over a map, beyond each candidate's own.

use crate::geometry::Point;

/// Answers questions about ways; each answer may cost a search.
pub trait Ways {
    /// How long the ways from a place to others are, metres; infinite where none is known.
    fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64>;

    /// How far the robot would have to turn to set out for a place, radians, 0 to pi.
    fn turn_rad(&mut self, to: Point) -> f64;
}

/// Straight lines, for where nothing is in the way.
#[derive(Clone, Copy, Debug)]
pub struct StraightWays {
    /// Where the robot is and where it faces.
    pub robot_in_map: crate::geometry::Pose,
}

impl Ways for StraightWays {
    fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64> {
        to.iter().map(|point| nalgebra::distance(&from, point)).collect()
    }

    fn turn_rad(&mut self, to: Point) -> f64 {
        let heading = crate::geometry::Pose::facing(self.robot_in_map.position(), to).yaw;
        crate::geometry::shortest_angle(self.robot_in_map.yaw, heading).abs()
    }
}
