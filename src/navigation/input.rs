//! What the navigator sees at one control tick.

use crate::geometry::{Pose, Twist};
use crate::grid::Costmap;
use crate::scan::LaserScan;
use std::sync::Arc;

/// What the navigator sees at one control tick.
#[derive(Clone, Copy, Debug)]
pub struct NavigationInput<'a> {
    /// Now, seconds.
    pub stamp_s: f64,
    /// Where the base frame is.
    pub pose_in_map: Pose,
    /// How it moves.
    pub twist: Twist,
    /// The newest costmap.
    pub costmap: &'a Arc<Costmap>,
    /// When the costmap was made, seconds: another stamp is another costmap.
    pub costmap_stamp_s: f64,
    /// The newest scan with the lidar's pose in the map frame.
    pub scan: Option<(&'a Pose, &'a LaserScan)>,
}
