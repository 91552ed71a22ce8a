//! The parameters of the stand-in for move_base, under its names.

use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// What move_base and its local planner are configured with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MoveBaseConfig {
    /// From one plan to the next while a goal is under way, seconds (`planner_frequency`
    /// is its inverse).
    pub planner_period_s: f64,
    /// A goal without a plan for so long is tried to be recovered, seconds.
    pub planner_patience_s: f64,
    /// The same without a valid velocity, seconds.
    pub controller_patience_s: f64,
    /// And without moving by [`Self::oscillation_distance_m`], seconds.
    pub oscillation_timeout_s: f64,
    /// How far the robot must move, metres.
    pub oscillation_distance_m: f64,
    /// A goal is reached within this distance, metres.
    pub xy_goal_tolerance_m: f64,
    /// And within this heading error, radians.
    pub yaw_goal_tolerance_rad: f64,
    /// Unknown cells are planned through (`allow_unknown`).
    pub allow_unknown: bool,
    /// Put around the outline, metres (`footprint_padding`).
    pub footprint_padding_m: f64,
    /// From one costmap to the next, seconds.
    pub costmap_period_s: f64,
    /// A goal is taken up so long after it was sent at least, seconds.
    pub take_up_min_s: f64,
    /// And at most so long.
    pub take_up_max_s: f64,
}

impl Default for MoveBaseConfig {
    fn default() -> Self {
        Self {
            planner_period_s: 1.0,
            planner_patience_s: 5.0,
            controller_patience_s: 5.0,
            oscillation_timeout_s: 10.0,
            oscillation_distance_m: 0.2,
            xy_goal_tolerance_m: 0.2,
            yaw_goal_tolerance_rad: 0.3,
            allow_unknown: true,
            footprint_padding_m: 0.01,
            costmap_period_s: 1.0,
            take_up_min_s: 0.1,
            take_up_max_s: 0.3,
        }
    }
}

impl MoveBaseConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        for (key, value) in [
            ("move_base.planner_period_s", self.planner_period_s),
            ("move_base.planner_patience_s", self.planner_patience_s),
            ("move_base.controller_patience_s", self.controller_patience_s),
            ("move_base.oscillation_timeout_s", self.oscillation_timeout_s),
            ("move_base.oscillation_distance_m", self.oscillation_distance_m),
            ("move_base.xy_goal_tolerance_m", self.xy_goal_tolerance_m),
            ("move_base.yaw_goal_tolerance_rad", self.yaw_goal_tolerance_rad),
            ("move_base.costmap_period_s", self.costmap_period_s),
        ] {
            OutOfRange::unless_positive(key, value)?;
        }
        OutOfRange::unless_not_negative("move_base.footprint_padding_m", self.footprint_padding_m)?;
        OutOfRange::unless_not_negative("move_base.take_up_min_s", self.take_up_min_s)?;
        OutOfRange::unless(
            (self.take_up_min_s..=10.0).contains(&self.take_up_max_s),
            "move_base.take_up_max_s",
            self.take_up_max_s,
            "at least take_up_min_s and at most 10",
        )
    }
}
