//! Carrying out commands with our own planner and controller (floor 2).
//!
//! The part of move_base in the simulator, and of the robot's driver where there is no
//! move_base: a goal becomes a path, the path velocity commands, and a goal that
//! cannot be reached is aborted with a reason. Pure: time and sensing arrive as
//! [`NavigationInput`].

mod back_off;
mod turn;

use crate::control::{ControlInput, Controller};
use crate::geometry::{Body, Point, Pose, Twist, shortest_angle};
use crate::grid::Costmap;
use crate::planning::{Driven, GlobalPlanner, Path, PlanError};
use crate::robot::{Command, CommandId, Navigation, NavigationState};
use crate::scan::LaserScan;
use back_off::BackOff;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use turn::Turn;

/// Tolerances and patience, in the terms of move_base and its local planners.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NavigatorConfig {
    /// Seconds between commands.
    pub control_period_s: f64,
    /// A goal is reached within this distance, metres.
    pub xy_goal_tolerance_m: f64,
    /// And within this heading error, radians.
    pub yaw_goal_tolerance_rad: f64,
    /// A path that is still free is planned anew after this time, seconds.
    pub replan_period_s: f64,
    /// A goal without a path is aborted after this time, seconds.
    pub planner_patience_s: f64,
    /// A goal whose path cannot be followed is aborted after this time, seconds.
    pub controller_patience_s: f64,
    /// Speed of turns on the spot, radians per second.
    pub turn_speed_rps: f64,
}

impl Default for NavigatorConfig {
    fn default() -> Self {
        Self {
            control_period_s: 0.1,
            xy_goal_tolerance_m: 0.15,
            yaw_goal_tolerance_rad: 0.3,
            replan_period_s: 2.0,
            planner_patience_s: 2.0,
            controller_patience_s: 5.0,
            turn_speed_rps: 1.0,
        }
    }
}

/// A path leads by a place when it comes this near, metres.
const BESIDE_M: f64 = 0.3;

/// What the navigator sees at one control tick.
#[derive(Clone, Copy, Debug)]
pub struct NavigationInput<'a> {
    /// Now, seconds.
    pub stamp_s: f64,
    /// Where the base frame is.
    pub pose_in_map: Pose,
    /// How it moves.
    pub twist: Twist,
    /// The newest costmap.
    pub costmap: &'a Arc<Costmap>,
    /// When the costmap was made, seconds: another stamp is another costmap.
    pub costmap_stamp_s: f64,
    /// The newest scan with the lidar's pose in the map frame.
    pub scan: Option<(&'a Pose, &'a LaserScan)>,
}

/// What is being done.
#[derive(Debug)]
enum Activity {
    Idle,
    Drive(Drive),
    Turn { id: CommandId, turn: Turn },
    BackOff { id: CommandId, back_off: BackOff },
    Ended(Navigation),
}

/// A goal under way.
#[derive(Debug)]
struct Drive {
    id: CommandId,
    goal: Pose,
    path: Option<Path>,
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

/// Plans, follows and reports.
pub struct Navigator {
    config: NavigatorConfig,
    planner: Box<dyn GlobalPlanner>,
    controller: Box<dyn Controller>,
    body: Body,
    activity: Activity,
    driven: Driven,
    opened: Option<Opened>,
}

/// A costmap as it came, and as it is for this robot.
struct Opened {
    came: Arc<Costmap>,
    /// Where it fits.
    tight: Arc<Costmap>,
    /// Where it can turn, which is planned for first.
    roomy: Arc<Costmap>,
    /// When that was, seconds.
    since_s: f64,
}

/// Costmaps are opened anew for a robot that has moved on after this time, seconds.
const OPENED_FOR_S: f64 = 2.0;

impl Navigator {
    /// A navigator of a body, at rest.
    #[must_use]
    pub fn new(
        config: NavigatorConfig,
        planner: Box<dyn GlobalPlanner>,
        controller: Box<dyn Controller>,
        body: &Body,
    ) -> Self {
        let (body, driven) = (body.clone(), Driven::default());
        Self { config, planner, controller, body, activity: Activity::Idle, driven, opened: None }
    }

    /// Takes a command; the id of the one under way changes nothing.
    pub fn command(&mut self, command: &Command) {
        match *command {
            Command::Hold => self.activity = Activity::Idle,
            Command::Drive { id, .. } | Command::Turn { id, .. } | Command::BackOff { id }
                if self.current() == Some(id) => {}
            Command::Drive { id, goal_in_map: goal } => {
                self.controller.reset();
                self.activity = Activity::Drive(Drive {
                    id,
                    goal,
                    path: None,
                    planned_s: f64::NEG_INFINITY,
                    costmap_stamp_s: f64::NEG_INFINITY,
                    without_path: None,
                    blocked: None,
                    arrived: false,
                    blocked_at: Vec::new(),
                });
            }
            Command::BackOff { id } => self.activity = Activity::BackOff { id, back_off: BackOff::new(&self.body) },
            Command::Turn { id, angle_rad } => {
                self.activity = Activity::Turn { id, turn: Turn::new(angle_rad, self.config.turn_speed_rps) };
            }
        }
    }

    /// The path being followed, if any.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.activity {
            Activity::Drive(drive) => drive.path.as_ref(),
            _ => None,
        }
    }

    /// The velocity command until the next tick, and how the current command is doing.
    pub fn update(&mut self, input: &NavigationInput<'_>) -> (Twist, Navigation) {
        self.driven.note(&input.pose_in_map);
        let [tight, roomy] = self.open(input);
        let input = &NavigationInput { costmap: &tight, ..*input };
        let (twist, navigation) = match &mut self.activity {
            Activity::Idle => return (Twist::ZERO, Navigation { command: 0, state: NavigationState::Idle }),
            Activity::Ended(navigation) => return (Twist::ZERO, navigation.clone()),
            Activity::Turn { id, turn } => {
                let (twist, done) = turn.update(&input.pose_in_map, &input.twist);
                let state = if done { NavigationState::Succeeded } else { NavigationState::Active };
                (twist, Navigation { command: *id, state })
            }
            Activity::BackOff { id, back_off } => {
                let (twist, state) = back_off.update(input);
                (twist, Navigation { command: *id, state })
            }
            Activity::Drive(drive) => {
                let (twist, state) =
                    drive.update(input, &roomy, &self.config, &mut *self.planner, &mut *self.controller);
                (twist, Navigation { command: drive.id, state })
            }
        };
        if navigation.state != NavigationState::Active {
            self.activity = Activity::Ended(navigation.clone());
        }
        (twist, navigation)
    }

    /// The costmap as it is for a robot that is where it is and came from where it came.
    fn open(&mut self, input: &NavigationInput<'_>) -> [Arc<Costmap>; 2] {
        let own = input.costmap.info().cell_at(input.pose_in_map.position());
        let is_lost = matches!(&self.activity, Activity::Drive(drive) if drive.path.is_none());
        if let Some(Opened { came, tight, roomy, since_s }) = &self.opened
            && Arc::ptr_eq(came, input.costmap)
            && tight.is_passable(own)
            && !is_lost
            && input.stamp_s - since_s < OPENED_FOR_S
        {
            return [Arc::clone(tight), Arc::clone(roomy)];
        }
        let came = Arc::clone(input.costmap);
        let tight = self.driven.open(&came, &input.pose_in_map);
        let roomy = match came.without_narrow() {
            Some(roomy) => self.driven.open(&Arc::new(roomy), &input.pose_in_map),
            None => Arc::clone(&tight),
        };
        let opened = [Arc::clone(&tight), Arc::clone(&roomy)];
        self.opened = Some(Opened { came, tight, roomy, since_s: input.stamp_s });
        opened
    }

    fn current(&self) -> Option<CommandId> {
        match &self.activity {
            Activity::Idle => None,
            Activity::Drive(drive) => Some(drive.id),
            Activity::Turn { id, .. } | Activity::BackOff { id, .. } => Some(*id),
            Activity::Ended(navigation) => Some(navigation.command),
        }
    }
}

impl Drive {
    fn update(
        &mut self,
        input: &NavigationInput<'_>,
        roomy: &Costmap,
        config: &NavigatorConfig,
        planner: &mut dyn GlobalPlanner,
        controller: &mut dyn Controller,
    ) -> (Twist, NavigationState) {
        self.arrived |= input.pose_in_map.distance_to(self.goal.position()) <= config.xy_goal_tolerance_m;
        if self.arrived {
            return self.face_goal(input, config);
        }
        self.replan(input, roomy, config, planner, controller);
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
        roomy: &Costmap,
        config: &NavigatorConfig,
        planner: &mut dyn GlobalPlanner,
        controller: &mut dyn Controller,
    ) {
        let new_costmap = input.costmap_stamp_s != self.costmap_stamp_s;
        let old_plan = input.stamp_s - self.planned_s >= config.replan_period_s;
        let obstacle = if new_costmap { self.path.as_ref().and_then(|path| first_blocked(path, input)) } else { None };
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
            Err(_) => planner.plan(input.costmap, &pose, &goal),
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
                if self.path.as_ref().is_some_and(|path| first_blocked(path, input).is_none()) => {}
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
fn first_blocked(path: &Path, input: &NavigationInput<'_>) -> Option<Point> {
    let here = input.pose_in_map.position();
    let nearest = path
        .poses
        .iter()
        .enumerate()
        .min_by(|a, b| a.1.distance_to(here).total_cmp(&b.1.distance_to(here)))
        .map_or(0, |(index, _)| index);
    let info = input.costmap.info();
    let ahead = path.poses.iter().skip(nearest + 1).map(Pose::position);
    ahead.into_iter().find(|&point| !input.costmap.is_passable(info.cell_at(point)))
}

#[cfg(test)]
mod tests;
