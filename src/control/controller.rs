//! What a controller sees and tells: the contract of all that turn paths into velocities.

use crate::geometry::{Path, Pose, Twist};
use crate::grid::Costmap;
use crate::scan::LaserScan;

/// What a controller may look at.
#[derive(Clone, Copy, Debug)]
pub struct ControlInput<'a> {
    /// Where the base frame is.
    pub pose_in_map: Pose,
    /// How it moves now.
    pub twist: Twist,
    /// Where it shall go.
    pub path: &'a Path,
    /// What stands around, as known.
    pub costmap: &'a Costmap,
    /// The newest scan with the lidar's pose in the map frame.
    pub scan: Option<(&'a Pose, &'a LaserScan)>,
    /// Seconds until the next command.
    pub dt_s: f64,
}

/// Why no command can be given.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ControlError {
    /// Every motion along the path would end in an obstacle.
    #[error("no motion along the path is free of obstacles")]
    Blocked,
    /// The path has no poses.
    #[error("the path is empty")]
    EmptyPath,
}

/// Follows paths.
pub trait Controller: Send {
    /// The controller's name in configuration files.
    fn name(&self) -> &'static str;

    /// Forgets the progress along the last path: a new one begins.
    fn reset(&mut self);

    /// The command until the next call.
    ///
    /// # Errors
    /// [`ControlError`] when the robot should stand still.
    fn control(&mut self, input: &ControlInput<'_>) -> Result<Twist, ControlError>;
}
