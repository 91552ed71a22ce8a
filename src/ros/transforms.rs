//! Listening to `/tf` and `/tf_static`.

use super::convert;
use super::feed::Feed;
use super::log::Level;
use super::msg::tf2_msgs::TFMessage;
use super::node::Node;
use crate::geometry::Pose;
use crate::robot::PoseError;
use crate::tf::{TransformBuffer, TransformError, frame_name, is_upside_down, planar};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How far back transforms are remembered, seconds, as in tf2.
const HISTORY_S: f64 = 10.0;
/// A stamp this far before the last one is a jump back in time, seconds.
const JUMP_S: f64 = 3.0;
/// After this time without a transform the subscription is made anew.
const SILENCE: Duration = Duration::from_secs(10);
/// Fixed transforms are told once; a lost connection is found after this time.
const STATIC_SILENCE: Duration = Duration::from_secs(60);

/// What is known of the frames.
pub struct Transforms {
    buffer: Arc<Mutex<TransformBuffer>>,
    _feeds: [Feed; 2],
}

impl Transforms {
    /// Begins to listen.
    #[must_use]
    pub fn listen(node: &Node) -> Self {
        let buffer = Arc::new(Mutex::new(TransformBuffer::new(HISTORY_S)));
        let feed = |topic: &'static str, silence: Duration, is_static: bool| {
            let (buffer, log) = (Arc::clone(&buffer), node.log().clone());
            node.listen(topic, 100, silence, move |message: TFMessage, caller| {
                let mut buffer = lock(&buffer);
                for sample in convert::transforms(message) {
                    if let Err(error) = buffer.insert(&sample, is_static) {
                        log.once(Level::Warn, format_args!("{topic} from {caller}: {error}"));
                    }
                }
            })
        };
        let feeds = [feed("/tf", SILENCE, false), feed("/tf_static", STATIC_SILENCE, true)];
        Self { buffer, _feeds: feeds }
    }

    /// Forgets what moves, when time has jumped back from `last_s` to `now_s`.
    pub fn notice_time(&self, last_s: f64, now_s: f64) {
        if now_s < last_s - JUMP_S {
            lock(&self.buffer).clear_moving();
        }
    }

    /// Where a robot is in the map frame now.
    ///
    /// # Errors
    /// [`PoseError`] when no transform leads there, or the newest is too old.
    pub fn robot(&self, map: &str, base: &str, now_s: f64, limit_s: f64) -> Result<Pose, PoseError> {
        let names = || (frame_name(map).to_owned(), frame_name(base).to_owned());
        match lock(&self.buffer).latest(map, base) {
            Ok(newest) if now_s - newest.stamp_s <= limit_s => Ok(planar(&newest.transform)),
            Ok(newest) => {
                let (map_frame, base_frame) = names();
                Err(PoseError::Stale { map_frame, base_frame, age_s: now_s - newest.stamp_s, limit_s })
            }
            Err(error) => {
                let (map_frame, base_frame) = names();
                Err(PoseError::NotYet { map_frame, base_frame, why: error.to_string() })
            }
        }
    }

    /// Where a sensor was in another frame at a time, and whether it hung upside down.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn sensor(&self, target: &str, sensor: &str, stamp_s: f64) -> Result<(Pose, bool), TransformError> {
        let transform = lock(&self.buffer).at(target, sensor, stamp_s)?;
        Ok((planar(&transform), is_upside_down(&transform)))
    }
}

fn lock(buffer: &Mutex<TransformBuffer>) -> MutexGuard<'_, TransformBuffer> {
    buffer.lock().unwrap_or_else(PoisonError::into_inner)
}
