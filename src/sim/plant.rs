//! The simulated robot without a mind: a body in a world, its lidar, and the mapper that
//! sees through it. Somebody else decides where it drives.
//!
//! What a map shows is what the lidar has seen of the world, published once in a while.
//! The map frame is the world's: with a perfect SLAM ([`super::SlamKind`]) in truth, with
//! one that matches scans as far as its estimate goes, and then the pose in the map is what
//! the robot believes. The body moves by the true one. Coverage counts what the scans in the
//! newest map have truly seen, wherever an erring SLAM has drawn it.

use super::published::Published;
use super::schedule::{Micros, Periodic, seconds};
use super::slam::{Slam, Sweep};
use super::{
    Coverage, DiffDrive, Lidar, MapperError, Odometry, SimConfig, SimConfigError, TargetArea, World, WorldError,
};
use crate::config::RobotConfig;
use crate::geometry::{Pose, Twist};
use crate::grid::{Costmap, LiveCostmap, OccupancyGrid, Snapshot};
use crate::robot::MapSnapshot;
use crate::scan::LaserScan;
use serde::Serialize;
use std::sync::Arc;

/// Why a simulation cannot begin.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimError {
    /// A setting that cannot be.
    #[error(transparent)]
    Config(#[from] SimConfigError),
    /// The robot cannot start where it shall.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The map cannot be made.
    #[error(transparent)]
    Mapper(#[from] MapperError),
}

/// What a run has come to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SimStats {
    /// Simulated time, seconds.
    pub sim_time_s: f64,
    /// Length of the true path, metres.
    pub distance_m: f64,
    /// All turning either way, radians.
    pub turned_rad: f64,
    /// Contacts with solid cells.
    pub collisions: usize,
    /// Share of the target area that the scans in the newest map have seen, 0 to 1.
    pub coverage: f64,
    /// Area of all cells that the mapper has seen, square metres.
    pub known_area_m2: f64,
    /// The target area, square metres.
    pub target_area_m2: f64,
}

/// What has sensed at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sensed {
    /// A sweep of the lidar was taken.
    pub scan: bool,
    /// A map was published, though it may be the same as before.
    pub map: bool,
}

/// The body, its lidar and its mapper.
pub struct Plant {
    world: Arc<World>,
    body: DiffDrive,
    lidar: Lidar,
    slam: Slam,
    mount: Pose,
    target: TargetArea,
    coverage: Coverage,
    now: Micros,
    sweep: Periodic,
    newest: Sweep,
    published: Published,
}

impl Plant {
    /// A robot at rest at a pose of the world, with its first scan taken and its first
    /// map published. `robot` is a validated configuration.
    ///
    /// # Errors
    /// [`SimError`] for a setting out of its range or a start where the robot does not
    /// fit.
    pub fn new(world: Arc<World>, robot: &RobotConfig, config: SimConfig, start: Pose) -> Result<Self, SimError> {
        config.validate()?;
        let target = TargetArea::new(&world, &robot.footprint, &start)?;
        let odometry = Odometry::new(config.odometry_noise(), config.seed);
        let body = DiffDrive::new(&world, &robot.footprint, robot.limits, start, odometry);
        let mut lidar_config = robot.lidar;
        lidar_config.noise_std_m = config.lidar_noise_std_m.unwrap_or(lidar_config.noise_std_m);
        let mut lidar = Lidar::new(lidar_config, config.seed);
        let costs = LiveCostmap::new(config.thresholds, robot.inflation());
        let newest = take_sweep(&mut lidar, &world, &body, 0.0);
        let anchor = world.info().origin_in_map().position();
        let (slam, grid) = Slam::begin(&config, &start, anchor, lidar_config.mount, &newest)?;
        let published = Published::begin(grid, costs);
        let mut coverage = Coverage::new(&target);
        coverage.update(&published.map.cells);
        let mut this = Self {
            world,
            body,
            lidar,
            slam,
            mount: lidar_config.mount,
            target,
            coverage,
            now: 0,
            sweep: Periodic::every_s(1.0 / lidar_config.rate_hz),
            newest,
            published,
        };
        // What falls on time 0 has just been done.
        this.sweep.is_due(0);
        Ok(this)
    }

    /// What the run has come to so far.
    #[must_use]
    pub fn stats(&self) -> SimStats {
        SimStats {
            sim_time_s: seconds(self.now),
            distance_m: self.body.distance_m(),
            turned_rad: self.body.turned_rad(),
            collisions: self.body.collisions(),
            coverage: self.coverage.share(),
            known_area_m2: self.slam.known_area_m2(),
            target_area_m2: self.target.area_m2(),
        }
    }

    /// Simulated time, seconds.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        seconds(self.now)
    }

    /// The true pose in the world, whose frame is the map's. No robot knows it.
    #[must_use]
    pub const fn pose(&self) -> Pose {
        self.body.pose()
    }

    /// Where the robot believes it is in the map, as late as it knows.
    #[must_use]
    pub fn pose_in_map(&self) -> Pose {
        self.slam.pose_in_map(&self.body.pose(), self.now)
    }

    /// How late that pose is, seconds.
    #[must_use]
    pub fn pose_lateness_s(&self) -> f64 {
        self.slam.lateness_s()
    }

    /// Where the odometry's frame is believed to lie in the map.
    #[must_use]
    pub fn map_from_odom(&self) -> Pose {
        self.slam.map_from_odom(&self.body.pose(), &self.body.pose_in_odom())
    }

    /// How it moves.
    #[must_use]
    pub const fn twist(&self) -> Twist {
        self.body.twist()
    }

    /// Where the wheels believe the robot is, from its start at the origin.
    #[must_use]
    pub const fn pose_in_odom(&self) -> Pose {
        self.body.pose_in_odom()
    }

    /// The newest published map.
    #[must_use]
    pub const fn map(&self) -> &Arc<OccupancyGrid> {
        &self.published.map.cells
    }

    /// The same with what changed since earlier ones, and the costmap made of it.
    #[must_use]
    pub fn map_snapshot(&self) -> MapSnapshot {
        self.published.snapshot()
    }

    /// The same without its costmap.
    #[must_use]
    pub const fn published_map(&self) -> &Snapshot<OccupancyGrid> {
        &self.published.map
    }

    /// The costmap of that map.
    #[must_use]
    pub const fn costmap(&self) -> &Arc<Costmap> {
        &self.published.costmap.cells
    }

    /// When that map was true, seconds.
    #[must_use]
    pub const fn map_stamp_s(&self) -> f64 {
        self.published.stamp_s
    }

    /// How many maps have been published.
    #[must_use]
    pub const fn map_version(&self) -> u64 {
        self.published.map.changes.version()
    }

    /// The newest scan with the lidar's pose in the map frame, as far as that is known.
    #[must_use]
    pub fn scan(&self) -> (Pose, &Arc<LaserScan>) {
        let lidar_in_map = match &self.slam {
            Slam::Perfect(_) => self.newest.lidar_in_world,
            Slam::Matched(_) => self.map_from_odom().compose(&self.lidar_in_odom()),
        };
        (lidar_in_map, &self.newest.scan)
    }

    /// Where the lidar was in the odometry's frame when it took that scan.
    #[must_use]
    pub fn lidar_in_odom(&self) -> Pose {
        self.newest.base_in_odom.compose(&self.mount)
    }

    /// The world it lives in.
    #[must_use]
    pub const fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// The area that coverage is a share of.
    #[must_use]
    pub const fn target(&self) -> &TargetArea {
        &self.target
    }

    /// What of that area has been seen.
    #[must_use]
    pub const fn coverage(&self) -> &Coverage {
        &self.coverage
    }

    pub(crate) fn now(&self) -> Micros {
        self.now
    }

    /// When something happens next by itself.
    pub(crate) fn next(&self) -> Micros {
        self.sweep.next().min(self.slam.next())
    }

    /// The body holds a twist until a time; what lies before is over.
    pub(crate) fn drive(&mut self, twist: &Twist, end: Micros) {
        if end > self.now {
            self.body.drive(&self.world, twist, seconds(end - self.now));
            self.now = end;
            self.slam.note(&self.body.pose_in_odom(), end);
        }
    }

    /// The scan and the map that are due now, in this order.
    ///
    /// # Errors
    /// [`MapperError`] when the map cannot grow any more.
    pub fn sense(&mut self) -> Result<Sensed, MapperError> {
        let mut sensed = Sensed { scan: self.sweep.is_due(self.now), map: false };
        if sensed.scan {
            self.newest = take_sweep(&mut self.lidar, &self.world, &self.body, seconds(self.now));
            self.slam.add(&self.newest, self.now)?;
        }
        if let Some(map) = self.slam.publish(&self.newest, self.now)? {
            sensed.map = true;
            // On known ground nothing changes for long, and counting takes its time.
            if self.published.renew(map.stamp_s, map.grid) {
                self.coverage.update(&map.seen.cells);
            }
        }
        Ok(sensed)
    }
}

/// A sweep from where the body is.
fn take_sweep(lidar: &mut Lidar, world: &World, body: &DiffDrive, stamp_s: f64) -> Sweep {
    let lidar_in_world = lidar.pose(&body.pose());
    let scan = Arc::new(lidar.sweep(world, &lidar_in_world, stamp_s));
    Sweep { lidar_in_world, base_in_odom: body.pose_in_odom(), scan }
}
