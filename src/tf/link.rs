//! One frame in its parent over time.

use super::frame_name;
use crate::geometry::Pose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use std::collections::VecDeque;

/// The most samples that are kept of one frame: ten seconds at 400 Hz.
const MAX_SAMPLES: usize = 4000;
/// The squared norm of a rotation may differ from 1 by less than this, as in tf2.
const NORM_TOLERANCE: f64 = 10e-3;

/// A transform as it arrives: where `child` is in `parent`.
#[derive(Clone, Debug, PartialEq)]
pub struct TransformSample {
    /// The frame it is expressed in.
    pub parent: String,
    /// The frame that it places.
    pub child: String,
    /// When it was true, seconds.
    pub stamp_s: f64,
    /// Metres.
    pub translation_m: [f64; 3],
    /// A quaternion x, y, z, w of norm 1, or as near to it as tf2 asks for.
    pub rotation_xyzw: [f64; 4],
}

impl TransformSample {
    /// Where `child` lies in `parent` at a time in seconds, both of them in one plane.
    #[must_use]
    pub fn planar(stamp_s: f64, parent: &str, child: &str, child_in_parent: &Pose) -> Self {
        let (sin, cos) = (0.5 * child_in_parent.yaw).sin_cos();
        Self {
            parent: parent.to_owned(),
            child: child.to_owned(),
            stamp_s,
            translation_m: [child_in_parent.x, child_in_parent.y, 0.0],
            rotation_xyzw: [0.0, 0.0, sin, cos],
        }
    }
}

/// Why a transform is not taken in.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RejectedTransform {
    /// A frame without a name.
    #[error("a transform without a frame's name: parent {parent:?}, child {child:?}")]
    Nameless {
        /// As given.
        parent: String,
        /// As given.
        child: String,
    },
    /// A frame that is its own parent.
    #[error("the frame {0} is its own parent")]
    OwnParent(String),
    /// Numbers that are none.
    #[error("the transform from {parent} to {child} holds numbers that are not finite")]
    NotFinite {
        /// The parent.
        parent: String,
        /// The child.
        child: String,
    },
    /// A quaternion that is no rotation.
    #[error("the rotation from {parent} to {child} is no unit quaternion: its norm is {norm:.3}, must be 1")]
    NotNormalised {
        /// The parent.
        parent: String,
        /// The child.
        child: String,
        /// What its norm is.
        norm: f64,
    },
    /// More frames than a robot has.
    #[error("the transform to {child} is one frame too many: at most {limit} are kept")]
    TooMany {
        /// The frame that was turned away.
        child: String,
        /// How many are kept.
        limit: usize,
    },
}

impl TransformSample {
    /// Whether tf2 takes it in: both frames have names, which differ, all numbers are finite
    /// and the rotation is a unit quaternion (`BufferCore::setTransform`).
    ///
    /// # Errors
    /// [`RejectedTransform`] with the first thing that is wrong.
    pub fn check(&self) -> Result<(), RejectedTransform> {
        let (parent, child) = (frame_name(&self.parent), frame_name(&self.child));
        let names = || (parent.to_owned(), child.to_owned());
        if parent.is_empty() || child.is_empty() {
            return Err(RejectedTransform::Nameless { parent: self.parent.clone(), child: self.child.clone() });
        }
        if parent == child {
            return Err(RejectedTransform::OwnParent(child.to_owned()));
        }
        let squared: f64 = self.rotation_xyzw.iter().map(|v| v * v).sum();
        if !(self.stamp_s.is_finite() && squared.is_finite() && self.translation_m.iter().all(|v| v.is_finite())) {
            let (parent, child) = names();
            return Err(RejectedTransform::NotFinite { parent, child });
        }
        if (squared - 1.0).abs() >= NORM_TOLERANCE {
            let (parent, child) = names();
            return Err(RejectedTransform::NotNormalised { parent, child, norm: squared.sqrt() });
        }
        Ok(())
    }

    /// The transform itself.
    pub(super) fn isometry(&self) -> Result<Isometry3<f64>, RejectedTransform> {
        self.check()?;
        let ([x, y, z], [i, j, k, w]) = (self.translation_m, self.rotation_xyzw);
        let rotation = UnitQuaternion::from_quaternion(Quaternion::new(w, i, j, k));
        Ok(Isometry3::from_parts(Translation3::new(x, y, z), rotation))
    }
}

/// A frame in its parent: one fixed transform, or samples in order of time.
#[derive(Clone, Debug)]
pub(super) struct Link {
    pub parent: String,
    pub is_static: bool,
    samples: VecDeque<(f64, Isometry3<f64>)>,
}

/// Why a link has no transform for a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct OutOfHistory {
    pub oldest_s: f64,
    pub newest_s: f64,
}

impl Link {
    pub fn new(parent: &str, is_static: bool) -> Self {
        Self { parent: parent.to_owned(), is_static, samples: VecDeque::new() }
    }

    /// Takes a sample in; one that is older than the history is dropped.
    pub fn insert(&mut self, stamp_s: f64, transform: Isometry3<f64>, history_s: f64) {
        if self.is_static {
            self.samples.clear();
        }
        let newest_s = self.newest_s().unwrap_or(stamp_s);
        if stamp_s < newest_s - history_s {
            return;
        }
        let at = self.samples.partition_point(|(s, _)| *s < stamp_s);
        match self.samples.get_mut(at) {
            Some(same) if same.0 == stamp_s => same.1 = transform,
            _ => self.samples.insert(at, (stamp_s, transform)),
        }
        let keep_from_s = self.newest_s().unwrap_or(stamp_s) - history_s;
        // One sample before the history's begin stays, to interpolate from.
        while self.samples.len() > MAX_SAMPLES || self.samples.get(1).is_some_and(|(s, _)| *s < keep_from_s) {
            self.samples.pop_front();
        }
    }

    /// Drops the samples after a time.
    pub fn forget_after(&mut self, stamp_s: f64) {
        while self.samples.back().is_some_and(|(s, _)| *s > stamp_s) {
            self.samples.pop_back();
        }
    }

    /// The newest stamp, seconds; of a static one, that at which it was told.
    pub fn newest_s(&self) -> Option<f64> {
        self.samples.back().map(|(stamp_s, _)| *stamp_s)
    }

    /// The transform at a time: a straight line between positions, a great arc between
    /// rotations.
    pub fn at(&self, stamp_s: f64) -> Result<Isometry3<f64>, OutOfHistory> {
        let (Some(oldest), Some(newest)) = (self.samples.front(), self.samples.back()) else {
            return Err(OutOfHistory { oldest_s: f64::NAN, newest_s: f64::NAN });
        };
        if self.is_static {
            return Ok(newest.1);
        }
        let after = self.samples.partition_point(|(s, _)| *s < stamp_s);
        let outside = OutOfHistory { oldest_s: oldest.0, newest_s: newest.0 };
        let (after_s, to) = self.samples.get(after).ok_or(outside)?;
        if *after_s == stamp_s {
            return Ok(*to);
        }
        let (before_s, from) = after.checked_sub(1).and_then(|i| self.samples.get(i)).ok_or(outside)?;
        let share = (stamp_s - before_s) / (after_s - before_s);
        let translation = from.translation.vector.lerp(&to.translation.vector, share);
        // Opposite rotations have no shortest arc between them: the nearer one serves.
        let rotation = from.rotation.try_slerp(&to.rotation, share, 1e-9).unwrap_or(to.rotation);
        Ok(Isometry3::from_parts(translation.into(), rotation))
    }
}
