//! The explorer's clock: ROS time that neither jumps back nor counts pauses.

/// Makes run time of ROS time.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunClock {
    /// Run time minus ROS time, seconds.
    offset_s: f64,
    /// The last run time, and the ROS time that it was.
    last: Option<(f64, f64)>,
    /// The real time then.
    wall_s: f64,
    /// A jump ahead that nobody was told of, seconds.
    ahead_s: Option<f64>,
}

/// A step back of ROS time by more than this is a jump: a bag in a loop, a simulator
/// that was reset.
const JUMP_S: f64 = 1.0;
/// A step ahead by more than this is a jump too, beside what the fastest simulator does in the real
/// time that has passed: clocks that were set, a computer that slept.
const AHEAD_S: f64 = 10.0;
const FASTEST: f64 = 100.0;

impl RunClock {
    /// The run time now, by ROS time and by real time since any moment; after a jump it goes on from
    /// where it was.
    pub fn at(&mut self, ros_s: f64, wall_s: f64) -> f64 {
        let mut now_s = ros_s + self.offset_s;
        if let Some((last_s, _)) = self.last {
            let step_s = now_s - last_s;
            let is_ahead = step_s > AHEAD_S + FASTEST * (wall_s - self.wall_s);
            if step_s < -JUMP_S || is_ahead {
                self.offset_s = last_s - ros_s;
            }
            self.ahead_s = if is_ahead { Some(step_s) } else { self.ahead_s };
            now_s = (ros_s + self.offset_s).max(last_s);
        }
        (self.last, self.wall_s) = (Some((now_s, ros_s)), wall_s);
        now_s
    }

    /// By how much ROS time jumped ahead, seconds, if it did and this was not asked before.
    pub const fn take_jump_ahead(&mut self) -> Option<f64> {
        self.ahead_s.take()
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
        assert_eq!((clock.at(100.0, 0.0), clock.at(100.5, 0.5), clock.of(100.2)), (100.0, 100.5, 100.2));
        assert_eq!(clock.of(101.0), 100.5, "nothing happens in the future");
        assert_eq!(clock.at(125.5, 0.75), 125.5, "a hundred times as fast");
        assert_eq!(clock.take_jump_ahead(), None);
    }

    #[test]
    fn a_jump_back_and_a_pause_are_passed_over() {
        let mut clock = RunClock::default();
        clock.at(100.0, 0.0);
        assert_eq!((clock.at(5.0, 0.1), clock.at(6.0, 1.1)), (100.0, 101.0));
        clock.skip_to(60.0);
        assert_eq!((clock.at(60.0, 2.0), clock.at(61.5, 3.5), clock.of(60.5)), (101.0, 102.5, 101.5));
    }

    #[test]
    fn a_jump_ahead_is_passed_over_and_told_once() {
        let mut clock = RunClock::default();
        clock.at(100.0, 0.0);
        assert_eq!((clock.at(3_700.0, 0.2), clock.at(3_701.0, 1.2)), (100.0, 101.0));
        assert_eq!((clock.take_jump_ahead(), clock.take_jump_ahead()), (Some(3_600.0), None));
        assert_eq!(clock.of(3_700.5), 100.5);
    }
}
