//! Does what is asked for at the desk: while an exploration is under way, and between two.

use super::action::{ExploreAction, Outcome};
use super::connect::Connected;
use super::desk::{Answer, Desk, Order, Pending, Request};
use super::rules::{Effect, Rule, Stage, rule};
use crate::explore::{Areas, End, EndReason, Explorer, ExplorerSettings, STOPPED};
use crate::ros::Node;
use crate::ros::actionlib::is_meant;
use crate::ros::display::status_sentence;
use crate::ros::log::Log;
use crate::ros::msg::actionlib_msgs::GoalID;
use crate::ros::msg::frontier_explorer::{ExplorationStatus, ExploreResult};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// What the node does next.
#[derive(Clone, Debug)]
pub enum Next {
    /// It explores.
    Explore,
    /// It explores as a mission script ordered.
    Order(Order),
    /// It drives back to the start.
    GoHome,
}

/// What a request is about.
pub struct Matter<'a> {
    /// What the node is about.
    pub stage: Stage,
    /// The exploration that is under way, or was last.
    pub explorer: Option<&'a mut Explorer>,
    /// Its time, seconds.
    pub now_s: f64,
    /// Tells what it sees, chose and rejected.
    pub explain: &'a dyn Fn() -> String,
}

/// The one who does it.
pub struct Operator {
    log: Log,
    desk: Desk,
    paused: Arc<AtomicBool>,
    action: ExploreAction,
    next: Option<Next>,
    /// Why the exploration under way shall end.
    stop: Option<String>,
    /// The order that is carried out.
    order: Option<Order>,
    order_is_over: bool,
    /// Answered when the exploration has ended.
    at_the_end: Vec<Pending>,
    /// Answered when the robot has obeyed.
    obeyed: Vec<(Pending, Answer)>,
}

impl Operator {
    /// One who has nothing to do yet.
    pub fn new(node: &Node, desk: Desk, connected: &Connected, action: ExploreAction) -> Self {
        Self {
            log: node.log().clone(),
            desk,
            paused: Arc::clone(&connected.paused),
            action,
            next: None,
            stop: None,
            order: None,
            order_is_over: false,
            at_the_end: Vec::new(),
            obeyed: Vec::new(),
        }
    }

    /// An exploration is to begin without being asked for.
    pub fn begin(&mut self) {
        self.next = Some(Next::Explore);
    }

    /// Why the exploration under way shall end, if it shall.
    pub fn stop_requested(&self) -> Option<String> {
        self.stop.clone()
    }

    /// The order that is carried out, if one is.
    pub const fn order(&self) -> Option<&Order> {
        self.order.as_ref()
    }

    /// The areas of the exploration that begins now: an order has its own region.
    pub fn areas(&self, current: Areas) -> Areas {
        match &self.order {
            Some(order) => Areas { region: order.region.clone(), ..current },
            None => current,
        }
    }

    /// The settings of an exploration that is under way or begins now: an order has its own limit
    /// and end.
    pub fn wanted(&self, settings: &ExplorerSettings) -> ExplorerSettings {
        let mut wanted = settings.clone();
        if let Some(order) = &self.order {
            wanted.patience.time_limit_s = order.time_limit_s.or(wanted.patience.time_limit_s);
            wanted.return_to_start |= order.return_home;
        }
        wanted
    }

    /// Whether the exploration rests.
    pub fn is_paused(&self) -> bool {
        self.paused.load(Ordering::Relaxed)
    }

    /// Whether there is something to do next.
    pub const fn has_work(&self) -> bool {
        self.next.is_some()
    }

    /// Waits until there is something to do, and has what is asked for served meanwhile; `None`
    /// when the node is told to stop.
    pub fn wait_for_work(&mut self, node: &Node, mut serve: impl FnMut(&mut Self)) -> Option<Next> {
        node.wait_until(Duration::MAX, || {
            serve(self);
            self.has_work()
        });
        let next = self.next.take()?;
        if let Next::Order(order) = &next {
            self.action.accept(order);
            (self.order, self.order_is_over) = (Some(order.clone()), false);
        }
        Some(next)
    }

    /// Does what is asked for.
    pub fn serve(&mut self, matter: &mut Matter<'_>) {
        for (pending, answer) in std::mem::take(&mut self.obeyed) {
            self.answer(pending, answer);
        }
        for pending in self.desk.take() {
            match pending.request.clone() {
                Request::Control(control) => {
                    let rule = rule(control, matter.stage, self.is_paused());
                    self.control(pending, rule, matter);
                }
                Request::Order(order) => self.take_order(order, matter),
                Request::Cancel(message) => self.cancel(&message),
            }
        }
    }

    /// The exploration has ended: whoever waited for that is told.
    pub fn ended(&mut self, end: &End, status: &ExplorationStatus, saved: Result<Option<String>, String>) {
        self.stop = None;
        let map = match &saved {
            Ok(Some(file)) => format!("; the map is saved as {file}"),
            Ok(None) => String::new(),
            Err(why) => format!("; {why}"),
        };
        for pending in self.at_the_end.drain(..) {
            let text = format!("{}: {} ({}){map}", end.reason.name(), end.message, status_sentence(status));
            pending.answer(Answer { success: saved.is_ok(), message: text });
        }
        let Some(order) = self.order.take() else { return };
        let in_time = order.time_limit_s.is_some() && end.reason == EndReason::TimeLimit;
        let success = (end.reason.is_success() || in_time) && saved.is_ok();
        let outcome = match (success, self.order_is_over) {
            (_, true) => Outcome::Preempted,
            (true, false) => Outcome::Succeeded,
            (false, false) => Outcome::Aborted,
        };
        let message = match &saved {
            Err(why) => format!("{}; {why}", end.message),
            Ok(_) => end.message.clone(),
        };
        let result = ExploreResult {
            success,
            end_reason: end.reason.name().to_owned(),
            message,
            map_file: saved.ok().flatten().unwrap_or_default(),
            totals: status.clone(),
        };
        self.action.finish(outcome, result);
    }

    fn control(&mut self, pending: Pending, rule: Rule, matter: &mut Matter<'_>) {
        let Rule { success, effect, says } = rule;
        let is_paused = |paused| self.paused.store(paused, Ordering::Relaxed);
        let mut answer = Answer { success, message: says.to_owned() };
        match effect {
            Effect::None => {}
            Effect::Begin => {
                is_paused(false);
                self.replace(Next::Explore, matter.stage, "another exploration was started");
            }
            Effect::Pause => {
                is_paused(true);
                return self.obeyed.push((pending, answer));
            }
            Effect::GoOn => is_paused(false),
            Effect::End => {
                is_paused(false);
                self.stop = Some(STOPPED.to_owned());
                return self.at_the_end.push(pending);
            }
            Effect::DriveHome => answer = self.drive_home(matter, says),
            Effect::Forget => {
                let forgotten = matter.explorer.as_mut().map_or(0, |explorer| explorer.clear_blacklist());
                answer.message = format!("{forgotten} places that were left alone may be tried again");
            }
            Effect::Explain => answer.message = (matter.explain)(),
        }
        self.answer(pending, answer);
    }

    /// Answers; who asked by a topic hears it in the log.
    fn answer(&self, pending: Pending, answer: Answer) {
        if !pending.is_asked() {
            self.log.info(&answer.message);
        }
        pending.answer(answer);
    }

    fn drive_home(&mut self, matter: &mut Matter<'_>, says: &str) -> Answer {
        let home = match &mut matter.explorer {
            Some(explorer) if matter.stage.is_under_way() => {
                explorer.return_home(matter.now_s, "sent home by the user")
            }
            Some(explorer) => explorer.start_pose(),
            None => None,
        };
        let Some(home) = home else { return Answer::no("no start is known") };
        self.paused.store(false, Ordering::Relaxed);
        if !matter.stage.is_under_way() {
            self.next = Some(Next::GoHome);
        }
        Answer::yes(format!("{says} at ({:.2}, {:.2}) m", home.x, home.y))
    }

    fn take_order(&mut self, order: Order, matter: &Matter<'_>) {
        if let Some(Next::Order(earlier)) = self.next.take() {
            self.action.recall(earlier, "another goal has taken its place");
        }
        self.order_is_over |= self.order.is_some();
        self.replace(Next::Order(order), matter.stage, "a goal of the action takes its place");
    }

    /// Does something else next, after the end of what is under way.
    fn replace(&mut self, next: Next, stage: Stage, why: &str) {
        self.paused.store(false, Ordering::Relaxed);
        self.next = Some(next);
        if stage.is_under_way() {
            self.stop = Some(why.to_owned());
        }
    }

    fn cancel(&mut self, message: &GoalID) {
        if let Some(Next::Order(order)) = self.next.take_if(|next| match next {
            Next::Order(order) => is_meant(message, &order.id),
            _ => false,
        }) {
            self.action.recall(order, "cancelled");
        }
        if self.order.as_ref().is_some_and(|order| is_meant(message, &order.id)) {
            self.log.info("the goal of the action is cancelled");
            self.paused.store(false, Ordering::Relaxed);
            self.order_is_over = true;
            self.stop = Some("the goal of the action was cancelled".to_owned());
        }
    }
}
