//! The map as the explorer sees it: the newest one, with its costmap.

use super::clock::RunClock;
use super::map_feed::{MapFeed, ReceivedMap};
use super::node::Node;
use crate::grid::{Costmap, Inflation, OccupancyGrid, Thresholds};
use crate::robot::MapSnapshot;
use std::sync::Arc;

/// Where costs come from besides our own inflation of the map.
pub enum CostmapFeed {
    /// From nowhere.
    None,
    /// A costmap that takes the place of our own; it is waited for.
    PlannedOn(MapFeed),
    /// The costmap of whoever drives, where it comes: what is no place to stand there is
    /// none here.
    Believed(MapFeed),
}

/// A map, as it came and as it is explored.
struct KnownMap {
    /// Those of the map and of the costmap.
    version: (u64, u64),
    snapshot: MapSnapshot,
    received: ReceivedMap,
    /// Our own costs of the map, where we make them.
    own: Option<Arc<Costmap>>,
}

/// The feeds of map and costmap, and the newest of both.
pub struct RobotMap {
    map: MapFeed,
    costmap: CostmapFeed,
    thresholds: Thresholds,
    inflation: Inflation,
    known: Option<KnownMap>,
}

impl RobotMap {
    /// No map yet.
    #[must_use]
    pub const fn new(map: MapFeed, costmap: CostmapFeed, thresholds: Thresholds, inflation: Inflation) -> Self {
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
        let CostmapFeed::PlannedOn(feed) = &self.costmap else { return None };
        feed.missing(node, "~global_costmap_topic", waited_s)
    }

    /// Takes the newest map and costmap in; whether one of them is new.
    pub fn take_newest(&mut self, clock: &RunClock) -> bool {
        let Some(received) = self.map.newest() else { return false };
        let costmap = match &mut self.costmap {
            CostmapFeed::None => None,
            CostmapFeed::PlannedOn(feed) => {
                let Some(costmap) = feed.newest() else { return false };
                Some(costmap)
            }
            CostmapFeed::Believed(feed) => feed.newest().filter(|costmap| costmap.frame == received.frame),
        };
        let version = (received.version, costmap.as_ref().map_or(0, |costmap| costmap.version));
        if self.known.as_ref().is_some_and(|known| known.version == version) {
            return false;
        }
        let grid = Arc::clone(&received.grid);
        let (own, costs) = match (&self.costmap, costmap) {
            (CostmapFeed::PlannedOn(_), Some(costmap)) => {
                (None, Arc::new(Costmap::from_published(&costmap.grid).on_grid(grid.info())))
            }
            (_, costmap) => {
                let own = self.inflated(&grid, received.version);
                let costs = match costmap {
                    Some(costmap) => Arc::new(own.with_obstacles_of(&Costmap::from_published(&costmap.grid))),
                    None => Arc::clone(&own),
                };
                (Some(own), costs)
            }
        };
        let snapshot =
            MapSnapshot { stamp_s: clock.of(received.stamp_s), version: received.version, grid, costmap: Some(costs) };
        self.known = Some(KnownMap { version, snapshot, received, own });
        true
    }

    /// Our own costs of a map, made once for each.
    fn inflated(&self, grid: &Arc<OccupancyGrid>, version: u64) -> Arc<Costmap> {
        match &self.known {
            Some(KnownMap { version: (same, _), own: Some(own), .. }) if *same == version => Arc::clone(own),
            Some(KnownMap { snapshot, own: Some(own), .. }) => {
                Arc::new(own.reinflate(&snapshot.grid, grid, &self.thresholds, &self.inflation))
            }
            _ => Arc::new(Costmap::inflate(grid, &self.thresholds, &self.inflation)),
        }
    }
}
