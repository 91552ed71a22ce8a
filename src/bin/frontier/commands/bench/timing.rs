//! Times of the same work done again and again.

use serde::Serialize;
use std::hint::black_box;
use std::time::Instant;

/// What the times of several runs come to, milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Times {
    /// Half of the runs were faster.
    pub median_ms: f64,
    /// The fastest run: the least disturbed.
    pub min_ms: f64,
    /// Nine of ten runs were faster.
    pub p90_ms: f64,
}

impl Times {
    /// Of the times of single runs, milliseconds, of which there must be at least one.
    pub fn of(mut times_ms: Vec<f64>) -> Self {
        times_ms.sort_by(f64::total_cmp);
        let last = times_ms.len().saturating_sub(1);
        let at = |share: f64| times_ms.get((last as f64 * share) as usize).copied().unwrap_or_default();
        Self { median_ms: at(0.5), min_ms: at(0.0), p90_ms: at(0.9) }
    }

    /// Times some work, after one run that warms the caches.
    pub fn measure<T>(runs: u32, mut work: impl FnMut() -> T) -> Self {
        black_box(work());
        let time = |_| {
            let began = Instant::now();
            black_box(work());
            began.elapsed().as_secs_f64() * 1e3
        };
        Self::of((0..runs).map(time).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_does_not_matter_and_one_run_is_all_three() {
        let times = Times::of((1..=11).rev().map(f64::from).collect());
        assert_eq!(times, Times { median_ms: 6.0, min_ms: 1.0, p90_ms: 10.0 });
        assert_eq!(Times::of(vec![3.0]), Times { median_ms: 3.0, min_ms: 3.0, p90_ms: 3.0 });
    }

    #[test]
    fn work_is_done_once_more_than_it_is_timed() {
        let mut count = 0;
        Times::measure(5, || count += 1);
        assert_eq!(count, 6);
    }
}
