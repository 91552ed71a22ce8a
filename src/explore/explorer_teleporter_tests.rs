//! A robot for tests: it jumps to its goals and sees three cells far.

use crate::explore::{End, Explorer, ExplorerSettings, RobotTraits};
use crate::geometry::{Body, Footprint, MotionLimits, Pose};
use crate::grid::{Inflation, OccupancyGrid};
use crate::robot::{Command, MapSnapshot, Navigation, NavigationState, Observation};
use crate::scan::Sight;
use std::f64::consts::TAU;
use std::sync::Arc;

/// A point with a lidar that sees three cells far.
pub fn point_robot() -> RobotTraits {
    let sight = Sight { range_m: 3.0, field_of_view_rad: TAU, heading_rad: 0.0 };
    RobotTraits { inflation: POINT_ROBOT, body: BODY, sight }
}

pub const POINT_ROBOT: Inflation =
    Inflation { inscribed_radius_m: 0.0, clear_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };

pub const BODY: Body = Body {
    footprint: Footprint::RadiusM(0.1),
    limits: MotionLimits { max_linear_mps: 0.5, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 },
};

/// A robot that sees three cells far, arrives at every goal at once and turns at once.
pub struct Teleporter {
    pub world: OccupancyGrid,
    pub map: OccupancyGrid,
    pub pose: Pose,
    pub stamp_s: f64,
    pub navigation: Navigation,
    pub aborts: bool,
    pub moves: bool,
    /// It is not let turn on the spot.
    pub cannot_turn: bool,
    /// It drives so far in a second, straight ahead, instead of jumping.
    pub stride_m: Option<f64>,
    /// It comes to rest a little before its goals, and nobody calls that arrived.
    pub stops_short: bool,
    /// Each map comes with a correction of its pose.
    pub is_corrected: bool,
    pub home: Pose,
    pub log: Vec<Command>,
}

/// A place between two, three quarters of a metre from the first.
fn halfway(from: &Pose, to: &Pose) -> Pose {
    let heading = Pose::facing(from.position(), to.position()).yaw;
    Pose::new(from.x + 0.75 * heading.cos(), from.y + 0.75 * heading.sin(), heading)
}

impl Teleporter {
    pub fn new(world: &str, x: f64, y: f64) -> Self {
        let world = OccupancyGrid::from_ascii(world).unwrap();
        let map = OccupancyGrid::filled(*world.info(), OccupancyGrid::UNKNOWN);
        let navigation = Navigation { command: 0, state: NavigationState::Idle };
        let pose = Pose::new(x, y, 0.0);
        Self {
            world,
            map,
            pose,
            stamp_s: 0.0,
            navigation,
            aborts: false,
            moves: true,
            cannot_turn: false,
            stride_m: None,
            stops_short: false,
            is_corrected: false,
            home: pose,
            log: Vec::new(),
        }
    }

    pub fn observation(&mut self) -> Observation {
        let here = self.map.info().cell_at(self.pose.position());
        for dy in -3..=3 {
            for dx in -3..=3 {
                let cell = here.offset((dx, dy));
                if let Some(value) = self.world.get(cell) {
                    self.map.set(cell, value);
                }
            }
        }
        self.stamp_s += 1.0;
        let correction_m = if self.is_corrected && self.stamp_s % 2.0 == 0.0 { 0.07 } else { 0.0 };
        Observation {
            stamp_s: self.stamp_s,
            pose_in_map: Ok(Pose::new(self.pose.x + correction_m, self.pose.y, self.pose.yaw)),
            map: Some(MapSnapshot::alone(self.stamp_s, self.stamp_s as u64, Arc::new(self.map.clone()))),
            scan: None,
            navigation: self.navigation.clone(),
        }
    }

    pub fn obey(&mut self, command: &Command) {
        let (id, state) = match command {
            Command::Hold => (0, NavigationState::Idle),
            Command::Turn { id, .. } if self.cannot_turn => (*id, NavigationState::Aborted("no room".to_owned())),
            Command::Turn { id, .. } | Command::BackOff { id } => (*id, NavigationState::Succeeded),
            Command::Drive { id, goal_in_map } if self.aborts => {
                if self.moves {
                    // Now here, now there, and never to a goal.
                    let home = self.home;
                    self.pose =
                        if self.pose.distance_to(home.position()) > 0.1 { home } else { halfway(&home, goal_in_map) };
                }
                (*id, NavigationState::Aborted("no way".to_owned()))
            }
            Command::Drive { id, goal_in_map } if self.stops_short => {
                self.pose = goal_in_map.compose(&Pose::new(-0.2, 0.0, 0.0));
                (*id, NavigationState::Active)
            }
            Command::Drive { id, goal_in_map }
                if self.stride_m.is_some_and(|stride_m| self.pose.distance_to(goal_in_map.position()) > stride_m) =>
            {
                let heading = Pose::facing(self.pose.position(), goal_in_map.position()).yaw;
                let stride_m = self.stride_m.unwrap_or_default();
                self.pose =
                    Pose::new(self.pose.x + stride_m * heading.cos(), self.pose.y + stride_m * heading.sin(), heading);
                (*id, NavigationState::Active)
            }
            Command::Drive { id, goal_in_map } => {
                self.pose = *goal_in_map;
                (*id, NavigationState::Succeeded)
            }
        };
        if self.log.last() != Some(command) {
            self.log.push(command.clone());
        }
        self.navigation = Navigation { command: id, state };
    }

    pub fn explore(&mut self, settings: ExplorerSettings) -> (End, Explorer) {
        let mut explorer = Explorer::new(settings, &point_robot()).unwrap();
        let end = self.follow(&mut explorer, 2000).expect("the run did not end");
        (end, explorer)
    }

    /// Does what an explorer asks for, up to so many steps, until it ends.
    pub fn follow(&mut self, explorer: &mut Explorer, steps: usize) -> Option<End> {
        (0..steps).find_map(|_| {
            let decision = explorer.step(&self.observation());
            self.obey(&decision.command);
            decision.end
        })
    }
}
