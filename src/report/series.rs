//! Coverage and distance over time, and when a share of the world was covered.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The shares of coverage whose first time and distance are reported, by the names
/// that they have in files.
pub const COVERAGE_SHARES: [(&str, f64); 5] =
    [("0.50", 0.50), ("0.80", 0.80), ("0.90", 0.90), ("0.95", 0.95), ("0.99", 0.99)];

/// The most points that a series keeps.
const MAX_POINTS: usize = 1000;

/// One moment of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeriesPoint {
    /// Seconds since the start.
    pub time_s: f64,
    /// Share of the world that is covered, 0..=1.
    pub coverage: f64,
    /// Metres driven.
    pub distance_m: f64,
}

/// A number for each of [`COVERAGE_SHARES`] by name; `None` where it was not reached.
pub type ByShare = BTreeMap<String, Option<f64>>;

/// Collects a run tick by tick. The shares are watched at every tick; of the points,
/// no more than 1000 are kept, evenly over the ticks.
#[derive(Clone, Debug)]
pub struct Series {
    points: Vec<SeriesPoint>,
    stride: u64,
    ticks: u64,
    newest: Option<SeriesPoint>,
    reached: [Option<SeriesPoint>; COVERAGE_SHARES.len()],
}

impl Default for Series {
    fn default() -> Self {
        Self { points: Vec::new(), stride: 1, ticks: 0, newest: None, reached: [None; COVERAGE_SHARES.len()] }
    }
}

impl Series {
    /// An empty series.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes one tick: seconds since the start, covered share, metres driven. A tick
    /// with a number that is not finite is passed over.
    pub fn push(&mut self, time_s: f64, coverage: f64, distance_m: f64) {
        if ![time_s, coverage, distance_m].iter().all(|v| v.is_finite()) {
            return;
        }
        let point = SeriesPoint { time_s, coverage, distance_m };
        self.newest = Some(point);
        for (reached, (_, share)) in self.reached.iter_mut().zip(COVERAGE_SHARES) {
            if coverage >= share {
                reached.get_or_insert(point);
            }
        }
        if self.ticks.is_multiple_of(self.stride) {
            // One place is left for the newest point.
            if self.points.len() + 1 == MAX_POINTS {
                self.points = self.points.iter().copied().step_by(2).collect();
                self.stride *= 2;
            }
            if self.ticks.is_multiple_of(self.stride) {
                self.points.push(point);
            }
        }
        self.ticks += 1;
    }

    /// The points kept, in order, from the first tick to the newest.
    #[must_use]
    pub fn points(&self) -> Vec<SeriesPoint> {
        let mut points = self.points.clone();
        points.extend(self.newest.filter(|newest| points.last() != Some(newest)));
        points
    }

    /// Seconds until each share was first reached.
    #[must_use]
    pub fn time_to_coverage_s(&self) -> ByShare {
        self.by_share(|point| point.time_s)
    }

    /// Metres driven until each share was first reached.
    #[must_use]
    pub fn distance_to_coverage_m(&self) -> ByShare {
        self.by_share(|point| point.distance_m)
    }

    fn by_share(&self, value: impl Fn(&SeriesPoint) -> f64) -> ByShare {
        let shares = COVERAGE_SHARES.iter().zip(&self.reached);
        shares.map(|((name, _), reached)| ((*name).to_owned(), reached.as_ref().map(&value))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_reached_at_ticks_whatever_is_thinned() {
        let mut series = Series::new();
        for tick in 0..=94_000u32 {
            let t = f64::from(tick);
            series.push(t, t / 100_000.0, t * 2.0);
        }
        let times = series.time_to_coverage_s();
        assert_eq!(times.len(), COVERAGE_SHARES.len());
        assert_eq!(times["0.50"], Some(50_000.0));
        assert_eq!(times["0.90"], Some(90_000.0));
        assert_eq!(times["0.95"], None);
        assert_eq!(series.distance_to_coverage_m()["0.80"], Some(160_000.0));
        let points = series.points();
        assert!((500..=1000).contains(&points.len()), "{}", points.len());
        assert_eq!((points[0].time_s, points.last().unwrap().time_s), (0.0, 94_000.0));
        let steps: Vec<f64> = points.windows(2).map(|w| w[1].time_s - w[0].time_s).collect();
        assert!(steps[..steps.len() - 1].iter().all(|&step| step == steps[0]));
    }

    #[test]
    fn coverage_that_falls_back_was_reached_all_the_same() {
        let mut series = Series::new();
        for (t, coverage) in [(0.0, 0.4), (1.0, 0.5), (2.0, 0.45), (3.0, f64::NAN), (4.0, 0.55)] {
            series.push(t, coverage, t);
        }
        assert_eq!(series.time_to_coverage_s()["0.50"], Some(1.0));
        assert_eq!(series.points().len(), 4);
    }

    #[test]
    fn short_series_are_kept_whole() {
        for ticks in [0, 1, 998, 999, 1000, 1001, 1998, 1999, 2000] {
            let mut series = Series::new();
            (0..ticks).for_each(|t| series.push(f64::from(t), 0.0, 0.0));
            let points = series.points();
            assert!(points.len() <= MAX_POINTS && points.len() >= ticks.min(500) as usize, "{ticks}: {}", points.len());
            assert!(ticks >= 1000 || points.len() == ticks as usize);
        }
    }
}
