//! The action `~explore`: an exploration as a mission script orders it, with feedback and a
//! result.

use super::areas::{Asked, Wish};
use super::connect::Connected;
use super::desk::{Desk, Order, Request};
use super::settings::ExploreNodeError;
use crate::geometry::{Point, Polygon};
use crate::ros::actionlib::{Entry, GoalBook};
use crate::ros::convert;
use crate::ros::map_feed::MapReader;
use crate::ros::msg::actionlib_msgs::{GoalID, GoalStatus, GoalStatusArray};
use crate::ros::msg::frontier_explorer::{
    ExplorationStatus, ExploreActionFeedback, ExploreActionGoal, ExploreActionResult, ExploreFeedback, ExploreGoal,
    ExploreResult,
};
use crate::ros::msg::geometry_msgs::PolygonStamped;
use crate::ros::transforms::Transforms;
use crate::ros::{Feed, Node, Publisher};
use nalgebra::Point3;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Goals come seldom: so often it is looked whether all who send them are met.
const LOOK: Duration = Duration::from_secs(30);
/// A goal with a region waits so long for the first map, and for the transform to it.
const FRAME_WITHIN: Duration = Duration::from_secs(10);
const TRANSFORM_WITHIN: Duration = Duration::from_secs(2);
/// From one status to the next, real time: 5 Hz, as actionlib.
const STATUS_PERIOD: Duration = Duration::from_millis(200);
/// From one feedback to the next, real time.
const FEEDBACK_PERIOD: Duration = Duration::from_secs(1);

/// How an order ended, as actionlib knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// As was ordered.
    Succeeded,
    /// Cancelled, or another one took its place.
    Preempted,
    /// Otherwise.
    Aborted,
}

/// The action's server.
pub struct ExploreAction {
    teller: Arc<Teller>,
    _feeds: Vec<Feed>,
}

/// Tells how the exploration is doing.
pub type Exploration = Box<dyn Fn() -> ExplorationStatus + Send + Sync>;

/// What is told of the goals.
struct Teller {
    node: Node,
    book: Mutex<GoalBook>,
    /// What is told as feedback.
    exploration: Exploration,
    status: Publisher<GoalStatusArray>,
    feedback: Publisher<ExploreActionFeedback>,
    result: Publisher<ExploreActionResult>,
}

impl ExploreAction {
    /// Offers the action; feedback is the exploration's status.
    ///
    /// # Errors
    /// [`ExploreNodeError`] when a topic cannot be offered.
    pub fn offer(
        node: &Node,
        desk: &Desk,
        connected: &Connected,
        exploration: Exploration,
    ) -> Result<Self, ExploreNodeError> {
        let teller = Arc::new(Teller {
            node: node.clone(),
            book: Mutex::default(),
            exploration,
            status: node.publish("~explore/status", 10)?,
            feedback: node.publish("~explore/feedback", 10)?,
            result: node.publish("~explore/result", 10)?,
        });
        let theirs = Arc::clone(&teller);
        std::thread::spawn(move || tell(&theirs));
        let (goals, cancels, theirs) = (desk.clone(), desk.clone(), Arc::clone(&teller));
        let frames = MapFrame::new(node, connected);
        let feeds = vec![
            Feed::listen_seldom(node, "~explore/goal", 10, LOOK, move |message: ExploreActionGoal, _| {
                match order(message.goal_id.clone(), &message.goal, |region| frames.corners(region)) {
                    Ok(order) => goals.hand_in(Request::Order(order)),
                    Err(why) => theirs.turn_away(message.goal_id, GoalStatus::REJECTED, &why),
                }
            }),
            Feed::listen_seldom(node, "~explore/cancel", 10, LOOK, move |message: GoalID, _| {
                cancels.hand_in(Request::Cancel(message));
            }),
        ];
        Ok(Self { teller, _feeds: feeds })
    }

    /// Takes an order up.
    pub fn accept(&self, order: &Order) {
        let teller = &self.teller;
        teller.node.log().info(format_args!("the goal {} of the action is taken up", order.id.id));
        lock(&teller.book).accept(order.id.clone(), teller.node.wall_s());
        teller.tell_status();
        teller.tell_feedback();
    }

    /// An order that was not taken up yet is recalled.
    pub fn recall(&self, order: Order, why: &str) {
        self.teller.turn_away(order.id, GoalStatus::RECALLED, why);
    }

    /// Ends the order under way, if there is one.
    pub fn finish(&self, outcome: Outcome, result: ExploreResult) {
        let status = match outcome {
            Outcome::Succeeded => GoalStatus::SUCCEEDED,
            Outcome::Preempted => GoalStatus::PREEMPTED,
            Outcome::Aborted => GoalStatus::ABORTED,
        };
        let teller = &self.teller;
        let ended = lock(&teller.book).end(status, &result.message, teller.node.wall_s());
        if let Some(entry) = ended {
            teller.tell_result(&entry, result);
        }
    }
}

impl Teller {
    fn turn_away(&self, id: GoalID, status: u8, why: &str) {
        self.node.log().warn(format_args!("the goal {} of the action is turned away: {why}", id.id));
        let entry = lock(&self.book).turn_away(id, status, why, self.node.wall_s());
        self.tell_result(&entry, ExploreResult { message: why.to_owned(), ..ExploreResult::default() });
    }

    fn tell_result(&self, entry: &Entry, result: ExploreResult) {
        let header = convert::header("", self.node.now_s());
        let _ = self.result.send(ExploreActionResult { header, status: entry.message(), result });
        self.tell_status();
    }

    fn tell_status(&self) {
        let status_list = lock(&self.book).list(self.node.wall_s());
        let _ = self.status.send(GoalStatusArray { header: convert::header("", self.node.now_s()), status_list });
    }

    fn tell_feedback(&self) {
        let Some(active) = lock(&self.book).active().map(Entry::message) else { return };
        let feedback = ExploreFeedback { status: (self.exploration)() };
        let header = convert::header("", self.node.now_s());
        let _ = self.feedback.send(ExploreActionFeedback { header, status: active, feedback });
    }
}

/// Tells status and feedback while the node lives.
fn tell(teller: &Teller) {
    let mut next_feedback = Instant::now();
    while teller.node.is_ok() {
        teller.tell_status();
        if Instant::now() >= next_feedback {
            next_feedback = Instant::now() + FEEDBACK_PERIOD;
            teller.tell_feedback();
        }
        std::thread::sleep(STATUS_PERIOD);
    }
}

/// Brings polygons to the map's frame.
struct MapFrame {
    node: Node,
    transforms: Arc<Transforms>,
    maps: MapReader,
}

impl MapFrame {
    fn new(node: &Node, connected: &Connected) -> Self {
        Self { node: node.clone(), transforms: Arc::clone(&connected.transforms), maps: connected.maps.clone() }
    }

    /// The corners of a polygon in the map's frame, which is waited for.
    fn corners(&self, region: &PolygonStamped) -> Result<Vec<Point>, String> {
        let points: Vec<Point3<f64>> =
            region.polygon.points.iter().map(|p| Point3::new(p.x, p.y, p.z).cast()).collect();
        if points.is_empty() {
            return Ok(Vec::new());
        }
        self.node.wait_until(FRAME_WITHIN, || self.maps.newest().is_some());
        let Some(map) = self.maps.newest().map(|map| map.frame) else {
            return Err("the corners of the region: no map has come that could tell its frame".to_owned());
        };
        let (frame, stamp_s) = (region.header.frame_id.clone(), convert::seconds(&region.header.stamp));
        let asked = Asked { wish: Wish::Order, frame, stamp_s, points };
        let mut corners = Ok(Vec::new());
        self.node.wait_until(TRANSFORM_WITHIN, || {
            corners = asked.to_map(&self.transforms, &map);
            corners.is_ok()
        });
        corners
    }
}

/// What a goal orders, or why it cannot be ordered; the corners of its region are brought to the
/// map's frame.
fn order(
    id: GoalID,
    goal: &ExploreGoal,
    corners: impl Fn(&PolygonStamped) -> Result<Vec<Point>, String>,
) -> Result<Order, String> {
    let limit_s = goal.time_limit_s;
    if !(limit_s.is_finite() && limit_s >= 0.0) {
        return Err(format!("time_limit_s is {limit_s}: must be finite and at least 0 s, 0 for none"));
    }
    let corners = corners(&goal.region)?;
    let region = match corners.is_empty() {
        true => None,
        false => Some(Polygon::new(corners).map_err(|e| format!("region: {e}"))?),
    };
    Ok(Order {
        id,
        region,
        time_limit_s: (limit_s > 0.0).then_some(limit_s),
        return_home: goal.return_home,
        map_file: goal.map_file.clone(),
    })
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::msg::geometry_msgs::Point32;

    #[test]
    fn a_goal_is_checked_before_it_is_taken_up() {
        let corners = |region: &PolygonStamped| {
            let points = region.polygon.points.iter();
            match region.header.frame_id.as_str() {
                "" => Ok(points.map(|p| Point::new(f64::from(p.x), f64::from(p.y))).collect()),
                other => Err(format!("the frame {other}")),
            }
        };
        let read = |goal: &ExploreGoal| order(GoalID::default(), goal, corners);
        let everything = read(&ExploreGoal::default()).unwrap();
        assert!(everything.region.is_none() && everything.time_limit_s.is_none() && !everything.return_home);
        let limit = |time_limit_s| ExploreGoal { time_limit_s, ..ExploreGoal::default() };
        assert_eq!(read(&limit(12.0)).unwrap().time_limit_s, Some(12.0));
        for wrong in [-1.0, f64::NAN, f64::INFINITY] {
            assert!(read(&limit(wrong)).unwrap_err().starts_with("time_limit_s is "), "{wrong}");
        }
        let mut goal = ExploreGoal::default();
        goal.region.polygon.points = vec![Point32::default(); 2];
        assert!(read(&goal).unwrap_err().starts_with("region: "));
        let corner = |x: f32, y: f32| Point32 { x, y, z: 0.0 };
        goal.region.polygon.points = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
        assert_eq!(read(&goal).unwrap().region.unwrap().corners().len(), 3);
        goal.region.header.frame_id = "odom".to_owned();
        assert!(read(&goal).unwrap_err().contains("the frame odom"));
    }
}
