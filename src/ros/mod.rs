//! The ROS 1 adapter (floor 3): rosrust behind the guards that a robot needs, and the robot
//! that the explorer sees through it.
//!
//! rosrust, its traps and the ways round them stay in this room. Each node is an object
//! of its own ([`Node`]), so that one process may run several.

pub(crate) mod actionlib;
pub(crate) mod bell;
mod call;
mod clock;
mod clock_watch;
pub mod convert;
pub mod ctl;
mod directory;
pub(crate) mod display;
pub(crate) mod doctor;
pub(crate) mod dynamic_reconfigure;
mod embedded_master;
mod feed;
mod frames;
pub(crate) mod log;
pub(crate) mod map_feed;
mod master;
pub(crate) mod move_base;
pub mod msg;
mod node;
mod params;
pub(crate) mod pilot;
pub(crate) mod program;
pub mod region;
pub(crate) mod rivals;
pub(crate) mod robot;
pub(crate) mod robot_map;
pub(crate) mod scan_feed;
pub mod stop;
pub(crate) mod transforms;
pub(crate) mod troubles;
pub(crate) mod tuning;
mod turn_goals;

pub use actionlib::{GoalStatus, GoalTracker};
pub use call::{CallError, call};
pub use embedded_master::{EmbeddedMasterError, start_embedded_master};
pub use feed::Feed;
pub use frames::{Frames, ToldLink};
pub use log::{Level, Log};
pub use map_feed::{Recalled, ReceivedMap, Remembered, receive_map};
pub use master::{MasterError, probe};
pub use node::{Node, NodeError};
pub(crate) use params::ParamTree;
pub(crate) use robot::RosRobot;
pub(crate) use rosrust::{Publisher, Service};
