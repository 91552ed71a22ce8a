//! The nearest frontier first.
//!
//! Topiwala, Inani and Kathpal 2018, section III: medians "arranged in the increasing
//! order of the Euclidean distance from the current robot pose". Yamauchi 1997 goes to
//! the nearest by the way that the planner finds.

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How nearness is measured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DistanceMeasure {
    /// By the straight line to the frontier.
    #[default]
    Euclidean,
    /// By the cost of the cheapest way to the goal.
    Path,
}

impl DistanceMeasure {
    /// The distance of a candidate, metres.
    #[must_use]
    pub fn of_m(self, candidate: &Candidate) -> f64 {
        match self {
            Self::Euclidean => candidate.distance_m,
            Self::Path => candidate.way_m.unwrap_or(candidate.distance_m),
        }
    }
}

/// Parameters of the strategy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NearestConfig {
    /// How nearness is measured.
    pub distance: DistanceMeasure,
}

/// The strategy.
///
/// The nearest by the straight line may be the farther one by the way there:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{
///     Candidate, DistanceMeasure, GoalSelector, Nearest, NearestConfig, SelectionContext, StraightWays,
/// };
///
/// let robot = Pose::default();
/// let at = |x: f64| Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), 10, 0.05, &robot);
/// let behind_a_wall = Candidate { way_m: Some(9.0), ..at(1.0) };
/// let candidates = [behind_a_wall, Candidate { way_m: Some(3.0), ..at(3.0) }];
/// let totals = |distance| {
///     let mut nearest = Nearest(NearestConfig { distance });
///     let mut ways = StraightWays { robot_in_map: robot };
///     let scores = nearest.score(&candidates, &mut SelectionContext::straight(&mut ways));
///     scores.iter().map(|score| score.total).collect::<Vec<_>>()
/// };
/// assert_eq!(totals(DistanceMeasure::Euclidean), [1.0, 3.0]);
/// assert_eq!(totals(DistanceMeasure::Path), [9.0, 3.0]);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Nearest(pub NearestConfig);

impl GoalSelector for Nearest {
    fn name(&self) -> &'static str {
        "nearest"
    }

    fn needs(&self) -> Needs {
        Needs { way: self.0.distance == DistanceMeasure::Path, ..Needs::default() }
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        candidates
            .iter()
            .map(|c| {
                let distance_m = self.0.distance.of_m(c);
                Score { total: distance_m, parts: [("distance_m", distance_m)].into() }
            })
            .collect()
    }
}
