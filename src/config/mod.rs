//! Configuration files: raw serde structs that become validated types (floor 2).

mod robot;

pub use robot::{CostmapConfig, LidarConfig, RobotConfig, RobotConfigError};
