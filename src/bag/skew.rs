//! How far the clock of message headers is from the recorder's.
//!
//! One message says nothing: it may have been stamped ahead, or late, or recorded at a time
//! that cannot be. The median of many does.

use super::Nanos;

/// So many differences are kept; beyond it every second one, then every fourth, and so on.
const MAX_SAMPLES: usize = 256;

/// Header time minus record time of the messages of one source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skew {
    seen: u64,
    stride: u64,
    samples_s: Vec<f64>,
}

impl Skew {
    /// Adds a message. A stamp of 0 says nothing.
    pub(super) fn add(&mut self, stamp: Nanos, recorded: Nanos) {
        if stamp == 0 {
            return;
        }
        self.stride = self.stride.max(1);
        if self.seen.is_multiple_of(self.stride) {
            if self.samples_s.len() >= MAX_SAMPLES {
                self.samples_s = self.samples_s.iter().copied().step_by(2).collect();
                self.stride *= 2;
            }
            if self.seen.is_multiple_of(self.stride) {
                self.samples_s.push((i128::from(stamp) - i128::from(recorded)) as f64 * 1e-9);
            }
        }
        self.seen += 1;
    }

    /// The median difference, seconds: above 0 where headers are ahead of the recorder.
    /// `None` when no message had a stamp.
    #[must_use]
    pub fn median_s(&self) -> Option<f64> {
        median(self.samples_s.clone())
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

    #[test]
    fn the_median_does_not_hear_the_few() {
        let mut skew = Skew::default();
        assert_eq!(skew.median_s(), None);
        skew.add(1_000_000_000_000, 0);
        for i in 0..10_000_u64 {
            let recorded = 1_000_000_000_000 + i * 10_000_000;
            skew.add(recorded - 600_000_000, recorded);
            skew.add(0, recorded);
        }
        skew.add(u64::from(u32::MAX) * 1_000_000_000, 2);
        assert!((skew.median_s().unwrap() + 0.6).abs() < 1e-9, "{:?}", skew.median_s());
        assert!(skew.samples_s.len() <= MAX_SAMPLES && skew.seen == 10_002);
    }
}
