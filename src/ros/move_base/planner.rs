//! Asking move_base whether there is a way, with our own planner to fall back on.

use super::super::call::call;
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
/// How far from the goal a plan may end, metres.
const TOLERANCE_M: f32 = 0.3;

/// A planner that asks `make_plan`. move_base answers only while it is idle and its
/// answer to "there is none" cannot be told from "not now", so an empty plan is checked
/// by our own planner, and so is a server that does not answer.
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

    fn ask(&self, start: &Pose, goal: &Pose) -> Option<Path> {
        // A node that was told to stop has no time for this.
        if !self.node.is_ok() {
            return None;
        }
        let frame = self.frame.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let now_s = self.node.now_s();
        let request = GetPlanReq {
            start: convert::stamped(start, &frame, now_s),
            goal: convert::stamped(goal, &frame, now_s),
            tolerance: TOLERANCE_M,
        };
        match call::<GetPlan>(&self.node, &self.service, request, LIMIT) {
            Ok(answer) if answer.plan.poses.len() > 1 => {
                let poses = answer.plan.poses.iter().map(|one| convert::pose(&one.pose)).collect();
                let mut path = Path { poses, cost: 0.0 };
                path.cost = path.length_m();
                Some(path)
            }
            Ok(_) => None,
            Err(error) => {
                self.node.log().once(Level::Warn, format_args!("{error}: our own planner decides"));
                None
            }
        }
    }
}

impl GlobalPlanner for AskingPlanner {
    fn name(&self) -> &'static str {
        "make_plan"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        match self.ask(start_in_map, goal_in_map) {
            Some(path) => Ok(path),
            None => self.own.plan(costmap, start_in_map, goal_in_map),
        }
    }
}
