//! Keeps a replay as fast as its recording, or a number of times as fast.

use crate::explore::{Decision, Explorer, Watcher};
use crate::replay::BagRobot;
use crate::robot::Observation;
use std::time::{Duration, Instant};

/// Waits after each step for the time on the wall to come.
pub struct Pace {
    began: Instant,
    rate: Option<f64>,
}

impl Pace {
    /// A replay that begins now, `rate` times as fast as it was recorded; as fast as possible
    /// without one.
    #[must_use]
    pub fn new(rate: Option<f64>) -> Self {
        Self { began: Instant::now(), rate }
    }
}

impl Watcher<BagRobot> for Pace {
    fn after_step(&mut self, robot: &BagRobot, _: &Explorer, _: &Observation, _: &Decision) {
        if let Some(rate) = self.rate {
            // Silence that was passed over is not waited for either.
            let due = Duration::try_from_secs_f64((robot.now_s() - robot.skipped_s()) / rate).unwrap_or(Duration::MAX);
            std::thread::sleep(due.saturating_sub(self.began.elapsed()));
        }
    }
}
