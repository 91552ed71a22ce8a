//! The costmaps that decisions are made on, each made of another and kept up to date.

use crate::grid::{Costmap, Inflation, LiveCostmap, Roomy, Snapshot, Thresholds};
use crate::planning::{Opened, Passable};
use crate::robot::MapSnapshot;

/// The costmaps of a decision, one made of the other and each kept up to date.
pub(super) struct Costs {
    /// Our own, where the map comes without one.
    own: LiveCostmap,
    /// For a robot that keeps to where it can turn.
    pub roomy: Roomy,
    /// The same, and what was driven through stays open.
    pub opened: Opened,
    pub passable: Passable,
}

impl Costs {
    /// Of nothing so far.
    pub fn new(thresholds: Thresholds, inflation: Inflation) -> Self {
        Self {
            own: LiveCostmap::new(thresholds, inflation),
            roomy: Roomy::default(),
            opened: Opened::default(),
            passable: Passable::default(),
        }
    }

    /// The costmap that came with the map, or our own.
    pub fn of(&mut self, map: &MapSnapshot) -> Snapshot<Costmap> {
        map.costmap.clone().unwrap_or_else(|| self.own.update(&map.grid, &map.changes))
    }
}
