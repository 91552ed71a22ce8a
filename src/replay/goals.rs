//! The goals that a recording was sent to, and what became of them.

use crate::geometry::Pose;
use serde::Serialize;

/// Goals this near to the robot are for turning, not for driving, metres.
const TURN_WITHIN_M: f64 = 0.1;

/// What became of a goal.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum GoalEnd {
    /// The robot got there.
    Reached,
    /// Another goal took its place, or it was cancelled.
    TakenAway,
    /// The server gave it up, with what it said.
    GivenUp(String),
}

/// A goal that the recording was sent to.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordedGoal {
    /// When, seconds since the bag's begin.
    pub time_s: f64,
    /// Where to, in the map frame.
    pub goal_in_map: Pose,
    /// Where the robot stands already: it is told to turn.
    pub is_turn: bool,
    /// When it ended, seconds since the bag's begin, and how.
    pub end: Option<(f64, GoalEnd)>,
    #[serde(skip)]
    id: String,
}

impl RecordedGoal {
    /// Whether the recording was on its way there at some time from `from_s` to `to_s`.
    #[must_use]
    pub fn is_in_force(&self, from_s: f64, to_s: f64) -> bool {
        self.time_s <= to_s && self.end.as_ref().is_none_or(|(end_s, _)| *end_s >= from_s)
    }
}

/// All of them so far.
#[derive(Clone, Debug, Default)]
pub struct RecordedGoals {
    goals: Vec<RecordedGoal>,
    /// Whether the recording holds results: else only arriving ends a goal.
    has_results: bool,
}

impl RecordedGoals {
    /// None yet, of a recording that holds their results, or that does not.
    #[must_use]
    pub const fn new(has_results: bool) -> Self {
        Self { goals: Vec::new(), has_results }
    }

    /// The recording was sent to a goal, which takes the place of the one before.
    pub(super) fn begin(&mut self, time_s: f64, id: String, goal_in_map: Pose, robot_in_map: Option<Pose>) {
        if let Some(last) = self.goals.last_mut() {
            last.end.get_or_insert((time_s, GoalEnd::TakenAway));
        }
        let is_turn = robot_in_map.is_some_and(|robot| robot.distance_to(goal_in_map.position()) <= TURN_WITHIN_M);
        self.goals.push(RecordedGoal { time_s, goal_in_map, is_turn, end: None, id });
    }

    /// The server told what became of a goal, in the numbers of `actionlib_msgs/GoalStatus`.
    pub(super) fn end(&mut self, time_s: f64, id: &str, status: u8, text: String) {
        if let Some(goal) = self.goals.iter_mut().rev().find(|goal| goal.id == id) {
            let how = match status {
                3 => GoalEnd::Reached,
                2 | 8 => GoalEnd::TakenAway,
                _ => GoalEnd::GivenUp(text),
            };
            // A goal that was replaced first ended then.
            goal.end.get_or_insert((time_s, how));
        }
    }

    /// The goals in the order of their times.
    #[must_use]
    pub fn all(&self) -> &[RecordedGoal] {
        &self.goals
    }

    /// Whether results tell how goals ended.
    #[must_use]
    pub const fn has_results(&self) -> bool {
        self.has_results
    }

    /// The goal that the recording is on its way to.
    #[must_use]
    pub fn in_force(&self) -> Option<&RecordedGoal> {
        self.goals.last().filter(|goal| goal.end.is_none() && !goal.is_turn)
    }

    /// The newest goal within a distance of a place that was in force from a time on.
    #[must_use]
    pub fn near(&self, place: &Pose, within_m: f64, from_s: f64) -> Option<&RecordedGoal> {
        let is_it = |goal: &&RecordedGoal| {
            !goal.is_turn
                && goal.is_in_force(from_s, f64::INFINITY)
                && goal.goal_in_map.distance_to(place.position()) <= within_m
        };
        self.goals.iter().rev().find(is_it)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_goal_ends_by_its_result_or_by_the_next_one() {
        let mut goals = RecordedGoals::new(true);
        let at = |x| Pose::new(x, 0.0, 0.0);
        goals.begin(1.0, "a".into(), at(1.0), Some(at(0.0)));
        assert_eq!(goals.in_force().unwrap().goal_in_map, at(1.0));
        goals.end(4.0, "a", 3, String::new());
        assert_eq!(goals.all()[0].end, Some((4.0, GoalEnd::Reached)));
        assert!(goals.in_force().is_none());
        goals.begin(5.0, "b".into(), at(2.0), Some(at(1.0)));
        goals.begin(6.0, "c".into(), at(3.0), Some(at(1.5)));
        goals.end(6.1, "b", 2, String::new());
        assert_eq!(goals.all()[1].end, Some((6.0, GoalEnd::TakenAway)));
        assert_eq!(goals.near(&at(2.1), 0.5, 5.9).unwrap().time_s, 5.0);
        assert!(goals.near(&at(2.1), 0.5, 6.5).is_none() && goals.near(&at(1.0), 0.5, 4.5).is_none());
        goals.begin(8.0, "d".into(), at(3.0), Some(at(2.95)));
        assert!(goals.all()[3].is_turn && goals.in_force().is_none());
        goals.end(9.0, "d", 4, "stuck".into());
        assert_eq!(goals.all()[3].end, Some((9.0, GoalEnd::GivenUp("stuck".into()))));
    }
}
