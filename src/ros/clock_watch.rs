//! Whether ROS time goes on, by the clock on the wall.

use std::time::{Duration, Instant};

/// Remembers when ROS time last changed.
#[derive(Clone, Copy, Debug)]
pub struct ClockWatch {
    last_s: f64,
    moved: Instant,
}

impl ClockWatch {
    /// A watch that begins now.
    #[must_use]
    pub fn new() -> Self {
        Self { last_s: f64::NEG_INFINITY, moved: Instant::now() }
    }

    /// For how long ROS time, in seconds, has stood; zero when it has just changed.
    pub fn stands_for(&mut self, ros_s: f64) -> Duration {
        if ros_s != self.last_s {
            (self.last_s, self.moved) = (ros_s, Instant::now());
        }
        self.moved.elapsed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_that_stands_is_measured_on_the_wall() {
        let mut watch = ClockWatch::new();
        assert!(watch.stands_for(5.0) < Duration::from_millis(20));
        std::thread::sleep(Duration::from_millis(30));
        assert!(watch.stands_for(5.0) >= Duration::from_millis(30));
        assert!(watch.stands_for(4.0) < Duration::from_millis(20), "a jump back is a change");
    }
}
