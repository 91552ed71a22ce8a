//! A differential-drive body in the world.
//!
//! It follows velocity commands under its acceleration limits, moves along exact
//! arcs in short substeps, and stops where it would touch something solid.

use super::{CollisionShape, Odometry, World};
use crate::geometry::{Footprint, MotionLimits, Pose, Twist, shortest_angle};

/// The longest substep, seconds.
const SUBSTEP_S: f64 = 0.02;
/// A contact is over when the body is this far from where it sensed, metres; it
/// would otherwise be counted anew at every attempt.
const CONTACT_RELEASE_M: f64 = 0.1;
/// Or when it has turned this far, radians.
const CONTACT_RELEASE_RAD: f64 = 0.5;

/// The body's motion so far.
#[derive(Clone, Debug)]
pub struct DiffDrive {
    limits: MotionLimits,
    body: CollisionShape,
    pose: Pose,
    twist: Twist,
    odometry: Odometry,
    /// Where the contact sensed that is not over yet.
    contact: Option<Pose>,
    collisions: usize,
    distance_m: f64,
    turned_rad: f64,
}

impl DiffDrive {
    /// A body that stands still at a pose where it fits ([`CollisionShape::check_start`]).
    #[must_use]
    pub fn new(world: &World, footprint: &Footprint, limits: MotionLimits, start: Pose, odometry: Odometry) -> Self {
        Self {
            limits,
            body: CollisionShape::new(footprint, world.info().resolution_m()),
            pose: start,
            twist: Twist::ZERO,
            odometry,
            contact: None,
            collisions: 0,
            distance_m: 0.0,
            turned_rad: 0.0,
        }
    }

    /// True pose in the world.
    #[must_use]
    pub const fn pose(&self) -> Pose {
        self.pose
    }

    /// True velocity.
    #[must_use]
    pub const fn twist(&self) -> Twist {
        self.twist
    }

    /// Where the wheels believe the body is, from its start at the origin.
    #[must_use]
    pub const fn pose_in_odom(&self) -> Pose {
        self.odometry.pose_in_odom()
    }

    /// Contacts so far; one that lasts counts once.
    #[must_use]
    pub const fn collisions(&self) -> usize {
        self.collisions
    }

    /// Length of the true path, metres.
    #[must_use]
    pub const fn distance_m(&self) -> f64 {
        self.distance_m
    }

    /// Sum of all turning either way, radians.
    #[must_use]
    pub const fn turned_rad(&self) -> f64 {
        self.turned_rad
    }

    /// Follows a command for `dt_s` seconds.
    pub fn drive(&mut self, world: &World, command: &Twist, dt_s: f64) {
        if self.twist == Twist::ZERO && *command == Twist::ZERO {
            return;
        }
        let count = (dt_s / self.longest_substep_s(world)).ceil().max(1.0);
        let substep_s = dt_s / count;
        for _ in 0..count as usize {
            self.substep(world, command, substep_s);
        }
    }

    /// No point of the body may move by more than half a cell in a substep, or it
    /// could step through a wall.
    fn longest_substep_s(&self, world: &World) -> f64 {
        let fastest_mps = self.limits.max_linear_mps + self.limits.max_angular_rps * self.body.circumscribed_radius_m();
        SUBSTEP_S.min(0.5 * world.info().resolution_m() / fastest_mps)
    }

    fn substep(&mut self, world: &World, command: &Twist, dt_s: f64) {
        self.twist = self.limits.reachable(&self.twist, command, dt_s);
        let mut next = self.twist.advance(&self.pose, dt_s);
        let mut fits = self.body.fits(world, &next);
        if !fits {
            self.touch();
            // What stands in the way stops the wheels' push, not their turn.
            self.twist.linear_mps = 0.0;
            next = self.twist.advance(&self.pose, dt_s);
            fits = self.body.fits(world, &next);
        }
        if fits {
            self.odometry.advance(&self.twist, dt_s);
            self.pose = next;
            self.distance_m += (self.twist.linear_mps * dt_s).abs();
            self.turned_rad += (self.twist.angular_rps * dt_s).abs();
            self.contact = self.contact.filter(|at| !is_clear_of(at, &next));
        } else {
            self.twist = Twist::ZERO;
        }
    }

    /// Counts a collision, once for each contact.
    fn touch(&mut self) {
        if self.contact.is_none() {
            self.collisions += 1;
            self.contact = Some(self.pose);
        }
    }
}

fn is_clear_of(contact: &Pose, pose: &Pose) -> bool {
    contact.distance_to(pose.position()) > CONTACT_RELEASE_M
        || shortest_angle(contact.yaw, pose.yaw).abs() > CONTACT_RELEASE_RAD
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{GridInfo, OccupancyGrid, Thresholds};
    use crate::sim::OdometryNoise;
    use std::f64::consts::FRAC_PI_2;

    const LIMITS: MotionLimits =
        MotionLimits { max_linear_mps: 0.5, max_angular_rps: 1.0, max_linear_mps2: 1.0, max_angular_rps2: 2.0 };

    /// Free from (0, 0) to (6, 4) metres.
    fn hall() -> World {
        let info = GridInfo::new(120, 80, 0.05, Pose::default()).unwrap();
        World::new(&OccupancyGrid::filled(info, 0), &Thresholds::default()).unwrap()
    }

    fn body(footprint: &Footprint, start: Pose) -> DiffDrive {
        DiffDrive::new(&hall(), footprint, LIMITS, start, Odometry::new(OdometryNoise::NONE, 0))
    }

    #[test]
    fn it_accelerates_to_its_top_speed_and_no_further() {
        let mut robot = body(&Footprint::RadiusM(0.2), Pose::new(1.0, 2.0, 0.0));
        robot.drive(&hall(), &Twist::new(9.0, 0.0), 0.1);
        assert!((robot.twist().linear_mps - 0.1).abs() < 1e-12);
        robot.drive(&hall(), &Twist::new(9.0, 0.0), 1.9);
        assert!((robot.twist().linear_mps - 0.5).abs() < 1e-12);
        // 0.125 m while it accelerates, 1.5 s at 0.5 m/s; substeps end a little ahead.
        assert!((robot.distance_m() - 0.875).abs() < 0.006, "{}", robot.distance_m());
        assert!((robot.pose().x - 1.0 - robot.distance_m()).abs() < 1e-9);
    }

    #[test]
    fn a_wall_stops_it_and_counts_once() {
        let mut robot = body(&Footprint::RadiusM(0.2), Pose::new(5.0, 2.0, 0.0));
        for _ in 0..100 {
            robot.drive(&hall(), &Twist::new(0.5, 0.0), 0.1);
        }
        assert_eq!(robot.collisions(), 1);
        assert!(robot.pose().x > 5.7 && robot.pose().x < 5.86, "{}", robot.pose().x);
        for _ in 0..10 {
            robot.drive(&hall(), &Twist::new(-0.5, 0.0), 0.1);
        }
        assert!(robot.pose().x < 5.5);
        for _ in 0..40 {
            robot.drive(&hall(), &Twist::new(0.5, 0.0), 0.1);
        }
        assert_eq!(robot.collisions(), 2);
    }

    #[test]
    fn a_disc_that_pushes_against_a_wall_still_turns() {
        let mut robot = body(&Footprint::RadiusM(0.2), Pose::new(5.0, 2.0, 0.0));
        for _ in 0..40 {
            robot.drive(&hall(), &Twist::new(0.5, 0.0), 0.1);
        }
        let at = robot.pose();
        for _ in 0..10 {
            robot.drive(&hall(), &Twist::new(0.5, 1.0), 0.1);
        }
        assert!(robot.pose().yaw > 0.5 && robot.pose().x - at.x < 0.05, "{:?}", robot.pose());
    }

    #[test]
    fn a_rectangle_cannot_turn_in_a_narrow_place() {
        let long = Footprint::PolygonM(vec![[-0.5, -0.1], [0.5, -0.1], [0.5, 0.1], [-0.5, 0.1]]);
        let mut robot = body(&long, Pose::new(3.0, 0.25, 0.0));
        for _ in 0..30 {
            robot.drive(&hall(), &Twist::new(0.0, 1.0), 0.1);
        }
        assert_eq!(robot.collisions(), 1);
        assert!(robot.pose().yaw < 0.6, "{}", robot.pose().yaw);
        assert_eq!(robot.pose().position(), crate::geometry::Point::new(3.0, 0.25));
    }

    #[test]
    fn odometry_without_noise_is_the_way_from_the_start() {
        let start = Pose::new(3.0, 2.0, FRAC_PI_2);
        let mut robot = body(&Footprint::RadiusM(0.2), start);
        for _ in 0..20 {
            robot.drive(&hall(), &Twist::new(0.3, 0.5), 0.1);
        }
        let believed = start.compose(&robot.pose_in_odom());
        assert!((believed.x - robot.pose().x).abs() < 1e-9 && (believed.y - robot.pose().y).abs() < 1e-9);
        assert!(robot.turned_rad() > 0.5 && robot.collisions() == 0);
    }
}
