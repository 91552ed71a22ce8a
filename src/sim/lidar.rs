//! A planar lidar by exact ray casting.
//!
//! The beam model of *Probabilistic Robotics* (Thrun, Burgard, Fox 2005), chapter 6,
//! reduced to its gaussian about the true range: no short, lost or random readings.
//! All rays of a sweep are taken at one instant.

use super::World;
use crate::config::LidarConfig;
use crate::geometry::Pose;
use crate::scan::LaserScan;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg32;

/// Which sequence of the seed the ranges' noise is drawn from.
const STREAM: u64 = 0x11da;

/// A lidar with its source of noise.
#[derive(Clone, Debug)]
pub struct Lidar {
    config: LidarConfig,
    angle_min_rad: f64,
    angle_increment_rad: f64,
    noise: Pcg32,
}

impl Lidar {
    /// A lidar of a validated configuration; `seed` decides the noise.
    #[must_use]
    pub fn new(config: LidarConfig, seed: u64) -> Self {
        let field = config.field_of_view_rad;
        let all_round = field > std::f64::consts::TAU - 1e-3;
        let (angle_min_rad, angle_increment_rad) = match config.rays {
            0 | 1 => (0.0, 0.0),
            // All round, the first ray must not be cast twice.
            rays if all_round => (-0.5 * field, field / f64::from(rays)),
            rays => (-0.5 * field, field / f64::from(rays - 1)),
        };
        Self { config, angle_min_rad, angle_increment_rad, noise: Pcg32::new(seed, STREAM) }
    }

    /// Where the lidar is when the robot's base is at a pose.
    #[must_use]
    pub fn pose(&self, base: &Pose) -> Pose {
        base.compose(&self.config.mount)
    }

    /// One sweep at `stamp_s` seconds from a pose of the lidar itself: +inf where
    /// nothing solid is within range, -inf where something is too near (REP 117).
    pub fn sweep(&mut self, world: &World, lidar_pose: &Pose, stamp_s: f64) -> LaserScan {
        let mut scan = LaserScan {
            stamp_s,
            angle_min_rad: self.angle_min_rad,
            angle_increment_rad: self.angle_increment_rad,
            range_min_m: self.config.range_min_m,
            range_max_m: self.config.range_max_m,
            ranges_m: Vec::with_capacity(self.config.rays as usize),
        };
        for ray in 0..self.config.rays as usize {
            let heading_rad = lidar_pose.yaw + scan.angle_rad(ray);
            let truth = world.cast(lidar_pose.position(), heading_rad, self.config.range_max_m);
            let range = self.measure(truth);
            scan.ranges_m.push(range);
        }
        scan
    }

    fn measure(&mut self, truth: Option<f64>) -> f32 {
        let Some(mut range_m) = truth else { return f32::INFINITY };
        if self.config.noise_std_m > 0.0 && range_m >= self.config.range_min_m {
            let deviation: f64 = StandardNormal.sample(&mut self.noise);
            range_m += self.config.noise_std_m * deviation;
        }
        if range_m < self.config.range_min_m {
            f32::NEG_INFINITY
        } else if range_m > self.config.range_max_m {
            f32::INFINITY
        } else {
            range_m as f32
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use crate::grid::{GridInfo, OccupancyGrid, Thresholds, traverse};
    use std::f64::consts::{PI, TAU};

    const CONFIG: LidarConfig = LidarConfig {
        mount: Pose::new(0.0, 0.0, 0.0),
        range_min_m: 0.12,
        range_max_m: 3.0,
        field_of_view_rad: TAU,
        rays: 360,
        rate_hz: 10.0,
        noise_std_m: 0.0,
    };

    /// A free room of 4 m x 4 m about the origin, in cells of 0.05 m.
    fn room(yaw: f64) -> World {
        let corner = Pose::new(0.0, 0.0, yaw).transform(Point::new(-2.0, -2.0));
        let info = GridInfo::new(80, 80, 0.05, Pose::new(corner.x, corner.y, yaw)).unwrap();
        World::new(&OccupancyGrid::filled(info, 0), &Thresholds::default()).unwrap()
    }

    #[test]
    fn a_square_room_is_measured_exactly() {
        for yaw in [0.0, 0.4] {
            let scan = Lidar::new(CONFIG, 0).sweep(&room(yaw), &Pose::new(0.0, 0.0, yaw), 1.5);
            assert_eq!((scan.ranges_m.len(), scan.stamp_s), (360, 1.5));
            for (angle, reading) in scan.readings() {
                let wall_m = 2.0 / angle.cos().abs().max(angle.sin().abs());
                assert!(matches!(reading, crate::scan::Reading::Hit(r) if (r - wall_m).abs() < 1e-5), "{angle}");
            }
        }
    }

    #[test]
    fn nothing_in_reach_is_infinite_and_too_near_is_minus_infinite() {
        let short = LidarConfig { range_max_m: 1.0, ..CONFIG };
        let scan = Lidar::new(short, 0).sweep(&room(0.0), &Pose::default(), 0.0);
        assert!(scan.ranges_m.iter().all(|&r| r == f32::INFINITY));
        let near = Lidar::new(short, 0).sweep(&room(0.0), &Pose::new(1.95, 0.0, 0.0), 0.0);
        assert_eq!(near.ranges_m[180], f32::NEG_INFINITY);
        let inside = Lidar::new(short, 0).sweep(&room(0.0), &Pose::new(9.0, 0.0, 0.0), 0.0);
        assert!(inside.ranges_m.iter().all(|&r| r == f32::NEG_INFINITY));
    }

    #[test]
    fn a_narrow_view_looks_ahead_of_its_mount() {
        let mount = Pose::new(0.5, 0.0, PI);
        let narrow = LidarConfig { mount, field_of_view_rad: 1.0, rays: 11, ..CONFIG };
        let mut lidar = Lidar::new(narrow, 0);
        let pose = lidar.pose(&Pose::new(0.0, 0.0, 0.0));
        let scan = lidar.sweep(&room(0.0), &pose, 0.0);
        assert!((scan.angle_rad(0) + 0.5).abs() < 1e-12 && (scan.angle_rad(10) - 0.5).abs() < 1e-12);
        assert!((scan.ranges_m[5] - 2.5).abs() < 1e-6);
    }

    #[test]
    fn a_pillar_is_seen_as_the_textbook_sees_it() {
        let info = GridInfo::new(80, 80, 0.05, Pose::new(-2.0, -2.0, 0.0)).unwrap();
        let mut truth = OccupancyGrid::filled(info, 0);
        for point in [(1.0, 0.3), (-0.6, 0.9), (-1.2, -1.0)] {
            truth.set(info.cell_at(Point::new(point.0, point.1)), 100);
        }
        let w = World::new(&truth, &Thresholds::default()).unwrap();
        let pose = Pose::new(0.013, -0.021, 0.3);
        let scan = Lidar::new(LidarConfig { range_max_m: 5.0, ..CONFIG }, 0).sweep(&w, &pose, 0.0);
        for (ray, &range) in scan.ranges_m.iter().enumerate() {
            let heading = pose.yaw + scan.angle_rad(ray);
            let solid = traverse(&info, pose.position(), heading, 5.0).find(|&(cell, _)| w.is_solid(cell)).unwrap();
            assert!((f64::from(range) - solid.1 * 0.05).abs() < 1e-6);
        }
    }

    #[test]
    fn noise_has_its_spread_and_its_seed() {
        let noisy = LidarConfig { noise_std_m: 0.02, rays: 4000, field_of_view_rad: 0.01, ..CONFIG };
        let sweep = |seed| Lidar::new(noisy, seed).sweep(&room(0.0), &Pose::default(), 0.0);
        assert_eq!(sweep(7), sweep(7));
        assert_ne!(sweep(7), sweep(8));
        let errors: Vec<f64> = sweep(7).ranges_m.iter().map(|&r| f64::from(r) - 2.0).collect();
        let variance = errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64;
        assert!((variance.sqrt() - 0.02).abs() < 0.001, "{}", variance.sqrt());
    }
}
