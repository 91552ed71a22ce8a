//! The topics and services of move_base: its action, `make_plan`, `clear_costmaps`, and the
//! global costmap. Who plans and drives behind them is a [`Driver`]: the stand-in that fails
//! as the real one, or our own navigator.
//!
//! As in move_base, `make_plan` answers false while a goal is active, and true with an empty
//! path where there is no way; it looks for a goal within the tolerance of the request in
//! squares three cells apart. Costs are published once a second, first whole, then what has
//! changed.

use super::make_plan::{Plans, plan_within};
use super::params::Fault;
use crate::geometry::{Pose, Twist};
use crate::grid::{Costmap, GridPatch, OccupancyGrid};
use crate::planning::GlobalPlanner;
use crate::robot::{Command, CommandId, NavigationState};
use crate::ros::actionlib::{Entry, GoalBook};
use crate::ros::msg::actionlib_msgs::{GoalID, GoalStatus, GoalStatusArray};
use crate::ros::msg::geometry_msgs::PoseStamped;
use crate::ros::msg::map_msgs::OccupancyGridUpdate;
use crate::ros::msg::move_base_msgs::{
    MoveBaseActionFeedback, MoveBaseActionGoal, MoveBaseActionResult, MoveBaseFeedback, MoveBaseResult,
};
use crate::ros::msg::nav_msgs::{GetPlan, GetPlanRes, OccupancyGrid as GridMessage, Path as PathMessage};
use crate::ros::msg::std_srvs;
use crate::ros::{Feed, Node, NodeError, Publisher, Service, convert};
use crate::sim::{Driver, Plant};

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
/// From one costmap to the next, simulated seconds (`publish_frequency`).
const COSTMAP_PERIOD_S: f64 = 1.0;

/// What has come from clients.
enum Order {
    Goal(GoalID, Pose),
    Cancel(GoalID),
    ClearCostmaps,
}

/// The action server.
pub struct MoveBaseServer {
    node: Node,
    driver: Driver,
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
    costmap_at_s: f64,
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
        driver: Driver,
        planner: Box<dyn GlobalPlanner>,
        plant: &Plant,
    ) -> Result<Self, NodeError> {
        let orders = Arc::<Mutex<Vec<Order>>>::default();
        let plans = Arc::new(Mutex::new(Plans {
            planner,
            costmap: Arc::clone(plant.costmap()),
            pose: plant.pose_in_map(),
            is_busy: false,
        }));
        Ok(Self {
            driver,
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
            costmap_at_s: 0.0,
            next_status: Instant::now(),
            next_feedback: Instant::now(),
            _feeds: listen(node, &orders),
            _services: serve(node, &plans, &orders)?,
            node: node.clone(),
            orders,
            plans,
        })
    }

    /// Takes orders, and gives the velocity until the next control tick, `dt_s` seconds on.
    pub fn control(&mut self, plant: &Plant, dt_s: f64, stamp_s: f64, fault: Fault) -> Option<Twist> {
        self.take_orders(plant.now_s(), stamp_s, fault);
        if self.book.active().is_some() && fault == Fault::AbortGoals {
            self.finish(GoalStatus::ABORTED, "aborted by a fault that was switched on", plant.now_s(), stamp_s);
            return Some(Twist::ZERO);
        }
        if matches!(fault, Fault::Hang | Fault::DeadMoveBase) {
            return self.book.active().map(|_| Twist::ZERO);
        }
        let (twist, navigation) = self.driver.update(plant, dt_s);
        if plant.now_s() >= self.costmap_at_s {
            self.costmap_at_s = plant.now_s() + COSTMAP_PERIOD_S;
            let costmap = Arc::clone(self.driver.costmap(plant));
            self.show_costmap(&costmap, stamp_s);
        }
        self.book.active()?;
        match navigation.state {
            NavigationState::Succeeded => {
                self.finish(GoalStatus::SUCCEEDED, "Goal reached.", plant.now_s(), stamp_s);
            }
            NavigationState::Aborted(why) => self.finish(GoalStatus::ABORTED, &why, plant.now_s(), stamp_s),
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
            let base_position = convert::stamped(&plant.pose_in_map(), MAP, stamp_s);
            let _ = self.feedback.send(MoveBaseActionFeedback {
                header: convert::header("", stamp_s),
                status: active.message(),
                feedback: MoveBaseFeedback { base_position },
            });
        }
        if let Some(path) = self.driver.path() {
            let _ = self.plan.send(convert::path_message(path, MAP, stamp_s));
        }
        let mut plans = lock(&self.plans);
        plans.costmap = Arc::clone(self.driver.costmap(plant));
        plans.pose = plant.pose_in_map();
        plans.is_busy = self.book.active().is_some();
    }

    /// Publishes the costmap: what changed, where the size is the same.
    fn show_costmap(&mut self, costmap: &Costmap, stamp_s: f64) {
        let new = costmap.to_published();
        if let Some(old) = self.published.as_ref().filter(|old| old.info() == new.info())
            && let Some(patch) = GridPatch::difference(old, &new)
        {
            let _ = self.updates.send(convert::patch_message(patch, MAP, stamp_s));
        }
        // The latched grid serves those who come later.
        if self.published.as_ref().is_none_or(|old| old.info() != new.info()) {
            let _ = self.costmap.send(convert::grid_message(&new, MAP, stamp_s));
        }
        self.published = Some(new);
    }

    fn take_orders(&mut self, sim_s: f64, stamp_s: f64, fault: Fault) {
        let orders = std::mem::take(&mut *self.orders.lock().unwrap_or_else(PoisonError::into_inner));
        if fault == Fault::DeadMoveBase {
            return;
        }
        for order in orders {
            let now_s = self.node.wall_s();
            match order {
                Order::Goal(id, _) if fault == Fault::RejectGoals => {
                    let text = "rejected by a fault that was switched on";
                    let rejected = self.book.turn_away(id, GoalStatus::REJECTED, text, now_s);
                    self.tell_result(Some(rejected), stamp_s);
                }
                Order::Goal(id, goal_in_map) => {
                    let replaced = self.book.accept(id, now_s);
                    self.tell_result(replaced, stamp_s);
                    self.commands += 1;
                    self.driver.drive(self.commands, goal_in_map, sim_s);
                    let _ = self.current_goal.send(convert::stamped(&goal_in_map, MAP, stamp_s));
                }
                Order::ClearCostmaps => self.driver.clear_costmaps(),
                Order::Cancel(id) => {
                    let cancelled = self.book.cancel(&id, now_s);
                    if cancelled.is_some() {
                        self.driver.command(&Command::Hold, sim_s);
                    }
                    self.tell_result(cancelled, stamp_s);
                }
            }
        }
    }

    fn finish(&mut self, status: u8, text: &str, sim_s: f64, stamp_s: f64) {
        self.driver.command(&Command::Hold, sim_s);
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
        Feed::listen_seldom(node, "move_base/goal", 10, LOOK, move |message: MoveBaseActionGoal, _| {
            push(&goals, Order::Goal(message.goal_id, convert::pose(&message.goal.target_pose.pose)));
        }),
        Feed::listen_seldom(node, "move_base_simple/goal", 10, LOOK, move |message: PoseStamped, _| {
            let mut count = count.lock().unwrap_or_else(PoisonError::into_inner);
            *count += 1;
            let id = GoalID { stamp: owner.stamp(), id: format!("{}-simple-{count}", owner.name()) };
            push(&simple, Order::Goal(id, convert::pose(&message.pose)));
        }),
        Feed::listen_seldom(node, "move_base/cancel", 10, LOOK, move |message: GoalID, _| {
            push(&cancels, Order::Cancel(message));
        }),
    ]
}

fn serve(node: &Node, plans: &Arc<Mutex<Plans>>, orders: &Arc<Mutex<Vec<Order>>>) -> Result<Vec<Service>, NodeError> {
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
        let plan = plan_within(plans, &start, &goal, f64::from(request.tolerance))
            .map_or_else(PathMessage::default, |path| convert::path_message(&path, MAP, 0.0));
        Ok(GetPlanRes { plan })
    })?;
    let orders = Arc::clone(orders);
    let clear = node.serve::<std_srvs::Empty>("move_base/clear_costmaps", move |_| {
        orders.lock().unwrap_or_else(PoisonError::into_inner).push(Order::ClearCostmaps);
        Ok(std_srvs::EmptyRes {})
    })?;
    Ok(vec![make_plan, clear])
}

fn lock(plans: &Mutex<Plans>) -> MutexGuard<'_, Plans> {
    plans.lock().unwrap_or_else(PoisonError::into_inner)
}
