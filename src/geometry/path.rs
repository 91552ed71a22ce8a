//! A way through the map frame: what planners make and controllers follow.

use super::Pose;

/// A way to go, from the start to the goal, in the map frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// At least the start and the goal; neighbouring poses at most a few cells apart.
    pub poses: Vec<Pose>,
    /// What the planner minimised, in its own unit (comparable within one planner).
    pub cost: f64,
}

impl Path {
    /// Length in metres along the poses.
    #[must_use]
    pub fn length_m(&self) -> f64 {
        self.poses.windows(2).map(|pair| pair[0].distance_to(pair[1].position())).sum()
    }
}
