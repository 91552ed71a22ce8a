//! The largest information gain first, however far: the second baseline of Liang 2020
//! (Table 1), where the gain is the radius of the frontier's enclosing circle.

use super::{Candidate, GoalSelector, Score, SelectionContext};

/// The strategy.
#[derive(Clone, Copy, Debug, Default)]
pub struct MaxGain;

impl GoalSelector for MaxGain {
    fn name(&self) -> &'static str {
        "max_gain"
    }

    fn score(&mut self, candidates: &[Candidate], _: &SelectionContext) -> Vec<Score> {
        candidates.iter().map(|c| Score { total: -c.radius_m, parts: [("radius_m", c.radius_m)].into() }).collect()
    }
}
