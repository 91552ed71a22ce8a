//! What became of a goal, from what an action server says of it: the client's side of
//! actionlib's protocol. Pure; times are seconds of real time.
//!
//! Status and result come on topics of their own, so in either order: the result
//! decides, and a final status decides where no result follows. A goal is lost when the
//! server never lists it, lists it no more, or falls silent. After a loss the server is in
//! doubt until it has taken a goal up: one that ignores goals is as good as none.

use crate::robot::NavigationState;

/// A server that has not listed a goal by then never got it, seconds.
const ACCEPT_WITHIN_S: f64 = 3.0;
/// A server is gone after this time without a status, seconds.
const STATUS_WITHIN_S: f64 = 3.0;
/// A result follows its final status, or the goal's vanishing, within this time, seconds.
const RESULT_WITHIN_S: f64 = 1.0;

/// A goal's state in the words of `actionlib_msgs/GoalStatus`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GoalStatus {
    /// Not taken up yet.
    Pending,
    /// Under way, or being cancelled.
    Active,
    /// Cancelled, by us or by another goal.
    Preempted,
    /// Reached.
    Succeeded,
    /// Given up by the server.
    Aborted,
    /// Turned away by the server.
    Rejected,
}

impl GoalStatus {
    /// From the number of the message; unknown ones count as under way.
    #[must_use]
    pub const fn from_number(number: u8) -> Self {
        match number {
            0 | 7 => Self::Pending,
            2 | 8 => Self::Preempted,
            3 => Self::Succeeded,
            4 | 9 => Self::Aborted,
            5 => Self::Rejected,
            _ => Self::Active,
        }
    }

    /// Whether the goal is over.
    #[must_use]
    pub const fn is_final(self) -> bool {
        !matches!(self, Self::Pending | Self::Active)
    }
}

#[derive(Clone, Debug)]
struct Goal {
    id: String,
    sent_s: f64,
    /// When the server last listed it.
    listed_s: Option<f64>,
    /// Its final status, and when it came, while the result has not.
    closed: Option<(GoalStatus, String, f64)>,
    outcome: Option<NavigationState>,
}

/// Follows one goal at a time.
#[derive(Clone, Debug, Default)]
pub struct GoalTracker {
    goal: Option<Goal>,
    last_status_s: Option<f64>,
    /// Why the last goal was lost, until the server takes one up.
    doubt: Option<String>,
}

impl GoalTracker {
    /// Follows a goal from now on. To be called before the goal is sent, or the answer
    /// may be there first.
    pub fn begin(&mut self, id: String, now_s: f64) {
        self.goal = Some(Goal { id, sent_s: now_s, listed_s: None, closed: None, outcome: None });
    }

    /// Follows no goal any more; returns the id of one that was under way.
    pub fn forget(&mut self) -> Option<String> {
        self.goal.take().filter(|goal| goal.outcome.is_none()).map(|goal| goal.id)
    }

    /// The server told what it is about: goals by id, with their status and text.
    pub fn on_status<'a>(&mut self, goals: impl IntoIterator<Item = (&'a str, GoalStatus, &'a str)>, now_s: f64) {
        self.last_status_s = Some(now_s);
        let Some(goal) = &mut self.goal else { return };
        for (id, status, text) in goals {
            if id == goal.id {
                goal.listed_s = Some(now_s);
                self.doubt = None;
                if status.is_final() && goal.closed.is_none() {
                    goal.closed = Some((status, text.to_owned(), now_s));
                }
            }
        }
    }

    /// The server told the result of a goal; those of others are none of ours.
    pub fn on_result(&mut self, id: &str, status: GoalStatus, text: &str) {
        if let Some(goal) = self.goal.as_mut().filter(|goal| goal.id == id)
            && goal.outcome.is_none()
            && status.is_final()
        {
            goal.outcome = Some(outcome(status, text));
            self.doubt = None;
        }
    }

    /// No goal could be sent, for this reason.
    pub fn on_unready(&mut self, why: &str) {
        self.doubt = Some(why.to_owned());
    }

    /// Whether the goal was lost, so that it can be sent again.
    pub fn is_lost(&mut self, now_s: f64) -> bool {
        self.update(now_s);
        let outcome = self.goal.as_ref().and_then(|goal| goal.outcome.as_ref());
        matches!(outcome, Some(NavigationState::Unavailable(_)))
    }

    /// Seconds since the last status.
    #[must_use]
    pub fn status_age_s(&self, now_s: f64) -> Option<f64> {
        self.last_status_s.map(|last_s| now_s - last_s)
    }

    /// How the goal is doing now. One that was sent after a loss is not under way before
    /// the server has taken it up.
    pub fn state(&mut self, now_s: f64) -> NavigationState {
        self.update(now_s);
        match (&self.goal, &self.doubt) {
            (None, _) => NavigationState::Idle,
            (Some(Goal { outcome: Some(outcome), .. }), _) => outcome.clone(),
            (Some(_), Some(why)) => NavigationState::Unavailable(why.clone()),
            (Some(_), None) => NavigationState::Active,
        }
    }

    /// Whether the server has shown that it knows the goal.
    pub const fn is_taken_up(&self) -> bool {
        match &self.goal {
            Some(goal) => goal.listed_s.is_some() || goal.closed.is_some() || goal.outcome.is_some(),
            None => false,
        }
    }

    /// Looks whether the result is overdue.
    fn update(&mut self, now_s: f64) {
        let Some(goal) = self.goal.as_mut().filter(|goal| goal.outcome.is_none()) else { return };
        goal.outcome = overdue(goal, self.last_status_s, now_s);
        if let Some(NavigationState::Unavailable(why)) = &goal.outcome {
            self.doubt = Some(why.clone());
        }
    }
}

/// The outcome of a goal for which no result came in time.
fn overdue(goal: &Goal, last_status_s: Option<f64>, now_s: f64) -> Option<NavigationState> {
    if let Some((status, text, since_s)) = &goal.closed {
        return (now_s - since_s >= RESULT_WITHIN_S).then(|| outcome(*status, text));
    }
    let silent_s = now_s - last_status_s.unwrap_or(goal.sent_s).max(goal.sent_s);
    if silent_s >= STATUS_WITHIN_S {
        return Some(lost(format!("move_base has said nothing for {silent_s:.0} s")));
    }
    match goal.listed_s {
        None if now_s - goal.sent_s >= ACCEPT_WITHIN_S => Some(lost("move_base never took the goal up".to_owned())),
        Some(listed_s) if last_status_s.is_some_and(|last_s| last_s - listed_s >= RESULT_WITHIN_S) => {
            Some(lost("move_base does not know the goal any more".to_owned()))
        }
        _ => None,
    }
}

/// A goal that was lost is no fault of its place: it can be sent again.
const fn lost(why: String) -> NavigationState {
    NavigationState::Unavailable(why)
}

fn outcome(status: GoalStatus, text: &str) -> NavigationState {
    match status {
        GoalStatus::Succeeded => NavigationState::Succeeded,
        GoalStatus::Preempted => NavigationState::Preempted,
        GoalStatus::Rejected if text.is_empty() => NavigationState::Aborted("move_base rejected the goal".to_owned()),
        _ if text.is_empty() => NavigationState::Aborted("move_base gave the goal up".to_owned()),
        _ => NavigationState::Aborted(text.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use NavigationState::{Active, Idle, Preempted, Succeeded};

    fn tracker() -> GoalTracker {
        let mut tracker = GoalTracker::default();
        tracker.on_status([], 9.9);
        tracker.begin("ours".to_owned(), 10.0);
        tracker
    }

    fn listed(tracker: &mut GoalTracker, status: GoalStatus, now_s: f64) {
        tracker.on_status([("theirs", GoalStatus::Aborted, "no"), ("ours", status, "text")], now_s);
    }

    #[test]
    fn status_and_result_may_come_in_either_order() {
        let mut first = tracker();
        listed(&mut first, GoalStatus::Active, 10.2);
        assert_eq!(first.state(10.3), Active);
        first.on_result("ours", GoalStatus::Succeeded, "");
        assert_eq!(first.state(10.4), Succeeded);
        listed(&mut first, GoalStatus::Aborted, 10.5);
        assert_eq!(first.state(30.0), Succeeded, "the result decides, and stays");

        let mut second = tracker();
        listed(&mut second, GoalStatus::Aborted, 10.2);
        assert_eq!(second.state(10.3), Active, "the result may still come");
        second.on_result("ours", GoalStatus::Succeeded, "");
        assert_eq!(second.state(10.4), Succeeded);
    }

    #[test]
    fn a_final_status_serves_where_no_result_follows() {
        let mut tracker = tracker();
        listed(&mut tracker, GoalStatus::Aborted, 10.2);
        assert_eq!(tracker.state(11.3), NavigationState::Aborted("text".to_owned()));
    }

    #[test]
    fn results_of_others_are_none_of_ours() {
        let mut tracker = tracker();
        tracker.on_result("theirs", GoalStatus::Aborted, "");
        listed(&mut tracker, GoalStatus::Active, 10.2);
        assert_eq!(tracker.state(10.3), Active);
        tracker.on_result("ours", GoalStatus::Preempted, "");
        assert_eq!(tracker.state(10.3), Preempted);
    }

    #[test]
    fn goals_get_lost_in_three_ways() {
        let mut unheard = tracker();
        unheard.on_status([], 12.9);
        assert_eq!(unheard.state(12.9), Active);
        unheard.on_status([], 13.1);
        assert_eq!(unheard.state(13.1), lost("move_base never took the goal up".to_owned()));

        let mut silent = tracker();
        listed(&mut silent, GoalStatus::Active, 10.5);
        assert_eq!(silent.state(13.4), Active);
        assert_eq!(silent.state(13.6), lost("move_base has said nothing for 3 s".to_owned()));

        let mut dropped = tracker();
        listed(&mut dropped, GoalStatus::Active, 10.5);
        dropped.on_status([], 10.7);
        assert_eq!(dropped.state(10.7), Active);
        dropped.on_status([], 11.6);
        assert_eq!(dropped.state(11.6), lost("move_base does not know the goal any more".to_owned()));
    }

    #[test]
    fn a_server_that_ignores_goals_stays_unavailable_until_it_takes_one_up() {
        let ignored = lost("move_base never took the goal up".to_owned());
        let mut tracker = tracker();
        tracker.on_status([], 13.5);
        assert!(tracker.is_lost(13.5));
        for i in 0..20 {
            let sent_s = 14.0 + 4.0 * f64::from(i);
            tracker.begin("ours".to_owned(), sent_s);
            for after_s in [0.1, 1.5, 3.5] {
                tracker.on_status([], sent_s + after_s);
                assert_eq!(tracker.state(sent_s + after_s), ignored, "{sent_s} + {after_s}");
                assert_eq!(tracker.is_lost(sent_s + after_s), after_s > 3.0, "a goal has its time");
            }
        }
        tracker.begin("ours".to_owned(), 100.0);
        assert_eq!(tracker.state(100.1), ignored);
        listed(&mut tracker, GoalStatus::Pending, 100.2);
        assert_eq!(tracker.state(100.3), Active);
        tracker.on_unready("no server");
        assert_eq!(tracker.state(100.4), lost("no server".to_owned()));
    }

    #[test]
    fn a_goal_that_was_let_go_is_named_once() {
        let mut under_way = tracker();
        assert_eq!(under_way.forget(), Some("ours".to_owned()));
        assert_eq!((under_way.forget(), under_way.state(20.0)), (None, Idle));
        let mut over = tracker();
        over.on_result("ours", GoalStatus::Succeeded, "");
        assert_eq!(over.forget(), None);
    }
}
