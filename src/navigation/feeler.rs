//! Whether a slow motion brings the body nearer to anything.

use super::NavigationInput;
use crate::control::{ControlInput, Outline, Surroundings};
use crate::geometry::{Body, Path, Pose, Twist};

/// The body may be this near to something, metres; where it is nearer already, it may come no
/// nearer. More than the noise of a lidar.
const CLEAR_M: f64 = 0.02;
/// What is looked ahead, seconds, in steps of so many.
const AHEAD_S: f64 = 2.5;
const STEP_S: f64 = 0.1;
/// A motion that leads less far is none.
const FEWEST_STEPS: usize = 4;
/// Distances from here on are as good as any, metres.
pub const ENOUGH_M: f64 = 0.4;
/// The fastest motion that is asked about, metres per second.
const FASTEST_MPS: f64 = 0.12;

/// A body that feels its way.
#[derive(Clone, Debug)]
pub struct Feeler {
    outline: Outline,
    radius_m: f64,
}

impl Feeler {
    /// The feeler of a body.
    pub fn new(body: &Body) -> Self {
        Self { outline: Outline::new(&body.footprint), radius_m: body.footprint.circumscribed_radius_m() }
    }

    /// What stands around, by scan and costmap; nothing can be felt without a scan.
    pub fn around(&self, input: &NavigationInput<'_>) -> Option<Surroundings> {
        let path = Path::default();
        let control = ControlInput {
            pose_in_map: input.pose_in_map,
            twist: input.twist,
            path: &path,
            costmap: input.costmap,
            scan: Some(input.scan?),
            dt_s: STEP_S,
        };
        Surroundings::new(&control, self.radius_m + ENOUGH_M + AHEAD_S * FASTEST_MPS).ok()
    }

    /// How far from everything the body is at a pose, metres, up to where it is far enough.
    pub fn clearance_m(&self, pose: &Pose, around: &Surroundings) -> f64 {
        around.clearance_m(&self.outline, self.radius_m, pose, ENOUGH_M)
    }

    /// How far from everything the body comes, metres, if a motion brings it nearer to
    /// nothing for at least a few steps; coming nearer by `slack_m` is nothing.
    pub fn gain_m(&self, pose: &Pose, around: &Surroundings, motion: Twist, slack_m: f64) -> Option<f64> {
        let clearance_m = |at: &Pose| self.clearance_m(at, around);
        let least_m = clearance_m(pose).min(CLEAR_M) - slack_m;
        let steps = (1..=(AHEAD_S / STEP_S) as u32).map(|step| motion.advance(pose, STEP_S * f64::from(step)));
        let led: Vec<f64> = steps.map(|at| clearance_m(&at)).take_while(|&here_m| here_m >= least_m).collect();
        (led.len() >= FEWEST_STEPS).then(|| led.into_iter().fold(f64::NEG_INFINITY, f64::max))
    }
}
