//! The largest radius for its distance first: e = radius / distance.
//!
//! Liang, Wang and Li 2020, eq. 7: the radius of the minimum enclosing circle is the
//! information gain, the Euclidean distance from its centre to the robot the cost.

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};

/// Nearer than this counts as this, metres: the ratio stays finite.
const NEAREST_M: f64 = 1e-3;

/// The strategy.
#[derive(Clone, Copy, Debug, Default)]
pub struct RadiusDistance;

impl GoalSelector for RadiusDistance {
    fn name(&self) -> &'static str {
        "radius_distance"
    }

    fn needs(&self) -> Needs {
        Needs { radius: true, ..Needs::default() }
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        candidates
            .iter()
            .map(|c| {
                let radius_m = c.radius_m.unwrap_or_default();
                let e = radius_m / c.distance_m.max(NEAREST_M);
                let parts = [("radius_m", radius_m), ("distance_m", c.distance_m), ("e", e)];
                Score { total: -e, parts: parts.into() }
            })
            .collect()
    }
}
