//! Carrying out commands with our own planner and controller (floor 2).
//!
//! The part of move_base in the simulator, and of the robot's driver where there is no
//! move_base: a goal becomes a path, the path velocity commands, and a goal that
//! cannot be reached is aborted with a reason. Pure: time and sensing arrive as
//! [`NavigationInput`].

mod back_off;
mod config;
mod drive;
mod feeler;
mod input;
mod turn;

pub use config::NavigatorConfig;
pub use input::NavigationInput;

use crate::control::Controller;
use crate::geometry::{Areas, Body, Twist};
use crate::grid::Costmap;
use crate::planning::{Driven, Fence, GlobalPlanner, Path};
use crate::robot::{Command, CommandId, Navigation, NavigationState};
use back_off::BackOff;
use drive::Drive;
use std::sync::Arc;
use turn::Turn;

/// What is being done.
#[derive(Debug)]
enum Activity {
    Idle,
    Drive(Drive),
    Turn { id: CommandId, turn: Turn },
    BackOff { id: CommandId, back_off: BackOff },
    Ended(Navigation),
}

/// Plans, follows and reports.
pub struct Navigator {
    config: NavigatorConfig,
    planner: Box<dyn GlobalPlanner>,
    controller: Box<dyn Controller>,
    body: Body,
    activity: Activity,
    driven: Driven,
    fence: Fence,
    opened: Option<Opened>,
}

/// A costmap as it came, and as it is for this robot.
struct Opened {
    came: Arc<Costmap>,
    /// Where it fits, whatever its areas say.
    walls: Arc<Costmap>,
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
        let fence = Fence::default();
        Self { config, planner, controller, body, activity: Activity::Idle, driven, fence, opened: None }
    }

    /// Plans within these areas from now on. They end no way that a robot outside needs to get in.
    pub fn set_areas(&mut self, areas: Areas) {
        self.fence = Fence::new(areas, self.body.footprint.inscribed_radius_m());
        self.opened = None;
        if let Activity::Drive(drive) = &mut self.activity {
            drive.plan_anew();
        }
    }

    /// Takes a command; the id of the one under way changes nothing.
    pub fn command(&mut self, command: &Command) {
        match *command {
            Command::Hold => self.activity = Activity::Idle,
            Command::Drive { id, .. } | Command::Turn { id, .. } | Command::BackOff { id }
                if self.current() == Some(id) => {}
            Command::Drive { id, goal_in_map: goal } => {
                self.controller.reset();
                self.activity = Activity::Drive(Drive::new(id, goal));
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
        let [walls, tight, roomy] = self.open(input);
        let input = &NavigationInput { costmap: &walls, ..*input };
        let (twist, navigation) = match &mut self.activity {
            Activity::Idle => return (Twist::ZERO, Navigation { command: 0, state: NavigationState::Idle }),
            Activity::Ended(navigation) => return (Twist::ZERO, navigation.clone()),
            Activity::Turn { id, turn } => {
                let (twist, done) = turn.update(&input.pose_in_map);
                let state = if done { NavigationState::Succeeded } else { NavigationState::Active };
                (twist, Navigation { command: *id, state })
            }
            Activity::BackOff { id, back_off } => {
                let (twist, state) = back_off.update(input);
                (twist, Navigation { command: *id, state })
            }
            Activity::Drive(drive) => {
                let (planner, controller) = (&mut *self.planner, &mut *self.controller);
                let (twist, state) = drive.update(input, [&tight, &roomy], &self.config, planner, controller);
                (twist, Navigation { command: drive.id, state })
            }
        };
        if navigation.state != NavigationState::Active {
            self.activity = Activity::Ended(navigation.clone());
        }
        (twist, navigation)
    }

    /// The costmap as it is for a robot that is where it is and came from where it came.
    fn open(&mut self, input: &NavigationInput<'_>) -> [Arc<Costmap>; 3] {
        let own = input.costmap.info().cell_at(input.pose_in_map.position());
        let is_lost = matches!(&self.activity, Activity::Drive(drive) if drive.path.is_none());
        if let Some(Opened { came, walls, tight, roomy, since_s }) = &self.opened
            && Arc::ptr_eq(came, input.costmap)
            && tight.is_passable(own)
            && !is_lost
            && input.stamp_s - since_s < OPENED_FOR_S
        {
            return [Arc::clone(walls), Arc::clone(tight), Arc::clone(roomy)];
        }
        let came = Arc::clone(input.costmap);
        let pose = &input.pose_in_map;
        let walls = self.driven.open(&came, pose);
        let tight = self.fence.close(&walls, pose);
        let roomy = match came.without_narrow() {
            Some(roomy) => self.fence.close(&self.driven.open(&Arc::new(roomy), pose), pose),
            None => Arc::clone(&tight),
        };
        let opened = [Arc::clone(&walls), Arc::clone(&tight), Arc::clone(&roomy)];
        self.opened = Some(Opened { came, walls, tight, roomy, since_s: input.stamp_s });
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

#[cfg(test)]
mod tests;
