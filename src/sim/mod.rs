//! The built-in simulator: a world, a lidar, a body, a mapper, and a robot made of
//! them (rim). It reads no clock and no file, and draws every random number from a
//! seed: the same configuration gives the same run, byte for byte.

mod collision;
mod config;
mod coverage;
mod diff_drive;
mod driver;
mod lidar;
mod map_window;
mod mapper;
mod motion_filter;
mod move_base;
mod odometry;
mod plant;
mod published;
mod ray;
mod robot;
pub(crate) mod schedule;
mod slam;
mod world;

pub use collision::CollisionShape;
pub use config::{MapStyle, MapperConfig, SimConfig, SimConfigError};
pub use coverage::{Coverage, SENSED_MARGIN_M, TargetArea};
pub use diff_drive::DiffDrive;
pub use driver::{Driver, DriverKind};
pub use lidar::Lidar;
pub use mapper::{Mapper, MapperError};
pub use move_base::{InflatedPlanner, MoveBase, MoveBaseConfig, MoveBaseInput, global_planner_cell};
pub use odometry::{Odometry, OdometryNoise};
pub use plant::{Plant, Sensed, SimError, SimStats};
pub use robot::SimRobot;
pub use slam::{SlamConfig, SlamKind};
pub use world::{World, WorldError};
