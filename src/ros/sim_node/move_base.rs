//! A stand-in for move_base: its action, `make_plan`, `clear_costmaps`, and the global
//! costmap. It plans and drives with our own navigator, so it shows that the node speaks
//! move_base's protocol, and says nothing of how well the real one drives.

use super::super::convert;
use super::super::feed::Feed;
use super::super::msg::actionlib_msgs::{GoalID, GoalStatus, GoalStatusArray};
use super::super::msg::geometry_msgs::PoseStamped;
use super::super::msg::map_msgs::OccupancyGridUpdate;
use super::super::msg::move_base_msgs::{
    MoveBaseActionFeedback, MoveBaseActionGoal, MoveBaseActionResult, MoveBaseFeedback, MoveBaseResult,
};
use super::super::msg::nav_msgs::{GetPlan, GetPlanRes, OccupancyGrid as GridMessage, Path as PathMessage};
use super::super::msg::std_srvs;
use super::super::node::{Node, NodeError};
use super::goal_book::{Entry, GoalBook};
use super::params::Fault;
use crate::geometry::{Pose, Twist};
use crate::grid::{Costmap, GridPatch, OccupancyGrid};
use crate::navigation::{NavigationInput, Navigator};
use crate::planning::GlobalPlanner;
use crate::robot::{Command, CommandId, NavigationState};
use crate::sim::Plant;
use rosrust::{Publisher, Service};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// From one status to the next, real time: 5 Hz, as actionlib.
const STATUS_PERIOD: Duration = Duration::from_millis(200);
/// From one feedback to the next, real time.
const FEEDBACK_PERIOD: Duration = Duration::from_millis(100);
/// Goals come seldom: so often it is looked whether all who send them are met.
const LOOK: Duration = Duration::from_secs(30);
/// The frame of goals and plans.
const MAP: &str = "map";

/// What has come from clients.
enum Order {
    Goal(GoalID, Pose),
    Cancel(GoalID),
}

/// What the plan service knows.
struct Plans {
    planner: Box<dyn GlobalPlanner>,
    costmap: Arc<Costmap>,
    pose: Pose,
    is_busy: bool,
}

/// The action server.
pub struct MoveBaseServer {
    node: Node,
    navigator: Navigator,
    book: GoalBook,
    commands: CommandId,
    orders: Arc<Mutex<Vec<Order>>>,
    plans: Arc<Mutex<Plans>>,
    status: Publisher<GoalStatusArray>,
    feedback: Publisher<MoveBaseActionFeedback>,
    result: Publisher<MoveBaseActionResult>,
    current_goal: Publisher<PoseStamped>,
    plan: Publisher<PathMessage>,
    costmap: Publisher<GridMessage>,
    updates: Publisher<OccupancyGridUpdate>,
    published: Option<OccupancyGrid>,
    next_status: Instant,
    next_feedback: Instant,
    _feeds: Vec<Feed>,
    _services: Vec<Service>,
}

impl MoveBaseServer {
    /// Offers everything that move_base offers.
    ///
    /// # Errors
    /// [`NodeError`] when something cannot be offered.
    pub fn offer(
        node: &Node,
        navigator: Navigator,
        planner: Box<dyn GlobalPlanner>,
        plant: &Plant,
    ) -> Result<Self, NodeError> {
        let orders = Arc::<Mutex<Vec<Order>>>::default();
        let plans = Arc::new(Mutex::new(Plans {
            planner,
            costmap: Arc::clone(plant.costmap()),
            pose: plant.pose(),
            is_busy: false,
        }));
        Ok(Self {
            navigator,
            book: GoalBook::default(),
            commands: 0,
            status: node.publish("move_base/status", 10)?,
            feedback: node.publish("move_base/feedback", 10)?,
            result: node.publish("move_base/result", 10)?,
            current_goal: node.publish_latched("move_base/current_goal")?,
            plan: node.publish_latched("move_base/NavfnROS/plan")?,
            costmap: node.publish_latched("move_base/global_costmap/costmap")?,
            updates: node.publish("move_base/global_costmap/costmap_updates", 10)?,
            published: None,
            next_status: Instant::now(),
            next_feedback: Instant::now(),
            _feeds: listen(node, &orders),
            _services: serve(node, &plans)?,
            node: node.clone(),
            orders,
            plans,
        })
    }

    /// Takes orders, and gives the velocity until the next control tick.
    pub fn control(&mut self, plant: &Plant, stamp_s: f64, fault: Fault) -> Option<Twist> {
        self.take_orders(stamp_s, fault);
        self.book.active()?;
        if fault == Fault::AbortGoals {
            self.finish(GoalStatus::ABORTED, "aborted by a fault that was switched on", stamp_s);
            return Some(Twist::ZERO);
        }
        if matches!(fault, Fault::Hang | Fault::DeadMoveBase) {
            return Some(Twist::ZERO);
        }
        let (lidar_in_map, scan) = plant.scan();
        let input = NavigationInput {
            stamp_s: plant.now_s(),
            pose_in_map: plant.pose(),
            twist: plant.twist(),
            costmap: plant.costmap(),
            costmap_stamp_s: plant.map_stamp_s(),
            scan: Some((lidar_in_map, scan)),
        };
        let (twist, navigation) = self.navigator.update(&input);
        match navigation.state {
            NavigationState::Succeeded => self.finish(GoalStatus::SUCCEEDED, "Goal reached.", stamp_s),
            NavigationState::Aborted(why) => self.finish(GoalStatus::ABORTED, &why, stamp_s),
            _ => {}
        }
        Some(twist)
    }

    /// Tells status and feedback, as often as move_base does in real time.
    pub fn tell(&mut self, plant: &Plant, stamp_s: f64, fault: Fault) {
        if fault == Fault::DeadMoveBase {
            return;
        }
        let now = Instant::now();
        if now >= self.next_status {
            self.next_status = now + STATUS_PERIOD;
            let status_list = self.book.list(self.node.wall_s());
            let _ = self.status.send(GoalStatusArray { header: convert::header("", stamp_s), status_list });
        }
        if let (true, Some(active)) = (now >= self.next_feedback, self.book.active()) {
            self.next_feedback = now + FEEDBACK_PERIOD;
            let base_position = convert::stamped(&plant.pose(), MAP, stamp_s);
            let _ = self.feedback.send(MoveBaseActionFeedback {
                header: convert::header("", stamp_s),
                status: active.message(),
                feedback: MoveBaseFeedback { base_position },
            });
        }
        if let Some(path) = self.navigator.path() {
            let _ = self.plan.send(convert::path_message(path, MAP, stamp_s));
        }
        let mut plans = lock(&self.plans);
        plans.costmap = Arc::clone(plant.costmap());
        plans.pose = plant.pose();
        plans.is_busy = self.book.active().is_some();
    }

    /// Publishes the costmap of a new map: what changed, where the size is the same.
    pub fn show_costmap(&mut self, costmap: &Costmap, stamp_s: f64) {
        let new = costmap.to_published();
        match &self.published {
            Some(old) if old.info() == new.info() => {
                if let Some(patch) = GridPatch::difference(old, &new) {
                    let update = convert::patch_message(patch, MAP, stamp_s);
                    let _ = self.updates.send(update);
                }
            }
            _ => {}
        }
        // The latched grid serves those who come later.
        if self.published.as_ref().is_none_or(|old| old.info() != new.info()) {
            let _ = self.costmap.send(convert::grid_message(&new, MAP, stamp_s));
        }
        self.published = Some(new);
    }

    fn take_orders(&mut self, stamp_s: f64, fault: Fault) {
        let orders = std::mem::take(&mut *self.orders.lock().unwrap_or_else(PoisonError::into_inner));
        if fault == Fault::DeadMoveBase {
            return;
        }
        for order in orders {
            let now_s = self.node.wall_s();
            match order {
                Order::Goal(id, goal_in_map) => {
                    let replaced = self.book.accept(id, now_s);
                    self.tell_result(replaced, stamp_s);
                    self.commands += 1;
                    self.navigator.command(&Command::Drive { id: self.commands, goal_in_map });
                    let _ = self.current_goal.send(convert::stamped(&goal_in_map, MAP, stamp_s));
                }
                Order::Cancel(id) => {
                    let cancelled = self.book.cancel(&id, now_s);
                    if cancelled.is_some() {
                        self.navigator.command(&Command::Hold);
                    }
                    self.tell_result(cancelled, stamp_s);
                }
            }
        }
    }

    fn finish(&mut self, status: u8, text: &str, stamp_s: f64) {
        self.navigator.command(&Command::Hold);
        let ended = self.book.end(status, text, self.node.wall_s());
        self.tell_result(ended, stamp_s);
    }

    fn tell_result(&self, ended: Option<Entry>, stamp_s: f64) {
        if let Some(entry) = ended {
            let _ = self.result.send(MoveBaseActionResult {
                header: convert::header("", stamp_s),
                status: entry.message(),
                result: MoveBaseResult {},
            });
        }
    }
}

fn listen(node: &Node, orders: &Arc<Mutex<Vec<Order>>>) -> Vec<Feed> {
    let push = |orders: &Mutex<Vec<Order>>, order| orders.lock().unwrap_or_else(PoisonError::into_inner).push(order);
    let (goals, simple, cancels) = (Arc::clone(orders), Arc::clone(orders), Arc::clone(orders));
    let count = Mutex::new(0_u64);
    let owner = node.clone();
    vec![
        node.listen_seldom("move_base/goal", 10, LOOK, move |message: MoveBaseActionGoal, _| {
            push(&goals, Order::Goal(message.goal_id, convert::pose(&message.goal.target_pose.pose)));
        }),
        node.listen_seldom("move_base_simple/goal", 10, LOOK, move |message: PoseStamped, _| {
            let mut count = count.lock().unwrap_or_else(PoisonError::into_inner);
            *count += 1;
            let id = GoalID { stamp: owner.stamp(), id: format!("{}-simple-{count}", owner.name()) };
            push(&simple, Order::Goal(id, convert::pose(&message.pose)));
        }),
        node.listen_seldom("move_base/cancel", 10, LOOK, move |message: GoalID, _| {
            push(&cancels, Order::Cancel(message));
        }),
    ]
}

fn serve(node: &Node, plans: &Arc<Mutex<Plans>>) -> Result<Vec<Service>, NodeError> {
    let plans = Arc::clone(plans);
    let make_plan = node.serve::<GetPlan>("move_base/make_plan", move |request| {
        let plans = &mut *lock(&plans);
        if plans.is_busy {
            return Err("move_base must be idle to make a plan for others".to_owned());
        }
        // An empty frame asks for a plan from where the robot is.
        let start =
            if request.start.header.frame_id.is_empty() { plans.pose } else { convert::pose(&request.start.pose) };
        let goal = convert::pose(&request.goal.pose);
        let plan = match plans.planner.plan(&plans.costmap, &start, &goal) {
            Ok(path) => convert::path_message(&path, MAP, 0.0),
            Err(_) => PathMessage::default(),
        };
        Ok(GetPlanRes { plan })
    })?;
    let clear = node.serve::<std_srvs::Empty>("move_base/clear_costmaps", |_| Ok(std_srvs::EmptyRes {}))?;
    Ok(vec![make_plan, clear])
}

fn lock(plans: &Mutex<Plans>) -> MutexGuard<'_, Plans> {
    plans.lock().unwrap_or_else(PoisonError::into_inner)
}
