//! The costmaps that decisions are made on, each made of another and kept up to date.

use crate::geometry::Areas;
use crate::grid::{Costmap, Inflation, LiveCostmap, Roomy, Snapshot, Thresholds};
use crate::planning::{Fence, Opened, Passable};
use crate::robot::MapSnapshot;

/// The costmaps of a decision, one made of the other and each kept up to date.
pub(super) struct Costs {
    /// Our own, where the map comes without one.
    own: LiveCostmap,
    /// For a robot that keeps to where it can turn.
    pub roomy: Roomy,
    /// The same, and what was driven through stays open.
    pub opened: Opened,
    /// The same, and closed where the areas forbid it.
    pub fence: Fence,
    margin_m: f64,
    pub passable: Passable,
}

impl Costs {
    /// Of nothing so far.
    pub fn new(thresholds: Thresholds, inflation: Inflation, areas: Areas) -> Self {
        let margin_m = inflation.inscribed_radius_m;
        Self {
            fence: Fence::new(areas, margin_m),
            margin_m,
            own: LiveCostmap::new(thresholds, inflation),
            roomy: Roomy::default(),
            opened: Opened::default(),
            passable: Passable::default(),
        }
    }

    /// Keeps to other areas.
    pub fn set_areas(&mut self, areas: &Areas) {
        (self.fence, self.passable) = (Fence::new(areas.clone(), self.margin_m), Passable::default());
    }

    /// The costmap that came with the map, or our own.
    pub fn of(&mut self, map: &MapSnapshot) -> Snapshot<Costmap> {
        map.costmap.clone().unwrap_or_else(|| self.own.update(&map.grid, &map.changes))
    }
}
