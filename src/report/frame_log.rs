//! The moments of a run that its animation shows, however long it takes.
//!
//! A log holds a limited number of frames: when it is full, every second one is
//! dropped and from then on frames are taken half as often. The last moment is kept
//! in any case.

use crate::geometry::{Point, Pose};
use crate::grid::OccupancyGrid;
use std::sync::Arc;

/// One moment of a run.
#[derive(Clone, Debug)]
pub struct Frame {
    /// When, seconds.
    pub time_s: f64,
    /// The map as it was then.
    pub grid: Arc<OccupancyGrid>,
    /// Where the robot was, if that was known.
    pub pose_in_map: Option<Pose>,
    /// How many points of the run's trajectory had been driven by then.
    pub trajectory_len: usize,
    /// Centres of the frontier cells, in the map frame.
    pub frontier_points_in_map: Arc<[Point]>,
    /// Where the robot was heading.
    pub goal_in_map: Option<Point>,
}

/// The frames of a run, thinned as it goes on.
#[derive(Clone, Debug)]
pub struct FrameLog {
    frames: Vec<Frame>,
    capacity: usize,
    interval_s: f64,
    last: Option<Frame>,
}

impl Default for FrameLog {
    /// At most 120 frames, at first two in a second.
    fn default() -> Self {
        Self::new(120, 0.5)
    }
}

impl FrameLog {
    /// A log of at most `capacity` frames (at least 2), at first one in `interval_s`
    /// seconds (not negative).
    #[must_use]
    pub fn new(capacity: usize, interval_s: f64) -> Self {
        Self { frames: Vec::new(), capacity: capacity.max(2), interval_s: interval_s.max(0.0), last: None }
    }

    /// Whether a frame of this time would be taken: ask before making one.
    #[must_use]
    pub fn wants(&self, time_s: f64) -> bool {
        // A hair less than the interval: ticks of 0.1 s do not add up exactly.
        self.frames.last().is_none_or(|newest| time_s - newest.time_s >= self.interval_s - 1e-6)
    }

    /// Takes a frame if its time has come; the newest frame is remembered in any case,
    /// for the end. Times must not go back.
    pub fn push(&mut self, frame: Frame) {
        if !self.wants(frame.time_s) {
            self.last = Some(frame);
            return;
        }
        self.last = None;
        // One place is left for the last moment.
        if self.frames.len() + 1 >= self.capacity {
            let mut keep = false;
            self.frames.retain(|_| {
                keep = !keep;
                keep
            });
            self.interval_s = if self.interval_s > 0.0 { self.interval_s * 2.0 } else { self.span_s() };
            if !self.wants(frame.time_s) {
                self.last = Some(frame);
                return;
            }
        }
        self.frames.push(frame);
    }

    /// The frames so far, in order of time, the newest among them.
    pub fn frames(&self) -> impl Iterator<Item = &Frame> {
        self.frames.iter().chain(&self.last)
    }

    /// Number of frames.
    #[must_use]
    pub fn len(&self) -> usize {
        self.frames.len() + usize::from(self.last.is_some())
    }

    /// Whether no frame was taken.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Mean time between the kept frames, seconds: an interval for a log that began
    /// with none.
    fn span_s(&self) -> f64 {
        match (self.frames.first(), self.frames.last()) {
            (Some(first), Some(last)) => (last.time_s - first.time_s) / self.frames.len() as f64,
            _ => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn log(capacity: usize, interval_s: f64, ticks: u32) -> FrameLog {
        let grid = Arc::new(OccupancyGrid::from_ascii(".").unwrap());
        let mut log = FrameLog::new(capacity, interval_s);
        for tick in 0..ticks {
            log.push(Frame {
                time_s: f64::from(tick) * 0.1,
                grid: Arc::clone(&grid),
                pose_in_map: None,
                trajectory_len: 0,
                frontier_points_in_map: Arc::new([]),
                goal_in_map: None,
            });
        }
        log
    }

    #[test]
    fn long_runs_are_thinned_evenly_and_keep_their_ends() {
        for ticks in [1, 2, 7, 100, 1001, 54321] {
            for interval_s in [0.0, 0.1, 0.5] {
                let log = log(20, interval_s, ticks);
                let times: Vec<f64> = log.frames().map(|f| f.time_s).collect();
                assert!(times.len() <= 20 && log.len() == times.len(), "{ticks} ticks: {times:?}");
                assert_eq!(times.first(), Some(&0.0));
                assert_eq!(times.last(), Some(&(f64::from(ticks - 1) * 0.1)));
                assert!(ticks < 1001 || times.len() >= 9, "{ticks} ticks: {times:?}");
                let steps: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
                let widest = steps.iter().copied().fold(0.0, f64::max);
                assert!(steps.iter().rev().skip(1).all(|s| widest <= s * 1.5 + 0.11), "{steps:?}");
            }
        }
    }
}
