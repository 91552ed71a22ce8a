//! Configuration files: raw serde structs that become validated types (floor 2).

mod preset;
mod robot;
mod robots;

pub use preset::{NavigationSettings, Preset, PresetError};
pub use robot::{CostmapConfig, LidarConfig, RobotConfig, RobotConfigError};
pub use robots::{BUILTIN_ROBOTS, builtin_robot};
