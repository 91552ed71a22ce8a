//! The newest scan, with the lidar's pose when it was taken. A scan may come before the
//! transforms of its time: the last few are kept, and the newest that can be placed counts.
//! Scans that show nothing at all count as none.

use super::convert;
use super::directory::list;
use super::feed::Feed;
use super::msg::sensor_msgs::LaserScan as ScanMessage;
use super::node::Node;
use super::transforms::Transforms;
use crate::geometry::Pose;
use crate::scan::LaserScan;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Lidars scan at 5 Hz or more: one that is silent for longer has lost its connection.
const SILENCE: Duration = Duration::from_secs(5);
/// So many scans are kept.
const KEPT: usize = 6;
/// A scan older than this no longer tells what is ahead, and one stamped further ahead of
/// ROS time has a stamp that tells nothing, seconds.
const LIMIT_S: f64 = 1.0;
/// How old an answer of the master may be when it is asked who publishes scans.
const LISTING_AGE: Duration = Duration::from_secs(5);

/// A scan, and the ROS time in seconds at which it came.
#[derive(Clone)]
struct Kept {
    message: Arc<ScanMessage>,
    arrived_s: f64,
}

#[derive(Default)]
struct State {
    /// The last scans that show something, the newest first.
    last: VecDeque<Kept>,
    /// What is wrong with the last scan, where it shows nothing.
    blind: Option<String>,
}

/// A scan topic, listened to until this is dropped.
pub struct ScanFeed {
    node: Node,
    topic: String,
    state: Arc<Mutex<State>>,
    _feed: Feed,
}

impl ScanFeed {
    /// Begins to listen.
    #[must_use]
    pub fn listen(node: &Node, topic: &str) -> Self {
        let state = Arc::<Mutex<State>>::default();
        let (theirs, owner) = (Arc::clone(&state), node.clone());
        let feed = Feed::listen(node, topic, 2, SILENCE, move |message: ScanMessage, _| {
            let sight = convert::scan(&message).sight();
            let mut state = lock(&theirs);
            state.blind = sight.err().map(|why| why.to_string());
            if state.blind.is_none() {
                state.last.push_front(Kept { message: Arc::new(message), arrived_s: owner.now_s() });
                state.last.truncate(KEPT);
            }
        });
        Self { node: node.clone(), topic: topic.to_owned(), state, _feed: feed }
    }

    /// The newest scan that can be placed in a frame, with its lidar's pose at that time.
    pub fn newest_in(&self, frame: &str, transforms: &Transforms) -> Option<(Pose, LaserScan)> {
        self.placed(frame, transforms).map(|(pose, scan, _)| (pose, scan))
    }

    /// The same, as long as it tells what is ahead now, in seconds of ROS time.
    ///
    /// # Errors
    /// A sentence on why no scan does.
    pub fn fresh_in(&self, frame: &str, transforms: &Transforms, now_s: f64) -> Result<(Pose, LaserScan), String> {
        let placed = self.placed(frame, transforms);
        let blind = lock(&self.state).blind.clone();
        let topic = &self.topic;
        match placed {
            Some((pose, scan, arrived_s)) => {
                let (age_s, silent_s) = (now_s - scan.stamp_s, now_s - arrived_s);
                if age_s.abs() <= LIMIT_S && silent_s <= LIMIT_S {
                    Ok((pose, scan))
                } else if let Some(why) = blind {
                    Err(format!("the scans on {topic} show nothing: {why}"))
                } else if age_s < -LIMIT_S {
                    Err(format!("clock skew: the scan on {topic} is stamped {:.1} s ahead of ROS time", -age_s))
                } else {
                    Err(format!(
                        "the last scan on {topic} is {:.1} s old: must be at most {LIMIT_S} s",
                        age_s.max(silent_s)
                    ))
                }
            }
            None => Err(match (blind, lock(&self.state).last.front()) {
                (Some(why), _) => format!("the scans on {topic} show nothing: {why}"),
                (None, Some(kept)) => {
                    let lidar = &kept.message.header.frame_id;
                    format!("no transform places the scans on {topic}: from {frame} to their frame {lidar:?}")
                }
                (None, None) => self.why_none(),
            }),
        }
    }

    /// Whether any scan has come so far.
    #[must_use]
    pub fn has_begun(&self) -> bool {
        let state = lock(&self.state);
        state.blind.is_some() || !state.last.is_empty()
    }

    fn placed(&self, frame: &str, transforms: &Transforms) -> Option<(Pose, LaserScan, f64)> {
        let last = lock(&self.state).last.clone();
        last.iter().find_map(|Kept { message, arrived_s }| {
            let header = &message.header;
            let placed = transforms.sensor(frame, &header.frame_id, convert::seconds(&header.stamp));
            let (pose, is_upside_down) = placed.ok()?;
            let scan = convert::scan(message);
            Some((pose, if is_upside_down { scan.turned_upright() } else { scan }, *arrived_s))
        })
    }

    /// What the master knows of scans, when none has come.
    fn why_none(&self) -> String {
        let topic = self.node.full_name(&self.topic);
        let Some(listing) = self.node.listing(LISTING_AGE) else { return format!("no scan has come on {topic}") };
        let publishers = listing.publishers(&topic);
        if publishers.is_empty() {
            let others: Vec<String> = listing.published("sensor_msgs/LaserScan").map(|(t, _)| t.to_owned()).collect();
            format!("nobody publishes {topic}; topics with scans: {}", list(&others))
        } else {
            format!("no scan has come on {topic} from {}", list(&publishers))
        }
    }
}

fn lock(state: &Mutex<State>) -> MutexGuard<'_, State> {
    state.lock().unwrap_or_else(PoisonError::into_inner)
}
