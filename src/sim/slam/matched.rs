//! A SLAM that errs as gmapping does: the pose is what odometry and scan matching make of
//! it, and the map what the scans show when they are put there.
//!
//! As gmapping: a scan is processed only when odometry says that the robot has moved or
//! turned so far since the last one, to and fro added up (its `linearUpdate`,
//! `angularUpdate`), so that at rest nothing comes; a processed
//! scan corrects `map -> odom`, which so jumps, and makes a map when the last one is old
//! enough (`map_update_interval`). A cell is occupied when more than a quarter of the scans
//! that met it ended in it (`occ_thresh` 0.25): counted as +3 for an end and -1 for a pass.
//! The lattice begins at the start, not at a corner of the world's cells. What a scan
//! shows is known 0.1 to 0.25 s after it was taken, and a map of it up to half a second
//! later.
//!
//! Our matcher errs less than gmapping did in recorded runs: an error is added to each pose
//! that it finds.
//!
//! Kinder than gmapping: one hypothesis instead of 30 particles, so that the map never
//! changes where the robot is not; the map's axes are the world's; errors of odometry have
//! no bias.

use super::super::schedule::{Micros, micros, seconds};
use super::super::{Mapper, MapperConfig, MapperError, SimConfig};
use super::new_map::NewMap;
use super::{SlamConfig, Sweep};
use crate::geometry::{Point, Pose, normalize_angle, shortest_angle};
use crate::grid::{OccupancyGrid, Snapshot};
use crate::matching::{LikelihoodField, Prior, match_scan, thinned_hits};
use rand_distr::{Distribution, StandardNormal, Uniform};
use rand_pcg::Pcg32;
use std::collections::VecDeque;

/// Which sequence of the seed the lateness is drawn from.
const STREAM: u64 = 0x51a;
/// Scans with fewer points are not matched.
const FEWEST_POINTS: usize = 20;

/// What has been found and is told later.
#[derive(Debug)]
struct Coming<T> {
    due: Micros,
    what: T,
}

/// Matching on the growing map.
#[derive(Debug)]
pub struct MatchedSlam {
    config: SlamConfig,
    mount: Pose,
    mapper: Mapper,
    /// The same scans, put where they were truly taken.
    seen: Mapper,
    /// Where the last processed scan was by odometry and in the map.
    last: (Pose, Pose),
    /// Where the newest sweep was by odometry, and the motion from sweep to sweep since the last
    /// processed one: metres and radians.
    swept: Pose,
    moved_m: f64,
    turned_rad: f64,
    mapped: Micros,
    map_from_odom: Pose,
    corrections: VecDeque<Coming<Pose>>,
    maps: VecDeque<Coming<NewMap>>,
    lateness: Micros,
    random: Pcg32,
    /// What the wheels believed and when, as far back as the pose is late.
    trail: VecDeque<(Micros, Pose)>,
}

impl MatchedSlam {
    /// With the first sweep taken in, and its map. The map's frame is the world's as far
    /// as the robot knows: it begins at its true place.
    pub(super) fn begin(
        config: &SimConfig,
        start: &Pose,
        anchor: Point,
        mount: Pose,
        first: &Sweep,
    ) -> Result<(Self, Snapshot<OccupancyGrid>), MapperError> {
        let counting = MapperConfig {
            hit_log_odds: 3.0,
            pass_log_odds: -1.0,
            min_log_odds: -1e6,
            max_log_odds: 1e6,
            ..config.mapper
        };
        let mut mapper = Mapper::new(counting, start.position(), start.position())?;
        mapper.integrate(&start.compose(&mount), &first.scan)?;
        let grid = mapper.publish()?;
        let mut seen = Mapper::new(counting, start.position(), anchor)?;
        seen.integrate(&first.lidar_in_world, &first.scan)?;
        let mut random = Pcg32::new(config.seed, STREAM);
        let lateness = draw(config.slam.lateness_min_s, config.slam.lateness_max_s, &mut random);
        let this = Self {
            config: config.slam,
            mount,
            mapper,
            seen,
            last: (first.base_in_odom, *start),
            swept: first.base_in_odom,
            moved_m: 0.0,
            turned_rad: 0.0,
            mapped: 0,
            map_from_odom: start.compose(&first.base_in_odom.inverse()),
            corrections: VecDeque::new(),
            maps: VecDeque::new(),
            lateness,
            random,
            trail: VecDeque::from([(0, first.base_in_odom)]),
        };
        Ok((this, grid))
    }

    pub(super) fn next(&self) -> Micros {
        first_due(&self.corrections).min(first_due(&self.maps))
    }

    /// Processes a sweep if the robot has moved since the last one.
    pub(super) fn add(&mut self, sweep: &Sweep, now: Micros) -> Result<(), MapperError> {
        self.lateness = draw(self.config.lateness_min_s, self.config.lateness_max_s, &mut self.random);
        self.moved_m += self.swept.distance_to(sweep.base_in_odom.position());
        self.turned_rad += shortest_angle(self.swept.yaw, sweep.base_in_odom.yaw).abs();
        self.swept = sweep.base_in_odom;
        if self.moved_m < self.config.update_distance_m && self.turned_rad < self.config.update_angle_rad {
            return Ok(());
        }
        (self.moved_m, self.turned_rad) = (0.0, 0.0);
        let (odom, placed) = self.last;
        let moved = odom.inverse().compose(&sweep.base_in_odom);
        let prior = Prior::after_motion(&placed, &moved);
        let points = thinned_hits(&sweep.scan, &self.mount, self.config.max_points);
        let field = LikelihoodField::of(&self.mapper.publish()?.cells);
        let found = match_scan(&field, &points, &prior);
        let is_believed = points.len() >= FEWEST_POINTS && found.likelihood >= self.config.min_likelihood;
        let pose = self.err(if is_believed { found.pose } else { prior.pose });
        self.mapper.integrate(&pose.compose(&self.mount), &sweep.scan)?;
        self.seen.integrate(&sweep.lidar_in_world, &sweep.scan)?;
        self.last = (sweep.base_in_odom, pose);
        let due = now + self.lateness;
        if now - self.mapped >= micros(self.config.map_interval_s) {
            self.mapped = now;
            let map = NewMap { grid: self.mapper.publish()?, stamp_s: seconds(now), seen: self.seen.publish()? };
            let drawn = draw(self.config.map_delay_min_s, self.config.map_delay_max_s, &mut self.random);
            push(&mut self.maps, due + drawn, map);
        }
        push(&mut self.corrections, due, pose.compose(&sweep.base_in_odom.inverse()));
        Ok(())
    }

    /// Tells what has been found by now; the newest map if there are several.
    pub(super) fn publish(&mut self, now: Micros) -> Option<NewMap> {
        self.map_from_odom = take_due(&mut self.corrections, now).unwrap_or(self.map_from_odom);
        take_due(&mut self.maps, now)
    }

    /// The pose as a matcher finds it that is worse than ours.
    fn err(&mut self, pose: Pose) -> Pose {
        let mut error = |std: f64| -> f64 {
            let deviation: f64 = StandardNormal.sample(&mut self.random);
            std * deviation
        };
        let (std_m, std_rad) = (self.config.match_error_m, self.config.match_error_rad);
        pose.compose(&Pose::new(error(std_m), error(std_m), error(std_rad)))
    }

    pub(super) fn note(&mut self, base_in_odom: &Pose, now: Micros) {
        self.trail.push_back((now, *base_in_odom));
        let oldest = now.saturating_sub(micros(self.config.lateness_max_s));
        while self.trail.get(1).is_some_and(|&(time, _)| time <= oldest) {
            self.trail.pop_front();
        }
    }

    pub(super) const fn map_from_odom(&self) -> Pose {
        self.map_from_odom
    }

    pub(super) fn lateness_s(&self) -> f64 {
        seconds(self.lateness)
    }

    /// Where the robot was as late ago as it is known.
    pub(super) fn late_pose(&self, now: Micros) -> Pose {
        let then = now.saturating_sub(self.lateness);
        let after = self.trail.partition_point(|&(time, _)| time <= then);
        let before = self.trail.get(after.saturating_sub(1)).or(self.trail.front());
        let odom = match (before, self.trail.get(after)) {
            (Some(&(from, a)), Some(&(to, b))) if to > from && then > from => {
                between(&a, &b, (then - from) as f64 / (to - from) as f64)
            }
            (Some(&(_, a)), _) => a,
            _ => self.last.0,
        };
        self.map_from_odom.compose(&odom)
    }

    pub(super) fn known_area_m2(&self) -> f64 {
        self.mapper.known_area_m2()
    }
}

/// A share of the way from one pose to another.
fn between(a: &Pose, b: &Pose, share: f64) -> Pose {
    Pose::new(
        a.x + share * (b.x - a.x),
        a.y + share * (b.y - a.y),
        normalize_angle(a.yaw + share * shortest_angle(a.yaw, b.yaw)),
    )
}

fn draw(low_s: f64, high_s: f64, random: &mut Pcg32) -> Micros {
    let (low, high) = (micros(low_s), micros(high_s));
    Uniform::new_inclusive(low, high.max(low)).map_or(low, |drawn| drawn.sample(random))
}

/// What was found later is not told earlier.
fn push<T>(queue: &mut VecDeque<Coming<T>>, due: Micros, what: T) {
    let due = due.max(queue.back().map_or(0, |last| last.due));
    queue.push_back(Coming { due, what });
}

/// The newest that is due; what is older is dropped.
fn take_due<T>(queue: &mut VecDeque<Coming<T>>, now: Micros) -> Option<T> {
    let mut newest = None;
    while first_due(queue) <= now {
        let Some(coming) = queue.pop_front() else { break };
        newest = Some(coming.what);
    }
    newest
}

fn first_due<T>(queue: &VecDeque<Coming<T>>) -> Micros {
    queue.front().map_or(Micros::MAX, |coming| coming.due)
}
