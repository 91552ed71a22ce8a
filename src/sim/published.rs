//! The map that a simulated SLAM published last, with the costmap that is made of it.

use crate::grid::{Changes, Costmap, LiveCostmap, OccupancyGrid, Snapshot};
use crate::robot::MapSnapshot;
use std::sync::Arc;

/// A published map with its costmap.
#[derive(Debug)]
pub(super) struct Published {
    /// When the map was true, seconds.
    pub stamp_s: f64,
    /// Its version counts the maps that were published, also those of which nothing changed.
    pub map: Snapshot<OccupancyGrid>,
    /// The costmap made of it.
    pub costmap: Snapshot<Costmap>,
    /// The version of the map that the mapper knows it by.
    mapped: u64,
    costs: LiveCostmap,
}

impl Published {
    /// The first map.
    pub fn begin(grid: Snapshot<OccupancyGrid>, mut costs: LiveCostmap) -> Self {
        let mapped = grid.changes.version();
        let map = Snapshot { changes: Changes::beginning_at(1), ..grid };
        let costmap = costs.update(&map.cells, &map.changes);
        Self { stamp_s: 0.0, map, costmap, mapped, costs }
    }

    /// Takes the next map; whether it may be another than the last.
    pub fn renew(&mut self, stamp_s: f64, grid: Snapshot<OccupancyGrid>) -> bool {
        let since = grid.changes.since_on((self.mapped, self.map.cells.info()), grid.cells.info());
        self.mapped = grid.changes.version();
        self.map = Snapshot { changes: self.map.changes.then_since(&since), ..grid };
        self.costmap = self.costs.update(&self.map.cells, &self.map.changes);
        self.stamp_s = stamp_s;
        !since.is_nothing()
    }

    /// As the port hands it over.
    pub fn snapshot(&self) -> MapSnapshot {
        let (grid, changes) = (Arc::clone(&self.map.cells), self.map.changes.clone());
        MapSnapshot { stamp_s: self.stamp_s, grid, changes, costmap: Some(self.costmap.clone()) }
    }
}
