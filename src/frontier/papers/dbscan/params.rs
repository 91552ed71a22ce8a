//! What the DBSCAN detector alone reads: how near and how many the cells of a cluster are.

use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// No cluster is wider in its links than this many cells.
const MAX_EPS_CELLS: f64 = 100.0;

/// Parameters of DBSCAN.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DbscanParams {
    /// Cells whose centres are at most so far apart are neighbours, cells.
    pub eps_cells: f64,
    /// A core cell has at least so many neighbours, itself included.
    pub min_samples: u32,
}

impl Default for DbscanParams {
    fn default() -> Self {
        Self { eps_cells: 3.0, min_samples: 5 }
    }
}

impl DbscanParams {
    /// The numbers with their ranges.
    pub(in crate::frontier) fn numbers(&self) -> [Ranged; 2] {
        [
            Range::within(1.0, MAX_EPS_CELLS, "within 1 to 100 cells").of("detector.dbscan.eps_cells", self.eps_cells),
            Range::POSITIVE.of("detector.dbscan.min_samples", f64::from(self.min_samples)),
        ]
    }
}
