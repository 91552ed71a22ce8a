//! What the explorer knows of its robot: body, lidar and inflation.

use crate::geometry::Body;
use crate::grid::Inflation;
use crate::scan::Sight;

/// The robot, as far as decisions depend on it.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotTraits {
    /// For the costmaps that are made where the robot's navigation provides none.
    pub inflation: Inflation,
    /// Its outline and speeds.
    pub body: Body,
    /// What its lidar sees.
    pub sight: Sight,
}
