//! The largest radius for its distance first: e = radius / distance.
//!
//! Liang, Wang and Li 2020, eq. 7: the radius of the minimum enclosing circle is the
//! information gain, the Euclidean distance from its centre to the robot the cost.

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};

/// Nearer than this counts as this, metres: the ratio stays finite.
const NEAREST_M: f64 = 1e-3;

/// The strategy.
///
/// Twice the radius makes up for twice the distance, and no more:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{Candidate, GoalSelector, RadiusDistance, SelectionContext, StraightWays};
///
/// let robot_in_map = Pose::new(1.0, 0.0, 0.0);
/// let circles = [(3.0, 0.5), (5.0, 1.0), (9.0, 1.0)].map(|(x, radius_m)| Candidate {
///     radius_m: Some(radius_m),
///     ..Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), 10, 0.05, &robot_in_map)
/// });
/// let mut ways = StraightWays { robot_in_map };
/// let scores = RadiusDistance.score(&circles, &mut SelectionContext::straight(&mut ways));
/// assert_eq!(scores.iter().map(|score| score.parts["e"]).collect::<Vec<_>>(), [0.25, 0.25, 0.125]);
/// assert_eq!(scores[0].total, -0.25);
/// ```
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
