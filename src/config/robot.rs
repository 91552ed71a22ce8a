//! A robot: outline, speeds, lidar and how its navigation inflates obstacles.
//! One file for each in `configs/robots/`.

use super::names::one_line;
use crate::explore::{RobotTraits, Sight};
use crate::geometry::{Body, Footprint, FootprintError, MotionLimits, Pose};
use crate::grid::Inflation;
use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// A number of a robot file that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RobotConfigError {
    /// The YAML is not a robot.
    #[error("{0}")]
    Syntax(String),
    /// A value out of its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// A footprint that cannot be one.
    #[error(transparent)]
    Footprint(#[from] FootprintError),
    /// A name that no built-in robot has.
    #[error("no robot is called '{name}': must be one of {known}{hint}")]
    UnknownName {
        /// As given.
        name: String,
        /// The names that there are.
        known: String,
        /// The nearest of them, if one is near.
        hint: String,
    },
}

/// A planar lidar and where it is mounted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LidarConfig {
    /// Mounting pose in the base frame.
    #[serde(default)]
    pub mount: Pose,
    /// Shortest distance it can measure, metres.
    pub range_min_m: f64,
    /// Longest distance it can measure, metres.
    pub range_max_m: f64,
    /// Opening angle, centred ahead; 2 pi sees all round.
    pub field_of_view_rad: f64,
    /// Rays of one sweep.
    pub rays: u32,
    /// Sweeps per second.
    pub rate_hz: f64,
    /// Standard deviation of a range, metres.
    #[serde(default)]
    pub noise_std_m: f64,
}

/// How the robot's navigation inflates obstacles (costmap_2d's inflation layer).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CostmapConfig {
    /// How far from an obstacle costs reach, metres.
    pub inflation_radius_m: f64,
    /// Rate of the exponential decay, per metre.
    pub cost_scaling_factor: f64,
    /// Added to the footprint's radius, metres.
    #[serde(default)]
    pub padding_m: f64,
}

/// A validated robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotConfig {
    /// What users call it.
    pub name: String,
    /// Its outline.
    pub footprint: Footprint,
    /// What it is able to do.
    pub limits: MotionLimits,
    /// Its lidar.
    pub lidar: LidarConfig,
    /// Its costmap.
    pub costmap: CostmapConfig,
}

impl RobotConfig {
    /// Reads and validates the text of a robot file.
    ///
    /// # Errors
    /// [`RobotConfigError`] that names the key, the value and what is allowed.
    pub fn from_yaml(text: &str) -> Result<Self, RobotConfigError> {
        let robot: Self =
            serde_saphyr::from_str(text).map_err(|e| RobotConfigError::Syntax(one_line(&e.to_string())))?;
        robot.validate()?;
        Ok(robot)
    }

    /// The body, for planners and controllers.
    #[must_use]
    pub fn body(&self) -> Body {
        Body { footprint: self.footprint.clone(), limits: self.limits }
    }

    /// The inflation layer of this robot's costmap. A path is checked for the robot's
    /// centre alone: where the body fits through straight ahead is passable, and where
    /// it can turn any way, with its padding, is cheaper.
    #[must_use]
    pub fn inflation(&self) -> Inflation {
        Inflation {
            inscribed_radius_m: self.footprint.passage_radius_m() + self.costmap.padding_m,
            clear_radius_m: self.footprint.circumscribed_radius_m() + self.costmap.padding_m,
            inflation_radius_m: self.costmap.inflation_radius_m,
            cost_scaling_factor: self.costmap.cost_scaling_factor,
        }
    }

    /// What an explorer knows of this robot.
    #[must_use]
    pub fn traits(&self) -> RobotTraits {
        let LidarConfig { mount, range_max_m, field_of_view_rad, .. } = self.lidar;
        let sight = Sight { range_m: range_max_m, field_of_view_rad, heading_rad: mount.yaw };
        RobotTraits { inflation: self.inflation(), body: self.body(), sight }
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`RobotConfigError`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), RobotConfigError> {
        self.footprint.validate()?;
        for (key, value) in [
            ("limits.max_linear_mps", self.limits.max_linear_mps),
            ("limits.max_angular_rps", self.limits.max_angular_rps),
            ("limits.max_linear_mps2", self.limits.max_linear_mps2),
            ("limits.max_angular_rps2", self.limits.max_angular_rps2),
            ("lidar.range_max_m", self.lidar.range_max_m),
            ("lidar.field_of_view_rad", self.lidar.field_of_view_rad),
            ("lidar.rays", f64::from(self.lidar.rays)),
            ("lidar.rate_hz", self.lidar.rate_hz),
            ("costmap.inflation_radius_m", self.costmap.inflation_radius_m),
        ] {
            OutOfRange::unless_positive(key, value)?;
        }
        for (key, value) in [
            ("lidar.range_min_m", self.lidar.range_min_m),
            ("lidar.noise_std_m", self.lidar.noise_std_m),
            ("costmap.cost_scaling_factor", self.costmap.cost_scaling_factor),
            ("costmap.padding_m", self.costmap.padding_m),
        ] {
            OutOfRange::unless_not_negative(key, value)?;
        }
        let lidar = &self.lidar;
        OutOfRange::unless(
            lidar.range_min_m < lidar.range_max_m,
            "lidar.range_min_m",
            lidar.range_min_m,
            "below range_max_m",
        )?;
        let all_round = lidar.field_of_view_rad <= std::f64::consts::TAU + 1e-6;
        OutOfRange::unless(all_round, "lidar.field_of_view_rad", lidar.field_of_view_rad, "at most 2 pi")?;
        OutOfRange::unless(lidar.rays <= 100_000, "lidar.rays", f64::from(lidar.rays), "at most 100000")?;
        Ok(())
    }
}
