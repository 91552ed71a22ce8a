//! The ROS 1 adapter (floor 3): rosrust behind the guards that a robot needs, the robot
//! that the explorer sees through it, and the two nodes.
//!
//! rosrust, its traps and the ways round them stay in this room. Each node is an object
//! of its own ([`Node`]), so that one process may run several.

mod bell;
mod call;
mod clock;
mod clock_watch;
mod convert;
mod directory;
mod display;
mod embedded_master;
mod explore_node;
mod feed;
mod frames;
mod log;
mod map_feed;
mod master;
mod move_base;
pub mod msg;
mod node;
mod params;
mod pilot;
mod program;
mod region;
mod robot;
mod robot_map;
mod scan_feed;
mod sim_node;
pub mod stop;
mod transforms;
mod troubles;
mod turn_goals;

pub use call::{CallError, call};
pub use clock::RunClock;
pub use embedded_master::{EmbeddedMasterError, start_embedded_master};
pub use explore_node::{ExploreNodeError, explore_node, explore_with, receive_map};
pub use feed::Feed;
pub use log::{Level, Log};
pub use map_feed::{MapReader, ReceivedMap};
pub use master::{MasterError, probe};
pub use move_base::{GoalStatus, GoalTracker};
pub use node::{Node, NodeError};
pub use robot::RosRobot;
pub use sim_node::{Fault, SimNodeError, SimParams, SimParamsError, sim_node, simulate_with};
