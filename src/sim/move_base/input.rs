//! What the stand-in for move_base sees at one control tick.

use crate::geometry::{Pose, Twist};
use crate::grid::{OccupancyGrid, Snapshot};
use crate::scan::LaserScan;

/// What the stand-in sees at one control tick.
#[derive(Clone, Copy, Debug)]
pub struct MoveBaseInput<'a> {
    /// Now, seconds.
    pub stamp_s: f64,
    /// Until the next tick, seconds.
    pub dt_s: f64,
    /// Where the wheels believe the base is.
    pub pose_in_odom: Pose,
    /// Where the odometry's frame is believed to lie in the map.
    pub map_from_odom: Pose,
    /// How it moves.
    pub twist: Twist,
    /// The newest map.
    pub map: &'a Snapshot<OccupancyGrid>,
    /// The newest scan with the lidar's pose in the odometry's frame.
    pub scan: (&'a Pose, &'a LaserScan),
}

impl MoveBaseInput<'_> {
    /// Where the base is believed to be in the map.
    pub(super) fn pose_in_map(&self) -> Pose {
        self.map_from_odom.compose(&self.pose_in_odom)
    }
}
