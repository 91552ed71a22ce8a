//! The last look before a command goes to the wheels: would the body stop before what
//! the newest scan shows?

use super::outline::Outline;
use crate::geometry::{Body, Point, Pose, Twist};

/// The body keeps this far from what a scan hit, metres: less than the controllers keep,
/// or a robot would stand where its controller wants to go on.
const MARGIN_M: f64 = 0.004;
/// From one pose that is checked to the next, seconds.
const STEP_S: f64 = 0.05;

/// Stops a robot before obstacles that no map shows yet.
#[derive(Clone, Debug)]
pub struct StopGuard {
    body: Body,
    outline: Outline,
}

impl StopGuard {
    /// A guard of a body.
    #[must_use]
    pub fn new(body: &Body) -> Self {
        Self { body: body.clone(), outline: Outline::new(&body.footprint) }
    }

    /// The wanted command, if the body holds it for `dt_s` seconds and then stops
    /// without coming nearer than 4 mm to a hit; else its turn alone, if that is safe;
    /// else standing still. A hit that is that near already may be driven away from.
    #[must_use]
    pub fn check(&self, wanted: Twist, hits_in_base: &[Point], dt_s: f64) -> Twist {
        let turn = Twist::new(0.0, wanted.angular_rps);
        [wanted, turn].into_iter().find(|twist| self.is_safe(twist, hits_in_base, dt_s)).unwrap_or(Twist::ZERO)
    }

    fn is_safe(&self, twist: &Twist, hits_in_base: &[Point], dt_s: f64) -> bool {
        let limits = &self.body.limits;
        let stop_s =
            (twist.linear_mps.abs() / limits.max_linear_mps2).max(twist.angular_rps.abs() / limits.max_angular_rps2);
        // Slowing down covers half the way of going on for the same time.
        let steps = ((dt_s + 0.5 * stop_s) / STEP_S).ceil().max(1.0) as usize;
        let poses: Vec<Pose> =
            (1..=steps).map(|i| twist.advance(&Pose::default(), STEP_S * i as f64).inverse()).collect();
        let reach_m = (twist.linear_mps.abs() * STEP_S).mul_add(steps as f64, self.radius_m() + MARGIN_M);
        hits_in_base.iter().filter(|hit| hit.coords.norm() <= reach_m).all(|hit| {
            let now_m = self.outline.distance_m(*hit);
            poses.iter().all(|back| {
                let then_m = self.outline.distance_m(back.transform(*hit));
                then_m >= MARGIN_M || then_m >= now_m - 1e-9
            })
        })
    }

    fn radius_m(&self) -> f64 {
        self.body.footprint.circumscribed_radius_m()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Footprint, MotionLimits};

    const LIMITS: MotionLimits =
        MotionLimits { max_linear_mps: 0.5, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 };

    fn guard(footprint: Footprint) -> StopGuard {
        StopGuard::new(&Body { footprint, limits: LIMITS })
    }

    #[test]
    fn it_stops_in_time_and_not_before() {
        let disc = guard(Footprint::RadiusM(0.2));
        let ahead = Twist::new(0.5, 0.0);
        // 0.05 m in 0.1 s, 0.125 m to stop, 0.2 m radius, 4 mm margin.
        assert_eq!(disc.check(ahead, &[Point::new(0.41, 0.0)], 0.1), ahead);
        assert_eq!(disc.check(ahead, &[Point::new(0.37, 0.0)], 0.1), Twist::ZERO);
        assert_eq!(disc.check(ahead, &[Point::new(-0.3, 0.0), Point::new(0.5, 0.3)], 0.1), ahead);
    }

    #[test]
    fn a_disc_may_turn_where_it_may_not_drive() {
        let disc = guard(Footprint::RadiusM(0.2));
        let arc = Twist::new(0.4, 1.0);
        assert_eq!(disc.check(arc, &[Point::new(0.24, 0.0)], 0.1), Twist::new(0.0, 1.0));
    }

    #[test]
    fn a_long_body_may_not_turn_into_a_wall() {
        let long = guard(Footprint::PolygonM(vec![[-0.5, -0.1], [0.5, -0.1], [0.5, 0.1], [-0.5, 0.1]]));
        assert_eq!(long.check(Twist::new(0.0, 1.0), &[Point::new(0.45, 0.15)], 0.1), Twist::ZERO);
        assert_eq!(long.check(Twist::new(0.0, -1.0), &[Point::new(0.45, 0.15)], 0.1), Twist::new(0.0, -1.0));
    }

    #[test]
    fn what_touches_already_may_be_left() {
        let disc = guard(Footprint::RadiusM(0.2));
        let back = Twist::new(-0.2, 0.0);
        assert_eq!(disc.check(back, &[Point::new(0.21, 0.0)], 0.1), back);
    }
}
