//! The growing map: each scan is placed by odometry, matched, and taken in.

use crate::geometry::{Point, Pose, shortest_angle};
use crate::grid::OccupancyGrid;
use crate::matching::{LikelihoodField, Match, Prior, match_scan, thinned_hits};
use crate::scan::{BEYOND_ALL_LIDARS_M, LaserScan};
use crate::sim::{Mapper, MapperConfig, MapperError};

/// How far a lidar is believed where nobody says otherwise, metres: a map of all that lies
/// within is some 2000 cells to each side of the robot.
const REACH_M: f64 = 100.0;

/// How a map is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BuilderConfig {
    /// The mapper.
    pub mapper: MapperConfig,
    /// Readings beyond this many metres only clear, up to there; when infinite, beyond the
    /// lidar's limit or 100 m.
    pub max_range_m: f64,
    /// Whether scans are matched; else odometry is believed.
    pub is_matching: bool,
    /// A match below this mean likelihood is not believed.
    pub min_likelihood: f64,
    /// At most so many points of a scan are matched.
    pub max_points: usize,
}

impl Default for BuilderConfig {
    fn default() -> Self {
        let mapper =
            MapperConfig { filter_distance_m: 0.05, filter_angle_rad: 0.05, filter_time_s: 5.0, ..Default::default() };
        Self { mapper, max_range_m: f64::INFINITY, is_matching: true, min_likelihood: 0.3, max_points: 180 }
    }
}

impl BuilderConfig {
    /// The default with cells of an edge length in metres.
    #[must_use]
    pub fn with_resolution(resolution_m: f64) -> Self {
        let default = Self::default();
        Self { mapper: MapperConfig { resolution_m, ..default.mapper }, ..default }
    }
}

/// A map under way.
#[derive(Debug)]
pub struct MapBuilder {
    config: BuilderConfig,
    mapper: Option<Mapper>,
    field: Option<LikelihoodField>,
    /// Where the last scan taken in was by odometry and in the map, and when.
    last: Option<(Pose, Pose, f64)>,
    /// Scans taken in.
    pub taken: usize,
    /// Scans that did not fit, and were placed by odometry.
    pub unmatched: usize,
}

impl MapBuilder {
    /// An empty map; its frame is that of the first odometry.
    #[must_use]
    pub const fn new(config: BuilderConfig) -> Self {
        Self { config, mapper: None, field: None, last: None, taken: 0, unmatched: 0 }
    }

    /// The map so far, if a scan was taken in.
    ///
    /// # Errors
    /// Never for a map that grew without one.
    pub fn map(&self) -> Result<Option<OccupancyGrid>, MapperError> {
        self.mapper.as_ref().map(Mapper::map).transpose()
    }

    /// Takes a scan in and tells where the robot was in the map. `robot_in_odom` is what
    /// odometry said at the time of the scan, `mount` where the lidar stands on the robot.
    ///
    /// # Errors
    /// [`MapperError`] for a setting that cannot be, or a map that would become too large.
    pub fn add(&mut self, robot_in_odom: &Pose, mount: &Pose, scan: &LaserScan) -> Result<Pose, MapperError> {
        let Some((odom, placed, last_s)) = self.last else {
            return self.take(robot_in_odom, *robot_in_odom, mount, scan);
        };
        let moved = odom.inverse().compose(robot_in_odom);
        let told = placed.compose(&moved);
        let (way_m, turn_rad) = (moved.x.hypot(moved.y), shortest_angle(0.0, moved.yaw).abs());
        let MapperConfig { filter_distance_m, filter_angle_rad, filter_time_s, .. } = self.config.mapper;
        if way_m < filter_distance_m && turn_rad < filter_angle_rad && scan.stamp_s - last_s < filter_time_s {
            return Ok(told);
        }
        let prior = Prior::after_motion(&placed, &moved);
        let mut pose = told;
        if let (true, Some(field)) = (self.config.is_matching, &self.field) {
            let points = thinned_hits(&self.limited(scan), mount, self.config.max_points);
            let Match { pose: matched, likelihood } = match_scan(field, &points, &prior);
            if points.len() >= 20 && likelihood >= self.config.min_likelihood {
                pose = matched;
            } else {
                self.unmatched += 1;
            }
        }
        self.take(robot_in_odom, pose, mount, scan)
    }

    /// Takes a scan into the map at a pose.
    fn take(&mut self, odom: &Pose, pose: Pose, mount: &Pose, scan: &LaserScan) -> Result<Pose, MapperError> {
        if self.mapper.is_none() {
            self.mapper = Some(Mapper::new(self.config.mapper, pose.position(), Point::origin())?);
        }
        let cut = self.limited(scan);
        if let Some(mapper) = &mut self.mapper {
            mapper.integrate(&pose.compose(mount), &cut)?;
            if self.config.is_matching {
                self.field = Some(LikelihoodField::of(&mapper.publish()?.cells));
            }
        }
        self.taken += 1;
        self.last = Some((*odom, pose, scan.stamp_s));
        Ok(pose)
    }

    /// Whether a scan tells anything of the map.
    #[must_use]
    pub fn can_use(&self, scan: &LaserScan) -> bool {
        let range_max_m = self.range_max_m(scan);
        let is_near = |range_m: f64| range_m >= scan.range_min_m && range_m <= range_max_m;
        scan.ranges_m.iter().map(|&range| self.cut(scan, range)).any(|cut| cut == f32::INFINITY || is_near(cut.into()))
    }

    /// The longest range that is believed, metres.
    fn range_max_m(&self, scan: &LaserScan) -> f64 {
        let reach_m = if self.config.max_range_m.is_finite() { self.config.max_range_m } else { REACH_M };
        scan.range_max_m.min(reach_m)
    }

    /// The scan up to the longest range that is believed.
    fn limited(&self, scan: &LaserScan) -> LaserScan {
        let ranges_m = scan.ranges_m.iter().map(|&range| self.cut(scan, range)).collect();
        LaserScan { range_max_m: self.range_max_m(scan), ranges_m, ..*scan }
    }

    /// A range as the map takes it. One at `range_max` itself is what drivers from before
    /// REP 117 tell where nothing is. Where the lidar tells no limit, a ray that saw nothing
    /// tells nothing, unless the user says how far it reaches.
    fn cut(&self, scan: &LaserScan, range: f32) -> f32 {
        let range_m = f64::from(range);
        let is_limited = scan.range_max_m.is_finite() || self.config.max_range_m.is_finite();
        let is_clear = range_m >= scan.range_max_m * (1.0 - 1e-4) || range_m > self.range_max_m(scan);
        if range_m == f64::INFINITY && !is_limited || range_m.is_finite() && range_m >= BEYOND_ALL_LIDARS_M {
            f32::NAN
        } else if is_clear && range_m <= scan.range_max_m {
            f32::INFINITY
        } else {
            range
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::builtin_robot;
    use crate::grid::{CellState, GridInfo, Thresholds};
    use crate::sim::{Lidar, World};

    /// A robot drives through a room while its odometry turns 3 % too far.
    fn built(is_matching: bool) -> (f64, usize) {
        let info = GridInfo::new(160, 120, 0.05, Pose::new(-4.0, -3.0, 0.0)).unwrap();
        let mut truth = OccupancyGrid::filled(info, 0);
        for index in 0..info.len() {
            let cell = info.cell(index);
            let is_wall = cell.x < 4 || cell.y < 4 || cell.x > 155 || cell.y > 115;
            let is_pillar = (40..50).contains(&cell.x) && (70..76).contains(&cell.y);
            if is_wall || is_pillar {
                truth.set(cell, 100);
            }
        }
        let world = World::new(&truth, &Thresholds::default()).unwrap();
        let config = builtin_robot("turtlebot2").unwrap().lidar;
        let mut lidar = Lidar::new(config, 1);
        let mut builder = MapBuilder::new(BuilderConfig { is_matching, ..BuilderConfig::default() });
        let (mut pose, mut odom, mut error_m) = (Pose::new(-1.0, 0.0, 0.0), Pose::new(-1.0, 0.0, 0.0), 0.0_f64);
        for tick in 0..150 {
            let scan = lidar.sweep(&world, &lidar.pose(&pose), 0.1 * f64::from(tick));
            let found = builder.add(&odom, &config.mount, &scan).unwrap();
            error_m = error_m.max(found.distance_to(pose.position()));
            let twist = crate::geometry::Twist::new(0.4, 0.5);
            pose = twist.advance(&pose, 0.1);
            odom = crate::geometry::Twist::new(0.4, 0.515).advance(&odom, 0.1);
        }
        let map = builder.map().unwrap().unwrap();
        let occupied = |i: &usize| map.state(map.info().cell(*i), &Thresholds::default()) == CellState::Occupied;
        (error_m, (0..map.info().len()).filter(occupied).count())
    }

    #[test]
    fn a_lidar_without_a_limit_maps_what_it_measures() {
        let built = |range_max_m: f64, max_range_m: f64, ranges_m: Vec<f32>| {
            let mut builder = MapBuilder::new(BuilderConfig { max_range_m, ..BuilderConfig::default() });
            let scan =
                LaserScan { angle_increment_rad: 0.1, range_min_m: 0.1, range_max_m, ranges_m, ..Default::default() };
            let can_use = builder.can_use(&scan);
            builder.add(&Pose::default(), &Pose::default(), &scan).unwrap();
            let map = builder.map().unwrap().unwrap();
            (can_use, map.info().width(), map.census(&Thresholds::default()).known())
        };
        let (inf, nan) = (f32::INFINITY, f32::NAN);
        let (can_use, width, known) = built(f64::INFINITY, f64::INFINITY, vec![2.0, inf, nan, -inf, 1e30, 2.0]);
        assert!(can_use && width < 300 && known > 50, "{width} {known}");
        // It tells how far nothing is only where the user does.
        assert!(built(f64::INFINITY, 4.0, vec![inf; 6]).2 > 100);
        for nothing in [vec![inf; 6], vec![nan; 6], vec![-inf; 6], vec![0.0; 6], Vec::new()] {
            assert_eq!((built(f64::INFINITY, f64::INFINITY, nothing).0, built(8.0, 8.0, vec![nan]).0), (false, false));
        }
        // A limit that no map holds clears up to what it can hold.
        assert!(built(900.0, f64::INFINITY, vec![inf; 3]).1 < 5000);
    }

    #[test]
    fn matching_takes_the_drift_away() {
        let ((matched_m, single), (drifted_m, double)) = (built(true), built(false));
        assert!(matched_m < 0.06, "{matched_m} m");
        assert!(drifted_m > 2.0 * matched_m && double > single, "{drifted_m} m, {double} against {single} cells");
    }
}
