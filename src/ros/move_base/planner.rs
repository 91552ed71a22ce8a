//! Asking move_base whether there is a way, with our own planner to fall back on.

use super::super::call::{CallError, call};
use super::super::convert;
use super::super::log::Level;
use super::super::msg::nav_msgs::{GetPlan, GetPlanReq};
use super::super::node::Node;
use crate::geometry::{Path, Pose};
use crate::grid::Costmap;
use crate::planning::{GlobalPlanner, PlanError};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// How long move_base may think.
const LIMIT: Duration = Duration::from_secs(2);
/// How far from the goal a plan may end, metres: nowhere else, as with goals of the action.
const TOLERANCE_M: f32 = 0.0;

/// A planner that asks `make_plan`. An empty plan is a no, and its length is the way. While
/// a goal is active move_base refuses to answer: then, and where nobody answers, our own
/// planner decides, and that is said once.
pub struct AskingPlanner {
    node: Node,
    service: String,
    /// The frame of the map, once it is known.
    frame: Arc<Mutex<String>>,
    own: Box<dyn GlobalPlanner>,
}

impl AskingPlanner {
    /// Asks a server's `make_plan`; `own` stands in.
    #[must_use]
    pub fn new(node: &Node, server: &str, frame: Arc<Mutex<String>>, own: Box<dyn GlobalPlanner>) -> Self {
        Self { node: node.clone(), service: format!("{server}/make_plan"), frame, own }
    }

    /// The plan of the server: an empty one is a no; an error when it does not answer.
    fn ask(&self, start: &Pose, goal: &Pose) -> Result<Path, CallError> {
        let frame = self.frame.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let now_s = self.node.now_s();
        let request = GetPlanReq {
            start: convert::stamped(start, &frame, now_s),
            goal: convert::stamped(goal, &frame, now_s),
            tolerance: TOLERANCE_M,
        };
        let answer = call::<GetPlan>(&self.node, &self.service, request, LIMIT)?;
        let poses = answer.plan.poses.iter().map(|one| convert::pose(&one.pose)).collect();
        let mut path = Path { poses, cost: 0.0 };
        path.cost = path.length_m();
        Ok(path)
    }
}

impl GlobalPlanner for AskingPlanner {
    fn name(&self) -> &'static str {
        "make_plan"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        // A node that was told to stop has no time for this.
        if self.node.is_ok() {
            match self.ask(start_in_map, goal_in_map) {
                Ok(path) if path.poses.is_empty() => return Err(PlanError::no_path(goal_in_map.position())),
                Ok(path) => return Ok(path),
                Err(error) => {
                    self.node.log().once(Level::Warn, format_args!("{error}: our own planner decides"));
                }
            }
        }
        self.own.plan(costmap, start_in_map, goal_in_map)
    }
}
