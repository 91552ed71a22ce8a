//! Which SLAM the simulator has, and how far it errs.

use crate::range::OutOfRange;
use serde::{Deserialize, Serialize};

/// How the simulated robot knows where it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SlamKind {
    /// The true pose, a map without errors once a second: fast.
    #[default]
    Perfect,
    /// Odometry that slips and scans that are matched, as gmapping has it.
    Matched,
}

impl SlamKind {
    /// Its name in options and files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Perfect => "perfect",
            Self::Matched => "matched",
        }
    }

    /// The name where it is told in a run's files: of the perfect one nothing is.
    #[must_use]
    pub fn told(self) -> Option<String> {
        (self != Self::Perfect).then(|| self.name().to_owned())
    }
}

/// The SLAM's parameters; all but the kind are those of `matched`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SlamConfig {
    /// Which one.
    pub kind: SlamKind,
    /// A scan is processed when the robot has moved this far by odometry since the last
    /// one that was, metres (gmapping's `linearUpdate`).
    pub update_distance_m: f64,
    /// Or turned this far, radians (`angularUpdate`). There is no update by time: at rest
    /// no scan is processed and no map published.
    pub update_angle_rad: f64,
    /// A processed scan makes a map if the last one is at least so old, seconds
    /// (`map_update_interval`).
    pub map_interval_s: f64,
    /// What a scan shows, and where the robot is, is known so late at least, seconds.
    pub lateness_min_s: f64,
    /// And at most so late.
    pub lateness_max_s: f64,
    /// A map comes so long after the correction by its scan at least, seconds.
    pub map_delay_min_s: f64,
    /// And at most so long after it.
    pub map_delay_max_s: f64,
    /// Standard deviation along each axis of the error that is added to a match, metres.
    pub match_error_m: f64,
    /// And of its heading, radians.
    pub match_error_rad: f64,
    /// At most so many points of a scan are matched.
    pub max_points: usize,
    /// A match below this mean likelihood is not believed: odometry is.
    pub min_likelihood: f64,
}

impl Default for SlamConfig {
    fn default() -> Self {
        Self {
            kind: SlamKind::Perfect,
            update_distance_m: 0.3,
            update_angle_rad: 0.3,
            map_interval_s: 2.0,
            lateness_min_s: 0.1,
            lateness_max_s: 0.25,
            map_delay_min_s: 0.05,
            map_delay_max_s: 0.5,
            match_error_m: 0.015,
            match_error_rad: 0.006,
            max_points: 180,
            min_likelihood: 0.3,
        }
    }
}

impl SlamConfig {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        OutOfRange::unless_positive("slam.update_distance_m", self.update_distance_m)?;
        OutOfRange::unless_positive("slam.update_angle_rad", self.update_angle_rad)?;
        OutOfRange::unless_not_negative("slam.map_interval_s", self.map_interval_s)?;
        OutOfRange::unless_not_negative("slam.lateness_min_s", self.lateness_min_s)?;
        OutOfRange::unless(
            self.lateness_max_s >= self.lateness_min_s && self.lateness_max_s <= 10.0,
            "slam.lateness_max_s",
            self.lateness_max_s,
            "at least lateness_min_s and at most 10",
        )?;
        OutOfRange::unless_not_negative("slam.match_error_m", self.match_error_m)?;
        OutOfRange::unless_not_negative("slam.match_error_rad", self.match_error_rad)?;
        OutOfRange::unless_not_negative("slam.map_delay_min_s", self.map_delay_min_s)?;
        OutOfRange::unless(
            self.map_delay_max_s >= self.map_delay_min_s && self.map_delay_max_s <= 10.0,
            "slam.map_delay_max_s",
            self.map_delay_max_s,
            "at least map_delay_min_s and at most 10",
        )?;
        OutOfRange::unless(
            (0.0..=1.0).contains(&self.min_likelihood),
            "slam.min_likelihood",
            self.min_likelihood,
            "between 0 and 1",
        )
    }
}
