//! What the mapper is run with.

use super::schedule::period;
use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

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
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
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
        period("mapper.publish_period_s", self.publish_period_s)
    }
}

fn negative(key: &'static str, value: f64) -> Result<(), OutOfRange> {
    OutOfRange::unless(value.is_finite() && value < 0.0, key, value, "finite and < 0")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bad_number_is_named_with_its_range() {
        let mapper = MapperConfig { pass_log_odds: 0.4, ..MapperConfig::default() };
        assert!(mapper.validate().unwrap_err().to_string().starts_with("mapper.pass_log_odds is 0.4"));
    }
}
