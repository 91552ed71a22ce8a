//! The largest information gain first, however far: the second baseline of Liang 2020
//! (Table 1), where the gain is the radius of the frontier's enclosing circle.

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};

/// The strategy.
///
/// The smaller circle loses, however near it is:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{Candidate, GoalSelector, MaxGain, SelectionContext, StraightWays};
///
/// let robot = Pose::default();
/// let circle = |x: f64, radius_m| {
///     let candidate = Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), 10, 0.05, &robot);
///     Candidate { radius_m: Some(radius_m), ..candidate }
/// };
/// let mut ways = StraightWays { robot_in_map: robot };
/// let circles = [circle(1.0, 0.5), circle(40.0, 0.6)];
/// let scores = MaxGain.score(&circles, &mut SelectionContext::straight(&mut ways));
/// assert!(scores[1].total < scores[0].total);
/// ```
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
