//! The frames of a recording while it is played, by the clock of their stamps.

use super::clock::Clock;
use crate::bag::{Summary, seconds};
use crate::robot::PoseError;
use crate::tf::{Stamped, TransformBuffer, TransformSample, frame_name};
use std::collections::BTreeSet;

/// How far back transforms are remembered, seconds.
const HISTORY_S: f64 = 10.0;
/// A transform that is older than this is not believed, seconds.
const TOLERANCE_S: f64 = 0.5;
/// A transform that is stamped this far ahead of the clock, seconds, is taken in only when the
/// next is too: a single one would hide all that follow.
const AHEAD_S: f64 = 5.0;
/// One that was recorded at a time that cannot be must be this near to the clock, seconds.
const STRAY_S: f64 = 1.0;

/// Transforms of the last seconds. All times are seconds since the bag's begin: `time_s` by
/// the recorder's clock, stamps by that of the headers.
#[derive(Debug)]
pub struct Frames {
    /// The transforms themselves.
    pub transforms: TransformBuffer,
    /// The clock that headers go by.
    pub clock: Clock,
    /// The bag's begin, seconds since 1970.
    begin_s: f64,
    /// Frames and parents that would make a circle of the tree: one message of a frame that
    /// has no parent otherwise would stay.
    circular: BTreeSet<(String, String)>,
    /// How far ahead the last message was, if it was too far, seconds.
    ahead_s: Option<f64>,
}

impl Frames {
    /// Before the first message, with what is fixed in the whole bag.
    pub fn new(summary: &Summary, clock: Clock) -> Self {
        let transforms = TransformBuffer::new(HISTORY_S);
        let (begin_s, circular) = (seconds(summary.start), summary.circular.clone());
        let mut this = Self { transforms, clock, begin_s, circular, ahead_s: None };
        summary.tf.values().filter_map(|link| link.fixed.as_ref()).for_each(|fixed| this.learn_fixed([fixed]));
        this
    }

    /// The headers' clock at a time.
    pub const fn now_s(&self, time_s: f64) -> f64 {
        time_s + self.clock.offset_s()
    }

    /// Takes transforms in that are always true. What cannot be a transform is left out, as
    /// tf2 does; the summary of the bag tells of it.
    pub fn learn_fixed<'a>(&mut self, samples: impl IntoIterator<Item = &'a TransformSample>) {
        for sample in samples {
            self.insert(sample, true);
        }
    }

    /// Whether a transform is taken in.
    fn insert(&mut self, sample: &TransformSample, is_static: bool) -> bool {
        let name = |name: &str| frame_name(name).to_owned();
        let is_circular =
            !self.circular.is_empty() && self.circular.contains(&(name(&sample.child), name(&sample.parent)));
        !is_circular && self.transforms.insert(sample, is_static).is_ok()
    }

    /// Takes transforms in that are true for a moment.
    ///
    /// # Errors
    /// How far their stamps are from all others, when that cannot be.
    pub fn learn_moving(
        &mut self,
        mut samples: Vec<TransformSample>,
        time_s: f64,
        is_stray: bool,
    ) -> Result<(), String> {
        let are_stamped: Vec<bool> = samples.iter().map(|sample| sample.stamp_s > 0.0).collect();
        for sample in &mut samples {
            let (parent, child) = (frame_name(&sample.parent), frame_name(&sample.child));
            sample.stamp_s -= self.begin_s + self.clock.link_s(parent, child);
        }
        let now_s = self.now_s(time_s);
        let ahead_s = samples.iter().map(|sample| sample.stamp_s - now_s).fold(f64::NEG_INFINITY, f64::max);
        let was_ahead_s = std::mem::replace(&mut self.ahead_s, (ahead_s > AHEAD_S).then_some(ahead_s));
        let is_alone = ahead_s > AHEAD_S && was_ahead_s.is_none_or(|before_s| (before_s - ahead_s).abs() > AHEAD_S);
        if is_alone || (is_stray && ahead_s.abs() > STRAY_S) {
            let side = if ahead_s > 0.0 { "ahead of" } else { "behind" };
            return Err(format!("it is stamped {:.1} s {side} the others", ahead_s.abs()));
        }
        for (sample, is_stamped) in samples.iter().zip(are_stamped) {
            if self.insert(sample, false) && is_stamped && !is_stray {
                self.clock.learn(frame_name(&sample.child), sample.stamp_s - time_s);
            }
        }
        Ok(())
    }

    /// Where the robot was, as tf told it until a time.
    ///
    /// # Errors
    /// [`PoseError`] when no transform leads there, or the newest is too old.
    pub fn robot(&self, map_frame: &str, base_frame: &str, time_s: f64) -> Result<Stamped, PoseError> {
        let (map, base) = (map_frame.to_owned(), base_frame.to_owned());
        let newest = self.transforms.latest(map_frame, base_frame);
        let newest = newest.map_err(|why| PoseError::NotYet {
            map_frame: map.clone(),
            base_frame: base.clone(),
            why: why.to_string(),
        })?;
        let age_s = self.now_s(time_s) - newest.stamp_s;
        if age_s > TOLERANCE_S {
            return Err(PoseError::Stale { map_frame: map, base_frame: base, age_s, limit_s: TOLERANCE_S });
        }
        Ok(newest)
    }
}
