//! Size and distance together: larger is cheaper, nearer is cheaper.
//!
//! Alghfeli, Alhosani and Almheiri, section III.A: "information gain gives less cost to
//! larger clusters, while Euclidean distance gives less cost to closer centroids". The
//! paper leaves the scaling open; both costs are scaled to 0..=1 over the candidates
//! present and weighted.

use super::{Candidate, GoalSelector, Score, SelectionContext};
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Weights of the two costs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct JointCostConfig {
    /// Weight of the cost of being small, a cost of 0 to 1.
    pub size_weight: f64,
    /// Weight of the cost of being far, a cost of 0 to 1.
    pub distance_weight: f64,
}

impl Default for JointCostConfig {
    fn default() -> Self {
        Self { size_weight: 0.5, distance_weight: 0.5 }
    }
}

impl JointCostConfig {
    /// The weights with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        let weights =
            [("selection.size_weight", self.size_weight), ("selection.distance_weight", self.distance_weight)];
        weights.map(|(key, value)| Range::NOT_NEGATIVE.of(key, value)).into()
    }
}

/// The strategy.
///
/// Both costs are shares of the largest among the candidates, and the weights decide:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{
///     Candidate, GoalSelector, JointCost, JointCostConfig, SelectionContext, StraightWays,
/// };
///
/// let robot_in_map = Pose::default();
/// let at = |x: f64, cells| Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), cells, 0.5, &robot_in_map);
/// let (near_and_small, far_and_large) = (at(2.0, 3), at(8.0, 12));
/// let totals = |size_weight, distance_weight| {
///     let mut joint = JointCost(JointCostConfig { size_weight, distance_weight });
///     let mut ways = StraightWays { robot_in_map };
///     let both = [near_and_small.clone(), far_and_large.clone()];
///     let scores = joint.score(&both, &mut SelectionContext::straight(&mut ways));
///     [scores[0].total, scores[1].total]
/// };
/// assert_eq!(totals(1.0, 0.0), [0.75, 0.0]);
/// assert_eq!(totals(0.0, 1.0), [0.25, 1.0]);
/// assert_eq!(totals(0.5, 0.5), [0.5, 0.5]);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct JointCost(pub JointCostConfig);

impl GoalSelector for JointCost {
    fn name(&self) -> &'static str {
        "joint_cost"
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        let largest = |value: fn(&Candidate) -> f64| candidates.iter().map(value).fold(f64::MIN_POSITIVE, f64::max);
        let (largest_m, farthest_m) = (largest(|c| c.size_m), largest(|c| c.distance_m));
        candidates
            .iter()
            .map(|c| {
                let size_cost = 1.0 - c.size_m / largest_m;
                let distance_cost = c.distance_m / farthest_m;
                let total = self.0.size_weight * size_cost + self.0.distance_weight * distance_cost;
                Score { total, parts: [("size_cost", size_cost), ("distance_cost", distance_cost)].into() }
            })
            .collect()
    }
}
