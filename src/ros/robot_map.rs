//! The map as the explorer sees it: the newest one, with its costmap.

use super::clock::RunClock;
use super::map_feed::{MapFeed, ReceivedMap};
use super::node::Node;
use crate::grid::{Costmap, Inflation, Thresholds};
use crate::robot::MapSnapshot;
use std::sync::Arc;

/// A map, as it came and as it is explored.
struct KnownMap {
    /// Those of the map and of the costmap.
    version: (u64, u64),
    snapshot: MapSnapshot,
    received: ReceivedMap,
}

/// The feeds of map and costmap, and the newest of both.
pub struct RobotMap {
    map: MapFeed,
    /// Where the costmap is not made here.
    costmap: Option<MapFeed>,
    thresholds: Thresholds,
    inflation: Inflation,
    known: Option<KnownMap>,
}

impl RobotMap {
    /// No map yet; without a costmap's feed, maps are inflated here.
    #[must_use]
    pub const fn new(map: MapFeed, costmap: Option<MapFeed>, thresholds: Thresholds, inflation: Inflation) -> Self {
        Self { map, costmap, thresholds, inflation, known: None }
    }

    /// The newest map, as it came.
    #[must_use]
    pub fn received(&self) -> Option<&ReceivedMap> {
        self.known.as_ref().map(|known| &known.received)
    }

    /// The newest map with its costmap.
    #[must_use]
    pub fn snapshot(&self) -> Option<&MapSnapshot> {
        self.known.as_ref().map(|known| &known.snapshot)
    }

    /// The frame of the map; `map` until one has come.
    #[must_use]
    pub fn frame(&self) -> &str {
        self.received().map_or("map", |received| received.frame.as_str())
    }

    /// Why no map has come after so many seconds, if none has.
    #[must_use]
    pub fn missing_map(&self, node: &Node, waited_s: f64) -> Option<String> {
        self.map.missing(node, "~map_topic", waited_s)
    }

    /// Why no costmap has come after so many seconds, if one is needed and none has.
    #[must_use]
    pub fn missing_costmap(&self, node: &Node, waited_s: f64) -> Option<String> {
        self.costmap.as_ref()?.missing(node, "~global_costmap_topic", waited_s)
    }

    /// Takes the newest map and costmap in; whether one of them is new.
    pub fn take_newest(&mut self, clock: &RunClock) -> bool {
        let received = self.map.newest();
        let costmap = self.costmap.as_mut().map(MapFeed::newest);
        let Some(received) = received else { return false };
        // A costmap that is to come is waited for.
        if matches!(costmap, Some(None)) {
            return false;
        }
        let costmap = costmap.flatten();
        let version = (received.version, costmap.as_ref().map_or(0, |costmap| costmap.version));
        if self.known.as_ref().is_some_and(|known| known.version == version) {
            return false;
        }
        let grid = Arc::clone(&received.grid);
        let before = self.known.as_ref().map(|known| &known.snapshot);
        let before = before.and_then(|snapshot| Some((&snapshot.grid, snapshot.costmap.as_ref()?)));
        let costmap = match (costmap, before) {
            (Some(costmap), _) => Costmap::from_published(&costmap.grid).on_grid(grid.info()),
            (None, Some((old, costmap))) => costmap.reinflate(old, &grid, &self.thresholds, &self.inflation),
            (None, None) => Costmap::inflate(&grid, &self.thresholds, &self.inflation),
        };
        let snapshot = MapSnapshot {
            stamp_s: clock.of(received.stamp_s),
            version: version.0,
            grid,
            costmap: Some(Arc::new(costmap)),
        };
        self.known = Some(KnownMap { version, snapshot, received });
        true
    }
}
