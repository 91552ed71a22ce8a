//! Tolerances and patience of the navigator, as settings give them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Tolerances and patience, in the terms of move_base and its local planners.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NavigatorConfig {
    /// Time from one velocity command to the next, seconds.
    pub control_period_s: f64,
    /// A goal is reached within this distance, metres.
    pub xy_goal_tolerance_m: f64,
    /// A goal is reached within this heading error besides, radians.
    pub yaw_goal_tolerance_rad: f64,
    /// A path that is still free is planned anew after this time, seconds.
    pub replan_period_s: f64,
    /// A goal without a path is aborted after this time, seconds.
    pub planner_patience_s: f64,
    /// A goal whose path cannot be followed is aborted after this time, seconds.
    pub controller_patience_s: f64,
    /// Speed of turns on the spot, radians per second.
    pub turn_speed_rps: f64,
}

impl Default for NavigatorConfig {
    fn default() -> Self {
        Self {
            control_period_s: 0.1,
            xy_goal_tolerance_m: 0.15,
            yaw_goal_tolerance_rad: 0.3,
            replan_period_s: 2.0,
            planner_patience_s: 2.0,
            controller_patience_s: 5.0,
            turn_speed_rps: 1.0,
        }
    }
}
