//! What a simulation is run with, besides its world and its robot.

use super::{DriverKind, MoveBaseConfig, OdometryNoise, SlamConfig, SlamKind};
use crate::grid::{ThresholdError, Thresholds};
use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// A number of a simulation that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimConfigError {
    /// A value out of its range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Thresholds out of order.
    #[error(transparent)]
    Thresholds(#[from] ThresholdError),
}

/// What the published map's values look like.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MapStyle {
    /// -1, 0 and 100 only, as gmapping publishes.
    #[default]
    Gmapping,
    /// -1 and the probability in percent, 0..=100, as Cartographer publishes.
    Cartographer,
}

/// The mapper: an inverse sensor model in log odds on a grid that grows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MapperConfig {
    /// What published values look like.
    pub style: MapStyle,
    /// Edge length of a cell, metres.
    pub resolution_m: f64,
    /// Added to a cell's log odds by a scan that hits it.
    pub hit_log_odds: f32,
    /// Added to a cell's log odds by a scan that passes it; below zero.
    pub pass_log_odds: f32,
    /// Lower clamp of the log odds.
    pub min_log_odds: f32,
    /// Upper clamp of the log odds.
    pub max_log_odds: f32,
    /// The first map reaches this far from the start to every side, metres.
    pub initial_reach_m: f64,
    /// The map grows by multiples of this, metres.
    pub growth_m: f64,
    /// From one published map to the next, seconds of simulated time.
    pub publish_period_s: f64,
    /// A scan is taken in when the robot has moved this far since the last one, metres.
    pub filter_distance_m: f64,
    /// Or turned this far, radians.
    pub filter_angle_rad: f64,
    /// Or waited this long, seconds.
    pub filter_time_s: f64,
}

impl Default for MapperConfig {
    /// A hit says 70 %, a pass 40 %, certainty ends at 12 % and 97 %.
    fn default() -> Self {
        Self {
            style: MapStyle::Gmapping,
            resolution_m: 0.05,
            hit_log_odds: 0.85,
            pass_log_odds: -0.4,
            min_log_odds: -2.0,
            max_log_odds: 3.5,
            initial_reach_m: 5.0,
            growth_m: 2.0,
            publish_period_s: 1.0,
            filter_distance_m: 0.1,
            filter_angle_rad: 0.2,
            filter_time_s: 1.0,
        }
    }
}

impl MapperConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`SimConfigError`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), SimConfigError> {
        OutOfRange::unless_positive("mapper.resolution_m", self.resolution_m)?;
        OutOfRange::unless_positive("mapper.hit_log_odds", f64::from(self.hit_log_odds))?;
        OutOfRange::unless_positive("mapper.max_log_odds", f64::from(self.max_log_odds))?;
        negative("mapper.pass_log_odds", f64::from(self.pass_log_odds))?;
        negative("mapper.min_log_odds", f64::from(self.min_log_odds))?;
        OutOfRange::unless_positive("mapper.initial_reach_m", self.initial_reach_m)?;
        OutOfRange::unless_positive("mapper.growth_m", self.growth_m)?;
        OutOfRange::unless_not_negative("mapper.filter_distance_m", self.filter_distance_m)?;
        OutOfRange::unless_not_negative("mapper.filter_angle_rad", self.filter_angle_rad)?;
        OutOfRange::unless_not_negative("mapper.filter_time_s", self.filter_time_s)?;
        Ok(period("mapper.publish_period_s", self.publish_period_s)?)
    }
}

/// A simulation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SimConfig {
    /// Decides every random number.
    pub seed: u64,
    /// From one command of the robot's navigation to the next, seconds.
    pub control_period_s: f64,
    /// From one observation of the explorer to the next, seconds.
    pub tick_period_s: f64,
    /// Instead of the lidar's own standard deviation, metres.
    pub lidar_noise_std_m: Option<f64>,
    /// Errors of the wheels' odometry; when left out, none with a perfect SLAM and
    /// [`OdometryNoise::SLIPPING`] with one that matches.
    pub odometry_noise: Option<OdometryNoise>,
    /// How the robot knows where it is.
    pub slam: SlamConfig,
    /// Who drives to goals.
    pub driver: DriverKind,
    /// The stand-in for move_base, where it drives.
    pub move_base: MoveBaseConfig,
    /// The mapper.
    pub mapper: MapperConfig,
    /// What the robot's costmap takes for free and occupied.
    pub thresholds: Thresholds,
}

impl Default for SimConfig {
    fn default() -> Self {
        Self {
            seed: 0,
            control_period_s: 0.1,
            tick_period_s: 0.2,
            lidar_noise_std_m: None,
            odometry_noise: None,
            slam: SlamConfig::default(),
            driver: DriverKind::Navigator,
            move_base: MoveBaseConfig::default(),
            mapper: MapperConfig::default(),
            thresholds: Thresholds::default(),
        }
    }
}

impl SimConfig {
    /// The errors of the wheels' odometry.
    #[must_use]
    pub fn odometry_noise(&self) -> OdometryNoise {
        let usual = match self.slam.kind {
            SlamKind::Perfect => OdometryNoise::NONE,
            SlamKind::Matched => OdometryNoise::SLIPPING,
        };
        self.odometry_noise.unwrap_or(usual)
    }

    /// Checks the numbers.
    ///
    /// # Errors
    /// [`SimConfigError`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), SimConfigError> {
        period("control_period_s", self.control_period_s)?;
        period("tick_period_s", self.tick_period_s)?;
        OutOfRange::unless_not_negative("lidar_noise_std_m", self.lidar_noise_std_m.unwrap_or(0.0))?;
        let OdometryNoise { turn_by_turn, turn_by_drive, drive_by_drive, drive_by_turn } = self.odometry_noise();
        OutOfRange::unless_not_negative("odometry_noise.turn_by_turn", turn_by_turn)?;
        OutOfRange::unless_not_negative("odometry_noise.turn_by_drive", turn_by_drive)?;
        OutOfRange::unless_not_negative("odometry_noise.drive_by_drive", drive_by_drive)?;
        OutOfRange::unless_not_negative("odometry_noise.drive_by_turn", drive_by_turn)?;
        self.mapper.validate()?;
        self.slam.validate()?;
        self.move_base.validate()?;
        Ok(self.thresholds.validate()?)
    }
}

/// Simulated time is counted in whole microseconds.
fn period(key: &'static str, value: f64) -> Result<(), OutOfRange> {
    OutOfRange::unless((1e-3..=3600.0).contains(&value), key, value, "between 0.001 and 3600")
}

fn negative(key: &'static str, value: f64) -> Result<(), OutOfRange> {
    OutOfRange::unless(value.is_finite() && value < 0.0, key, value, "finite and < 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_valid() {
        assert_eq!(SimConfig::default().validate(), Ok(()));
    }

    #[test]
    fn a_bad_number_is_named_with_its_range() {
        let config = SimConfig { tick_period_s: 0.0, ..SimConfig::default() };
        let message = config.validate().unwrap_err().to_string();
        assert_eq!(message, "tick_period_s is 0: must be between 0.001 and 3600");
        let mapper = MapperConfig { pass_log_odds: 0.4, ..MapperConfig::default() };
        assert!(mapper.validate().unwrap_err().to_string().starts_with("mapper.pass_log_odds is 0.4"));
        let noisy = SimConfig { lidar_noise_std_m: Some(f64::NAN), ..SimConfig::default() };
        assert!(noisy.validate().is_err());
    }

    #[test]
    fn files_may_give_a_part_and_nothing_unknown() {
        let config: SimConfig = serde_saphyr::from_str("seed: 7\nmapper: {style: cartographer}").unwrap();
        assert_eq!((config.seed, config.mapper.style), (7, MapStyle::Cartographer));
        assert_eq!(config.tick_period_s, 0.2);
        assert!(serde_saphyr::from_str::<SimConfig>("sead: 7").is_err());
    }
}
