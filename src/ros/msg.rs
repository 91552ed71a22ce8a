//! The ROS messages, from the package in `msg/`.
pub use frontier_explorer_msgs::*;
