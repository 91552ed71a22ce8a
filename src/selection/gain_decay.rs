//! What waits at the end of a way, discounted by its length: gain times exp(-lambda way).
//!
//! Gonzalez-Banos and Latombe, "Navigation Strategies for Exploring Indoor Environments"
//! (2002); the gain is here the length of the frontier, as nobody knows what area lies behind
//! it, and `lambda_per_m` is 0.1 unless set. O(candidates).

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the strategy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GainDecayConfig {
    /// How fast the gain decays with the way: by e to the minus this for each of its metres. At
    /// 0.1 half of it is left after 7 m.
    pub lambda_per_m: f64,
}

impl Default for GainDecayConfig {
    fn default() -> Self {
        Self { lambda_per_m: 0.1 }
    }
}

impl GainDecayConfig {
    /// The numbers with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        vec![Range::NOT_NEGATIVE.of("selection.lambda_per_m", self.lambda_per_m)]
    }
}

/// The strategy.
///
/// Twice the gain makes up for 7 m more of way at the default, and for none of 20 m:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{
///     Candidate, GainDecay, GoalSelector, SelectionContext, StraightWays,
/// };
///
/// let robot_in_map = Pose::default();
/// let at = |x: f64, cells| Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), cells, 0.5, &robot_in_map);
/// let candidates = [at(1.0, 4), at(7.0, 8), at(21.0, 8)];
/// let mut ways = StraightWays { robot_in_map };
/// let scores = GainDecay::default().score(&candidates, &mut SelectionContext::straight(&mut ways));
/// assert!(scores[1].total < scores[0].total && scores[0].total < scores[2].total);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct GainDecay(pub GainDecayConfig);

impl GoalSelector for GainDecay {
    fn name(&self) -> &'static str {
        "gain_decay"
    }

    fn needs(&self) -> Needs {
        Needs { way: true, ..Needs::default() }
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        let of = |c: &Candidate| {
            let way_m = c.way_m.unwrap_or(c.distance_m);
            let gain = c.size_m * (-self.0.lambda_per_m * way_m).exp();
            Score { total: -gain, parts: [("gain", gain), ("way_m", way_m)].into() }
        };
        candidates.iter().map(of).collect()
    }
}
