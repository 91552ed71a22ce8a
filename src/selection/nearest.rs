//! The nearest frontier first, by the straight line from the robot.
//!
//! Topiwala, Inani and Kathpal 2018, section III: medians "arranged in the increasing
//! order of the Euclidean distance from the current robot pose".

use super::{Candidate, GoalSelector, Score, SelectionContext};

/// The strategy.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest;

impl GoalSelector for Nearest {
    fn name(&self) -> &'static str {
        "nearest"
    }

    fn score(&mut self, candidates: &[Candidate], _: &SelectionContext) -> Vec<Score> {
        candidates.iter().map(|c| Score { total: c.distance_m, parts: [("distance_m", c.distance_m)].into() }).collect()
    }
}
