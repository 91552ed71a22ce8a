//! Where requests wait until the one thread that explores takes them, and their answers.

use crate::geometry::Polygon;
use crate::ros::bell::Bell;
use crate::ros::msg::actionlib_msgs::GoalID;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// What an operator may ask for by a service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Control {
    /// Explore.
    Start,
    /// Rest.
    Pause,
    /// Go on.
    Resume,
    /// End the exploration.
    Stop,
    /// End it and drive back to the start.
    ReturnHome,
    /// Forget what has failed.
    ClearBlacklist,
    /// Tell what is seen, chosen and rejected, and why.
    Explain,
}

/// An exploration as a mission script orders it.
#[derive(Clone, Debug)]
pub struct Order {
    /// The action's goal.
    pub id: GoalID,
    /// Where to explore; everywhere without.
    pub region: Option<Polygon>,
    /// How long, seconds.
    pub time_limit_s: Option<f64>,
    /// Whether to drive back to the start.
    pub return_home: bool,
    /// Where to save the map; where `~map_file` says when empty.
    pub map_file: String,
}

/// What was asked for.
#[derive(Clone, Debug)]
pub enum Request {
    /// By a service or a topic.
    Control(Control),
    /// By a goal of the action.
    Order(Order),
    /// A goal of the action, or some, shall end.
    Cancel(GoalID),
}

/// What was done about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Whether what was asked for is so now.
    pub success: bool,
    /// A sentence.
    pub message: String,
}

impl Answer {
    /// It is as was asked for.
    pub fn yes(message: impl Into<String>) -> Self {
        Self { success: true, message: message.into() }
    }

    /// It is not.
    pub fn no(message: impl Into<String>) -> Self {
        Self { success: false, message: message.into() }
    }
}

/// A request that waits for its answer.
pub struct Pending {
    /// What was asked for.
    pub request: Request,
    reply: Option<Sender<Answer>>,
    number: u64,
}

impl Pending {
    /// Whether somebody waits for the answer.
    pub const fn is_asked(&self) -> bool {
        self.reply.is_some()
    }

    /// Answers it; who asked may have gone.
    pub fn answer(self, answer: Answer) {
        if let Some(reply) = self.reply {
            let _ = reply.send(answer);
        }
    }
}

#[derive(Default)]
struct Queue {
    waiting: Vec<Pending>,
    last: u64,
}

/// The desk; clones are the same.
#[derive(Clone)]
pub struct Desk {
    queue: Arc<Mutex<Queue>>,
    bell: Arc<Bell>,
}

impl Desk {
    /// An empty desk, which rings when something is asked for.
    pub fn new(bell: &Arc<Bell>) -> Self {
        Self { queue: Arc::default(), bell: Arc::clone(bell) }
    }

    /// Hands a request in and does not wait for the answer.
    pub fn hand_in(&self, request: Request) {
        self.push(request, None);
    }

    /// Hands a request in and waits for the answer. One that nobody has taken up by then is
    /// taken back.
    pub fn ask(&self, request: Request, limit: Duration) -> Answer {
        let (sender, receiver): (_, Receiver<Answer>) = channel();
        let number = self.push(request, Some(sender));
        if let Ok(answer) = receiver.recv_timeout(limit) {
            return answer;
        }
        let mut queue = self.lock();
        let before = queue.waiting.len();
        queue.waiting.retain(|pending| pending.number != number);
        if queue.waiting.len() < before {
            Answer::no(format!("the node is busy and has not looked at it for {} s: nothing was done", limit.as_secs()))
        } else {
            Answer::yes(format!("it is being done, and takes longer than {} s", limit.as_secs()))
        }
    }

    /// Takes all requests, the oldest first.
    pub fn take(&self) -> Vec<Pending> {
        std::mem::take(&mut self.lock().waiting)
    }

    fn push(&self, request: Request, reply: Option<Sender<Answer>>) -> u64 {
        let mut queue = self.lock();
        queue.last += 1;
        let number = queue.last;
        queue.waiting.push(Pending { request, reply, number });
        drop(queue);
        self.bell.ring();
        number
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_finds_who_asked() {
        let desk = Desk::new(&Arc::default());
        let asks = {
            let desk = desk.clone();
            std::thread::spawn(move || desk.ask(Request::Control(Control::Pause), Duration::from_secs(20)))
        };
        let pending = loop {
            if let Some(pending) = desk.take().pop() {
                break pending;
            }
        };
        assert!(matches!(pending.request, Request::Control(Control::Pause)));
        pending.answer(Answer::yes("paused"));
        assert_eq!(asks.join().unwrap(), Answer::yes("paused"));
    }

    #[test]
    fn what_nobody_took_up_is_not_done_later() {
        let desk = Desk::new(&Arc::default());
        let answer = desk.ask(Request::Control(Control::Stop), Duration::from_millis(10));
        assert!(!answer.success && answer.message.contains("nothing was done"), "{answer:?}");
        assert!(desk.take().is_empty());
    }
}
