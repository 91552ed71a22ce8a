//! Listening to `/tf` and `/tf_static`.

use super::convert;
use super::feed::Feed;
use super::frames::{Frames, ToldLink};
use super::log::Level;
use super::msg::tf2_msgs::TFMessage;
use super::node::Node;
use crate::geometry::Pose;
use crate::robot::PoseError;
use crate::tf::TransformError;
use nalgebra::Isometry3;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// After this time without a transform the subscription is made anew.
const SILENCE: Duration = Duration::from_secs(10);
/// Fixed transforms are told once: so often it is looked whether all who tell them are met.
const STATIC_LOOK: Duration = Duration::from_secs(60);

/// What is known of the frames.
pub struct Transforms {
    frames: Arc<Mutex<Frames>>,
    _feeds: [Feed; 2],
}

impl Transforms {
    /// Begins to listen.
    #[must_use]
    pub fn listen(node: &Node) -> Self {
        let frames = Arc::new(Mutex::new(Frames::new()));
        let taker = |topic: &'static str, is_static: bool| {
            let (frames, owner) = (Arc::clone(&frames), node.clone());
            move |message: TFMessage, caller: &str| {
                let now_s = owner.now_s();
                let mut frames = lock(&frames);
                for sample in convert::transforms(message) {
                    if let Err(error) = frames.take(&sample, is_static, now_s) {
                        owner.log().once(Level::Warn, format_args!("{topic} from {caller}: {error}"));
                    }
                }
            }
        };
        let moving = Feed::listen(node, "/tf", 100, SILENCE, taker("/tf", false));
        let fixed = Feed::listen_seldom(node, "/tf_static", 100, STATIC_LOOK, taker("/tf_static", true));
        Self { frames, _feeds: [moving, fixed] }
    }

    /// Forgets what moves, when time has jumped back from `last_s` to `now_s`.
    pub fn notice_time(&self, last_s: f64, now_s: f64) {
        lock(&self.frames).notice_time(last_s, now_s);
    }

    /// Where a robot is in the map frame now.
    ///
    /// # Errors
    /// [`PoseError`] when no transform leads there, or one cannot be believed.
    pub fn robot(&self, map: &str, base: &str, now_s: f64, limit_s: f64) -> Result<Pose, PoseError> {
        lock(&self.frames).robot(map, base, now_s, limit_s)
    }

    /// The moving links between two frames, with the times that were last told of them.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn links(&self, map: &str, base: &str) -> Result<Vec<ToldLink>, TransformError> {
        lock(&self.frames).links(map, base)
    }

    /// The names of all frames, in order.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        lock(&self.frames).names()
    }

    /// Where a sensor was in another frame at a time, and whether it hung upside down.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn sensor(&self, target: &str, sensor: &str, stamp_s: f64) -> Result<(Pose, bool), TransformError> {
        lock(&self.frames).sensor(target, sensor, stamp_s)
    }

    /// Where a frame is in another one at a time, or now where that time is 0 or not known.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn place(&self, target: &str, source: &str, stamp_s: f64) -> Result<Isometry3<f64>, TransformError> {
        lock(&self.frames).place(target, source, stamp_s)
    }
}

fn lock(frames: &Mutex<Frames>) -> MutexGuard<'_, Frames> {
    frames.lock().unwrap_or_else(PoisonError::into_inner)
}
