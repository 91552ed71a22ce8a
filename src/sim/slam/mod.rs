//! How the simulated robot knows where it is, and the map that comes of it.

mod config;
mod matched;
mod new_map;
mod perfect;
mod sweep;

pub use config::{SlamConfig, SlamKind};
pub(super) use sweep::Sweep;

use super::schedule::Micros;
use super::{MapperError, SimConfig};
use crate::geometry::{Point, Pose};
use crate::grid::{OccupancyGrid, Snapshot};
use matched::MatchedSlam;
use new_map::NewMap;
use perfect::PerfectSlam;

/// One of the two kinds.
#[derive(Debug)]
pub(super) enum Slam {
    Perfect(Box<PerfectSlam>),
    Matched(Box<MatchedSlam>),
}

impl Slam {
    /// With the first sweep taken in, at time 0 and the robot at `start`; also gives the
    /// first map, of which what is seen is the map itself: nobody has erred yet. `anchor` is a
    /// cell corner of the world.
    pub(super) fn begin(
        config: &SimConfig,
        start: &Pose,
        anchor: Point,
        mount: Pose,
        first: &Sweep,
    ) -> Result<(Self, Snapshot<OccupancyGrid>), MapperError> {
        Ok(match config.slam.kind {
            SlamKind::Perfect => {
                let (slam, grid) = PerfectSlam::begin(config.mapper, start, anchor, first)?;
                (Self::Perfect(Box::new(slam)), grid)
            }
            SlamKind::Matched => {
                let (slam, grid) = MatchedSlam::begin(config, start, anchor, mount, first)?;
                (Self::Matched(Box::new(slam)), grid)
            }
        })
    }

    /// When something happens next by itself.
    pub(super) fn next(&self) -> Micros {
        match self {
            Self::Perfect(slam) => slam.next(),
            Self::Matched(slam) => slam.next(),
        }
    }

    /// Takes a sweep that was taken now.
    pub(super) fn add(&mut self, sweep: &Sweep, now: Micros) -> Result<(), MapperError> {
        match self {
            Self::Perfect(slam) => slam.add(sweep, now),
            Self::Matched(slam) => slam.add(sweep, now),
        }
    }

    /// The map that is published now, if one is; `newest` is the newest sweep.
    pub(super) fn publish(&mut self, newest: &Sweep, now: Micros) -> Result<Option<NewMap>, MapperError> {
        match self {
            Self::Perfect(slam) => slam.publish(newest, now),
            Self::Matched(slam) => Ok(slam.publish(now)),
        }
    }

    /// Remembers where the wheels believe the robot at a time.
    pub(super) fn note(&mut self, base_in_odom: &Pose, now: Micros) {
        if let Self::Matched(slam) = self {
            slam.note(base_in_odom, now);
        }
    }

    /// `map -> odom`: where the odometry's frame is believed to lie in the map.
    pub(super) fn map_from_odom(&self, base_in_world: &Pose, base_in_odom: &Pose) -> Pose {
        match self {
            Self::Perfect(_) => base_in_world.compose(&base_in_odom.inverse()),
            Self::Matched(slam) => slam.map_from_odom(),
        }
    }

    /// Where the robot is believed to be in the map, as late as it is known.
    pub(super) fn pose_in_map(&self, base_in_world: &Pose, now: Micros) -> Pose {
        match self {
            Self::Perfect(_) => *base_in_world,
            Self::Matched(slam) => slam.late_pose(now),
        }
    }

    /// How late the pose is known, seconds.
    pub(super) fn lateness_s(&self) -> f64 {
        match self {
            Self::Perfect(_) => 0.0,
            Self::Matched(slam) => slam.lateness_s(),
        }
    }

    /// Area of all cells seen so far, square metres.
    pub(super) fn known_area_m2(&self) -> f64 {
        match self {
            Self::Perfect(slam) => slam.known_area_m2(),
            Self::Matched(slam) => slam.known_area_m2(),
        }
    }
}

#[cfg(test)]
mod tests;
