//! A SLAM that never errs: scans are put where they were taken, and the map comes by the
//! clock.

use super::super::motion_filter::MotionFilter;
use super::super::schedule::{Micros, Periodic, seconds};
use super::super::{Mapper, MapperConfig, MapperError};
use super::Sweep;
use super::new_map::NewMap;
use crate::geometry::{Point, Pose};
use crate::grid::{OccupancyGrid, Snapshot};

/// Mapping with known poses.
#[derive(Debug)]
pub struct PerfectSlam {
    config: MapperConfig,
    mapper: Mapper,
    publish: Periodic,
    filter: MotionFilter,
    /// Whether the map shows the newest sweep.
    is_mapped: bool,
}

impl PerfectSlam {
    /// With the first sweep taken in, and its map.
    pub(super) fn begin(
        config: MapperConfig,
        start: &Pose,
        anchor: Point,
        first: &Sweep,
    ) -> Result<(Self, Snapshot<OccupancyGrid>), MapperError> {
        let mut mapper = Mapper::new(config, start.position(), anchor)?;
        mapper.integrate(&first.lidar_in_world, &first.scan)?;
        let mut filter = MotionFilter::default();
        filter.accepts(&first.lidar_in_world, 0.0, &config);
        let grid = mapper.publish()?;
        let mut publish = Periodic::every_s(config.publish_period_s);
        // What falls on time 0 has just been done.
        publish.is_due(0);
        Ok((Self { config, mapper, publish, filter, is_mapped: true }, grid))
    }

    pub(super) const fn next(&self) -> Micros {
        self.publish.next()
    }

    pub(super) fn add(&mut self, sweep: &Sweep, now: Micros) -> Result<(), MapperError> {
        self.is_mapped = self.filter.accepts(&sweep.lidar_in_world, seconds(now), &self.config);
        if self.is_mapped {
            self.mapper.integrate(&sweep.lidar_in_world, &sweep.scan)?;
        }
        Ok(())
    }

    /// A map shows all that was sensed before its stamp.
    pub(super) fn publish(&mut self, newest: &Sweep, now: Micros) -> Result<Option<NewMap>, MapperError> {
        if !self.publish.is_due(now) {
            return Ok(None);
        }
        if !std::mem::replace(&mut self.is_mapped, true) {
            self.mapper.integrate(&newest.lidar_in_world, &newest.scan)?;
        }
        let grid = self.mapper.publish()?;
        Ok(Some(NewMap { seen: grid.clone(), grid, stamp_s: seconds(now) }))
    }

    pub(super) fn known_area_m2(&self) -> f64 {
        self.mapper.known_area_m2()
    }
}
