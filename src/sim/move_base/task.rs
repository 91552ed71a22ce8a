//! A goal under way: move_base's states, and what leads from one to the next.

use super::recovery::{RECOVERIES, Recovery, Rotation, Trigger, abort_text};
use super::{InflatedPlanner, LocalPlanner, MoveBaseConfig, MoveBaseInput};
use crate::geometry::{Path, Pose, Twist, shortest_angle};
use crate::grid::Costmap;
use crate::robot::{CommandId, NavigationState};
use std::sync::Arc;

/// A base drives on at its last velocity for so long, seconds: move_base says nothing while
/// it plans.
const HOLD_S: f64 = 0.5;

/// move_base's states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Planning,
    Controlling,
    Clearing,
}

/// A goal under way.
#[derive(Debug)]
pub struct Task {
    /// The goal's command.
    pub id: CommandId,
    /// The plan being followed, in the map's frame.
    pub plan: Option<Path>,
    /// The velocity told last.
    pub twist: Twist,
    goal: Pose,
    state: State,
    trigger: Trigger,
    /// The next recovery to try.
    recovery: usize,
    rotation: Option<Rotation>,
    /// When to plan next; never while a goal without a plan is being recovered.
    plan_at_s: f64,
    valid_plan_s: f64,
    valid_control_s: f64,
    /// Where and when the robot last had moved.
    moved: (Pose, f64),
    told_s: f64,
    /// The position is reached; only the heading is left.
    arrived: bool,
}

impl Task {
    /// A goal that is taken up now, by a robot that moves as told.
    pub fn new(id: CommandId, goal: Pose, held: Twist, input: &MoveBaseInput<'_>) -> Self {
        let now_s = input.stamp_s;
        Self {
            id,
            plan: None,
            twist: held,
            goal,
            state: State::Planning,
            trigger: Trigger::Planning,
            recovery: 0,
            rotation: None,
            plan_at_s: now_s,
            valid_plan_s: now_s,
            valid_control_s: now_s,
            moved: (input.pose_in_map(), now_s),
            told_s: now_s,
            arrived: false,
        }
    }

    /// One control tick; sets the velocity.
    pub fn cycle(
        &mut self,
        input: &MoveBaseInput<'_>,
        config: &MoveBaseConfig,
        costmap: &Arc<Costmap>,
        planner: &mut InflatedPlanner,
        local: &mut LocalPlanner,
    ) -> NavigationState {
        let now_s = input.stamp_s;
        if input.pose_in_map().distance_to(self.moved.0.position()) >= config.oscillation_distance_m {
            self.moved = (input.pose_in_map(), now_s);
            if self.trigger == Trigger::Oscillation {
                self.recovery = 0;
            }
        }
        if let Some(rotation) = &mut self.rotation {
            match rotation.advance(&input.pose_in_odom, local) {
                Some(twist) => self.tell(twist, now_s),
                None => {
                    self.rotation = None;
                    self.recovered(now_s);
                }
            }
            return NavigationState::Active;
        }
        if now_s >= self.plan_at_s {
            self.plan_anew(input, config, costmap, planner, local);
        }
        match self.state {
            State::Planning => {
                if now_s - self.told_s > HOLD_S {
                    self.twist = Twist::ZERO;
                }
            }
            State::Controlling => return self.control(input, config, local),
            State::Clearing => return self.recover(input, local),
        }
        NavigationState::Active
    }

    /// What move_base's planning thread does.
    fn plan_anew(
        &mut self,
        input: &MoveBaseInput<'_>,
        config: &MoveBaseConfig,
        costmap: &Arc<Costmap>,
        planner: &mut InflatedPlanner,
        local: &mut LocalPlanner,
    ) {
        let now_s = input.stamp_s;
        self.plan_at_s = now_s + config.planner_period_s;
        if let Ok(path) = planner.plan_on(costmap, &input.pose_in_map(), &self.goal) {
            self.plan = Some(path);
            self.valid_plan_s = now_s;
            self.state = State::Controlling;
            if self.trigger == Trigger::Planning {
                self.recovery = 0;
            }
            local.set_plan();
        } else if self.state == State::Planning && now_s > self.valid_plan_s + config.planner_patience_s {
            self.state = State::Clearing;
            self.plan_at_s = f64::INFINITY;
            self.trigger = Trigger::Planning;
            self.tell(Twist::ZERO, now_s);
        }
    }

    fn control(
        &mut self,
        input: &MoveBaseInput<'_>,
        config: &MoveBaseConfig,
        local: &mut LocalPlanner,
    ) -> NavigationState {
        let (now_s, pose) = (input.stamp_s, input.pose_in_map());
        self.arrived |= pose.distance_to(self.goal.position()) <= config.xy_goal_tolerance_m;
        let is_turned = shortest_angle(pose.yaw, self.goal.yaw).abs() <= config.yaw_goal_tolerance_rad;
        if self.arrived && is_turned {
            return NavigationState::Succeeded;
        }
        let is_oscillating = now_s > self.moved.1 + config.oscillation_timeout_s;
        if is_oscillating {
            self.state = State::Clearing;
            self.trigger = Trigger::Oscillation;
        }
        let velocity = match &self.plan {
            _ if self.arrived => local.turn(input, self.goal.yaw),
            Some(plan) => local.follow(input, plan),
            None => Ok(Twist::ZERO),
        };
        if let Ok(twist) = velocity {
            self.valid_control_s = now_s;
            self.tell(if is_oscillating { Twist::ZERO } else { twist }, now_s);
            if self.trigger == Trigger::Controlling {
                self.recovery = 0;
            }
        } else {
            self.tell(Twist::ZERO, now_s);
            if now_s > self.valid_control_s + config.controller_patience_s {
                self.state = State::Clearing;
                self.trigger = Trigger::Controlling;
            } else {
                self.valid_plan_s = now_s;
                self.state = State::Planning;
                self.plan_at_s = now_s;
            }
        }
        NavigationState::Active
    }

    /// The next recovery behaviour, or the end.
    fn recover(&mut self, input: &MoveBaseInput<'_>, local: &mut LocalPlanner) -> NavigationState {
        let Some(recovery) = RECOVERIES.get(self.recovery) else {
            self.tell(Twist::ZERO, input.stamp_s);
            return NavigationState::Aborted(abort_text(self.trigger).to_owned());
        };
        match *recovery {
            Recovery::Clear(distance_m) => {
                local.clear_beyond(&input.pose_in_odom, distance_m);
                self.recovered(input.stamp_s);
            }
            Recovery::Rotate => self.rotation = Some(Rotation::new(input.pose_in_odom.yaw)),
        }
        NavigationState::Active
    }

    /// A recovery behaviour is over: plan again.
    fn recovered(&mut self, now_s: f64) {
        self.tell(Twist::ZERO, now_s);
        self.moved.1 = now_s;
        self.valid_plan_s = now_s;
        self.plan_at_s = now_s;
        self.state = State::Planning;
        self.recovery += 1;
    }

    fn tell(&mut self, twist: Twist, now_s: f64) {
        (self.twist, self.told_s) = (twist, now_s);
    }
}
