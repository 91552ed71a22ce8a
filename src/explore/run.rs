//! The one driver loop: it serves the node, the simulator and the replay.

use super::{Decision, End, EndReason, Explorer};
use crate::robot::{Observation, Robot, RobotError};

/// What is said of a run that its user stopped.
pub const STOPPED: &str = "stopped by the user";

/// Looks on while a run goes on: records, progress bars, publishers.
pub trait Watcher<R> {
    /// Called with every observation, also when nothing is decided on it; what was changed
    /// meanwhile, by the user or by a recording, can be told here.
    fn before_step(&mut self, _robot: &R, _explorer: &mut Explorer, _observation: &Observation) {}

    /// Called after each step, before the command goes out.
    fn after_step(&mut self, robot: &R, explorer: &Explorer, observation: &Observation, decision: &Decision);

    /// Why the user wants the run to stop, if so.
    fn stop_requested(&self) -> Option<String> {
        None
    }
}

/// Two that look on together, the first one first.
impl<R, A: Watcher<R>, B: Watcher<R>> Watcher<R> for (A, B) {
    fn before_step(&mut self, robot: &R, explorer: &mut Explorer, observation: &Observation) {
        self.0.before_step(robot, explorer, observation);
        self.1.before_step(robot, explorer, observation);
    }

    fn after_step(&mut self, robot: &R, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        self.0.after_step(robot, explorer, observation, decision);
        self.1.after_step(robot, explorer, observation, decision);
    }

    fn stop_requested(&self) -> Option<String> {
        self.0.stop_requested().or_else(|| self.1.stop_requested())
    }
}

/// Nobody looks on.
impl<R> Watcher<R> for () {
    fn after_step(&mut self, _: &R, _: &Explorer, _: &Observation, _: &Decision) {}
}

/// Runs the explorer on a robot until one of them ends.
pub fn run<R: Robot>(robot: &mut R, explorer: &mut Explorer, watcher: &mut impl Watcher<R>) -> End {
    let mut now_s = 0.0;
    loop {
        let observation = match robot.observe() {
            Ok(observation) => observation,
            Err(error) => return explorer.end_now(reason_of(&error), now_s, &error.to_string()),
        };
        now_s = observation.stamp_s;
        watcher.before_step(robot, explorer, &observation);
        if let Some(why) = watcher.stop_requested() {
            // A robot that cannot be told to hold any more is as good as stopped.
            let _ = robot.command(&crate::robot::Command::Hold);
            return explorer.end_now(EndReason::Interrupted, now_s, &why);
        }
        if !robot.is_ready() {
            continue;
        }
        let decision = explorer.step(&observation);
        watcher.after_step(robot, explorer, &observation, &decision);
        if let Err(error) = robot.command(&decision.command) {
            return explorer.end_now(reason_of(&error), now_s, &error.to_string());
        }
        if let Some(end) = decision.end {
            return end;
        }
    }
}

const fn reason_of(error: &RobotError) -> EndReason {
    match error {
        RobotError::Ended => EndReason::RecordingEnded,
        RobotError::Interrupted => EndReason::Interrupted,
        RobotError::Disconnected(_) => EndReason::Disconnected,
    }
}
