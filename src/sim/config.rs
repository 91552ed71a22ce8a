//! What a simulation is run with, besides its world and its robot.

use super::schedule::period;
use super::{DriverKind, MapperConfig, MoveBaseConfig, OdometryNoise, SlamConfig, SlamKind};
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sim::MapStyle;

    #[test]
    fn the_defaults_are_valid() {
        assert_eq!(SimConfig::default().validate(), Ok(()));
    }

    #[test]
    fn a_bad_number_is_named_with_its_range() {
        let config = SimConfig { tick_period_s: 0.0, ..SimConfig::default() };
        let message = config.validate().unwrap_err().to_string();
        assert_eq!(message, "tick_period_s is 0: must be between 0.001 and 3600");
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
