//! The newest scan, with the lidar's pose when it was taken. A scan may come before the
//! transforms of its time: the last few are kept, and the newest that can be placed counts.

use super::convert;
use super::feed::Feed;
use super::msg::sensor_msgs::LaserScan as ScanMessage;
use super::node::Node;
use super::transforms::Transforms;
use crate::geometry::Pose;
use crate::scan::LaserScan;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Lidars scan at 5 Hz or more: one that is silent for longer has lost its connection.
const SILENCE: Duration = Duration::from_secs(5);

/// So many scans are kept.
const KEPT: usize = 6;

/// The last scans, the newest first.
type Last = VecDeque<Arc<ScanMessage>>;

/// A scan topic, listened to until this is dropped.
pub struct ScanFeed {
    last: Arc<Mutex<Last>>,
    _feed: Feed,
}

impl ScanFeed {
    /// Begins to listen.
    #[must_use]
    pub fn listen(node: &Node, topic: &str) -> Self {
        let last = Arc::<Mutex<Last>>::default();
        let theirs = Arc::clone(&last);
        let feed = node.listen(topic, 2, SILENCE, move |message: ScanMessage, _| {
            let mut last = theirs.lock().unwrap_or_else(PoisonError::into_inner);
            last.push_front(Arc::new(message));
            last.truncate(KEPT);
        });
        Self { last, _feed: feed }
    }

    /// The newest scan that can be placed in a frame, with its lidar's pose at that time.
    pub fn newest_in(&self, frame: &str, transforms: &Transforms) -> Option<(Pose, LaserScan)> {
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        last.iter().find_map(|message| {
            let header = &message.header;
            let placed = transforms.sensor(frame, &header.frame_id, convert::seconds(&header.stamp));
            let (pose, is_upside_down) = placed.ok()?;
            Some((pose, convert::scan(message, is_upside_down)))
        })
    }
}
