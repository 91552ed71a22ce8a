//! Getting away from what stands too near: slowly straight ahead or back, on a slight bow
//! where straight does not help, and turning on the spot where nothing else does.
//!
//! A robot in contact with a table leg or a door jamb is refused by its controller, since
//! every motion that it knows begins in an obstacle. What leads away is allowed here, as
//! long as no point of the body comes nearer to anything than it is, and only with a scan
//! that shows what is there.

use super::NavigationInput;
use super::feeler::{ENOUGH_M, Feeler};
use crate::control::Surroundings;
use crate::geometry::{Body, Pose, Twist, shortest_angle};
use crate::robot::NavigationState;

/// Speed along and turning speed, metres and radians per second.
const SPEED_MPS: f64 = 0.1;
const SPEED_RPS: f64 = 0.4;
/// So far it goes, metres and radians.
const FAR_M: f64 = 0.25;
const FAR_RAD: f64 = 0.6;
/// At the longest, seconds.
const LONGEST_S: f64 = 6.0;

/// A motion under which the robot stands for so long leads nowhere, seconds.
const VAIN_S: f64 = 0.6;
/// Coming nearer by less than this is rounding, metres.
const ROUNDING_M: f64 = 2e-3;

/// A motion is worth it that leads so much farther away from everything: along a wall nothing is
/// won, metres.
const WORTH_M: f64 = 0.04;

/// The motions, the best first where they do equally well: straight where that is worth it, then
/// bows, then turns.
const MOTIONS: [&[Twist]; 3] = [
    &[Twist::new(-SPEED_MPS, 0.0), Twist::new(SPEED_MPS, 0.0)],
    &[
        Twist::new(-SPEED_MPS, SPEED_RPS),
        Twist::new(-SPEED_MPS, -SPEED_RPS),
        Twist::new(SPEED_MPS, SPEED_RPS),
        Twist::new(SPEED_MPS, -SPEED_RPS),
    ],
    &[Twist::new(0.0, SPEED_RPS), Twist::new(0.0, -SPEED_RPS)],
];

/// Backing off, under way.
#[derive(Clone, Debug)]
pub struct BackOff {
    feeler: Feeler,
    began: Option<(f64, Pose)>,
    /// The motion under way, and where and when the robot last moved under it.
    motion: Option<(Twist, Pose, f64)>,
    /// Motions that led nowhere.
    vain: Vec<Twist>,
}

impl BackOff {
    /// A body that gets away.
    pub fn new(body: &Body) -> Self {
        Self { feeler: Feeler::new(body), began: None, motion: None, vain: Vec::new() }
    }

    /// The command until the next tick, and how it is doing.
    pub fn update(&mut self, input: &NavigationInput<'_>) -> (Twist, NavigationState) {
        if input.scan.is_none() {
            return (Twist::ZERO, NavigationState::Aborted("no scan shows what stands around".to_owned()));
        }
        let (now_s, pose) = (input.stamp_s, input.pose_in_map);
        let (began_s, from) = *self.began.get_or_insert((now_s, pose));
        let came_m = pose.distance_to(from.position());
        let turned_rad = shortest_angle(from.yaw, pose.yaw).abs();
        let is_over = came_m >= FAR_M || turned_rad >= FAR_RAD || now_s - began_s >= LONGEST_S;
        let around = self.feeler.around(input);
        let motion = match (is_over, around) {
            (false, Some(around)) => self.choose(&pose, now_s, &around),
            _ => None,
        };
        match motion {
            Some(twist) => (twist, NavigationState::Active),
            None if came_m > 0.0 || turned_rad > 0.0 => (Twist::ZERO, NavigationState::Succeeded),
            None => (Twist::ZERO, NavigationState::Aborted("every way from here touches something".to_owned())),
        }
    }

    /// The motion that leads farthest away from everything; the one under way while it can
    /// go on and moves the robot.
    fn choose(&mut self, pose: &Pose, now_s: f64, around: &Surroundings) -> Option<Twist> {
        if let Some((twist, at, since_s)) = &mut self.motion {
            let has_moved = pose.distance_to(at.position()) > 0.01 || shortest_angle(at.yaw, pose.yaw).abs() > 0.02;
            if has_moved {
                (*at, *since_s) = (*pose, now_s);
            }
            let twist = *twist;
            if now_s - *since_s >= VAIN_S {
                self.vain.push(twist);
            } else if self.feeler.gain_m(pose, around, twist, ROUNDING_M).is_some() {
                return Some(twist);
            }
        }
        let worth_m = (self.feeler.clearance_m(pose, around) + WORTH_M).min(ENOUGH_M);
        let mut best: Option<(f64, Twist)> = None;
        for motions in MOTIONS {
            for &motion in motions.iter().filter(|motion| !self.vain.contains(motion)) {
                let gain_m = self.feeler.gain_m(pose, around, motion, ROUNDING_M);
                // Of motions that do equally well the first one is taken.
                if let Some(gain_m) =
                    gain_m.filter(|gain_m| best.is_none_or(|(best_m, _)| *gain_m > best_m + ROUNDING_M))
                {
                    best = Some((gain_m, motion));
                }
            }
            if best.is_some_and(|(gain_m, _)| gain_m >= worth_m) {
                break;
            }
        }
        let motion = best.map(|(_, motion)| motion);
        self.motion = motion.map(|twist| (twist, *pose, now_s));
        motion
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Footprint, MotionLimits, Point};
    use crate::grid::{Costmap, GridInfo};
    use crate::scan::LaserScan;
    use std::sync::Arc;

    const LIMITS: MotionLimits =
        MotionLimits { max_linear_mps: 0.3, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 };

    /// What a lidar at the origin of the base sees of points.
    fn scan_of(points: &[Point], pose: &Pose) -> LaserScan {
        let mut ranges_m = vec![f32::INFINITY; 720];
        let increment = std::f64::consts::TAU / 720.0;
        for point in points {
            let in_base = pose.inverse().transform(*point);
            let angle = in_base.y.atan2(in_base.x).rem_euclid(std::f64::consts::TAU);
            ranges_m[(angle / increment).round() as usize % 720] = in_base.coords.norm() as f32;
        }
        LaserScan {
            angle_increment_rad: increment,
            range_min_m: 0.01,
            range_max_m: 5.0,
            ranges_m,
            ..LaserScan::default()
        }
    }

    fn back_off(points: &[Point], start: Pose, with_scan: bool) -> (Pose, NavigationState, f64) {
        let info = GridInfo::new(100, 100, 0.05, Pose::new(-2.5, -2.5, 0.0)).unwrap();
        let costmap = Arc::new(Costmap::from_costs(info, vec![0; info.len()]).unwrap());
        let body = Body { footprint: Footprint::RadiusM(0.18), limits: LIMITS };
        let mut back_off = BackOff::new(&body);
        let (mut pose, mut nearest_m) = (start, f64::INFINITY);
        for tick in 0..100 {
            let scan = scan_of(points, &pose);
            let input = NavigationInput {
                stamp_s: 0.1 * f64::from(tick),
                pose_in_map: pose,
                twist: Twist::ZERO,
                costmap: &costmap,
                costmap_stamp_s: 0.0,
                scan: with_scan.then_some((&pose, &scan)),
            };
            let (twist, state) = back_off.update(&input);
            if state != NavigationState::Active {
                return (pose, state, nearest_m);
            }
            pose = twist.advance(&pose, 0.1);
            nearest_m = points.iter().map(|p| pose.distance_to(*p) - 0.18).fold(nearest_m, f64::min);
        }
        panic!("it did not end");
    }

    #[test]
    fn it_leads_away_from_what_touches_and_comes_no_nearer() {
        let leg = Point::new(0.16, 0.06);
        let (end, state, nearest_m) = back_off(&[leg], Pose::default(), true);
        assert_eq!(state, NavigationState::Succeeded);
        assert!(end.x < -0.2 && end.distance_to(leg) > 0.36, "{end:?}");
        assert!(nearest_m > leg.coords.norm() - 0.18 - 1e-3, "{nearest_m}");
        let behind = Point::new(-0.17, 0.0);
        assert!(back_off(&[behind], Pose::default(), true).0.x > 0.2, "ahead, where it stands behind");
    }

    #[test]
    fn along_a_wall_it_bends_away() {
        let wall: Vec<Point> = (-60..=60).map(|i| Point::new(0.03 * f64::from(i), 0.23)).collect();
        let (end, state, nearest_m) = back_off(&wall, Pose::default(), true);
        assert_eq!(state, NavigationState::Succeeded);
        assert!(end.y < -0.04 && nearest_m > 0.045, "{end:?}, {nearest_m} m");
    }

    #[test]
    fn without_sight_or_without_room_it_stands() {
        let (end, state, _) = back_off(&[Point::new(0.1, 0.0)], Pose::default(), false);
        assert!(matches!(state, NavigationState::Aborted(_)) && end == Pose::default());
        let ring: Vec<Point> =
            (0..60).map(|i| f64::from(i) * 0.105).map(|a| Point::new(0.19 * a.cos(), 0.19 * a.sin())).collect();
        let (end, _, _) = back_off(&ring, Pose::default(), true);
        assert!(end.distance_to(Point::origin()) < 0.011, "{end:?}");
    }
}
