//! Medians, ranges and bootstrap confidence intervals of a handful of measurements.
//!
//! A run that never reaches a share of coverage counts as later than every run that
//! does: it is infinity here, and so the median of runs of which most fail is "not
//! reached" and not the median of the lucky ones.

use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use serde::Serialize;

/// Samples drawn for a confidence interval.
const RESAMPLES: usize = 2000;

/// Decides the samples: the same measurements have the same interval.
const SEED: u64 = 0xb007;

/// The middle of some measurements and how far they spread. Every figure is `None`
/// where it was not reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Spread {
    /// How many reached what is measured.
    pub reached: usize,
    /// Of how many.
    pub of: usize,
    /// The median.
    pub median: Option<f64>,
    /// The first quartile.
    pub q25: Option<f64>,
    /// The third quartile.
    pub q75: Option<f64>,
    /// The lower end of the median's bootstrap 95 % confidence interval (percentiles).
    pub ci_low: Option<f64>,
    /// Its upper end.
    pub ci_high: Option<f64>,
}

impl Spread {
    /// Of some measurements, `None` where what is measured was not reached.
    #[must_use]
    pub fn of(values: impl IntoIterator<Item = Option<f64>>) -> Self {
        let mut sorted: Vec<f64> = values.into_iter().map(|value| value.unwrap_or(f64::INFINITY)).collect();
        sorted.sort_by(f64::total_cmp);
        if sorted.is_empty() {
            return Self::default();
        }
        let finite = |value: f64| value.is_finite().then_some(value);
        let medians = bootstrap_medians(&sorted);
        Self {
            reached: sorted.iter().filter(|value| value.is_finite()).count(),
            of: sorted.len(),
            median: finite(quantile(&sorted, 0.5)),
            q25: finite(quantile(&sorted, 0.25)),
            q75: finite(quantile(&sorted, 0.75)),
            ci_low: finite(quantile(&medians, 0.025)),
            ci_high: finite(quantile(&medians, 0.975)),
        }
    }
}

/// The quantile of sorted values, interpolated linearly (type 7 of Hyndman and Fan
/// 1996); infinite where either neighbour counts and is, and for no values.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * sorted.len().saturating_sub(1) as f64;
    let below = place.floor();
    let at = |i: usize| sorted.get(i).copied().unwrap_or(f64::INFINITY);
    let (low, high) = (at(below as usize), at(place.ceil() as usize));
    // Infinity less infinity is no number, and nothing is to be interpolated.
    if low.total_cmp(&high).is_eq() { low } else { low + (high - low) * (place - below) }
}

/// The sorted medians of samples drawn with replacement (Efron 1979).
fn bootstrap_medians(sorted: &[f64]) -> Vec<f64> {
    let mut random = Pcg32::new(SEED, sorted.len() as u64);
    let count = sorted.len() as u64;
    let mut sample = vec![0.0; sorted.len()];
    let mut medians: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            for value in &mut sample {
                // A 32-bit number scaled down: biased by less than one in a million here.
                let pick = (u64::from(random.next_u32()) * count) >> 32;
                *value = sorted.get(pick as usize).copied().unwrap_or(f64::INFINITY);
            }
            sample.sort_by(f64::total_cmp);
            quantile(&sample, 0.5)
        })
        .collect();
    medians.sort_by(f64::total_cmp);
    medians
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_r_and_numpy() {
        let values = [1.0, 2.0, 4.0, 8.0];
        for (share, expected) in [(0.0, 1.0), (0.25, 1.75), (0.5, 3.0), (0.75, 5.0), (1.0, 8.0)] {
            assert_eq!(quantile(&values, share), expected, "{share}");
        }
    }

    #[test]
    fn what_is_not_reached_is_late_and_not_absent() {
        let spread = Spread::of([Some(10.0), None, Some(30.0), Some(20.0)]);
        assert_eq!((spread.reached, spread.of), (3, 4));
        assert_eq!((spread.median, spread.q25, spread.q75), (Some(25.0), Some(17.5), None));
        let lost = Spread::of([None, None, Some(1.0)]);
        assert_eq!((lost.median, lost.reached, lost.of), (None, 1, 3));
        assert_eq!(Spread::of([]), Spread::default());
    }

    #[test]
    fn one_run_has_an_interval_of_one_point() {
        let spread = Spread::of([Some(7.0)]);
        assert_eq!((spread.ci_low, spread.median, spread.ci_high), (Some(7.0), Some(7.0), Some(7.0)));
    }

    #[test]
    fn the_interval_covers_the_median_of_what_is_sampled_as_often_as_it_says() {
        // Uniform numbers have the median 1/2; of 200 intervals about 190 hold it.
        let mut random = Pcg32::new(1, 1);
        let mut held = 0;
        for _ in 0..200 {
            let values: Vec<_> = (0..25).map(|_| Some(f64::from(random.next_u32()) / f64::from(u32::MAX))).collect();
            let spread = Spread::of(values.iter().copied());
            assert_eq!(spread, Spread::of(values));
            held += usize::from(spread.ci_low <= Some(0.5) && Some(0.5) <= spread.ci_high);
        }
        assert!((178..=199).contains(&held), "{held}");
    }
}
