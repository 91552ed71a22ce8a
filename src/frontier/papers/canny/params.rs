//! What the Canny detector alone reads: when a gradient is an edge, and what blocks.

use crate::grid::{INSCRIBED_COST, LETHAL_COST};
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the edges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct CannyParams {
    /// Gradient from which a cell that continues an edge belongs to it, grey levels by Sobel.
    pub low_threshold: f32,
    /// Gradient from which a cell is an edge by itself, grey levels by Sobel.
    pub high_threshold: f32,
    /// Costs of the costmap from here on count as blocked. The default is where the robot's centre
    /// would be in collision; with 1 the whole inflation counts, and doors narrower
    /// than twice the inflation radius are closed.
    pub blocked_cost_min: u8,
}

impl Default for CannyParams {
    fn default() -> Self {
        Self { low_threshold: 60.0, high_threshold: 120.0, blocked_cost_min: INSCRIBED_COST }
    }
}

impl CannyParams {
    /// The numbers with their ranges.
    pub(in crate::frontier) fn numbers(&self) -> [Ranged; 3] {
        let (low, high) = (f64::from(self.low_threshold), f64::from(self.high_threshold));
        let costs = Range::within(1.0, f64::from(LETHAL_COST), "within 1 to 254");
        [
            Range::POSITIVE.of("detector.canny.low_threshold", low),
            Range::within(low, f64::MAX, "finite and >= low_threshold").of("detector.canny.high_threshold", high),
            costs.of("detector.canny.blocked_cost_min", f64::from(self.blocked_cost_min)),
        ]
    }
}
