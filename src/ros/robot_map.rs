//! The map as the explorer sees it: the newest one, with its costmap.

use super::clock::RunClock;
use super::map_feed::{MapFeed, ReceivedMap};
use super::node::Node;
use crate::grid::{
    BelievedCosts, Changes, Inflation, LiveCostmap, Since, Snapshot, Thresholds, unknown_share_hidden_by,
};
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
}

/// The feeds of map and costmap, and the newest of both.
pub struct RobotMap {
    map: MapFeed,
    costmap: CostmapFeed,
    /// Our own costs of the map.
    own: LiveCostmap,
    /// What is made of them and of those that come.
    believed: BelievedCosts,
    /// The versions of the costs, whichever of the two they are.
    costs: Changes,
    /// Whether the last costs were believed ones, and their version as such.
    source: Option<(bool, u64)>,
    known: Option<KnownMap>,
}

impl RobotMap {
    /// No map yet.
    #[must_use]
    pub fn new(map: MapFeed, costmap: CostmapFeed, thresholds: Thresholds, inflation: Inflation) -> Self {
        let own = LiveCostmap::new(thresholds, inflation);
        let (believed, costs) = (BelievedCosts::default(), Changes::default());
        Self { map, costmap, own, believed, costs, source: None, known: None }
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

    /// What to say where the costmap has no unknown cell and the map has: whoever drives takes
    /// what nobody has seen for free.
    #[must_use]
    pub fn without_unknown(&self, node: &Node) -> Option<String> {
        let (CostmapFeed::PlannedOn(feed) | CostmapFeed::Believed(feed)) = &self.costmap else { return None };
        let (map, costmap) = (self.received()?, feed.reader().newest()?);
        let is_hidden = costmap.frame == map.frame && unknown_share_hidden_by(&costmap.grid, &map.grid).is_some();
        let topic = node.full_name(feed.topic());
        let space = topic.trim_end_matches("/costmap");
        is_hidden.then(|| {
            format!(
                "the costmap on {topic} has no unknown cell, and the map has: goals lead through what nobody has \
                 seen; set {space}/track_unknown_space to true in move_base's parameters and start it again"
            )
        })
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
        let version = (received.changes.version(), costmap.as_ref().map_or(0, |costmap| costmap.changes.version()));
        if self.known.as_ref().is_some_and(|known| known.version == version) {
            return false;
        }
        let grid = Arc::clone(&received.grid);
        let theirs = costmap.map(|costmap| Snapshot { cells: costmap.grid, changes: costmap.changes });
        let is_believed = theirs.is_some();
        let costs = match (&self.costmap, theirs) {
            (CostmapFeed::PlannedOn(_), Some(theirs)) => self.believed.instead(grid.info(), &theirs),
            (_, Some(theirs)) => self.believed.beside(&self.own.update(&grid, &received.changes), &theirs),
            (_, None) => self.own.update(&grid, &received.changes),
        };
        let source = (is_believed, costs.changes.version());
        let last = self.source.replace(source).filter(|(was_believed, _)| *was_believed == is_believed);
        let known = self.known.as_ref().and_then(|known| known.snapshot.costmap.as_ref()).zip(last);
        let since = known.map_or(Since::All, |(known, (_, version))| {
            costs.changes.since_on((version, known.cells.info()), costs.cells.info())
        });
        self.costs = self.costs.then_since(&since);
        let costmap = Some(Snapshot { changes: self.costs.clone(), ..costs });
        let (stamp_s, changes) = (clock.of(received.stamp_s), received.changes.clone());
        let snapshot = MapSnapshot { stamp_s, grid, changes, costmap };
        self.known = Some(KnownMap { version, snapshot, received });
        true
    }
}
