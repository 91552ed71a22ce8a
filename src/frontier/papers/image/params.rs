//! What the image detector alone reads: the size of its structuring element.

use crate::grid::GridInfo;
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Half of B in cells, where the resolution would ask for more: what a byte counts.
const MAX_HALF_CELLS: f64 = 254.0;

/// Parameters of the image processing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct ImageParams {
    /// Side of the square structuring element B, metres.
    pub element_m: f64,
}

impl Default for ImageParams {
    fn default() -> Self {
        Self { element_m: 0.3 }
    }
}

impl ImageParams {
    /// The numbers with their ranges.
    pub(in crate::frontier) fn numbers(&self) -> [Ranged; 1] {
        [Range::within(0.0, 5.0, "within 0 to 5 m").of("detector.image.element_m", self.element_m)]
    }

    /// How far B reaches to each side of its centre, cells.
    pub(super) fn half_cells(&self, info: &GridInfo) -> u8 {
        info.cells(0.5 * self.element_m).round().clamp(0.0, MAX_HALF_CELLS) as u8
    }
}
