//! Where a scan fits on a map: a search over poses on two grids, coarse and fine, and
//! Gauss-Newton steps from the best.
//!
//! The search is that of Olson, "Real-Time Correlative Scan Matching" (ICRA 2009), over
//! the likelihood field; the refinement that of Kohlbrecher and others, "A Flexible and
//! Scalable SLAM System with Full 3D Motion Estimation" (SSRR 2011, Hector SLAM). Both
//! are held by a prior, the pose that odometry tells, where the scan says nothing: along a
//! bare corridor.

use super::field::{Blur, LikelihoodField};
use crate::geometry::{Point, Pose, normalize_angle, shortest_angle};
use crate::scan::{LaserScan, Reading};
use nalgebra::{Matrix3, Vector3};

/// Standard deviations of the likelihoods: coarse, fine, and for the last steps, metres.
const SIGMAS_M: [f64; 3] = [0.20, 0.10, 0.06];
/// Of the coarse and the fine grid: reach and step, metres and radians.
const GRIDS: [(f64, f64, f64, f64); 2] = [(0.24, 0.08, 0.24, 0.03), (0.06, 0.02, 0.03, 0.01)];
/// Gauss-Newton steps.
const STEPS: usize = 12;

/// How far odometry is believed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// The pose that it tells.
    pub pose: Pose,
    /// Standard deviation of the position, metres.
    pub position_std_m: f64,
    /// Standard deviation of the heading, radians.
    pub heading_std_rad: f64,
}

impl Prior {
    /// What odometry tells of a body that was at a pose and has moved since; the longer
    /// the way and the turn, the less it is believed.
    #[must_use]
    pub fn after_motion(before: &Pose, moved: &Pose) -> Self {
        let (way_m, turn_rad) = (moved.x.hypot(moved.y), shortest_angle(0.0, moved.yaw).abs());
        Self {
            pose: before.compose(moved),
            position_std_m: 0.03 + 0.2 * way_m + 0.05 * turn_rad,
            heading_std_rad: 0.02 + 0.2 * turn_rad + 0.05 * way_m,
        }
    }

    /// Half the squared distance in standard deviations.
    fn penalty(&self, pose: &Pose) -> f64 {
        let position = pose.distance_to(self.pose.position()) / self.position_std_m;
        let heading = shortest_angle(self.pose.yaw, pose.yaw) / self.heading_std_rad;
        0.5 * (position * position + heading * heading)
    }
}

/// The weight of the prior beside a mean likelihood of 0 to 1.
const PRIOR_WEIGHT: f64 = 0.02;

/// Where a scan fits, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Match {
    /// The pose of what the points are given in.
    pub pose: Pose,
    /// Mean likelihood of the points there, 0 to 1.
    pub likelihood: f64,
}

/// The hits of a scan in the frame of the body that carries the lidar at `mount`, thinned
/// evenly to at most `max_points`.
#[must_use]
pub fn thinned_hits(scan: &LaserScan, mount: &Pose, max_points: usize) -> Vec<Point> {
    let is_hit = |range: &&f32| matches!(scan.reading(**range), Reading::Hit(_));
    let count = scan.ranges_m.iter().filter(is_hit).count();
    let stride = count.div_ceil(max_points.max(1)).max(1);
    scan.hits(mount).step_by(stride).collect()
}

/// Fits points of a body's frame to a field, beginning at what odometry tells.
/// O(poses on the grids times points).
#[must_use]
pub fn match_scan(field: &LikelihoodField, points_in_body: &[Point], prior: &Prior) -> Match {
    let [coarse, fine, last] = SIGMAS_M.map(|sigma_m| field.blur(sigma_m));
    let mut pose = prior.pose;
    for (blur, grid) in [coarse, fine].iter().zip(GRIDS) {
        pose = search(field, blur, points_in_body, prior, pose, grid);
    }
    let refined = refine(field, &last, points_in_body, prior, pose);
    // Compared between the cells: within one, the grids' own measure is the same everywhere.
    let between = |pose: &Pose| smooth_mean(field, &last, points_in_body, pose) - PRIOR_WEIGHT * prior.penalty(pose);
    if between(&refined) >= between(&pose) {
        pose = refined;
    }
    Match { pose, likelihood: mean(field, &last, points_in_body, &pose) }
}

fn mean(field: &LikelihoodField, blur: &Blur, points: &[Point], pose: &Pose) -> f64 {
    let (sin, cos) = pose.yaw.sin_cos();
    let there = |p: &Point| Point::new(pose.x + cos * p.x - sin * p.y, pose.y + sin * p.x + cos * p.y);
    points.iter().map(|p| field.at(blur, there(p))).sum::<f64>() / points.len().max(1) as f64
}

fn smooth_mean(field: &LikelihoodField, blur: &Blur, points: &[Point], pose: &Pose) -> f64 {
    let (sin, cos) = pose.yaw.sin_cos();
    let there = |p: &Point| Point::new(pose.x + cos * p.x - sin * p.y, pose.y + sin * p.x + cos * p.y);
    points.iter().map(|p| field.smooth(blur, there(p)).0).sum::<f64>() / points.len().max(1) as f64
}

fn goodness(field: &LikelihoodField, blur: &Blur, points: &[Point], prior: &Prior, pose: &Pose) -> f64 {
    mean(field, blur, points, pose) - PRIOR_WEIGHT * prior.penalty(pose)
}

fn search(
    field: &LikelihoodField,
    blur: &Blur,
    points: &[Point],
    prior: &Prior,
    around: Pose,
    (reach_m, step_m, reach_rad, step_rad): (f64, f64, f64, f64),
) -> Pose {
    let (cells, turns) = ((reach_m / step_m).round() as i32, (reach_rad / step_rad).round() as i32);
    let mut best = (goodness(field, blur, points, prior, &around), around);
    for turn in -turns..=turns {
        for x in -cells..=cells {
            for y in -cells..=cells {
                let yaw = normalize_angle(around.yaw + f64::from(turn) * step_rad);
                let pose = Pose::new(around.x + f64::from(x) * step_m, around.y + f64::from(y) * step_m, yaw);
                let goodness = goodness(field, blur, points, prior, &pose);
                if goodness > best.0 {
                    best = (goodness, pose);
                }
            }
        }
    }
    best.1
}

/// Makes the sum of squares of `1 - likelihood` small, with the prior beside it.
fn refine(field: &LikelihoodField, blur: &Blur, points: &[Point], prior: &Prior, begin: Pose) -> Pose {
    let mut pose = begin;
    let weight = 2.0 * PRIOR_WEIGHT * points.len() as f64;
    let (by_position, by_heading) = (weight / prior.position_std_m.powi(2), weight / prior.heading_std_rad.powi(2));
    for _ in 0..STEPS {
        let (sin, cos) = pose.yaw.sin_cos();
        let mut normal = Matrix3::from_diagonal(&Vector3::new(by_position, by_position, by_heading));
        let mut right = Vector3::new(
            by_position * (prior.pose.x - pose.x),
            by_position * (prior.pose.y - pose.y),
            by_heading * shortest_angle(pose.yaw, prior.pose.yaw),
        );
        for p in points {
            let there = Point::new(pose.x + cos * p.x - sin * p.y, pose.y + sin * p.x + cos * p.y);
            let (value, slope_x, slope_y) = field.smooth(blur, there);
            let turned = slope_x * (-sin * p.x - cos * p.y) + slope_y * (cos * p.x - sin * p.y);
            let slope = Vector3::new(slope_x, slope_y, turned);
            normal += slope * slope.transpose();
            right += slope * (1.0 - value);
        }
        let Some(step) = normal.try_inverse().map(|inverse| inverse * right) else { return pose };
        // A step farther than the fine grid reaches is one that has lost its way.
        if !step.iter().all(|v| v.is_finite()) || step.x.hypot(step.y) > 0.1 || step.z.abs() > 0.1 {
            return pose;
        }
        pose = Pose::new(pose.x + step.x, pose.y + step.y, normalize_angle(pose.yaw + step.z));
        if step.norm() < 1e-5 {
            break;
        }
    }
    pose
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Cell, GridInfo, OccupancyGrid};

    /// A room of 4 m x 3 m with a pillar, and what is seen of it from its middle.
    fn room() -> (LikelihoodField, Vec<Point>) {
        let info = GridInfo::new(100, 80, 0.05, Pose::default()).unwrap();
        let mut grid = OccupancyGrid::filled(info, 0);
        let mut points = Vec::new();
        for i in 0..info.len() {
            let cell = info.cell(i);
            let (x, y) = (cell.x, cell.y);
            let is_wall =
                ((10..=90).contains(&x) && (y == 10 || y == 70)) || ((10..=70).contains(&y) && (x == 10 || x == 90));
            let is_pillar = (70..74).contains(&x) && (20..24).contains(&y);
            if is_wall || is_pillar {
                grid.set(Cell::new(x, y), 100);
                points.push(info.center(cell) - nalgebra::Vector2::new(2.5, 2.0));
            }
        }
        (LikelihoodField::of(&grid), points)
    }

    #[test]
    fn a_scan_is_found_where_it_was_taken() {
        let (field, points) = room();
        for (x, y, yaw) in [(0.0, 0.0, 0.0), (0.2, -0.15, 0.2), (-0.22, 0.1, -0.15)] {
            let told = Pose::new(2.5 + x, 2.0 + y, yaw);
            let prior = Prior { pose: told, position_std_m: 0.3, heading_std_rad: 0.3 };
            let found = match_scan(&field, &points, &prior);
            let error_m = found.pose.distance_to(Point::new(2.5, 2.0));
            assert!(error_m < 0.015 && found.pose.yaw.abs() < 0.005, "{found:?} from {told:?}");
            assert!(found.likelihood > 0.9, "{found:?}");
        }
    }

    #[test]
    fn without_points_odometry_holds() {
        let (field, _) = room();
        let pose = Pose::new(1.0, 2.0, 0.3);
        let found = match_scan(&field, &[], &Prior { pose, position_std_m: 0.1, heading_std_rad: 0.1 });
        assert_eq!((found.pose, found.likelihood), (pose, 0.0));
    }
}
