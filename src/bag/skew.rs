//! How far the clock of message headers is from the recorder's.
//!
//! One message says nothing: it may have been stamped ahead, or late, or recorded at a time
//! that cannot be. The median of many does. The clocks need not run at the same speed, as
//! that of a simulation does not, so that two sources are compared at the same times.

use super::Nanos;

/// So many differences are kept; beyond it every second one, then every fourth, and so on.
const MAX_SAMPLES: usize = 256;
/// So many of the first ones are kept beside.
const FIRST: usize = 15;

/// Header time minus record time of the messages of one source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skew {
    seen: u64,
    stride: u64,
    first_s: Vec<f64>,
    /// When they were recorded, and the differences in seconds.
    samples: Vec<(Nanos, f64)>,
}

impl Skew {
    /// Adds a message. A stamp of 0 says nothing.
    pub(super) fn add(&mut self, stamp: Nanos, recorded: Nanos) {
        if stamp == 0 {
            return;
        }
        let difference_s = (i128::from(stamp) - i128::from(recorded)) as f64 * 1e-9;
        if self.first_s.len() < FIRST {
            self.first_s.push(difference_s);
        }
        self.stride = self.stride.max(1);
        if self.seen.is_multiple_of(self.stride) {
            if self.samples.len() >= MAX_SAMPLES {
                self.samples = self.samples.iter().copied().step_by(2).collect();
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.samples.push((recorded, difference_s));
            }
        }
        self.seen += 1;
    }

    /// The median difference, seconds: above 0 where headers are ahead of the recorder.
    /// `None` when no message had a stamp.
    #[must_use]
    pub fn median_s(&self) -> Option<f64> {
        median(self.samples.iter().map(|(_, difference_s)| *difference_s).collect())
    }

    /// The median of the first few, seconds.
    #[must_use]
    pub fn first_s(&self) -> Option<f64> {
        median(self.first_s.clone())
    }

    /// How far the clock of this source is ahead of that of another one, at the same times,
    /// seconds. `None` when one of them had no stamps.
    #[must_use]
    pub fn ahead_of_s(&self, other: &Self) -> Option<f64> {
        let mut others = other.samples.clone();
        others.sort_by_key(|(recorded, _)| *recorded);
        let nearest = |recorded: Nanos| {
            let after = others.partition_point(|(at, _)| *at < recorded);
            let around = [after.checked_sub(1), Some(after)].into_iter().flatten().filter_map(|i| others.get(i));
            around.min_by_key(|(at, _)| at.abs_diff(recorded)).map(|(_, difference_s)| *difference_s)
        };
        median(self.samples.iter().filter_map(|&(recorded, own_s)| Some(own_s - nearest(recorded)?)).collect())
    }
}

/// The lower median of some numbers; `None` without any.
fn median(mut numbers: Vec<f64>) -> Option<f64> {
    numbers.sort_by(f64::total_cmp);
    numbers.get(numbers.len().saturating_sub(1) / 2).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: Nanos = 1_000_000_000;

    #[test]
    fn the_median_does_not_hear_the_few() {
        let mut skew = Skew::default();
        assert_eq!(skew.median_s(), None);
        skew.add(1000 * S, 0);
        for i in 0..10_000_u64 {
            let recorded = 1000 * S + i * 10_000_000;
            skew.add(recorded - 600_000_000, recorded);
            skew.add(0, recorded);
        }
        skew.add(u64::from(u32::MAX) * S, 2);
        for found_s in [skew.median_s(), skew.first_s()] {
            assert!((found_s.unwrap() + 0.6).abs() < 1e-9, "{found_s:?}");
        }
        assert!(skew.samples.len() <= MAX_SAMPLES && skew.seen == 10_002);
    }

    #[test]
    fn clocks_of_another_speed_are_compared_at_the_same_times() {
        // The headers go half as fast as the recorder; the second source begins late.
        let (mut all, mut late) = (Skew::default(), Skew::default());
        for i in 0..6000_u64 {
            let recorded = 5000 * S + i * S / 10;
            all.add(100 * S + i * S / 20, recorded);
            if i > 4000 {
                late.add(107 * S + i * S / 20, recorded);
            }
        }
        let ahead_s = late.ahead_of_s(&all).unwrap();
        assert!((ahead_s - 7.0).abs() < 1.5, "{ahead_s}");
        assert_eq!(Skew::default().ahead_of_s(&all), None);
    }
}
