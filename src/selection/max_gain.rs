//! The largest information gain first, however far: the second baseline of Liang 2020
//! (Table 1), where the gain is the radius of the frontier's enclosing circle.

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};

/// The strategy.
#[derive(Clone, Copy, Debug, Default)]
pub struct MaxGain;

impl GoalSelector for MaxGain {
    fn name(&self) -> &'static str {
        "max_gain"
    }

    fn needs(&self) -> Needs {
        Needs { radius: true, ..Needs::default() }
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        let gains_m = candidates.iter().map(|c| c.radius_m.unwrap_or_default());
        gains_m.map(|gain_m| Score { total: -gain_m, parts: [("radius_m", gain_m)].into() }).collect()
    }
}
