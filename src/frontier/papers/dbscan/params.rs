//! What the DBSCAN detector alone reads: how near and how many the cells of a cluster are.

use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// No cluster is wider in its links than this many cells.
const MAX_EPS_CELLS: f64 = 100.0;

/// Parameters of DBSCAN.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        let eps = self.eps_cells;
        OutOfRange::unless(
            (1.0..=MAX_EPS_CELLS).contains(&eps),
            "detector.dbscan.eps_cells",
            eps,
            "within 1 to 100 cells",
        )?;
        OutOfRange::unless_positive("detector.dbscan.min_samples", f64::from(self.min_samples))
    }
}
