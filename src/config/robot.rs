//! A robot: outline, speeds, lidar and how its navigation inflates obstacles.
//! One file for each in `configs/robots/`.

use super::names::one_line;
use crate::explore::RobotTraits;
use crate::geometry::{Body, Footprint, FootprintError, MotionLimits, Pose};
use crate::grid::Inflation;
use crate::range::{OutOfRange, Range, Ranged};
use crate::scan::Sight;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::f64::consts::TAU;

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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LidarConfig {
    /// Where the lidar is mounted in the base frame.
    #[serde(default)]
    pub mount: Pose,
    /// Shortest distance it can measure, metres.
    pub range_min_m: f64,
    /// Longest distance it can measure, metres.
    pub range_max_m: f64,
    /// Opening angle, centred ahead, radians; 2 pi sees all round.
    pub field_of_view_rad: f64,
    /// Number of rays of one sweep.
    pub rays: u32,
    /// Sweeps per second, Hz.
    pub rate_hz: f64,
    /// Standard deviation of a range, metres.
    #[serde(default)]
    pub noise_std_m: f64,
}

/// How the robot's navigation inflates obstacles (costmap_2d's inflation layer).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotConfig {
    /// What users call the robot.
    pub name: String,
    /// Its outline, by a radius or by a polygon.
    pub footprint: Footprint,
    /// What it is able to do.
    pub limits: MotionLimits,
    /// Its planar lidar and where that is mounted.
    pub lidar: LidarConfig,
    /// How its navigation inflates obstacles (costmap_2d's inflation layer).
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
        Ok(Ranged::check_all(self.numbers())?)
    }

    /// The ranges of all numbers, by their paths.
    pub(super) fn ranges(&self) -> BTreeMap<String, Range> {
        // Checked by `Footprint::validate`.
        let radius = ("footprint.radius_m".to_owned(), Footprint::RADIUS);
        self.numbers().into_iter().map(|n| (n.key.to_owned(), n.range)).chain([radius]).collect()
    }

    /// The numbers with their ranges, but for those of the footprint.
    fn numbers(&self) -> Vec<Ranged> {
        let (limits, lidar, costmap) = (&self.limits, &self.lidar, &self.costmap);
        let positive =
            [("limits.max_linear_mps2", limits.max_linear_mps2), ("limits.max_angular_rps2", limits.max_angular_rps2)];
        let not_negative =
            [("lidar.range_min_m", lidar.range_min_m), ("costmap.cost_scaling_factor", costmap.cost_scaling_factor)];
        let mount =
            [("lidar.mount.x", lidar.mount.x), ("lidar.mount.y", lidar.mount.y), ("lidar.mount.yaw", lidar.mount.yaw)];
        let longest = Range::above(lidar.range_min_m, 1e3, "> range_min_m and at most 1000");
        let opening = Range::above(0.0, TAU + 1e-6, "above 0 and at most 2 pi");
        let fast = Range::above(0.0, 100.0, "above 0 and at most 100");
        let mut numbers = vec![
            fast.of("limits.max_linear_mps", limits.max_linear_mps),
            fast.of("limits.max_angular_rps", limits.max_angular_rps),
        ];
        numbers.extend(positive.map(|(key, value)| Range::POSITIVE.of(key, value)));
        numbers.extend(not_negative.map(|(key, value)| Range::NOT_NEGATIVE.of(key, value)));
        numbers.extend(mount.map(|(key, value)| Range::FINITE.of(key, value)));
        numbers.push(longest.of("lidar.range_max_m", lidar.range_max_m));
        numbers.push(opening.of("lidar.field_of_view_rad", lidar.field_of_view_rad));
        numbers.push(Range::within(1.0, 1e5, "1 to 100000").of("lidar.rays", f64::from(lidar.rays)));
        numbers.push(Range::within(0.01, 1e3, "0.01 to 1000").of("lidar.rate_hz", lidar.rate_hz));
        // The map grows by what noise lets a wall be seen at.
        numbers.push(Range::within(0.0, 10.0, "0 to 10").of("lidar.noise_std_m", lidar.noise_std_m));
        let inflated = Range::above(0.0, 100.0, "above 0 and at most 100");
        numbers.push(inflated.of("costmap.inflation_radius_m", costmap.inflation_radius_m));
        numbers.push(Range::within(0.0, 100.0, "0 to 100").of("costmap.padding_m", costmap.padding_m));
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::super::builtin_robot;
    use super::*;

    #[test]
    fn robots_that_nobody_can_build_are_refused() {
        let check = |change: &dyn Fn(&mut RobotConfig), expected: &str| {
            let mut robot = builtin_robot("turtlebot2").unwrap();
            change(&mut robot);
            assert_eq!(robot.validate().unwrap_err().to_string(), expected);
        };
        check(
            &|r| r.footprint = Footprint::RadiusM(1e9),
            "footprint.radius_m is 1000000000: must be above 0 and at most 100",
        );
        check(
            &|r| r.lidar.range_max_m = 1e30,
            &format!("lidar.range_max_m is {}: must be > range_min_m and at most 1000", 1e30),
        );
        check(
            &|r| r.limits.max_linear_mps = 1e9,
            "limits.max_linear_mps is 1000000000: must be above 0 and at most 100",
        );
        check(&|r| r.lidar.noise_std_m = 127.0, "lidar.noise_std_m is 127: must be 0 to 10");
        check(&|r| r.lidar.rate_hz = 1e308, &format!("lidar.rate_hz is {}: must be 0.01 to 1000", 1e308));
        check(&|r| r.costmap.padding_m = 101.0, "costmap.padding_m is 101: must be 0 to 100");
        check(
            &|r| r.costmap.inflation_radius_m = 101.0,
            "costmap.inflation_radius_m is 101: must be above 0 and at most 100",
        );
    }
}
