//! From the parameters of `sim_node` to the plan of its run.

use super::SimNodeError;
use super::params::SimParams;
use crate::io::{load_preset, load_robot, load_world};
use crate::run::{NamedWorld, Plan};
use crate::sim::OdometryNoise;

/// The run that parameters describe, with the files that they name read.
///
/// # Errors
/// [`SimNodeError`] for a preset, a robot or a world that cannot be had.
pub fn plan(params: &SimParams) -> Result<Plan, SimNodeError> {
    let (robot, preset) = (load_robot(&params.robot)?, load_preset(&params.config)?);
    let (truth, name) = load_world(&params.world)?;
    let world = NamedWorld::new(name, &truth)?;
    let noise = |[turn_by_turn, turn_by_drive, drive_by_drive, drive_by_turn]: [f64; 4]| OdometryNoise {
        turn_by_turn,
        turn_by_drive,
        drive_by_drive,
        drive_by_turn,
    };
    Ok(Plan {
        start: params.start_pose()?.unwrap_or_else(|| world.world.most_open_spot()),
        preset,
        robot,
        world,
        seed: params.seed,
        map_style: params.map_style,
        lidar_noise_std_m: params.lidar_noise,
        odometry_noise: params.odometry_noise.map(noise),
        slam: params.slam,
        driver: params.driver,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::Thresholds;
    use serde_json::json;

    #[test]
    fn the_node_simulates_what_its_parameters_and_its_preset_say() {
        let folder = tempfile::tempdir().unwrap();
        let config = folder.path().join("strict.yaml");
        std::fs::write(&config, "explorer: {thresholds: {free_max: 5, occupied_min: 66}}").unwrap();
        let params = json!({
            "world": "maze", "config": config, "robot": "turtlebot3_burger", "start": [2.5, 2.5], "seed": 3,
            "slam": "perfect", "driver": "navigator", "lidar_noise": 0.02, "odometry_noise": [0.1, 0.2, 0.3, 0.4],
        });
        let plan = plan(&SimParams::from_tree(params).unwrap()).unwrap();
        let sim = plan.sim_config();
        assert_eq!(sim.thresholds, Thresholds { free_max: 5, occupied_min: 66 });
        assert_eq!((sim.seed, sim.lidar_noise_std_m), (3, Some(0.02)));
        let noise = sim.odometry_noise.unwrap();
        assert_eq!(
            [noise.turn_by_turn, noise.turn_by_drive, noise.drive_by_drive, noise.drive_by_turn],
            [0.1, 0.2, 0.3, 0.4]
        );
        assert_eq!((plan.world.name.as_str(), plan.robot.name.as_str()), ("maze", "turtlebot3_burger"));
        assert_eq!(plan.start, Pose::new(2.5, 2.5, 0.0));
    }
}
