//! Who drives the simulated robot to its goals.

use super::move_base::{MoveBase, MoveBaseInput};
use super::{DriverKind, MoveBaseConfig, Plant};
use crate::config::RobotConfig;
use crate::geometry::{Path, Pose, Twist};
use crate::grid::Costmap;
use crate::navigation::{NavigationInput, Navigator};
use crate::robot::{Command, CommandId, Navigation};
use std::sync::Arc;

/// Drives to goals.
pub enum Driver {
    /// Our own navigator.
    Navigator(Box<Navigator>),
    /// The stand-in for move_base. What is no goal is done by our own navigator, as
    /// explore_node does it by velocities.
    MoveBase {
        /// The stand-in.
        stand_in: Box<MoveBase>,
        /// For turns on the spot and for backing off.
        own: Box<Navigator>,
        /// Whether the command under way is a goal.
        is_goal: bool,
    },
}

impl Driver {
    /// A driver for a robot; `seed` decides the stand-in's delays.
    #[must_use]
    pub fn new(kind: DriverKind, config: MoveBaseConfig, robot: &RobotConfig, seed: u64, own: Navigator) -> Self {
        let own = Box::new(own);
        match kind {
            DriverKind::Navigator => Self::Navigator(own),
            DriverKind::MoveBase => {
                Self::MoveBase { stand_in: Box::new(MoveBase::new(config, robot, seed)), own, is_goal: false }
            }
        }
    }

    /// Takes a command at a time in seconds; the id of the one under way changes nothing.
    pub fn command(&mut self, command: &Command, now_s: f64) {
        match self {
            Self::Navigator(navigator) => navigator.command(command),
            Self::MoveBase { stand_in, own, is_goal } => {
                *is_goal = matches!(command, Command::Drive { .. });
                match *command {
                    Command::Drive { id, goal_in_map } => {
                        own.command(&Command::Hold);
                        stand_in.send(id, goal_in_map, now_s);
                    }
                    Command::Hold | Command::Turn { .. } | Command::BackOff { .. } => {
                        stand_in.cancel();
                        if matches!(command, Command::BackOff { .. }) {
                            // As explore_node asks move_base then.
                            stand_in.clear_costmaps();
                        }
                        own.command(command);
                    }
                }
            }
        }
    }

    /// Forgets obstacles that are not seen any more, as move_base's service does.
    pub fn clear_costmaps(&mut self) {
        if let Self::MoveBase { stand_in, .. } = self {
            stand_in.clear_costmaps();
        }
    }

    /// Drives to a goal.
    pub fn drive(&mut self, id: CommandId, goal_in_map: Pose, now_s: f64) {
        self.command(&Command::Drive { id, goal_in_map }, now_s);
    }

    /// The velocity until the next control tick, `dt_s` seconds on, and how the command is
    /// doing.
    pub fn update(&mut self, plant: &Plant, dt_s: f64) -> (Twist, Navigation) {
        let (lidar_in_map, scan) = plant.scan();
        let input = NavigationInput {
            stamp_s: plant.now_s(),
            pose_in_map: plant.pose_in_map(),
            twist: plant.twist(),
            costmap: plant.costmap(),
            costmap_stamp_s: plant.map_stamp_s(),
            scan: Some((&lidar_in_map, scan)),
        };
        match self {
            Self::Navigator(navigator) => navigator.update(&input),
            Self::MoveBase { stand_in, own, is_goal } => {
                let driven = stand_in.update(&MoveBaseInput {
                    stamp_s: plant.now_s(),
                    dt_s,
                    pose_in_odom: plant.pose_in_odom(),
                    map_from_odom: plant.map_from_odom(),
                    twist: plant.twist(),
                    map: plant.published_map(),
                    scan: (&plant.lidar_in_odom(), scan),
                });
                if *is_goal { driven } else { own.update(&input) }
            }
        }
    }

    /// The path being followed, if any.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Navigator(navigator) => navigator.path(),
            Self::MoveBase { stand_in, .. } => stand_in.path(),
        }
    }

    /// The costmap that goals are planned on.
    #[must_use]
    pub fn costmap<'a>(&'a self, plant: &'a Plant) -> &'a Arc<Costmap> {
        match self {
            Self::Navigator(_) => plant.costmap(),
            Self::MoveBase { stand_in, .. } => stand_in.costmap().unwrap_or_else(|| plant.costmap()),
        }
    }
}
