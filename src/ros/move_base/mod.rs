//! move_base, or whatever serves its action: goals go out, what became of them comes
//! back.

mod planner;
mod stranger;

pub use planner::AskingPlanner;
pub use stranger::Stranger;

use super::actionlib::{GoalStatus, GoalTracker};
use super::bell::Bell;
use super::call::call;
use super::convert;
use super::directory::list;
use super::feed::Feed;
use super::log::Level;
use super::msg::actionlib_msgs::{GoalID, GoalStatusArray};
use super::msg::move_base_msgs::{MoveBaseActionFeedback, MoveBaseActionGoal, MoveBaseActionResult, MoveBaseGoal};
use super::msg::std_srvs;
use super::node::{Node, NodeError};
use crate::geometry::Pose;
use crate::robot::NavigationState;
use rosrust::Publisher;
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use stranger::StrangerWatch;

/// A server is ready while its last status is younger than this, seconds.
const READY_WITHIN_S: f64 = 2.0;
/// Status comes at 5 Hz or more, so a connection that is silent for longer is broken.
const SILENCE: Duration = Duration::from_secs(5);
/// Result and feedback come only now and then: so often it is looked whether the server is met.
const LOOK: Duration = Duration::from_secs(30);
/// How old an answer of the master may be when it is asked for action servers.
const LISTING_AGE: Duration = Duration::from_secs(5);
/// How long a service of move_base may take.
const SERVICE_LIMIT: Duration = Duration::from_secs(3);

/// The client of one action server.
pub struct MoveBase {
    node: Node,
    server: String,
    tracker: Arc<Mutex<GoalTracker>>,
    strangers: Arc<Mutex<StrangerWatch>>,
    goals: Publisher<MoveBaseActionGoal>,
    cancels: Publisher<GoalID>,
    status: Feed,
    result: Feed,
    feedback: Feed,
    count: u64,
}

impl MoveBase {
    /// Connects to the server of that name in the node's namespace; rings the bell for
    /// results.
    ///
    /// # Errors
    /// [`NodeError`] when its topics cannot be offered.
    pub fn connect(node: &Node, server: &str, bell: &Arc<Bell>) -> Result<Self, NodeError> {
        let tracker = Arc::<Mutex<GoalTracker>>::default();
        let topic = |name: &str| format!("{server}/{name}");
        let strangers = Arc::<Mutex<StrangerWatch>>::default();
        let (theirs, others, owner) = (Arc::clone(&tracker), Arc::clone(&strangers), node.clone());
        let ours = format!("{}-", node.name());
        let status = Feed::listen(node, &topic("status"), 10, SILENCE, move |message: GoalStatusArray, _| {
            let goals = message
                .status_list
                .iter()
                .map(|one| (one.goal_id.id.as_str(), GoalStatus::from_number(one.status), one.text.as_str()));
            let under_way = goals.clone().filter(|(id, status, _)| !(status.is_final() || id.starts_with(&ours)));
            lock(&others).on_status(under_way.map(|(id, ..)| id));
            lock(&theirs).on_status(goals, owner.wall_s());
        });
        let (theirs, bell) = (Arc::clone(&tracker), Arc::clone(bell));
        let result = Feed::listen_seldom(node, &topic("result"), 10, LOOK, move |message: MoveBaseActionResult, _| {
            let status = &message.status;
            lock(&theirs).on_result(&status.goal_id.id, GoalStatus::from_number(status.status), &status.text);
            bell.ring();
        });
        let feedback = Feed::listen_seldom(node, &topic("feedback"), 5, LOOK, |_: MoveBaseActionFeedback, _| {});
        Ok(Self {
            goals: node.publish(&topic("goal"), 5)?,
            cancels: node.publish(&topic("cancel"), 5)?,
            node: node.clone(),
            server: server.to_owned(),
            tracker,
            strangers,
            status,
            result,
            feedback,
            count: 0,
        })
    }

    /// Sends a goal, which takes the place of one under way.
    ///
    /// # Errors
    /// What is missing, when the server is not ready: a goal that is sent before it has
    /// connected would be lost.
    pub fn send(&mut self, goal_in_map: &Pose, map_frame: &str) -> Result<(), String> {
        if let Err(why) = self.check_ready() {
            lock(&self.tracker).on_unready(&why);
            return Err(why);
        }
        self.count += 1;
        let (now_s, stamp) = (self.node.now_s(), self.node.stamp());
        let id = format!("{}-{}-{}.{:09}", self.node.name(), self.count, stamp.sec, stamp.nsec);
        lock(&self.tracker).begin(id.clone(), self.node.wall_s());
        let message = MoveBaseActionGoal {
            header: convert::header("", now_s),
            goal_id: GoalID { stamp, id },
            goal: MoveBaseGoal { target_pose: convert::stamped(goal_in_map, map_frame, now_s) },
        };
        self.goals.send(message).map_err(|e| e.to_string())
    }

    /// Cancels the goal under way, if there is one; goals of others go on.
    pub fn cancel(&mut self) {
        cancel(&self.tracker, &self.cancels);
    }

    /// The same from another thread, which asks no master.
    pub fn canceller(&self) -> impl FnOnce() + Send + 'static {
        let (tracker, cancels) = (Arc::clone(&self.tracker), self.cancels.clone());
        move || cancel(&tracker, &cancels)
    }

    /// Whether the goal was lost, so that it can be sent again.
    #[must_use]
    pub fn is_lost(&self) -> bool {
        lock(&self.tracker).is_lost(self.node.wall_s())
    }

    /// How the goal is doing.
    #[must_use]
    pub fn state(&self) -> NavigationState {
        let mut tracker = lock(&self.tracker);
        match tracker.state(self.node.wall_s()) {
            // Nothing is under way before the server has taken it up.
            NavigationState::Active if !tracker.is_taken_up() => NavigationState::Idle,
            state => state,
        }
    }

    /// Who else drives the robot now, in seconds of ROS time, if goals of others are left to
    /// their end for so long.
    pub fn stranger(&self, now_s: f64, limit_s: f64) -> Stranger {
        let is_taken_away = self.state() == NavigationState::Preempted;
        let mut strangers = lock(&self.strangers);
        if is_taken_away {
            strangers.on_preempted(now_s);
        }
        strangers.look(now_s, limit_s)
    }

    /// Asks move_base to clear the obstacles that it remembers, and does not wait for that:
    /// the explorer looks at a new map first.
    pub fn clear_costmaps(&self) {
        let (node, service) = (self.node.clone(), format!("{}/clear_costmaps", self.server));
        std::thread::spawn(move || {
            if let Err(error) = call::<std_srvs::Empty>(&node, &service, std_srvs::EmptyReq {}, SERVICE_LIMIT) {
                node.log().once(Level::Warn, error);
            }
        });
    }

    /// Why no goal can be sent now, with the servers that there are instead.
    #[must_use]
    pub fn trouble(&self) -> Option<String> {
        let why = self.check_ready().err()?;
        let Some(listing) = self.node.listing(LISTING_AGE) else { return Some(why) };
        let servers = listing.driving_servers();
        let wanted = self.node.full_name(&self.server);
        Some(if servers.contains(&wanted) {
            format!("{why}, though {wanted} is there")
        } else {
            let remedy = if servers.is_empty() { "start move_base" } else { "set ~move_base to one of them" };
            format!("{why}; action servers that drive: {}; {remedy}", list(&servers))
        })
    }

    /// Whether the server has connected both ways: one and the same node tells status,
    /// result and feedback, and hears goals and cancellations.
    fn check_ready(&self) -> Result<(), String> {
        let age_s = lock(&self.tracker).status_age_s(self.node.wall_s());
        if age_s.is_none_or(|age_s| age_s > READY_WITHIN_S) {
            return Err(format!("no action server tells its status on {}/status", self.server));
        }
        let hears = |names: Vec<String>| names.into_iter().collect::<BTreeSet<_>>();
        let (goal, cancel) = (hears(self.goals.subscriber_names()), hears(self.cancels.subscriber_names()));
        let (result, feedback) = (self.result.callers(), self.feedback.callers());
        let is_whole = |server: &String| {
            result.contains(server) && feedback.contains(server) && goal.contains(server) && cancel.contains(server)
        };
        if self.status.callers().iter().any(is_whole) {
            Ok(())
        } else {
            Err(format!("the action server {} has not connected to all topics yet", self.server))
        }
    }
}

fn cancel(tracker: &Mutex<GoalTracker>, cancels: &Publisher<GoalID>) {
    if let Some(id) = lock(tracker).forget() {
        // Stamp 0 with an id means this goal alone.
        let _ = cancels.send(GoalID { stamp: rosrust::Time::new(), id });
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
