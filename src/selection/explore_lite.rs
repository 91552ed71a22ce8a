//! explore_lite's cost, with its parameter names (m-explore, `FrontierSearch`).
//!
//! cost = potential_scale * distance * resolution - gain_scale * size, where the distance
//! is that of the frontier's nearest cell and the size its cells times the resolution,
//! both in metres. That the distance is multiplied by the resolution too, as if it were
//! cells, looks like an oversight there (3.0 weighs 0.15 a metre at 0.05 m); but it is what
//! its users have tuned their values by. The
//! `orientation_scale` of its launch files weighs the turn that the robot must make,
//! radians; explore_lite reads it and does not use it.

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};
use crate::geometry::{Pose, shortest_angle};
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Weights, with the values of explore_lite's launch file.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ExploreLiteConfig {
    /// Weight of the distance, per metre and metre of resolution.
    pub potential_scale: f64,
    /// Weight of the turn, per radian.
    pub orientation_scale: f64,
    /// Weight of the size, per metre.
    pub gain_scale: f64,
}

impl Default for ExploreLiteConfig {
    fn default() -> Self {
        Self { potential_scale: 3.0, orientation_scale: 0.0, gain_scale: 1.0 }
    }
}

impl ExploreLiteConfig {
    /// The weights with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        let weights = [
            ("selection.potential_scale", self.potential_scale),
            ("selection.orientation_scale", self.orientation_scale),
            ("selection.gain_scale", self.gain_scale),
        ];
        weights.map(|(key, value)| Range::NOT_NEGATIVE.of(key, value)).into()
    }
}

/// The strategy.
///
/// With the scales of its launch file a metre of frontier outweighs six metres of distance at
/// cells of 0.05 m, since the distance is multiplied by the resolution:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{
///     Candidate, ExploreLite, ExploreLiteConfig, GoalSelector, SelectionContext, StraightWays,
/// };
///
/// let robot_in_map = Pose::default();
/// let at = |x: f64, cells| Candidate {
///     nearest_m: Some(x),
///     ..Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), cells, 0.05, &robot_in_map)
/// };
/// let mut selector = ExploreLite(ExploreLiteConfig::default());
/// let mut ways = StraightWays { robot_in_map };
/// let scores = selector.score(&[at(1.0, 20), at(7.0, 40)], &mut SelectionContext::straight(&mut ways));
/// // 3.0 * 1.0 * 0.05 - 1.0 * 1.0, and 3.0 * 7.0 * 0.05 - 1.0 * 2.0
/// assert!((scores[0].total - -0.85).abs() < 1e-9 && (scores[1].total - -0.95).abs() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct ExploreLite(pub ExploreLiteConfig);

impl GoalSelector for ExploreLite {
    fn name(&self) -> &'static str {
        "explore_lite"
    }

    fn needs(&self) -> Needs {
        Needs { nearest: true, ..Needs::default() }
    }

    fn score(&mut self, candidates: &[Candidate], context: &mut SelectionContext<'_>) -> Vec<Score> {
        let (config, robot) = (self.0, context.robot_in_map);
        candidates
            .iter()
            .map(|c| {
                let turn_rad = shortest_angle(robot.yaw, Pose::facing(robot.position(), c.target).yaw).abs();
                let resolution_m = c.size_m / c.size_cells.max(1) as f64;
                let potential = config.potential_scale * c.nearest_m.unwrap_or(c.distance_m) * resolution_m;
                let orientation = config.orientation_scale * turn_rad;
                let gain = config.gain_scale * c.size_m;
                let parts = [("potential", potential), ("orientation", orientation), ("gain", gain)];
                Score { total: potential + orientation - gain, parts: parts.into() }
            })
            .collect()
    }
}
