//! The parameters of the Dynamic Window Approach ([`super::Dwa`]).

use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How much each critic counts; 0 switches it off.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DwaWeights {
    /// Weight of the forward speed: faster is better.
    pub speed: f64,
    /// Weight of the angle to the aim where the simulation ends: smaller is better.
    pub direction: f64,
    /// Weight of the distance from the path where the simulation ends: smaller is better.
    pub path: f64,
    /// Weight of the distance from obstacles along the simulation: larger is better.
    pub clearance: f64,
}

impl DwaWeights {
    /// The default weights.
    pub const DEFAULT: Self = Self { speed: 0.6, direction: 1.0, path: 0.4, clearance: 0.2 };
}

impl Default for DwaWeights {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Parameters of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DwaConfig {
    /// How far ahead each sample is simulated, seconds.
    pub horizon_s: f64,
    /// Samples of the forward speed.
    pub linear_samples: u32,
    /// Samples of the turning speed, besides 0.
    pub angular_samples: u32,
    /// The aim lies at most so far along the path, metres.
    pub lookahead_m: f64,
    /// Directions farther aside than this are turned to on the spot, radians.
    pub turn_on_spot_above_rad: f64,
    /// Distance that is kept free around the outline while stopping, metres.
    pub margin_m: f64,
    /// Distances from obstacles beyond this count alike, metres.
    pub clearance_cap_m: f64,
    /// Poses of the simulations are at most so far apart, metres.
    pub granularity_m: f64,
    /// How much each critic counts; 0 switches it off.
    pub weights: DwaWeights,
}

impl DwaConfig {
    /// The default parameters.
    pub const DEFAULT: Self = Self {
        horizon_s: 1.2,
        linear_samples: 6,
        angular_samples: 15,
        lookahead_m: 0.8,
        turn_on_spot_above_rad: 0.9,
        margin_m: 0.005,
        clearance_cap_m: 0.4,
        granularity_m: 0.025,
        weights: DwaWeights::DEFAULT,
    };

    /// The numbers with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        let positive = [
            ("controller.horizon_s", self.horizon_s),
            ("controller.lookahead_m", self.lookahead_m),
            ("controller.turn_on_spot_above_rad", self.turn_on_spot_above_rad),
            ("controller.clearance_cap_m", self.clearance_cap_m),
            ("controller.granularity_m", self.granularity_m),
        ];
        let weights = &self.weights;
        let not_negative = [
            ("controller.margin_m", self.margin_m),
            ("controller.weights.speed", weights.speed),
            ("controller.weights.direction", weights.direction),
            ("controller.weights.path", weights.path),
            ("controller.weights.clearance", weights.clearance),
        ];
        let samples =
            [("controller.linear_samples", self.linear_samples), ("controller.angular_samples", self.angular_samples)];
        let positive = positive.map(|(key, value)| Range::POSITIVE.of(key, value));
        let not_negative = not_negative.map(|(key, value)| Range::NOT_NEGATIVE.of(key, value));
        let samples = samples.map(|(key, value)| Range::within(2.0, 200.0, "2 to 200").of(key, f64::from(value)));
        [&positive[..], &not_negative, &samples].concat()
    }
}

impl Default for DwaConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}
