//! What comes of a SLAM: a map as it is published.

use crate::grid::{OccupancyGrid, Snapshot};

/// A map as it is published, and the time in seconds up to which it shows what was sensed.
pub struct NewMap {
    pub grid: Snapshot<OccupancyGrid>,
    pub stamp_s: f64,
    /// What the scans in it show when they are put where they were truly taken, in the world's
    /// frame: coverage is counted here. With a perfect SLAM this is the map itself.
    pub seen: Snapshot<OccupancyGrid>,
}

impl std::fmt::Debug for NewMap {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("NewMap").field("stamp_s", &self.stamp_s).finish_non_exhaustive()
    }
}
