//! The Dynamic Window Approach: the best of the velocities that can be reached and
//! from which the robot can still stop.
//!
//! Fox, Burgard and Thrun, "The Dynamic Window Approach to Collision Avoidance" (IEEE
//! Robotics and Automation Magazine 1997); Alghfeli, Alhosani and Almheiri, section C;
//! the critics of dwa_local_planner. Each tick:
//!
//! 1. The window: the speeds (v, omega) that the limits let the robot reach by the next
//!    tick, v never backwards and never beyond what can be braked away before the
//!    path's end.
//! 2. Admissible is a sample after which the robot, holding it for one tick and then
//!    braking as hard as it may, touches nothing. That is Fox's v <= sqrt(2 a d),
//!    simulated as the body will do it, along the arc, with its whole outline.
//! 3. Each sample is simulated over the horizon, no farther than most of the way to the
//!    aim. Four critics judge it: speed, direction to the aim, nearness to the path,
//!    clearance. Each is scaled to 0..1 over the admissible samples; the largest
//!    weighted sum wins.
//!
//! The aim is the farthest point of the path within the lookahead that can be seen; the
//! robot turns towards it on the spot when it looks far aside, and otherwise drives on,
//! however slowly, while any admissible sample does. When nothing is
//! admissible the robot brakes, and standing it reports [`ControlError::Blocked`], as
//! it does when only turning is left though it faces its aim. Obstacles are the
//! costmap's lethal cells and the newest scan's hits ([`super::surroundings`]); a robot
//! that something has come too near to may move as long as it comes no nearer.
//!
//! Why it never drives into what it knows: the braking that was checked at one tick is
//! the first part of what is possible at the next. O(samples x poses) a tick, each a
//! look-up, some 0.1 ms. Limit: dynamic obstacles are taken to stand still.

use super::dwa_config::DwaConfig;
use super::outline::Outline;
use super::path_progress::PathProgress;
use super::surroundings::Surroundings;
use super::{ControlError, ControlInput, Controller};
use crate::geometry::{Body, Footprint, MotionLimits, Point, Pose, Twist, shortest_angle};

/// The controller for one robot.
#[derive(Clone, Debug)]
pub struct Dwa {
    config: DwaConfig,
    limits: MotionLimits,
    outline: Outline,
    circumscribed_m: f64,
    /// How far the outline's farthest point goes for each radian turned on the spot;
    /// a disc's goes nowhere that was not its own.
    lever_m: f64,
    progress: PathProgress,
}

/// The values of the critics for one sample, all such that more is better.
type Judged = [f64; 4];

/// A spread of a critic below this counts as this, or noise would decide: metres per
/// second, radians, metres, metres.
const LEAST_SPREAD: Judged = [0.05, 0.1, 0.15, 0.2];

/// What one tick knows.
struct Scene<'a> {
    pose: Pose,
    surroundings: &'a Surroundings,
    path: &'a [Point],
    aim: Point,
    dt_s: f64,
    /// What must stay free around the outline, metres.
    needed_m: f64,
}

impl Dwa {
    /// A controller for a robot.
    #[must_use]
    pub fn new(config: DwaConfig, body: &Body) -> Self {
        let circumscribed_m = body.footprint.circumscribed_radius_m();
        let lever_m = match body.footprint {
            Footprint::RadiusM(_) => 0.0,
            Footprint::PolygonM(_) => circumscribed_m,
        };
        let outline = Outline::new(&body.footprint);
        Self { config, limits: body.limits, outline, circumscribed_m, lever_m, progress: PathProgress::new() }
    }

    /// Metres around the outline that must be free at the poses looked at so that
    /// nothing is touched between them, and the margin besides.
    fn margin_m(&self) -> f64 {
        let spacing_m = self.config.granularity_m;
        let between_m = match self.outline {
            // A point between two discs a spacing apart is by the sagitta nearer.
            Outline::Disc(radius_m) => spacing_m * spacing_m / (8.0 * radius_m),
            Outline::Convex(_) => 0.5 * spacing_m,
        };
        self.config.margin_m + between_m
    }

    fn clearance_m(&self, surroundings: &Surroundings, pose: &Pose, enough_m: f64) -> f64 {
        surroundings.clearance_m(&self.outline, self.circumscribed_m, pose, enough_m)
    }

    /// The obstacles as far as any simulation and its critics look.
    fn surroundings(&self, input: &ControlInput<'_>) -> Result<Surroundings, ControlError> {
        let top_mps = input.twist.linear_mps.abs().max(self.limits.max_linear_mps);
        let stop_m = top_mps * input.dt_s + self.limits.stopping_distance_m(top_mps) + top_mps * input.dt_s;
        let ahead_m = (top_mps * self.config.horizon_s).min(self.config.lookahead_m).max(stop_m);
        let reach_m = ahead_m + self.circumscribed_m + self.config.clearance_cap_m.max(self.margin_m());
        Surroundings::new(input, reach_m).map_err(|_| ControlError::Blocked)
    }

    /// The samples of the window, the straight and the slowest ones among them.
    fn window(&self, input: &ControlInput<'_>, on_spot: bool) -> Vec<Twist> {
        let reach = |linear, angular| self.limits.reachable(&input.twist, &Twist::new(linear, angular), input.dt_s);
        let remaining_m = input.path.poses.last().map_or(0.0, |end| input.pose_in_map.distance_to(end.position()));
        let before_end_mps = (2.0 * 0.8 * self.limits.max_linear_mps2 * remaining_m).sqrt().max(0.02);
        let top = self.limits.max_angular_rps;
        let (low, high) = (reach(0.0, -top), reach(before_end_mps.min(self.limits.max_linear_mps), top));
        let (slowest, fastest) = (low.linear_mps.max(0.0), high.linear_mps.max(low.linear_mps).max(0.0));
        let linear_samples = if on_spot { 1 } else { self.config.linear_samples };
        let share = |i: u32, of: u32| f64::from(i) / f64::from(of.max(2) - 1);
        let mut turns: Vec<f64> = (0..self.config.angular_samples)
            .map(|i| low.angular_rps + (high.angular_rps - low.angular_rps) * share(i, self.config.angular_samples))
            .collect();
        if low.angular_rps < 0.0 && high.angular_rps > 0.0 {
            turns.push(0.0);
        }
        (0..linear_samples)
            .map(|i| slowest + (fastest - slowest) * share(i, linear_samples))
            .flat_map(|linear| turns.iter().map(move |&angular| Twist::new(linear, angular)))
            .collect()
    }

    /// Whether the robot can hold a speed for one tick and then stop, touching nothing.
    fn is_admissible(&self, scene: &Scene<'_>, sample: Twist) -> bool {
        let (mut pose, mut twist) = (scene.pose, sample);
        // The fastest body is at rest after top speed / (acceleration x tick) ticks.
        for _ in 0..1000 {
            let swept_m = twist.linear_mps.abs() * scene.dt_s + twist.angular_rps.abs() * scene.dt_s * self.lever_m;
            let count = (swept_m / self.config.granularity_m).ceil().max(1.0) as u32;
            for i in 1..=count {
                let at = twist.advance(&pose, scene.dt_s * f64::from(i) / f64::from(count));
                if self.clearance_m(scene.surroundings, &at, scene.needed_m.max(0.0)) < scene.needed_m {
                    return false;
                }
            }
            pose = twist.advance(&pose, scene.dt_s);
            twist = self.limits.reachable(&twist, &Twist::ZERO, scene.dt_s);
            if twist.linear_mps == 0.0 && (self.lever_m == 0.0 || twist.angular_rps == 0.0) {
                return true;
            }
        }
        false
    }

    /// Simulates a sample over the horizon and asks the critics.
    fn judge(&self, scene: &Scene<'_>, sample: Twist) -> Judged {
        // Short of the aim, so that its direction means something at the end.
        let most_m = 0.7 * scene.pose.distance_to(scene.aim);
        let distance_m = (sample.linear_mps * self.config.horizon_s).min(most_m);
        let duration_s = if sample.linear_mps > 0.0 { distance_m / sample.linear_mps } else { self.config.horizon_s };
        let count = (distance_m / (2.0 * CRITIC_SPACING_M)).ceil().max(1.0) as u32;
        let mut clearance_m = self.config.clearance_cap_m;
        let mut end = scene.pose;
        for i in 1..=count {
            end = sample.advance(&scene.pose, duration_s * f64::from(i) / f64::from(count));
            let here_m = scene.surroundings.distance_m(end.position()) - self.circumscribed_m;
            clearance_m = clearance_m.min(here_m);
        }
        let aside_rad = shortest_angle(end.yaw, Pose::facing(end.position(), scene.aim).yaw).abs();
        let off_path_m = distance_to_line_m(scene.path, end.position());
        [sample.linear_mps, -aside_rad, -off_path_m, clearance_m.max(0.0)]
    }

    /// The sample with the largest weighted sum of critics; the first among equals.
    fn best(&self, judged: &[(Twist, Judged)]) -> Option<Twist> {
        let weights = &self.config.weights;
        let weights = [weights.speed, weights.direction, weights.path, weights.clearance];
        let mut least = [f64::INFINITY; 4];
        let mut most = [f64::NEG_INFINITY; 4];
        for (_, values) in judged {
            for (critic, &value) in values.iter().enumerate() {
                least[critic] = least[critic].min(value);
                most[critic] = most[critic].max(value);
            }
        }
        let total = |values: &Judged| -> f64 {
            (0..4).map(|c| weights[c] * (values[c] - least[c]) / (most[c] - least[c]).max(LEAST_SPREAD[c])).sum()
        };
        let mut best: Option<(f64, Twist)> = None;
        for (twist, values) in judged {
            let total = total(values);
            if best.is_none_or(|(highest, _)| total > highest) {
                best = Some((total, *twist));
            }
        }
        best.map(|(_, twist)| twist)
    }
}

/// Half the distance between poses at which the critics look for obstacles, metres.
const CRITIC_SPACING_M: f64 = 0.05;

impl Controller for Dwa {
    fn name(&self) -> &'static str {
        "dwa"
    }

    fn reset(&mut self) {
        self.progress = PathProgress::new();
    }

    fn control(&mut self, input: &ControlInput<'_>) -> Result<Twist, ControlError> {
        let pose = input.pose_in_map;
        self.progress.advance(input.path, pose.position(), 3.0 * self.config.lookahead_m);
        let aim = self.progress.aim(input, self.config.lookahead_m).ok_or(ControlError::EmptyPath)?;
        let surroundings = self.surroundings(input)?;
        let margin_m = self.margin_m();
        let now_m = self.clearance_m(&surroundings, &pose, margin_m);
        let path = self.progress.ahead(input.path, 2.0 * self.config.lookahead_m);
        let scene = Scene {
            pose,
            surroundings: &surroundings,
            path: &path,
            aim,
            dt_s: input.dt_s,
            needed_m: margin_m.min(now_m - 1e-9),
        };
        let aside_rad = shortest_angle(pose.yaw, Pose::facing(pose.position(), aim).yaw).abs();
        let on_spot = aside_rad > self.config.turn_on_spot_above_rad;
        let mut judged: Vec<(Twist, Judged)> = self
            .window(input, on_spot)
            .into_iter()
            .filter(|&sample| self.is_admissible(&scene, sample))
            .map(|sample| (sample, self.judge(&scene, sample)))
            .collect();
        // Standing is no way to the aim: without this a robot rests where driving on
        // looks a little worse to the critics than turning.
        if !on_spot && judged.iter().any(|(sample, _)| sample.linear_mps > 0.0) {
            judged.retain(|(sample, _)| sample.linear_mps > 0.0);
        }
        let stands = input.twist.is_still();
        // Standing and facing the aim, a robot that can only turn would turn for ever.
        let only_turns = judged.iter().all(|(sample, _)| sample.linear_mps == 0.0);
        let stuck = only_turns && !on_spot && aside_rad < LEAST_SPREAD[1];
        match self.best(&judged) {
            Some(_) if stands && stuck => Err(ControlError::Blocked),
            Some(twist) => Ok(twist),
            None if stands => Err(ControlError::Blocked),
            None => Ok(self.limits.reachable(&input.twist, &Twist::ZERO, input.dt_s)),
        }
    }
}

/// Metres from a point to the nearest place of a line of points.
fn distance_to_line_m(line: &[Point], point: Point) -> f64 {
    let first = line.first().map_or(0.0, |first| nalgebra::distance(first, &point));
    line.windows(2)
        .map(|pair| {
            let along = pair[1] - pair[0];
            let length_squared = along.norm_squared();
            let share = if length_squared > 0.0 { (point - pair[0]).dot(&along) / length_squared } else { 0.0 };
            nalgebra::distance(&(pair[0] + along * share.clamp(0.0, 1.0)), &point)
        })
        .fold(first, f64::min)
}

#[cfg(test)]
#[path = "dwa_tests.rs"]
mod tests;
