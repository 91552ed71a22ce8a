//! A map topic with its updates: gmapping's and Cartographer's `map`, move_base's
//! `global_costmap/costmap`.

mod remembered;

pub use remembered::{Recalled, Remembered};

use super::bell::Bell;
use super::convert;
use super::directory::list;
use super::feed::Feed;
use super::log::Level;
use super::msg::map_msgs::OccupancyGridUpdate;
use super::msg::nav_msgs::OccupancyGrid as MapMessage;
use super::node::Node;
use crate::grid::{Changes, Live, MapMemory, OccupancyGrid};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A mapper that has sent maps and is silent for longer may have lost its connection.
const SILENCE: Duration = Duration::from_secs(60);
/// The type of maps.
const MAP_TYPE: &str = "nav_msgs/OccupancyGrid";
/// How old an answer of the master may be when it is asked for maps.
const LISTING_AGE: Duration = Duration::from_secs(5);
/// A header's time is believed up to this long before the arrival, seconds.
const OLDEST_STAMP_S: f64 = 30.0;

/// A map as it came.
#[derive(Clone, Debug)]
pub struct ReceivedMap {
    /// The map, with all updates since.
    pub grid: Arc<OccupancyGrid>,
    /// Its version, which grows with every change, and what changed.
    pub changes: Changes,
    /// The frame that it is in.
    pub frame: String,
    /// Everything sensed up to this time is in it, seconds of ROS time.
    pub stamp_s: f64,
    /// When it came, for the latency from here to a goal.
    pub arrived: Instant,
}

/// What has come of a map so far.
struct KeptMap {
    live: Live<OccupancyGrid>,
    frame: String,
    stamp_s: f64,
    arrived: Instant,
}

impl KeptMap {
    fn received(&self) -> ReceivedMap {
        ReceivedMap {
            grid: Arc::clone(self.live.newest()),
            changes: self.live.changes().clone(),
            frame: self.frame.clone(),
            stamp_s: self.stamp_s,
            arrived: self.arrived,
        }
    }
}

/// What those who write the map know of it, and what those who read it see. To lay an update on a
/// large map takes its time: nobody who reads waits for it.
#[derive(Default)]
struct Shared {
    kept: Mutex<Kept>,
    newest: Mutex<Option<ReceivedMap>>,
    /// An update was lost: the whole map is needed again.
    has_gap: AtomicBool,
}

#[derive(Default)]
struct Kept {
    map: Option<KeptMap>,
    /// The map of an earlier session.
    earlier: Remembered,
    last_update_seq: Option<u32>,
}

impl Shared {
    /// Shows the readers what is kept now.
    fn show(&self, kept: &Kept) {
        *lock(&self.newest) = kept.map.as_ref().map(KeptMap::received);
    }
}

/// A map and its updates, listened to until this is dropped.
pub struct MapFeed {
    node: Node,
    topic: String,
    state: Arc<Shared>,
    bell: Arc<Bell>,
    feed: Feed,
    _updates: Option<Feed>,
}

impl MapFeed {
    /// Begins to listen; rings the bell for every change.
    #[must_use]
    pub fn listen(node: &Node, topic: &str, updates_topic: &str, bell: &Arc<Bell>) -> Self {
        let state = Arc::<Shared>::default();
        let updates = (!updates_topic.is_empty()).then(|| listen_to_updates(node, updates_topic, &state, bell));
        let feed = listen_to_maps(node, topic, &state, bell);
        Self { node: node.clone(), topic: topic.to_owned(), state, bell: Arc::clone(bell), feed, _updates: updates }
    }

    /// Lays the map of an earlier session below those that come from now on, where it agrees.
    pub fn remember(&self, earlier: MapMemory) {
        lock(&self.state.kept).earlier = Remembered::new(Some(earlier));
    }

    /// The newest map; after a lost update, asks for the whole map again.
    pub fn newest(&mut self) -> Option<ReceivedMap> {
        let map = lock(&self.state.newest).clone();
        if self.state.has_gap.swap(false, Ordering::Relaxed) {
            self.node
                .log()
                .once(Level::Warn, format_args!("an update of {} was lost: asking for all of it", self.topic));
            self.feed = listen_to_maps(&self.node, &self.topic, &self.state, &self.bell);
        }
        map
    }

    /// The topic, as it was asked for.
    #[must_use]
    pub fn topic(&self) -> &str {
        &self.topic
    }

    /// A handle that reads the newest map from other threads.
    #[must_use]
    pub fn reader(&self) -> MapReader {
        MapReader(Arc::clone(&self.state))
    }

    /// Why no map has come after so many seconds, if none has: who publishes the topic
    /// that `parameter` names, and which topics with maps there are instead.
    #[must_use]
    pub fn missing(&self, node: &Node, parameter: &str, waited_s: f64) -> Option<String> {
        if lock(&self.state.newest).is_some() {
            return None;
        }
        let topic = node.full_name(&self.topic);
        let silent = format!("no map has come on {topic} ({parameter}) for {waited_s:.0} s");
        let Some(listing) = node.listing(LISTING_AGE) else { return Some(silent) };
        let publishers = listing.publishers(&topic);
        let maps: Vec<String> =
            listing.published(MAP_TYPE).map(|(other, nodes)| format!("{other} (of {})", list(nodes))).collect();
        let remedy = if maps.is_empty() {
            "start a SLAM or map_server".to_owned()
        } else {
            format!("set {parameter} to one of them")
        };
        let instead = format!("topics with maps: {}; {remedy}", list(&maps));
        Some(match listing.type_of(&topic) {
            _ if publishers.is_empty() => format!("{silent}: nobody publishes it; {instead}"),
            Some(MAP_TYPE) | None => format!(
                "{silent}: {} publishes it and has sent none; a SLAM needs scans and transforms for its first",
                list(&publishers)
            ),
            Some(other) => format!("{silent}: it is a {other}; {instead}"),
        })
    }
}

/// Reads the newest map of a feed.
#[derive(Clone)]
pub struct MapReader(Arc<Shared>);

impl MapReader {
    /// The newest map, if one came.
    #[must_use]
    pub fn newest(&self) -> Option<ReceivedMap> {
        lock(&self.0.newest).clone()
    }

    /// What has become of the map of an earlier session.
    #[must_use]
    pub fn recalled(&self) -> Recalled {
        lock(&self.0.kept).earlier.state()
    }
}

fn listen_to_maps(node: &Node, topic: &str, state: &Arc<Shared>, bell: &Arc<Bell>) -> Feed {
    let (state, bell, owner, name) = (Arc::clone(state), Arc::clone(bell), node.clone(), topic.to_owned());
    Feed::listen(node, topic, 2, SILENCE, move |message: MapMessage, caller| {
        let arrived = Instant::now();
        let stamp_s = believable(convert::seconds(&message.header.stamp), owner.now_s());
        let frame = message.header.frame_id.clone();
        match convert::grid(message) {
            Ok(grid) => {
                let mut kept = lock(&state.kept);
                let mut live = kept.map.take().map(|map| map.live);
                let grid = kept.earlier.whole(grid);
                Live::renew(&mut live, grid);
                kept.map = live.map(|live| KeptMap { live, frame, stamp_s, arrived });
                state.show(&kept);
                drop(kept);
                bell.ring();
            }
            Err(error) => owner.log().once(Level::Warn, format_args!("a map on {name} from {caller}: {error}")),
        }
    })
}

fn listen_to_updates(node: &Node, topic: &str, state: &Arc<Shared>, bell: &Arc<Bell>) -> Feed {
    let (state, bell, owner, name) = (Arc::clone(state), Arc::clone(bell), node.clone(), topic.to_owned());
    Feed::listen(node, topic, 50, SILENCE, move |message: OccupancyGridUpdate, caller| {
        let (seq, arrived) = (message.header.seq, Instant::now());
        let stamp_s = believable(convert::seconds(&message.header.stamp), owner.now_s());
        let patch = convert::patch(message);
        let mut kept = lock(&state.kept);
        let follows = kept.last_update_seq.replace(seq).is_none_or(|last| seq == last.wrapping_add(1) || seq == last);
        if !follows {
            state.has_gap.store(true, Ordering::Relaxed);
        }
        // An update that comes before its map is part of that map already.
        let Kept { map: Some(map), earlier, .. } = &mut *kept else { return };
        let applied = match earlier.patch(&patch) {
            Some(joined) => joined.map(|joined| map.live.replace(joined)),
            None => map.live.apply(&patch),
        };
        match applied {
            Ok(()) => (map.stamp_s, map.arrived) = (stamp_s, arrived),
            // The map has changed its size, and the whole one is on its way.
            Err(error) => {
                state.has_gap.store(true, Ordering::Relaxed);
                owner.log().once(Level::Warn, format_args!("{name} from {caller}: {error}"));
            }
        }
        state.show(&kept);
        drop(kept);
        bell.ring();
    })
}

/// The time of a header where that can be, else that of the arrival.
fn believable(header_s: f64, now_s: f64) -> f64 {
    let age_s = now_s - header_s;
    if header_s > 0.0 && (0.0..=OLDEST_STAMP_S).contains(&age_s) { header_s } else { now_s }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Waits for one map of a topic and returns it: `frontier map save`.
///
/// # Errors
/// A sentence when none comes in time, or the node is told to stop.
pub fn receive_map(node: &Node, topic: &str, limit: Duration) -> Result<ReceivedMap, String> {
    let bell = Arc::default();
    let feed = MapFeed::listen(node, topic, "", &bell);
    let reader = feed.reader();
    node.wait_until(limit, || reader.newest().is_some());
    reader.newest().ok_or_else(|| format!("no map came on {topic} for {} s", limit.as_secs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_stamps_become_the_arrival() {
        assert_eq!(believable(99.0, 100.0), 99.0);
        for wrong in [0.0, 101.0, 12.0] {
            assert_eq!(believable(wrong, 100.0), 100.0);
        }
    }
}
