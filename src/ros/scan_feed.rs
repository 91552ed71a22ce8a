//! The newest scan, with the lidar's pose when it was taken.

use super::convert;
use super::feed::Feed;
use super::msg::sensor_msgs::LaserScan as ScanMessage;
use super::node::Node;
use super::transforms::Transforms;
use crate::geometry::Pose;
use crate::scan::LaserScan;
use crate::tf::TransformError;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Lidars scan at 5 Hz or more: one that is silent for longer has lost its connection.
const SILENCE: Duration = Duration::from_secs(5);

/// A scan topic, listened to until this is dropped.
pub struct ScanFeed {
    newest: Arc<Mutex<Option<Arc<ScanMessage>>>>,
    _feed: Feed,
}

impl ScanFeed {
    /// Begins to listen.
    #[must_use]
    pub fn listen(node: &Node, topic: &str) -> Self {
        let newest = Arc::<Mutex<Option<Arc<ScanMessage>>>>::default();
        let theirs = Arc::clone(&newest);
        let feed = node.listen(topic, 2, SILENCE, move |message: ScanMessage, _| {
            *theirs.lock().unwrap_or_else(PoisonError::into_inner) = Some(Arc::new(message));
        });
        Self { newest, _feed: feed }
    }

    /// The newest scan with its lidar's pose in a frame at that time.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads to the lidar's frame.
    pub fn newest_in(&self, frame: &str, transforms: &Transforms) -> Option<Result<(Pose, LaserScan), TransformError>> {
        let message = self.newest.lock().unwrap_or_else(PoisonError::into_inner).clone()?;
        let header = &message.header;
        let placed = transforms.sensor(frame, &header.frame_id, convert::seconds(&header.stamp));
        Some(placed.map(|(pose, is_upside_down)| (pose, convert::scan(&message, is_upside_down))))
    }
}
