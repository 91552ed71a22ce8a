//! Where the robot is, from transforms that may be old, stamped ahead, late, or come no
//! more. Pure; times are seconds of ROS time.
//!
//! A stamp alone does not say how fresh a transform is: gmapping and Cartographer stamp
//! `map -> odom` some tenths of a second ahead, a computer with a wrong clock any time, and
//! after a jump back of `/clock` messages from before it may still come. So each link is
//! judged by its stamp in both directions and by when it came.

use crate::geometry::Pose;
use crate::robot::PoseError;
use crate::tf::{
    MovingLink, RejectedTransform, TransformBuffer, TransformError, TransformSample, frame_name, is_upside_down, planar,
};
use nalgebra::Isometry3;
use std::collections::BTreeMap;

/// How far back transforms are remembered, seconds, as in tf2.
const HISTORY_S: f64 = 10.0;
/// A stamp this far before the last one is a jump back in time, seconds.
const JUMP_S: f64 = 3.0;
/// How far ahead of ROS time a stamp may be, beside the tolerance, seconds: what a SLAM
/// adds on purpose, and a `/clock` that comes later than `/tf`.
const AHEAD_S: f64 = 1.0;
/// A transform that is stamped further ahead than this, seconds, while good ones of the same
/// frame came in the last [`GOOD_FOR_S`], is late from before a jump back of time.
const LATE_AHEAD_S: f64 = 2.0 * AHEAD_S;
/// How long a good transform speaks against one that is stamped far ahead, seconds.
const GOOD_FOR_S: f64 = 1.0;

/// The last transform of a frame, in seconds of ROS time.
#[derive(Clone, Copy)]
struct Told {
    stamp_s: f64,
    arrived_s: f64,
}

/// A link between two frames whose transform changes.
#[derive(Clone, Debug, PartialEq)]
pub struct ToldLink {
    /// The upper frame.
    pub parent: String,
    /// The frame that moves in it.
    pub child: String,
    /// The newest stamp, seconds.
    pub stamp_s: f64,
    /// When the last transform came, seconds of ROS time; none while there is no time.
    pub arrived_s: Option<f64>,
}

/// What is known of the frames, and when it came.
pub struct Frames {
    buffer: TransformBuffer,
    /// What was last told of each moving frame.
    told: BTreeMap<String, Told>,
}

impl Frames {
    /// Nothing yet.
    #[allow(clippy::new_without_default)] // a const
    #[must_use]
    pub const fn new() -> Self {
        Self { buffer: TransformBuffer::new(HISTORY_S), told: BTreeMap::new() }
    }

    /// Takes a transform in that came at `now_s`, which is 0 while there is no time yet.
    /// One that is late from before a jump back of time is dropped.
    ///
    /// # Errors
    /// [`RejectedTransform`] for what cannot be a transform.
    pub fn take(&mut self, sample: &TransformSample, is_static: bool, now_s: f64) -> Result<(), RejectedTransform> {
        if is_static || now_s <= 0.0 {
            return self.buffer.insert(sample, is_static);
        }
        let (child, stamp_s, latest_s) = (frame_name(&sample.child), sample.stamp_s, now_s + AHEAD_S);
        let is_good = |told: &Told| told.stamp_s <= latest_s && (now_s - told.arrived_s).abs() <= GOOD_FOR_S;
        if stamp_s > now_s + LATE_AHEAD_S && self.told.get(child).is_some_and(is_good) {
            return Ok(());
        }
        if stamp_s <= latest_s {
            // What is stamped later came from before a jump back, or from a wrong clock: it
            // would hide this transform for as long as its stamp lies ahead.
            self.buffer.forget_after(child, latest_s);
        }
        self.buffer.insert(sample, is_static)?;
        self.told.insert(child.to_owned(), Told { stamp_s, arrived_s: now_s });
        Ok(())
    }

    /// Forgets what moves, when time has jumped back from `last_s` to `now_s`.
    pub fn notice_time(&mut self, last_s: f64, now_s: f64) {
        if now_s < last_s - JUMP_S {
            self.buffer.clear_moving();
            self.told.clear();
        }
    }

    /// Where a robot is in the map frame at `now_s`, by transforms that are at most
    /// `limit_s` old.
    ///
    /// # Errors
    /// [`PoseError`] when no transform leads there, or one cannot be believed.
    pub fn robot(&self, map: &str, base: &str, now_s: f64, limit_s: f64) -> Result<Pose, PoseError> {
        let (map_frame, base_frame) = (frame_name(map).to_owned(), frame_name(base).to_owned());
        let links = match self.buffer.moving_links(map, base) {
            Ok(links) => links,
            Err(error) => {
                let why = self.what_is_missing(&map_frame, &base_frame, &error);
                return Err(PoseError::NotYet { map_frame, base_frame, why });
            }
        };
        let wrong_clock = |link| skew(link, now_s, limit_s + AHEAD_S).or_else(|| self.lag(link, now_s, limit_s));
        if let Some(error) = links.iter().find_map(wrong_clock) {
            return Err(error);
        }
        let oldest_s = links.iter().map(|link| link.newest_s).fold(f64::INFINITY, f64::min);
        let age_s = now_s - oldest_s;
        if age_s > limit_s {
            return Err(PoseError::Stale { map_frame, base_frame, age_s, limit_s });
        }
        if let Some(error) = links.iter().find_map(|link| self.silence(link, now_s, limit_s)) {
            return Err(error);
        }
        match self.buffer.latest(map, base) {
            Ok(newest) => Ok(planar(&newest.transform)),
            Err(error) => Err(PoseError::NotYet { map_frame, base_frame, why: error.to_string() }),
        }
    }

    /// The moving links between two frames, with the times that were last told of them.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn links(&self, map: &str, base: &str) -> Result<Vec<ToldLink>, TransformError> {
        let links = self.buffer.moving_links(map, base)?;
        let told = |link: MovingLink<'_>| {
            let arrived_s = self.told.get(link.child).map(|told| told.arrived_s);
            ToldLink { parent: link.parent.to_owned(), child: link.child.to_owned(), stamp_s: link.newest_s, arrived_s }
        };
        Ok(links.into_iter().map(told).collect())
    }

    /// The names of all frames, in order.
    pub fn names(&self) -> Vec<String> {
        self.buffer.frames().into_iter().map(ToOwned::to_owned).collect()
    }

    /// Where a sensor was in another frame at a time, and whether it hung upside down.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn sensor(&self, target: &str, sensor: &str, stamp_s: f64) -> Result<(Pose, bool), TransformError> {
        let transform = self.buffer.at(target, sensor, stamp_s)?;
        Ok((planar(&transform), is_upside_down(&transform)))
    }

    /// Where a frame is in another one at a time, or at the newest time that is known where that
    /// one is 0 or not known.
    ///
    /// # Errors
    /// [`TransformError`] when no transform leads there.
    pub fn place(&self, target: &str, source: &str, stamp_s: f64) -> Result<Isometry3<f64>, TransformError> {
        if stamp_s > 0.0
            && let Ok(transform) = self.buffer.at(target, source, stamp_s)
        {
            return Ok(transform);
        }
        self.buffer.latest(target, source).map(|newest| newest.transform)
    }

    /// Names every frame that tf does not have, with those that it has.
    fn what_is_missing(&self, map_frame: &str, base_frame: &str, error: &TransformError) -> String {
        let known = self.buffer.frames();
        let missing = |frame: &str| !known.contains(&frame);
        let has = if known.is_empty() { "no frame yet".to_owned() } else { known.join(", ") };
        match (missing(map_frame), missing(base_frame)) {
            (true, true) => format!("neither frame is known: tf has {has}"),
            (true, false) => format!("the map's frame {map_frame} is unknown: tf has {has}"),
            (false, true) => {
                format!(
                    "the robot's frame {base_frame} (~base_frame) is unknown: tf has {has}; set ~base_frame to the robot's"
                )
            }
            (false, false) => match error {
                TransformError::NotConnected { target_root, source_root, .. } => {
                    format!("{error}; what tells {target_root} -> {source_root} is missing")
                }
                _ => error.to_string(),
            },
        }
    }

    /// Stamped long before it came, and it still comes: a clock that is behind.
    fn lag(&self, link: &MovingLink<'_>, now_s: f64, limit_s: f64) -> Option<PoseError> {
        let told = self.told.get(link.child)?;
        let (behind_s, is_coming) = (told.arrived_s - told.stamp_s, now_s - told.arrived_s <= limit_s);
        let (parent, child, limit_s) = (link.parent.to_owned(), link.child.to_owned(), limit_s + AHEAD_S);
        (is_coming && behind_s > limit_s).then_some(PoseError::Lagging { parent, child, behind_s, limit_s })
    }

    fn silence(&self, link: &MovingLink<'_>, now_s: f64, limit_s: f64) -> Option<PoseError> {
        let silent_s = now_s - self.told.get(link.child)?.arrived_s;
        let (parent, child) = (link.parent.to_owned(), link.child.to_owned());
        (silent_s > limit_s).then_some(PoseError::Silent { parent, child, silent_s, limit_s })
    }
}

fn skew(link: &MovingLink<'_>, now_s: f64, limit_s: f64) -> Option<PoseError> {
    let ahead_s = link.newest_s - now_s;
    let (parent, child) = (link.parent.to_owned(), link.child.to_owned());
    (ahead_s > limit_s).then_some(PoseError::Skewed { parent, child, ahead_s, limit_s })
}

#[cfg(test)]
#[path = "frames_tests.rs"]
mod tests;
