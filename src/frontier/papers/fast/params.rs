//! What the fast detector alone reads: which cells it examines.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the fast detector.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct FastParams {
    /// Whether cells that changed since the last call are examined besides the contour.
    pub changed_cells: bool,
}

impl Default for FastParams {
    fn default() -> Self {
        Self { changed_cells: true }
    }
}
