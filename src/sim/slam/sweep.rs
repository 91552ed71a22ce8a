//! What is given to a SLAM: a sweep of the lidar, and where it was taken.

use crate::geometry::Pose;
use crate::scan::LaserScan;
use std::sync::Arc;

/// A sweep of the lidar and where it was taken.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Where the lidar truly was in the world.
    pub lidar_in_world: Pose,
    /// Where the wheels believed the robot's base.
    pub base_in_odom: Pose,
    /// The ranges.
    pub scan: Arc<LaserScan>,
}
