//! The simulated robot without a mind: a body in a world, its lidar, and the mapper that
//! sees through it. Somebody else decides where it drives.
//!
//! The pose in the map is the true one, as of a SLAM that never errs; what a map shows
//! is what the lidar has seen of the world, published once in a while. The map frame is
//! the world's.

use super::motion_filter::MotionFilter;
use super::schedule::{Micros, Periodic, micros, seconds};
use super::{
    Coverage, DiffDrive, Lidar, Mapper, MapperError, Odometry, SimConfig, SimConfigError, TargetArea, World, WorldError,
};
use crate::config::RobotConfig;
use crate::geometry::{Pose, Twist};
use crate::grid::{Costmap, Inflation, OccupancyGrid};
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
    /// Share of the target area known in the newest map, 0 to 1.
    pub coverage: f64,
    /// Area of all cells that the mapper has seen, square metres.
    pub known_area_m2: f64,
    /// The target area, square metres.
    pub target_area_m2: f64,
}

/// A published map with the costmap made of it.
#[derive(Debug)]
struct Published {
    stamp_s: f64,
    version: u64,
    grid: Arc<OccupancyGrid>,
    costmap: Arc<Costmap>,
}

/// What has happened at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Happened {
    /// A sweep of the lidar was taken.
    pub scan: bool,
    /// A map was published, though it may be the same as before.
    pub map: bool,
}

/// The body, its lidar and its mapper.
pub struct Plant {
    config: SimConfig,
    inflation: Inflation,
    world: Arc<World>,
    body: DiffDrive,
    lidar: Lidar,
    mapper: Mapper,
    target: TargetArea,
    coverage: Coverage,
    now: Micros,
    sweep: Periodic,
    publish: Periodic,
    scan: (Pose, Arc<LaserScan>),
    /// Whether the map shows that scan.
    is_mapped: bool,
    filter: MotionFilter,
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
        let odometry = Odometry::new(config.odometry_noise, config.seed);
        let body = DiffDrive::new(&world, &robot.footprint, robot.limits, start, odometry);
        let mut lidar_config = robot.lidar;
        lidar_config.noise_std_m = config.lidar_noise_std_m.unwrap_or(lidar_config.noise_std_m);
        let mut lidar = Lidar::new(lidar_config, config.seed);
        let mut mapper = Mapper::new(config.mapper, start.position(), world.info().origin_in_map().position())?;
        let inflation = robot.inflation();
        let lidar_pose = lidar.pose(&start);
        let scan = (lidar_pose, Arc::new(lidar.sweep(&world, &lidar_pose, 0.0)));
        mapper.integrate(&scan.0, &scan.1)?;
        let mut filter = MotionFilter::default();
        filter.accepts(&lidar_pose, 0.0, &config.mapper);
        let grid = mapper.publish()?;
        let costmap = Costmap::inflate(&grid, &config.thresholds, &inflation);
        let published = Published { stamp_s: 0.0, version: 1, grid, costmap: Arc::new(costmap) };
        let mut coverage = Coverage::new(&target);
        coverage.update(&published.grid);
        let mut this = Self {
            config,
            inflation,
            world,
            body,
            lidar,
            mapper,
            target,
            coverage,
            now: 0,
            sweep: Periodic::every_s(1.0 / lidar_config.rate_hz),
            publish: Periodic::every_s(config.mapper.publish_period_s),
            scan,
            is_mapped: true,
            filter,
            published,
        };
        // What falls on time 0 has just been done.
        this.sweep.is_due(0);
        this.publish.is_due(0);
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
            known_area_m2: self.mapper.known_area_m2(),
            target_area_m2: self.target.area_m2(),
        }
    }

    /// Simulated time, seconds.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        seconds(self.now)
    }

    /// The true pose in the world, whose frame is the map's.
    #[must_use]
    pub const fn pose(&self) -> Pose {
        self.body.pose()
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
        &self.published.grid
    }

    /// The costmap of that map.
    #[must_use]
    pub const fn costmap(&self) -> &Arc<Costmap> {
        &self.published.costmap
    }

    /// When that map was true, seconds.
    #[must_use]
    pub const fn map_stamp_s(&self) -> f64 {
        self.published.stamp_s
    }

    /// How many maps have been published.
    #[must_use]
    pub const fn map_version(&self) -> u64 {
        self.published.version
    }

    /// The newest scan with the lidar's pose in the map frame.
    #[must_use]
    pub const fn scan(&self) -> &(Pose, Arc<LaserScan>) {
        &self.scan
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

    /// When something happens next by itself, seconds.
    #[must_use]
    pub fn next_s(&self) -> f64 {
        seconds(self.next())
    }

    /// The body holds a twist until a time in seconds; what lies before is over.
    pub fn drive_until_s(&mut self, twist: &Twist, end_s: f64) {
        self.drive(twist, micros(end_s));
    }

    pub(super) fn now(&self) -> Micros {
        self.now
    }

    pub(super) fn next(&self) -> Micros {
        self.sweep.next().min(self.publish.next())
    }

    pub(super) fn drive(&mut self, twist: &Twist, end: Micros) {
        if end > self.now {
            self.body.drive(&self.world, twist, seconds(end - self.now));
            self.now = end;
        }
    }

    /// The scan and the map that are due now, in this order.
    ///
    /// # Errors
    /// [`MapperError`] when the map cannot grow any more.
    pub fn happen(&mut self) -> Result<Happened, MapperError> {
        let stamp_s = seconds(self.now);
        let happened = Happened { scan: self.sweep.is_due(self.now), map: self.publish.is_due(self.now) };
        if happened.scan {
            let pose = self.lidar.pose(&self.body.pose());
            self.scan = (pose, Arc::new(self.lidar.sweep(&self.world, &pose, stamp_s)));
            self.is_mapped = self.filter.accepts(&pose, stamp_s, &self.config.mapper);
            if self.is_mapped {
                self.mapper.integrate(&pose, &self.scan.1)?;
            }
        }
        if happened.map {
            // A map shows all that was sensed before its stamp.
            if !std::mem::replace(&mut self.is_mapped, true) {
                self.mapper.integrate(&self.scan.0, &self.scan.1)?;
            }
            let grid = self.mapper.publish()?;
            self.published.stamp_s = stamp_s;
            self.published.version += 1;
            // On known ground nothing changes for long, and inflating takes its time.
            if grid != self.published.grid {
                let Published { version, grid: old, costmap, .. } = &self.published;
                let version = *version;
                let costmap = costmap.reinflate(old, &grid, &self.config.thresholds, &self.inflation);
                self.published = Published { stamp_s, version, grid, costmap: Arc::new(costmap) };
                self.coverage.update(&self.published.grid);
            }
        }
        Ok(happened)
    }
}
