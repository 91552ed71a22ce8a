//! A goal under way: planned, followed, planned anew, reached or given up.

use super::{NavigationInput, NavigatorConfig};
use crate::control::{ControlInput, Controller};
use crate::geometry::{Point, Pose, Twist, shortest_angle};
use crate::grid::Costmap;
use crate::planning::{GlobalPlanner, Path, PlanError};
use crate::robot::{CommandId, NavigationState};

/// A path leads by a place when it comes this near, metres.
const BESIDE_M: f64 = 0.3;

/// A goal under way.
#[derive(Debug)]
pub struct Drive {
    pub id: CommandId,
    pub goal: Pose,
    pub path: Option<Path>,
    planned_s: f64,
    costmap_stamp_s: f64,
    /// Since when there is no path, and why.
    without_path: Option<(f64, String)>,
    /// Since when the controller is blocked, and why.
    blocked: Option<(f64, String)>,
    /// The position is reached; only the heading is left.
    arrived: bool,
    /// Where paths turned out to be blocked.
    blocked_at: Vec<Point>,
}

impl Drive {
    /// A goal that nothing has been done about.
    pub const fn new(id: CommandId, goal: Pose) -> Self {
        Self {
            id,
            goal,
            path: None,
            planned_s: f64::NEG_INFINITY,
            costmap_stamp_s: f64::NEG_INFINITY,
            without_path: None,
            blocked: None,
            arrived: false,
            blocked_at: Vec::new(),
        }
    }

    /// Another way is planned at the next tick.
    pub fn plan_anew(&mut self) {
        (self.path, self.planned_s) = (None, f64::NEG_INFINITY);
    }

    /// The velocity command until the next tick, and how it is doing; ways are planned over
    /// `plannable`: the costmap of the input within the robot's areas, and before it the same with
    /// what is planned round first.
    pub fn update(
        &mut self,
        input: &NavigationInput<'_>,
        plannable: [&Costmap; 2],
        config: &NavigatorConfig,
        planner: &mut dyn GlobalPlanner,
        controller: &mut dyn Controller,
    ) -> (Twist, NavigationState) {
        self.arrived |= input.pose_in_map.distance_to(self.goal.position()) <= config.xy_goal_tolerance_m;
        if self.arrived {
            return self.face_goal(input, config);
        }
        self.replan(input, plannable, config, planner, controller);
        let Some(path) = &self.path else {
            return (Twist::ZERO, patience(&self.without_path, input.stamp_s, config.planner_patience_s));
        };
        let control = ControlInput {
            pose_in_map: input.pose_in_map,
            twist: input.twist,
            path,
            costmap: input.costmap,
            scan: input.scan,
            dt_s: config.control_period_s,
        };
        match controller.control(&control) {
            Ok(twist) => {
                self.blocked = None;
                (twist, NavigationState::Active)
            }
            Err(error) => {
                self.blocked.get_or_insert((input.stamp_s, error.to_string()));
                (Twist::ZERO, patience(&self.blocked, input.stamp_s, config.controller_patience_s))
            }
        }
    }

    fn replan(
        &mut self,
        input: &NavigationInput<'_>,
        plannable: [&Costmap; 2],
        config: &NavigatorConfig,
        planner: &mut dyn GlobalPlanner,
        controller: &mut dyn Controller,
    ) {
        let [tight, roomy] = plannable;
        let new_costmap = input.costmap_stamp_s != self.costmap_stamp_s;
        let old_plan = input.stamp_s - self.planned_s >= config.replan_period_s;
        let obstacle =
            if new_costmap { self.path.as_ref().and_then(|path| first_blocked(path, input, tight)) } else { None };
        let blocked = obstacle.is_some();
        self.blocked_at.extend(obstacle);
        let retry = self.path.is_none() && new_costmap;
        self.costmap_stamp_s = input.costmap_stamp_s;
        if !(old_plan || blocked || retry) {
            return;
        }
        self.planned_s = input.stamp_s;
        let (pose, goal) = (input.pose_in_map, self.goal);
        let by_room = planner.plan(roomy, &pose, &goal);
        let planned = match by_room {
            Err(PlanError::IterationLimit { .. }) | Ok(_) => by_room,
            // Only where there is no other way: where the robot fits and cannot turn.
            Err(_) => planner.plan(tight, &pose, &goal),
        };
        match planned {
            // A gap that opens from afar and closes from nearby would make the robot run to
            // and fro: a way that is free is kept against one by where another was blocked.
            Ok(path) if !blocked && self.path.is_some() && self.leads_by_obstacle(&path) => {}
            Ok(path) => {
                self.path = Some(path);
                self.without_path = None;
                controller.reset();
            }
            // A path that is still free serves on when the planner gave up its search for
            // a newer one: the goal may be too far from here for its limit.
            Err(PlanError::IterationLimit { .. })
                if self.path.as_ref().is_some_and(|path| first_blocked(path, input, tight).is_none()) => {}
            Err(error) => {
                self.path = None;
                let since = self.without_path.take().map_or(input.stamp_s, |(since, _)| since);
                self.without_path = Some((since, error.to_string()));
            }
        }
    }

    /// Whether a path leads by a place where another one was blocked, and the path under
    /// way does not.
    fn leads_by_obstacle(&self, path: &Path) -> bool {
        let meets = |path: &Path| {
            let near = |place: &Point| path.poses.iter().any(|pose| pose.distance_to(*place) <= BESIDE_M);
            self.blocked_at.iter().any(near)
        };
        meets(path) && !self.path.as_ref().is_some_and(meets)
    }

    /// Turns on the spot until the heading is the goal's.
    fn face_goal(&self, input: &NavigationInput<'_>, config: &NavigatorConfig) -> (Twist, NavigationState) {
        let error = shortest_angle(input.pose_in_map.yaw, self.goal.yaw);
        if error.abs() <= config.yaw_goal_tolerance_rad {
            (Twist::ZERO, NavigationState::Succeeded)
        } else {
            let speed = (2.0 * error.abs()).clamp(0.2, config.turn_speed_rps.max(0.2));
            (Twist::new(0.0, speed.copysign(error)), NavigationState::Active)
        }
    }
}

/// Active until the trouble has lasted too long.
fn patience(trouble: &Option<(f64, String)>, now_s: f64, limit_s: f64) -> NavigationState {
    match trouble {
        Some((since_s, reason)) if now_s - since_s >= limit_s => NavigationState::Aborted(reason.clone()),
        _ => NavigationState::Active,
    }
}

/// The first place on the part of a path still ahead that is blocked.
fn first_blocked(path: &Path, input: &NavigationInput<'_>, costmap: &Costmap) -> Option<Point> {
    let here = input.pose_in_map.position();
    let nearest = path
        .poses
        .iter()
        .enumerate()
        .min_by(|a, b| a.1.distance_to(here).total_cmp(&b.1.distance_to(here)))
        .map_or(0, |(index, _)| index);
    let info = costmap.info();
    let ahead = path.poses.iter().skip(nearest + 1).map(Pose::position);
    ahead.into_iter().find(|&point| !costmap.is_passable(info.cell_at(point)))
}
