//! The server's side of actionlib's protocol: which goals there are and how they are
//! doing. One goal is under way at a time, as in a SimpleActionServer; a new one takes
//! its place. Pure; times are seconds of real time.

use crate::ros::msg::actionlib_msgs::{GoalID, GoalStatus};

/// A goal that has ended stays in the list for this long, seconds, as in actionlib.
const KEEP_S: f64 = 5.0;

/// A goal and how it is doing.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its name.
    pub id: GoalID,
    /// The number of `actionlib_msgs/GoalStatus`.
    pub status: u8,
    /// Why it ended.
    pub text: String,
    ended_s: Option<f64>,
}

/// All goals of the last seconds.
#[derive(Clone, Debug, Default)]
pub struct GoalBook {
    entries: Vec<Entry>,
}

impl GoalBook {
    /// Takes a goal up. Returns the goal whose place it takes, if one was under way.
    pub fn accept(&mut self, id: GoalID, now_s: f64) -> Option<Entry> {
        let replaced = self.end(GoalStatus::PREEMPTED, "another goal has taken its place", now_s);
        self.entries.push(Entry { id, status: GoalStatus::ACTIVE, text: String::new(), ended_s: None });
        replaced
    }

    /// Turns a goal away, or takes note of one that ended before it was taken up.
    pub fn turn_away(&mut self, id: GoalID, status: u8, text: &str, now_s: f64) -> Entry {
        let entry = Entry { id, status, text: text.to_owned(), ended_s: Some(now_s) };
        self.entries.push(entry.clone());
        entry
    }

    /// Cancels what a message asks for. Returns the goal under way if it was among them.
    pub fn cancel(&mut self, message: &GoalID, now_s: f64) -> Option<Entry> {
        if is_meant(message, &self.active()?.id) { self.end(GoalStatus::PREEMPTED, "cancelled", now_s) } else { None }
    }

    /// Ends the goal under way, if there is one, and returns it.
    pub fn end(&mut self, status: u8, text: &str, now_s: f64) -> Option<Entry> {
        let active = self.entries.iter_mut().find(|entry| entry.ended_s.is_none())?;
        active.status = status;
        text.clone_into(&mut active.text);
        active.ended_s = Some(now_s);
        Some(active.clone())
    }

    /// The goal under way.
    #[must_use]
    pub fn active(&self) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.ended_s.is_none())
    }

    /// What `status` tells; goals that ended long ago are dropped.
    pub fn list(&mut self, now_s: f64) -> Vec<GoalStatus> {
        self.entries.retain(|entry| entry.ended_s.is_none_or(|ended_s| now_s - ended_s < KEEP_S));
        self.entries.iter().map(Entry::message).collect()
    }
}

/// Whether a cancellation means a goal: by its id, as one up to a time, or as all are meant.
#[must_use]
pub fn is_meant(message: &GoalID, goal: &GoalID) -> bool {
    let by_time = message.stamp.nanos() > 0;
    let all = message.id.is_empty() && !by_time;
    let named = !message.id.is_empty() && goal.id == message.id;
    let earlier = by_time && goal.stamp.nanos() <= message.stamp.nanos();
    all || named || earlier
}

impl Entry {
    /// The goal's status as a message.
    #[must_use]
    pub fn message(&self) -> GoalStatus {
        GoalStatus { goal_id: self.id.clone(), status: self.status, text: self.text.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn id(name: &str, sec: u32) -> GoalID {
        GoalID { stamp: rosrust::Time { sec, nsec: 0 }, id: name.to_owned() }
    }

    #[test]
    fn a_new_goal_takes_the_place_of_the_old_one() {
        let mut book = GoalBook::default();
        assert_eq!(book.accept(id("a", 1), 0.0), None);
        let replaced = book.accept(id("b", 2), 1.0).unwrap();
        assert_eq!((replaced.id.id.as_str(), replaced.status), ("a", GoalStatus::PREEMPTED));
        assert_eq!(book.active().unwrap().id.id, "b");
        assert_eq!(book.list(2.0).len(), 2);
        assert_eq!(book.list(6.5).len(), 1, "the old one has been told long enough");
    }

    #[test]
    fn cancellations_name_a_goal_a_time_or_all() {
        let begin = || {
            let mut book = GoalBook::default();
            book.accept(id("a", 10), 0.0);
            book
        };
        assert!(begin().cancel(&id("a", 0), 1.0).is_some());
        assert!(begin().cancel(&id("b", 0), 1.0).is_none());
        assert!(begin().cancel(&id("", 0), 1.0).is_some());
        assert!(begin().cancel(&id("", 10), 1.0).is_some());
        assert!(begin().cancel(&id("", 9), 1.0).is_none());
        assert!(GoalBook::default().cancel(&id("", 0), 1.0).is_none());
    }
}
