//! The explorer's clock: ROS time that neither jumps back nor counts pauses.

/// Makes run time of ROS time.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunClock {
    /// Run time minus ROS time, seconds.
    offset_s: f64,
    /// The last run time, and the ROS time that it was.
    last: Option<(f64, f64)>,
}

/// A step back of ROS time by more than this is a jump: a bag in a loop, a simulator
/// that was reset.
const JUMP_S: f64 = 1.0;

impl RunClock {
    /// The run time now; after a jump back it goes on from where it was.
    pub fn at(&mut self, ros_s: f64) -> f64 {
        let mut now_s = ros_s + self.offset_s;
        if let Some((last_s, _)) = self.last {
            if now_s < last_s - JUMP_S {
                self.offset_s = last_s - ros_s;
            }
            now_s = (ros_s + self.offset_s).max(last_s);
        }
        self.last = Some((now_s, ros_s));
        now_s
    }

    /// The time since the last run time was a pause.
    pub fn skip_to(&mut self, ros_s: f64) {
        if let Some((last_s, _)) = self.last {
            self.offset_s = last_s - ros_s;
        }
    }

    /// The run time of something that happened lately.
    #[must_use]
    pub fn of(&self, ros_s: f64) -> f64 {
        let run_s = ros_s + self.offset_s;
        self.last.map_or(run_s, |(last_s, _)| run_s.min(last_s))
    }

    /// The ROS time that was last asked about.
    #[must_use]
    pub fn last_ros_s(&self) -> Option<f64> {
        self.last.map(|(_, ros_s)| ros_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_runs_with_ros_time() {
        let mut clock = RunClock::default();
        assert_eq!((clock.at(100.0), clock.at(100.5), clock.of(100.2)), (100.0, 100.5, 100.2));
        assert_eq!(clock.of(101.0), 100.5, "nothing happens in the future");
    }

    #[test]
    fn a_jump_back_and_a_pause_are_passed_over() {
        let mut clock = RunClock::default();
        clock.at(100.0);
        assert_eq!((clock.at(5.0), clock.at(6.0)), (100.0, 101.0));
        clock.skip_to(60.0);
        assert_eq!((clock.at(60.0), clock.at(61.5), clock.of(60.5)), (101.0, 102.5, 101.5));
    }

    #[test]
    fn trembling_is_no_jump() {
        let mut clock = RunClock::default();
        clock.at(10.0);
        assert_eq!((clock.at(9.9), clock.at(10.1)), (10.0, 10.1));
    }
}
