//! Configuration files: raw serde structs that become validated types (floor 2).

mod preset;
mod robot;

pub use preset::{NavigationSettings, Preset, PresetError};
pub use robot::{CostmapConfig, LidarConfig, RobotConfig, RobotConfigError};
