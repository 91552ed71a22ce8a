//! Configuration files: raw serde structs that become validated types (floor 2).

mod explained;
mod found_live;
mod live;
mod merge;
mod names;
mod node;
mod node_error;
mod params;
mod preset;
mod robot;
mod robots;
mod setting;

pub use explained::{ExplainError, Explained};
pub use found_live::{FoundLive, is_same};
pub use live::{Live, LiveError, LiveNode, LiveParam, live_names};
pub use names::hint;
pub use node::{NodeParams, TurnBy};
pub use node_error::NodeParamsError;
pub use params::{ParamError, read_params};
pub use preset::{Drive, NavigationSettings, Preset, PresetError};
pub use robot::{CostmapConfig, LidarConfig, RobotConfig, RobotConfigError};
pub use robots::{BUILTIN_ROBOTS, builtin_robot};
pub use setting::{Choice, Setting};
