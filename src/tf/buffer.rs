//! All frames over the last seconds, and transforms between any two of them.

use super::frame_name;
use super::link::{Link, RejectedTransform, TransformSample};
use nalgebra::Isometry3;
use std::collections::BTreeMap;

/// The most frames that are kept: a robot has some dozens.
const MAX_FRAMES: usize = 4096;
/// The longest chain from a frame to its root.
const MAX_DEPTH: usize = 64;

/// Why there is no transform between two frames.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransformError {
    /// Nothing has named this frame so far.
    #[error("the frame {frame} is unknown: tf has {known}")]
    UnknownFrame {
        /// The frame that was asked for.
        frame: String,
        /// The frames that there are.
        known: String,
    },
    /// Both frames are there, in trees of their own.
    #[error("nothing connects {target} and {source_frame}: their roots are {target_root} and {source_root}")]
    NotConnected {
        /// The frame to express in.
        target: String,
        /// The frame to place.
        source_frame: String,
        /// The root of the first.
        target_root: String,
        /// The root of the second.
        source_root: String,
    },
    /// The time lies before or after what is known.
    #[error("the transform to {frame} is asked for at {at_s:.3} s and known from {oldest_s:.3} to {newest_s:.3} s")]
    OutOfHistory {
        /// The frame whose link to its parent has no such time.
        frame: String,
        /// The time asked for, seconds.
        at_s: f64,
        /// The oldest sample, seconds.
        oldest_s: f64,
        /// The newest sample, seconds.
        newest_s: f64,
    },
    /// Parents that lead in a circle.
    #[error("the frames above {0} lead in a circle, or deeper than {MAX_DEPTH}")]
    Circle(String),
}

/// A transform with the time that it was true at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stamped {
    /// Seconds; infinite between frames that are fixed to each other.
    pub stamp_s: f64,
    /// Where the source frame is in the target frame.
    pub transform: Isometry3<f64>,
}

/// A link of a chain between two frames whose transform changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingLink<'a> {
    /// The upper frame.
    pub parent: &'a str,
    /// The frame that moves in it.
    pub child: &'a str,
    /// The newest stamp, seconds.
    pub newest_s: f64,
}

/// What `/tf` and `/tf_static` have said over the last seconds.
#[derive(Clone, Debug)]
pub struct TransformBuffer {
    history_s: f64,
    links: BTreeMap<String, Link>,
}

impl TransformBuffer {
    /// An empty buffer that remembers so many seconds; tf2 remembers ten.
    #[must_use]
    pub const fn new(history_s: f64) -> Self {
        Self { history_s, links: BTreeMap::new() }
    }

    /// Takes a transform in. A frame that changes its parent loses its history, as in
    /// tf2.
    ///
    /// # Errors
    /// [`RejectedTransform`] for what cannot be a transform; the buffer is as before.
    pub fn insert(&mut self, sample: &TransformSample, is_static: bool) -> Result<(), RejectedTransform> {
        let (parent, child) = (frame_name(&sample.parent), frame_name(&sample.child));
        let transform = sample.isometry()?;
        if !self.links.contains_key(child) {
            if self.links.len() >= MAX_FRAMES {
                return Err(RejectedTransform::TooMany { child: child.to_owned(), limit: MAX_FRAMES });
            }
            self.links.insert(child.to_owned(), Link::new(parent, is_static));
        }
        if let Some(link) = self.links.get_mut(child) {
            if link.parent != parent || link.is_static != is_static {
                *link = Link::new(parent, is_static);
            }
            link.insert(sample.stamp_s, transform, self.history_s);
        }
        Ok(())
    }

    /// Forgets all that moves: after a jump back in time nothing of it is true. What is
    /// fixed stays, as it is told only once.
    pub fn clear_moving(&mut self) {
        self.links.retain(|_, link| link.is_static);
    }

    /// Forgets what was said of a moving frame for times after this one, seconds.
    pub fn forget_after(&mut self, child: &str, stamp_s: f64) {
        if let Some(link) = self.links.get_mut(frame_name(child)).filter(|link| !link.is_static) {
            link.forget_after(stamp_s);
        }
    }

    /// The links between two frames whose transforms change, with their newest stamps.
    ///
    /// # Errors
    /// [`TransformError`] with the frames that are missing.
    pub fn moving_links(&self, target: &str, source: &str) -> Result<Vec<MovingLink<'_>>, TransformError> {
        let (up_target, up_source) = self.chains(frame_name(target), frame_name(source))?;
        let moving = up_target.into_iter().chain(up_source).filter(|(_, link)| !link.is_static);
        let newest = |link: &Link| link.newest_s().unwrap_or(f64::NEG_INFINITY);
        Ok(moving.map(|(child, link)| MovingLink { parent: &link.parent, child, newest_s: newest(link) }).collect())
    }

    /// Where `source` is in `target`, at the newest time that all links between them
    /// know (tf2's time 0).
    ///
    /// # Errors
    /// [`TransformError`] with the frames or times that are missing.
    pub fn latest(&self, target: &str, source: &str) -> Result<Stamped, TransformError> {
        let (up_target, up_source) = self.chains(frame_name(target), frame_name(source))?;
        let moving = up_target.iter().chain(&up_source).filter(|(_, link)| !link.is_static);
        let stamp_s = moving.filter_map(|(_, link)| link.newest_s()).fold(f64::INFINITY, f64::min);
        let transform = join(&up_target, &up_source, stamp_s)?;
        Ok(Stamped { stamp_s, transform })
    }

    /// Where `source` is in `target` at a time in seconds, between the samples.
    ///
    /// # Errors
    /// [`TransformError`] with the frames or times that are missing.
    pub fn at(&self, target: &str, source: &str, stamp_s: f64) -> Result<Isometry3<f64>, TransformError> {
        let (up_target, up_source) = self.chains(frame_name(target), frame_name(source))?;
        join(&up_target, &up_source, stamp_s)
    }

    /// The names of all frames, in order.
    #[must_use]
    pub fn frames(&self) -> Vec<&str> {
        let mut names: Vec<&str> =
            self.links.iter().flat_map(|(child, link)| [child.as_str(), link.parent.as_str()]).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// Every frame that has a parent, with that parent and whether they are fixed to
    /// each other.
    pub fn tree(&self) -> impl Iterator<Item = (&str, &str, bool)> {
        self.links.iter().map(|(child, link)| (child.as_str(), link.parent.as_str(), link.is_static))
    }

    /// The links from both frames up to the first frame above both.
    fn chains(&self, target: &str, source: &str) -> Result<(Vec<Above<'_>>, Vec<Above<'_>>), TransformError> {
        let mut up_target = self.to_root(target)?;
        let mut up_source = self.to_root(source)?;
        let root = |chain: &[Above<'_>], frame: &str| {
            chain.last().map_or_else(|| frame.to_owned(), |(_, link)| link.parent.clone())
        };
        let (target_root, source_root) = (root(&up_target, target), root(&up_source, source));
        if target_root != source_root {
            let (target, source_frame) = (target.to_owned(), source.to_owned());
            return Err(TransformError::NotConnected { target, source_frame, target_root, source_root });
        }
        while let (Some(a), Some(b)) = (up_target.last(), up_source.last()) {
            if a.0 != b.0 {
                break;
            }
            up_target.pop();
            up_source.pop();
        }
        Ok((up_target, up_source))
    }

    fn to_root(&self, frame: &str) -> Result<Vec<Above<'_>>, TransformError> {
        let mut chain = Vec::new();
        let mut at = frame;
        while let Some((name, link)) = self.links.get_key_value(at) {
            if chain.len() >= MAX_DEPTH {
                return Err(TransformError::Circle(frame.to_owned()));
            }
            chain.push((name.as_str(), link));
            at = &link.parent;
        }
        if chain.is_empty() && !self.links.values().any(|link| link.parent == frame) {
            return Err(TransformError::UnknownFrame { frame: frame.to_owned(), known: self.known() });
        }
        Ok(chain)
    }

    fn known(&self) -> String {
        let frames = self.frames();
        if frames.is_empty() { "no frame yet".to_owned() } else { frames.join(", ") }
    }
}

/// A frame and its link to its parent.
type Above<'a> = (&'a str, &'a Link);

/// From the source up to the common frame, and down to the target.
fn join(up_target: &[Above<'_>], up_source: &[Above<'_>], stamp_s: f64) -> Result<Isometry3<f64>, TransformError> {
    Ok(climb(up_target, stamp_s)?.inverse() * climb(up_source, stamp_s)?)
}

/// Where the first frame of a chain is in the frame above its last.
fn climb(chain: &[Above<'_>], stamp_s: f64) -> Result<Isometry3<f64>, TransformError> {
    chain.iter().try_fold(Isometry3::identity(), |below, (frame, link)| {
        let here = link.at(stamp_s).map_err(|out| TransformError::OutOfHistory {
            frame: (*frame).to_owned(),
            at_s: stamp_s,
            oldest_s: out.oldest_s,
            newest_s: out.newest_s,
        })?;
        Ok(here * below)
    })
}

#[cfg(test)]
#[path = "buffer_tests.rs"]
mod tests;
