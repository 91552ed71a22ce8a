//! The map that a recording lacks, made of its scans while it is played.

use super::inputs::Inputs;
use crate::bag::ScanMessage;
use crate::geometry::Pose;
use crate::grid::OccupancyGrid;
use crate::mapping::{BuilderConfig, MapBuilder, MapperError};
use crate::scan::LaserScan;

use crate::tf::{TransformBuffer, TransformError, frame_name, is_upside_down, planar};
use std::collections::{BTreeMap, VecDeque};

/// A scan waits so long for the transforms of its time, seconds: less than tf remembers.
const WAIT_S: f64 = 5.0;
/// The most scans that wait.
const MAX_WAITING: usize = 4000;

/// Scans that were left out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// How many.
    pub scans: usize,
    /// The lidar's frame.
    pub frame: String,
    /// Why, for the first of them.
    pub reason: String,
}

impl std::fmt::Display for LeftOut {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { scans, frame, reason } = self;
        write!(f, "{scans} scans in {frame} were left out: {reason}")
    }
}

/// Places scans by odometry and takes them into a map.
#[derive(Debug)]
pub struct ScanMapping {
    builder: MapBuilder,
    odom_frame: String,
    base_frame: String,
    /// In the order of their stamps.
    waiting: VecDeque<ScanMessage>,
    /// Where the odometry's frame lies in the map.
    odom_in_map: Pose,
    /// How many of which frame were left out for which reason.
    left_out: BTreeMap<(String, Why), (usize, String)>,
    seen: usize,
}

/// Why a scan is left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Why {
    /// Nothing tells where the lidar is on the robot.
    Lidar,
    /// Nothing tells where the robot was.
    Robot,
    /// The scan is older than all that tf tells.
    TooOld,
    /// No reading tells a distance.
    Empty,
    /// The map would become too large.
    TooFar,
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
            left_out: BTreeMap::new(),
            seen: 0,
        })
    }

    /// Takes a scan in as soon as tf knows its time; so many were taken in now. `now_s` is
    /// the time by the clock of the stamps.
    ///
    /// # Errors
    /// [`MapperError`] for a setting that cannot be.
    pub fn add(&mut self, scan: ScanMessage, transforms: &TransformBuffer, now_s: f64) -> Result<usize, MapperError> {
        self.seen += 1;
        let at = self.waiting.partition_point(|other| other.scan.stamp_s <= scan.scan.stamp_s);
        self.waiting.insert(at, scan);
        self.settle(transforms, now_s)
    }

    /// Takes in what waits and has a place, and gives up what has waited too long, or all
    /// the rest when `now_s` is infinite; so many were taken in now.
    ///
    /// # Errors
    /// [`MapperError`] for a setting that cannot be.
    pub fn settle(&mut self, transforms: &TransformBuffer, now_s: f64) -> Result<usize, MapperError> {
        let before = self.builder.taken;
        while let Some(message) = self.waiting.front() {
            let waited_s = now_s - message.scan.stamp_s;
            match self.place(message, transforms) {
                Ok((robot_in_odom, mount, scan)) => match self.builder.add(&robot_in_odom, &mount, &scan) {
                    Ok(robot_in_map) => self.odom_in_map = robot_in_map.compose(&robot_in_odom.inverse()),
                    Err(error @ MapperError::Config(_)) => return Err(error),
                    Err(error) => self.leave_out(Why::TooFar, error.to_string()),
                },
                Err((Why::Lidar | Why::Robot, _)) if waited_s <= WAIT_S && self.waiting.len() <= MAX_WAITING => break,
                Err((why, reason)) => self.leave_out(why, reason),
            }
            self.waiting.pop_front();
        }
        Ok(self.builder.taken - before)
    }

    /// Where the robot was by odometry, and the scan seen from it.
    fn place(
        &self,
        message: &ScanMessage,
        transforms: &TransformBuffer,
    ) -> Result<(Pose, Pose, LaserScan), (Why, String)> {
        let lidar = |error: TransformError| (Why::Lidar, error.to_string());
        let (mount, scan) = on_robot(transforms, &self.base_frame, message).map_err(lidar)?;
        if !self.builder.can_use(&scan) {
            let reason =
                "no reading tells a distance, or how far nothing is (map build --max-range tells it)".to_owned();
            return Err((Why::Empty, reason));
        }
        let robot = transforms.at(&self.odom_frame, &self.base_frame, scan.stamp_s);
        let robot = robot.map_err(|error| match &error {
            TransformError::OutOfHistory { at_s, oldest_s, .. } if at_s < oldest_s => (Why::TooOld, error.to_string()),
            _ => (Why::Robot, error.to_string()),
        })?;
        Ok((planar(&robot), mount, scan))
    }

    /// Counts the first scan that waits as left out.
    fn leave_out(&mut self, why: Why, reason: String) {
        if let Some(message) = self.waiting.front() {
            let frame = frame_name(&message.header.frame).to_owned();
            self.left_out.entry((frame, why)).or_insert((0, reason)).0 += 1;
        }
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

    /// All scans so far.
    #[must_use]
    pub const fn seen(&self) -> usize {
        self.seen
    }

    /// Scans for which tf had no place, or that could not be used.
    #[must_use]
    pub fn without_pose(&self) -> usize {
        self.left_out.values().map(|(scans, _)| scans).sum::<usize>() + self.waiting.len()
    }

    /// Which scans were left out, and why.
    pub fn left_out(&self) -> impl Iterator<Item = LeftOut> + '_ {
        self.left_out.iter().map(|((frame, _), (scans, reason))| LeftOut {
            scans: *scans,
            frame: frame.clone(),
            reason: reason.clone(),
        })
    }
}

/// A scan seen from the robot: where the lidar stands on it, and the scan turned upright.
///
/// # Errors
/// [`TransformError`] when tf does not lead there.
pub(super) fn on_robot(
    transforms: &TransformBuffer,
    base_frame: &str,
    message: &ScanMessage,
) -> Result<(Pose, LaserScan), TransformError> {
    let mount = transforms.latest(base_frame, &message.header.frame)?.transform;
    let scan = message.scan.clone();
    Ok((planar(&mount), if is_upside_down(&mount) { scan.turned_upright() } else { scan }))
}
