//! The recorded robot. It cannot be told where to drive: its commands are taken down, and
//! their outcome is what the recording did by itself.
//!
//! While the recording drives to the goal that we chose too, that goal ends as the
//! recording's did. Another goal of ours is reached when the recorded robot comes near it,
//! and is taken away (as by a person who clicks another one) when the recording goes its own
//! way for a while; so decisions keep being made, and no goal is blamed. A turn lasts as long
//! as the recording turns.

use super::goals::{GoalEnd, RecordedGoals};
use super::player::{PlayError, Player};
use crate::bag::Summary;
use crate::geometry::{Pose, shortest_angle};
use crate::robot::{Command, Navigation, NavigationState, Observation, PoseError, Robot, RobotError};

/// From one look to the next, seconds, as `explore_node` has it.
const TICK_S: f64 = 0.2;
/// A goal counts as reached within this distance, metres.
const ARRIVED_M: f64 = 0.5;
/// A goal is given back after this time, seconds: shorter than any patience.
const OWN_WAY_S: f64 = 10.0;
/// Goals nearer than this to each other are the same, metres.
pub(super) const SAME_M: f64 = 0.5;
/// The recording may decide the same so much earlier or later than we, seconds.
pub(super) const LAG_S: f64 = 2.0;
/// A silence longer than this is passed over, seconds: it may last for years.
const SILENCE_S: f64 = 60.0;
/// A recording that turned less than this in [`LAG_S`] does not turn, radians.
const STANDS_RAD: f64 = 0.1;

/// A command under way.
#[derive(Clone, Copy, Debug)]
struct Task {
    id: u64,
    aim: Aim,
    since_s: f64,
}

/// What a command is after.
#[derive(Clone, Copy, Debug)]
enum Aim {
    Goal(Pose),
    Turn {
        /// The whole turn, radians.
        angle_rad: f64,
        /// How far the recording had turned at the command's begin, radians.
        from_rad: f64,
        /// How far it had turned, and when that was looked at last.
        seen: (f64, f64),
    },
}

/// A bag behind the port. All times are seconds since the bag's begin.
pub struct BagRobot {
    player: Player,
    end_s: f64,
    now_s: f64,
    task: Option<Task>,
    pose: Option<Pose>,
    distance_m: f64,
    turned_rad: f64,
    has_begun: bool,
    /// How much silence was passed over, seconds.
    skipped_s: f64,
    /// Why there is no pose, when last looked.
    no_pose: Option<PoseError>,
}

impl BagRobot {
    /// A recording from its begin to `until_s` seconds after it, or to its end.
    #[must_use]
    pub fn new(player: Player, summary: &Summary, until_s: Option<f64>) -> Self {
        let end_s = until_s.map_or(summary.duration_s(), |until_s| until_s.min(summary.duration_s()));
        Self {
            player,
            end_s,
            now_s: 0.0,
            task: None,
            pose: None,
            distance_m: 0.0,
            turned_rad: 0.0,
            has_begun: false,
            skipped_s: 0.0,
            no_pose: None,
        }
    }

    /// What plays the bag.
    #[must_use]
    pub const fn player(&self) -> &Player {
        &self.player
    }

    /// The time of the last observation.
    #[must_use]
    pub const fn now_s(&self) -> f64 {
        self.now_s
    }

    /// Where the robot was when that was last known.
    #[must_use]
    pub const fn pose(&self) -> Option<Pose> {
        self.pose
    }

    /// The way that was driven so far, metres.
    #[must_use]
    pub const fn distance_m(&self) -> f64 {
        self.distance_m
    }

    /// All turning so far, radians.
    #[must_use]
    pub const fn turned_rad(&self) -> f64 {
        self.turned_rad
    }

    /// The goals of the recording so far.
    #[must_use]
    pub const fn recorded_goals(&self) -> &RecordedGoals {
        self.player.goals()
    }

    /// Whether a map with the robot's place in it was ever known.
    #[must_use]
    pub const fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// Silence that was passed over so far, seconds.
    #[must_use]
    pub const fn skipped_s(&self) -> f64 {
        self.skipped_s
    }

    /// Why there was no pose, when that was looked for last.
    #[must_use]
    pub const fn no_pose(&self) -> Option<&PoseError> {
        self.no_pose.as_ref()
    }

    /// To the next tick, or to what wakes the node before.
    fn look(&mut self) -> Result<Observation, RobotError> {
        self.skip_silence(SILENCE_S)?;
        let now_s = self.player.play_to(self.now_s + TICK_S).map_err(|error| unreadable(&error))?.max(self.now_s);
        if now_s > self.end_s {
            return Err(RobotError::Ended);
        }
        self.now_s = now_s;
        let pose_in_map = self.player.pose(now_s);
        match &pose_in_map {
            Ok(pose) => self.follow(pose),
            Err(error) => self.no_pose = Some(error.clone()),
        }
        let scan = pose_in_map.as_ref().ok().and_then(|pose| self.player.scan(pose));
        let (map, navigation) = (self.player.map(), self.navigation());
        Ok(Observation { stamp_s: now_s, pose_in_map, map, scan, navigation })
    }

    /// Goes on to the tick before the next message, be it years away, when nothing comes for
    /// longer than some seconds.
    fn skip_silence(&mut self, longer_than_s: f64) -> Result<(), RobotError> {
        let next_s = self.player.next_time_s().map_err(|error| unreadable(&error))?;
        if let Some(next_s) = next_s.filter(|next_s| next_s - self.now_s > longer_than_s) {
            let before_s = (next_s.min(self.end_s) - TICK_S).max(self.now_s);
            self.skipped_s += before_s - self.now_s;
            self.now_s = before_s;
        }
        Ok(())
    }

    fn follow(&mut self, pose: &Pose) {
        if let Some(last) = self.pose {
            let step_m = pose.distance_to(last.position());
            // Tremor of a SLAM is no driving; a jump is none either, but a correction.
            if step_m < 1.0 {
                self.distance_m += step_m;
                self.turned_rad += shortest_angle(last.yaw, pose.yaw).abs();
            }
        }
        self.pose = Some(*pose);
    }

    /// How the recording did by the command under way.
    fn navigation(&mut self) -> Navigation {
        let (now_s, turned_rad) = (self.now_s, self.turned_rad);
        let Some(Task { id, aim, since_s }) = &mut self.task else {
            return Navigation { command: 0, state: NavigationState::Idle };
        };
        let (id, since_s) = (*id, *since_s);
        let state = match aim {
            Aim::Goal(goal) => {
                let goal = *goal;
                self.drive(&goal, since_s)
            }
            Aim::Turn { angle_rad, from_rad, seen } => {
                let is_done = turned_rad - *from_rad >= angle_rad.abs() - STANDS_RAD;
                let stands = now_s - seen.1 >= LAG_S && turned_rad - seen.0 < STANDS_RAD;
                if now_s - seen.1 >= LAG_S {
                    *seen = (turned_rad, now_s);
                }
                let is_sent_on = self.player.goals().in_force().is_some_and(|goal| goal.time_s > since_s);
                if is_done || stands || is_sent_on { NavigationState::Succeeded } else { NavigationState::Active }
            }
        };
        Navigation { command: id, state }
    }

    /// How the recording does by a goal of ours.
    fn drive(&self, goal: &Pose, since_s: f64) -> NavigationState {
        let goals = self.player.goals();
        let is_there = self.pose.is_some_and(|pose| pose.distance_to(goal.position()) <= ARRIVED_M);
        if let Some(recorded) = goals.near(goal, SAME_M, since_s - LAG_S) {
            return match &recorded.end {
                None if is_there && !goals.has_results() => NavigationState::Succeeded,
                None => NavigationState::Active,
                Some((_, GoalEnd::Reached)) => NavigationState::Succeeded,
                Some((_, GoalEnd::TakenAway)) => NavigationState::Preempted,
                Some((_, GoalEnd::GivenUp(why))) => NavigationState::Aborted(why.clone()),
            };
        }
        let waited_s = self.now_s - since_s;
        if waited_s <= LAG_S {
            // The recording may only be later than we.
            NavigationState::Active
        } else if is_there {
            NavigationState::Succeeded
        } else if waited_s > OWN_WAY_S {
            NavigationState::Preempted
        } else {
            NavigationState::Active
        }
    }
}

impl Robot for BagRobot {
    /// The first observation is that of the first map with the robot's place in it, as the
    /// node has it.
    fn observe(&mut self) -> Result<Observation, RobotError> {
        loop {
            let observation = self.look()?;
            self.has_begun |= observation.map.is_some() && observation.pose_in_map.is_ok();
            if self.has_begun {
                return Ok(observation);
            }
            self.skip_silence(0.0)?;
        }
    }

    fn command(&mut self, command: &Command) -> Result<(), RobotError> {
        let (id, aim) = match *command {
            Command::Hold => {
                self.task = None;
                return Ok(());
            }
            Command::Drive { id, goal_in_map } => (id, Aim::Goal(goal_in_map)),
            // A recording gets away as it did.
            Command::BackOff { id } => {
                (id, Aim::Turn { angle_rad: 0.0, from_rad: self.turned_rad, seen: (self.turned_rad, self.now_s) })
            }
            Command::Turn { id, angle_rad } => {
                let from_rad = self.turned_rad;
                (id, Aim::Turn { angle_rad, from_rad, seen: (from_rad, self.now_s) })
            }
        };
        if self.task.is_none_or(|task| task.id != id) {
            self.task = Some(Task { id, aim, since_s: self.now_s });
        }
        Ok(())
    }
}

fn unreadable(error: &PlayError) -> RobotError {
    RobotError::Disconnected(error.to_string())
}
