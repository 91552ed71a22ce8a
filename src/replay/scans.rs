//! The map that a recording lacks, made of its scans while it is played.

use super::inputs::Inputs;
use crate::bag::ScanMessage;
use crate::geometry::Pose;
use crate::grid::OccupancyGrid;
use crate::mapping::{BuilderConfig, MapBuilder, MapperError};
use crate::scan::LaserScan;

use crate::tf::{TransformBuffer, is_upside_down, planar};
use std::collections::VecDeque;

/// So many scans wait for the transforms of their time.
const WAITING: usize = 40;

/// Places scans by odometry and takes them into a map.
#[derive(Debug)]
pub struct ScanMapping {
    builder: MapBuilder,
    odom_frame: String,
    base_frame: String,
    waiting: VecDeque<ScanMessage>,
    /// Where the odometry's frame lies in the map.
    odom_in_map: Pose,
    without_pose: usize,
}

impl ScanMapping {
    /// An empty map of the robot and the odometry that were found; `None` without them.
    #[must_use]
    pub fn new(config: BuilderConfig, inputs: &Inputs) -> Option<Self> {
        Some(Self {
            builder: MapBuilder::new(config),
            odom_frame: inputs.odom_frame.clone()?,
            base_frame: inputs.base_frame.clone()?,
            waiting: VecDeque::new(),
            odom_in_map: Pose::default(),
            without_pose: 0,
        })
    }

    /// Takes a scan in as soon as tf knows its time; so many were taken in now.
    ///
    /// # Errors
    /// [`MapperError`] when the map would become too large.
    pub fn add(&mut self, scan: ScanMessage, transforms: &TransformBuffer) -> Result<usize, MapperError> {
        self.waiting.push_back(scan);
        let before = self.builder.taken;
        while let Some(message) = self.waiting.front() {
            let stamp_s = message.scan.stamp_s;
            let robot_in_odom = transforms.at(&self.odom_frame, &self.base_frame, stamp_s).ok();
            match (robot_in_odom, on_robot(transforms, &self.base_frame, message)) {
                (Some(robot), Some((mount, scan))) => {
                    let robot_in_odom = planar(&robot);
                    let robot_in_map = self.builder.add(&robot_in_odom, &mount, &scan)?;
                    self.odom_in_map = robot_in_map.compose(&robot_in_odom.inverse());
                }
                _ if self.waiting.len() <= WAITING => break,
                _ => self.without_pose += 1,
            }
            self.waiting.pop_front();
        }
        Ok(self.builder.taken - before)
    }

    /// The map so far, if a scan was taken in.
    #[must_use]
    pub fn map(&self) -> Option<OccupancyGrid> {
        self.builder.map().ok().flatten()
    }

    /// Where the odometry's frame lies in the map: what matching has corrected.
    #[must_use]
    pub const fn odom_in_map(&self) -> &Pose {
        &self.odom_in_map
    }

    /// Scans taken in, and of those the ones that were placed by odometry alone.
    #[must_use]
    pub const fn taken(&self) -> (usize, usize) {
        (self.builder.taken, self.builder.unmatched)
    }

    /// Scans for which tf had no place.
    #[must_use]
    pub fn without_pose(&self) -> usize {
        self.without_pose + self.waiting.len()
    }
}

/// A scan seen from the robot: where the lidar stands on it, and the scan turned upright.
/// `None` when tf does not lead there.
pub(super) fn on_robot(
    transforms: &TransformBuffer,
    base_frame: &str,
    message: &ScanMessage,
) -> Option<(Pose, LaserScan)> {
    let mount = transforms.latest(base_frame, &message.header.frame).ok()?.transform;
    let mut scan = message.scan.clone();
    if is_upside_down(&mount) {
        (scan.angle_min_rad, scan.angle_increment_rad) = (-scan.angle_min_rad, -scan.angle_increment_rad);
    }
    Some((planar(&mount), scan))
}
