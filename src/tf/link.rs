//! One frame in its parent over time.

use crate::geometry::Pose;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use std::collections::VecDeque;

/// The most samples that are kept of one frame: ten seconds at 400 Hz.
const MAX_SAMPLES: usize = 4000;

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
    /// A quaternion x, y, z, w; it need not be normalised.
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
    #[error("the transform from {parent} to {child} holds numbers that cannot be: must be finite, the rotation not 0")]
    NotFinite {
        /// The parent.
        parent: String,
        /// The child.
        child: String,
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
    /// The transform itself.
    pub(super) fn isometry(&self) -> Result<Isometry3<f64>, RejectedTransform> {
        let [x, y, z] = self.translation_m;
        let [i, j, k, w] = self.rotation_xyzw;
        let rotation = Quaternion::new(w, i, j, k);
        let finite = [x, y, z, self.stamp_s].iter().all(|v| v.is_finite()) && rotation.norm().is_finite();
        if !finite || rotation.norm() < 1e-6 {
            return Err(RejectedTransform::NotFinite { parent: self.parent.clone(), child: self.child.clone() });
        }
        Ok(Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::from_quaternion(rotation)))
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
