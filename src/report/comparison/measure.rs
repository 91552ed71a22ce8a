//! What is measured of every run: times to shares of coverage, time and way to the end.

use super::ComparedRun;
use serde::Serialize;

/// What is measured of every run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Measure {
    /// Seconds to half of the reachable free area.
    T50,
    /// Seconds to 90 % of it.
    T90,
    /// Seconds to 95 % of it.
    T95,
    /// Seconds to 99 % of it.
    T99,
    /// Seconds to the end, of runs that succeeded.
    Tend,
    /// Metres driven to the end, of runs that succeeded.
    Distance,
}

impl Measure {
    /// All of them, as tables show them.
    pub const ALL: [Self; 6] = [Self::T50, Self::T90, Self::T95, Self::T99, Self::Tend, Self::Distance];

    /// The head of its column.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::T50 => "T50 (s)",
            Self::T90 => "T90 (s)",
            Self::T95 => "T95 (s)",
            Self::T99 => "T99 (s)",
            Self::Tend => "Tend (s)",
            Self::Distance => "distance (m)",
        }
    }

    /// Of one run, `None` where it was not reached.
    #[must_use]
    pub fn of(self, run: &ComparedRun) -> Option<f64> {
        let time_s = |share: &str| run.time_to_coverage_s.get(share).copied().flatten();
        match self {
            Self::T50 => time_s("0.50"),
            Self::T90 => time_s("0.90"),
            Self::T95 => time_s("0.95"),
            Self::T99 => time_s("0.99"),
            Self::Tend => run.succeeded().then_some(run.sim_time_s),
            Self::Distance => run.succeeded().then_some(run.distance_m),
        }
    }
}
