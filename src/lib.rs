//! Autonomous frontier exploration for ROS 1 robots.
//!
//! One pipeline, written once, runs in a simulator, on bags and on a robot: an
//! occupancy grid goes in, frontiers are detected, a goal is chosen, the robot drives
//! there, and at the end a map_server map is saved. `ARCHITECTURE.md` shows the floors.

pub mod bag;
pub mod bits;
pub mod config;
pub mod control;
pub mod explore;
pub mod frontier;
pub mod geometry;
pub mod grid;
pub mod io;
pub mod mapping;
pub(crate) mod matching;
pub mod navigation;
#[cfg(feature = "ros")]
pub mod nodes;
pub mod planning;
pub mod range;
pub mod replay;
#[cfg(feature = "report")]
pub mod report;
pub mod robot;
#[cfg(feature = "ros")]
pub mod ros;
pub mod run;
pub mod scan;
pub mod selection;
pub mod sim;
pub mod tf;
