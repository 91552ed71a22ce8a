//! One simulated exploration, made ready from a preset, a robot and a world.

use anyhow::Context;
use frontier_explorer::config::{Preset, RobotConfig};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::OccupancyGrid;
use frontier_explorer::navigation::Navigator;
use frontier_explorer::sim::{DriverKind, MapStyle, SimConfig, SimRobot, SlamKind, World};
use std::sync::Arc;

/// A world that runs can share.
#[derive(Clone)]
pub struct NamedWorld {
    /// What reports call it.
    pub name: String,
    /// The world.
    pub world: Arc<World>,
}

impl NamedWorld {
    /// A world from its ground truth.
    pub fn new(name: String, truth: &OccupancyGrid) -> anyhow::Result<Self> {
        let world = World::new(truth, &SimConfig::default().thresholds).with_context(|| format!("world {name}"))?;
        Ok(Self { name, world: Arc::new(world) })
    }
}

/// What decides a run: the same plan gives the same run, byte for byte.
#[derive(Clone)]
pub struct Plan {
    /// How to explore.
    pub preset: Preset,
    /// What explores.
    pub robot: RobotConfig,
    /// Where.
    pub world: NamedWorld,
    /// From where.
    pub start: Pose,
    /// Decides every random number.
    pub seed: u64,
    /// The values of the map.
    pub map_style: MapStyle,
    /// Standard deviation of ranges, metres, instead of the lidar's own.
    pub lidar_noise_std_m: Option<f64>,
    /// How the robot knows where it is.
    pub slam: SlamKind,
}

/// Reads the name of a SLAM.
pub fn parse_slam(text: &str) -> Result<SlamKind, String> {
    let kinds = [SlamKind::Perfect, SlamKind::Matched];
    kinds.into_iter().find(|kind| kind.name() == text).ok_or_else(|| "must be perfect or matched".to_owned())
}

impl Plan {
    /// The robot at its start, and the explorer that has seen nothing.
    pub fn prepare(&self) -> anyhow::Result<(SimRobot, Explorer)> {
        let Self { preset, robot, world, .. } = self;
        let (body, navigation) = (robot.body(), &preset.navigation);
        let planner = preset.explorer.planner.build(&body);
        let navigator = Navigator::new(navigation.navigator, planner, navigation.controller.build(&body), &body);
        let sim = SimRobot::new(Arc::clone(&world.world), robot, self.sim_config(), navigator, self.start)
            .with_context(|| format!("world {}", world.name))?;
        let explorer = Explorer::new(preset.explorer.clone(), &robot.traits())?;
        Ok((sim, explorer))
    }

    fn sim_config(&self) -> SimConfig {
        let mut config = SimConfig {
            seed: self.seed,
            lidar_noise_std_m: self.lidar_noise_std_m,
            control_period_s: self.preset.navigation.navigator.control_period_s,
            thresholds: self.preset.explorer.thresholds,
            ..SimConfig::default()
        };
        config.mapper.style = self.map_style;
        config.slam.kind = self.slam;
        config.driver = match self.slam {
            SlamKind::Perfect => DriverKind::Navigator,
            SlamKind::Matched => DriverKind::MoveBase,
        };
        // The cells of the world: then coverage and maps compare cell by cell.
        config.mapper.resolution_m = self.world.world.info().resolution_m();
        config
    }
}
