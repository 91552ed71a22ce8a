//! What decides a simulated run, and what is made of it: `frontier explore`, the runs of
//! `frontier compare` and `sim_node` all begin with a plan.

use super::{NamedWorld, PlanError};
use crate::config::{Preset, RobotConfig};
use crate::explore::Explorer;
use crate::geometry::Pose;
use crate::sim::{Driver, DriverKind, MapStyle, OdometryNoise, Plant, SimConfig, SimError, SimRobot, SlamKind};
use std::sync::Arc;

/// What decides a run: the same plan gives the same run, byte for byte.
#[derive(Clone)]
pub struct Plan {
    /// How to explore.
    pub preset: Preset,
    /// What explores: a validated robot.
    pub robot: RobotConfig,
    /// Where.
    pub world: NamedWorld,
    /// From where, metres and radians of the world's frame.
    pub start: Pose,
    /// Decides every random number.
    pub seed: u64,
    /// The values of the map.
    pub map_style: MapStyle,
    /// Standard deviation of ranges, metres, instead of the lidar's own.
    pub lidar_noise_std_m: Option<f64>,
    /// Errors of the odometry, instead of those that go with the SLAM.
    pub odometry_noise: Option<OdometryNoise>,
    /// How the robot knows where it is.
    pub slam: SlamKind,
    /// Who drives to goals.
    pub driver: DriverKind,
}

impl Plan {
    /// The robot at its start, and the explorer that has seen nothing.
    ///
    /// # Errors
    /// [`PlanError`] for a setting out of its range or a start where the robot does not fit.
    pub fn prepare(&self) -> Result<(SimRobot, Explorer), PlanError> {
        Ok((self.robot()?, Explorer::new(self.preset.explorer.clone(), &self.robot.traits())?))
    }

    /// The robot at its start, for who needs no explorer.
    ///
    /// # Errors
    /// [`PlanError`] for a start where the robot does not fit.
    pub fn robot(&self) -> Result<SimRobot, PlanError> {
        let navigator = self.preset.navigator(&self.robot.body());
        let world = Arc::clone(&self.world.world);
        SimRobot::new(world, &self.robot, self.sim_config(), navigator, self.start).map_err(|source| self.wrong(source))
    }

    /// The robot at its start without a mind, and who drives it to goals.
    ///
    /// # Errors
    /// As [`Self::prepare`].
    pub fn plant(&self) -> Result<(Plant, Driver), PlanError> {
        let config = self.sim_config();
        let world = Arc::clone(&self.world.world);
        let plant = Plant::new(world, &self.robot, config, self.start).map_err(|source| self.wrong(source))?;
        let own = self.preset.navigator(&self.robot.body());
        Ok((plant, Driver::new(config.driver, config.move_base, &self.robot, config.seed, own)))
    }

    /// The simulation's settings: the preset's, and the world's resolution, so that coverage
    /// and maps compare cell by cell.
    #[must_use]
    pub fn sim_config(&self) -> SimConfig {
        let mut config = SimConfig {
            seed: self.seed,
            lidar_noise_std_m: self.lidar_noise_std_m,
            control_period_s: self.preset.navigation.navigator.control_period_s,
            thresholds: self.preset.explorer.thresholds,
            odometry_noise: self.odometry_noise,
            driver: self.driver,
            ..SimConfig::default()
        };
        config.mapper.style = self.map_style;
        config.mapper.resolution_m = self.world.world.info().resolution_m();
        config.slam.kind = self.slam;
        config
    }

    fn wrong(&self, source: SimError) -> PlanError {
        PlanError::Sim { world: self.world.name.clone(), source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::builtin_robot;
    use crate::grid::Thresholds;
    use crate::io::load_world;
    use crate::robot::Robot;

    fn plan(slam: SlamKind) -> Plan {
        let (truth, name) = load_world("office").unwrap();
        let mut preset = Preset::built_in("wfd").unwrap();
        preset.explorer.thresholds = Thresholds { free_max: 10, occupied_min: 90 };
        Plan {
            preset,
            robot: builtin_robot("turtlebot2").unwrap(),
            world: NamedWorld::new(name, &truth).unwrap(),
            start: Pose::new(1.5, 7.9, 0.0),
            seed: 7,
            map_style: MapStyle::Cartographer,
            lidar_noise_std_m: None,
            odometry_noise: None,
            slam,
            driver: DriverKind::beside(slam),
        }
    }

    #[test]
    fn a_plant_begins_as_the_robot_of_the_same_plan() {
        for slam in [SlamKind::Perfect, SlamKind::Matched] {
            let plan = plan(slam);
            assert_eq!(plan.sim_config().thresholds, plan.preset.explorer.thresholds);
            let ((plant, driver), (mut robot, _)) = (plan.plant().unwrap(), plan.prepare().unwrap());
            assert_eq!(plant.map().data(), robot.map().data());
            assert_eq!(plant.pose_in_map(), robot.pose_in_map());
            let (_, scan) = robot.observe().unwrap().scan.unwrap();
            assert_eq!(plant.scan().1.ranges_m, scan.ranges_m);
            assert_eq!(matches!(driver, Driver::MoveBase { .. }), slam == SlamKind::Matched);
            // Costs follow the preset: no cell of a first map is as free as it wants.
            assert_eq!(plant.map().census(&plan.preset.explorer.thresholds).free, 0);
            assert!(plant.map().census(&Thresholds::default()).free > 0);
        }
    }

    #[test]
    fn what_cannot_begin_names_its_world() {
        let blocked = Plan { start: Pose::new(-9.0, 0.0, 0.0), ..plan(SlamKind::Perfect) };
        let error = blocked.plant().err().unwrap().to_string();
        assert!(error.starts_with("world office: "), "{error}");
        assert_eq!(blocked.prepare().err().unwrap().to_string(), error);
    }
}
