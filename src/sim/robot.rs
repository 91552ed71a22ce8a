//! The simulated robot behind the port that the explorer knows: a plant, and who drives it.

use super::schedule::{Micros, Periodic, seconds};
use super::{Coverage, Driver, MapperError, Plant, SimConfig, SimError, SimStats, TargetArea, World};
use crate::config::RobotConfig;
use crate::geometry::{Pose, Twist};
use crate::grid::OccupancyGrid;
use crate::navigation::Navigator;
use crate::planning::Path;
use crate::robot::{Command, Navigation, NavigationState, Observation, Robot, RobotError};
use std::sync::Arc;

/// The simulated robot.
pub struct SimRobot {
    plant: Plant,
    driver: Driver,
    control_period_s: f64,
    tick: Periodic,
    control: Periodic,
    twist_command: Twist,
    navigation: Navigation,
}

impl SimRobot {
    /// A robot at rest at a pose of the world, with its first scan taken and its
    /// first map published. `robot` is a validated configuration, and `navigator`, which drives
    /// where no stand-in for move_base does,
    /// was made for `config.control_period_s`.
    ///
    /// # Errors
    /// [`SimError`] for a setting out of its range or a start where the robot does
    /// not fit.
    pub fn new(
        world: Arc<World>,
        robot: &RobotConfig,
        config: SimConfig,
        navigator: Navigator,
        start: Pose,
    ) -> Result<Self, SimError> {
        Ok(Self {
            plant: Plant::new(world, robot, config, start)?,
            driver: Driver::new(config.driver, config.move_base, robot, config.seed, navigator),
            control_period_s: config.control_period_s,
            tick: Periodic::every_s(config.tick_period_s),
            control: Periodic::every_s(config.control_period_s),
            twist_command: Twist::ZERO,
            navigation: Navigation { command: 0, state: NavigationState::Idle },
        })
    }

    /// What the run has come to so far.
    #[must_use]
    pub fn stats(&self) -> SimStats {
        self.plant.stats()
    }

    /// The true pose in the world, whose frame is the map's.
    #[must_use]
    pub const fn pose(&self) -> Pose {
        self.plant.pose()
    }

    /// Where the robot believes it is in the map.
    #[must_use]
    pub fn pose_in_map(&self) -> Pose {
        self.plant.pose_in_map()
    }

    /// Where the odometry's frame is believed to lie in the map.
    #[must_use]
    pub fn map_from_odom(&self) -> Pose {
        self.plant.map_from_odom()
    }

    /// Where the wheels believe the robot is, from its start at the origin.
    #[must_use]
    pub const fn pose_in_odom(&self) -> Pose {
        self.plant.pose_in_odom()
    }

    /// The newest published map.
    #[must_use]
    pub const fn map(&self) -> &Arc<OccupancyGrid> {
        self.plant.map()
    }

    /// The path being followed, if any.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.driver.path()
    }

    /// The world it lives in.
    #[must_use]
    pub const fn world(&self) -> &Arc<World> {
        self.plant.world()
    }

    /// The area that coverage is a share of.
    #[must_use]
    pub const fn target(&self) -> &TargetArea {
        self.plant.target()
    }

    /// What of that area has been seen.
    #[must_use]
    pub const fn coverage(&self) -> &Coverage {
        self.plant.coverage()
    }

    /// Lets simulated time pass; what falls together happens in the order scan, map,
    /// command, so that each has the newest of the one before.
    fn advance_to(&mut self, end: Micros) -> Result<(), MapperError> {
        loop {
            self.plant.sense()?;
            if self.plant.now() >= end {
                return Ok(());
            }
            if self.control.is_due(self.plant.now()) {
                self.steer();
            }
            let next = end.min(self.control.next()).min(self.plant.next());
            self.plant.drive(&self.twist_command, next);
        }
    }

    fn steer(&mut self) {
        let was_given_up = matches!(self.navigation.state, NavigationState::Aborted(_));
        (self.twist_command, self.navigation) = self.driver.update(&self.plant, self.control_period_s);
        if !was_given_up && matches!(self.navigation.state, NavigationState::Aborted(_)) {
            // As explore_node asks move_base then.
            self.driver.clear_costmaps();
        }
    }
}

impl Robot for SimRobot {
    /// Lets simulated time pass until the next tick; the first is at time 0.
    fn observe(&mut self) -> Result<Observation, RobotError> {
        let tick = self.tick.next();
        self.advance_to(tick).map_err(|error| RobotError::Disconnected(format!("the mapper stopped: {error}")))?;
        self.tick.is_due(tick);
        let (lidar_in_map, scan) = self.plant.scan();
        Ok(Observation {
            stamp_s: seconds(self.plant.now()),
            pose_in_map: Ok(self.plant.pose_in_map()),
            map: Some(self.plant.map_snapshot()),
            scan: Some((lidar_in_map, Arc::clone(scan))),
            navigation: self.navigation.clone(),
        })
    }

    fn command(&mut self, command: &Command) -> Result<(), RobotError> {
        self.driver.command(command, self.plant.now_s());
        Ok(())
    }
}

#[cfg(test)]
mod tests;
