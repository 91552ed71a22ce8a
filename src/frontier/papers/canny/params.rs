//! What the Canny detector alone reads: when a gradient is an edge, and what blocks.

use crate::grid::{INSCRIBED_COST, LETHAL_COST};
use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// Parameters of the edges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CannyParams {
    /// Gradient from which a cell that continues an edge belongs to it.
    pub low_threshold: f32,
    /// Gradient from which a cell is an edge by itself.
    pub high_threshold: f32,
    /// Costs from here on count as blocked. The default is where the robot's centre
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
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        let (low, high) = (f64::from(self.low_threshold), f64::from(self.high_threshold));
        OutOfRange::unless_positive("detector.canny.low_threshold", low)?;
        OutOfRange::unless(
            high.is_finite() && high >= low,
            "detector.canny.high_threshold",
            high,
            "finite and >= low_threshold",
        )?;
        OutOfRange::unless(
            (1..=LETHAL_COST).contains(&self.blocked_cost_min),
            "detector.canny.blocked_cost_min",
            f64::from(self.blocked_cost_min),
            "within 1 to 254",
        )
    }
}
