//! Carrying out commands with our own planner and controller (floor 2).
//!
//! The part of move_base in the simulator, and of the robot's driver where there is no
//! move_base: a goal becomes a path, the path velocity commands, and a goal that
//! cannot be reached is aborted with a reason. Pure: time and sensing arrive as
//! [`NavigationInput`].

mod turn;

use crate::control::{ControlInput, Controller};
use crate::geometry::{Pose, Twist, shortest_angle};
use crate::grid::Costmap;
use crate::planning::{GlobalPlanner, Path, PlanError};
use crate::robot::{Command, CommandId, Navigation, NavigationState};
use crate::scan::LaserScan;
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
}

/// Plans, follows and reports.
pub struct Navigator {
    config: NavigatorConfig,
    planner: Box<dyn GlobalPlanner>,
    controller: Box<dyn Controller>,
    activity: Activity,
}

impl Navigator {
    /// A navigator at rest.
    #[must_use]
    pub fn new(config: NavigatorConfig, planner: Box<dyn GlobalPlanner>, controller: Box<dyn Controller>) -> Self {
        Self { config, planner, controller, activity: Activity::Idle }
    }

    /// Takes a command; the id of the one under way changes nothing.
    pub fn command(&mut self, command: &Command) {
        match *command {
            Command::Hold => self.activity = Activity::Idle,
            Command::Drive { id, .. } | Command::Turn { id, .. } if self.current() == Some(id) => {}
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
                });
            }
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
        let (twist, navigation) = match &mut self.activity {
            Activity::Idle => return (Twist::ZERO, Navigation { command: 0, state: NavigationState::Idle }),
            Activity::Ended(navigation) => return (Twist::ZERO, navigation.clone()),
            Activity::Turn { id, turn } => {
                let (twist, done) = turn.update(&input.pose_in_map, &input.twist);
                let state = if done { NavigationState::Succeeded } else { NavigationState::Active };
                (twist, Navigation { command: *id, state })
            }
            Activity::Drive(drive) => {
                let (twist, state) = drive.update(input, &self.config, &mut *self.planner, &mut *self.controller);
                (twist, Navigation { command: drive.id, state })
            }
        };
        if navigation.state != NavigationState::Active {
            self.activity = Activity::Ended(navigation.clone());
        }
        (twist, navigation)
    }

    fn current(&self) -> Option<CommandId> {
        match &self.activity {
            Activity::Idle => None,
            Activity::Drive(drive) => Some(drive.id),
            Activity::Turn { id, .. } => Some(*id),
            Activity::Ended(navigation) => Some(navigation.command),
        }
    }
}

impl Drive {
    fn update(
        &mut self,
        input: &NavigationInput<'_>,
        config: &NavigatorConfig,
        planner: &mut dyn GlobalPlanner,
        controller: &mut dyn Controller,
    ) -> (Twist, NavigationState) {
        self.arrived |= input.pose_in_map.distance_to(self.goal.position()) <= config.xy_goal_tolerance_m;
        if self.arrived {
            return self.face_goal(input, config);
        }
        self.replan(input, config, planner, controller);
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
        config: &NavigatorConfig,
        planner: &mut dyn GlobalPlanner,
        controller: &mut dyn Controller,
    ) {
        let new_costmap = input.costmap_stamp_s != self.costmap_stamp_s;
        let old_plan = input.stamp_s - self.planned_s >= config.replan_period_s;
        let blocked = new_costmap && self.path.as_ref().is_some_and(|path| is_blocked(path, input));
        let retry = self.path.is_none() && new_costmap;
        self.costmap_stamp_s = input.costmap_stamp_s;
        if !(old_plan || blocked || retry) {
            return;
        }
        self.planned_s = input.stamp_s;
        match planner.plan(input.costmap, &input.pose_in_map, &self.goal) {
            Ok(path) => {
                self.path = Some(path);
                self.without_path = None;
                controller.reset();
            }
            // A path that is still free serves on when the planner gave up its search for
            // a newer one: the goal may be too far from here for its limit.
            Err(PlanError::IterationLimit { .. })
                if self.path.as_ref().is_some_and(|path| !is_blocked(path, input)) => {}
            Err(error) => {
                self.path = None;
                let since = self.without_path.take().map_or(input.stamp_s, |(since, _)| since);
                self.without_path = Some((since, error.to_string()));
            }
        }
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

/// Whether the part of a path still ahead touches a blocked cell.
fn is_blocked(path: &Path, input: &NavigationInput<'_>) -> bool {
    let here = input.pose_in_map.position();
    let nearest = path
        .poses
        .iter()
        .enumerate()
        .min_by(|a, b| a.1.distance_to(here).total_cmp(&b.1.distance_to(here)))
        .map_or(0, |(index, _)| index);
    let info = input.costmap.info();
    path.poses.iter().skip(nearest + 1).any(|pose| !input.costmap.is_passable(info.cell_at(pose.position())))
}

#[cfg(test)]
mod tests;
