//! What an occupancy value says about a cell.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The three kinds of territory of Yamauchi 1997 and Topiwala 2018, and a fourth that lies
/// between the thresholds, where these leave room for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellState {
    /// Known and without an obstacle.
    Free,
    /// Known to hold an obstacle.
    Occupied,
    /// Not seen.
    Unknown,
    /// Seen, and neither free nor occupied: Cartographer's greys, and the rims of obstacles. The
    /// robot keeps off; no frontier runs beside it, as there is nothing to discover.
    Unsettled,
}

/// Thresholds that contradict each other or the range of occupancy values.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("free_max {free_max} and occupied_min {occupied_min}: must satisfy {}", Thresholds::ALLOWED)]
pub struct ThresholdError {
    /// As given.
    pub free_max: i8,
    /// As given.
    pub occupied_min: i8,
}

/// Where free ends and occupied begins on the scale -1, 0..100 of
/// `nav_msgs/OccupancyGrid`. A value in between has been seen and is neither. The defaults
/// leave none in between and take every value below 65 as free: Cartographer publishes greys
/// for what it has seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Thresholds {
    /// The largest value of the map that is free, percent occupied.
    pub free_max: i8,
    /// The smallest value of the map that is occupied, percent occupied.
    pub occupied_min: i8,
}

impl Default for Thresholds {
    fn default() -> Self {
        Self { free_max: 64, occupied_min: 65 }
    }
}

impl Thresholds {
    /// What the two must satisfy, in words.
    pub(crate) const ALLOWED: &'static str = "0 <= free_max < occupied_min <= 100";

    /// Checks the order of the two.
    ///
    /// # Errors
    /// [`ThresholdError`] when they are out of order or out of 0..=100.
    pub fn validate(&self) -> Result<(), ThresholdError> {
        let Self { free_max, occupied_min } = *self;
        if 0 <= free_max && free_max < occupied_min && occupied_min <= 100 {
            Ok(())
        } else {
            Err(ThresholdError { free_max, occupied_min })
        }
    }

    /// The kind of territory that a value stands for.
    #[must_use]
    pub const fn classify(&self, value: i8) -> CellState {
        if value >= self.occupied_min {
            CellState::Occupied
        } else if value >= 0 && value <= self.free_max {
            CellState::Free
        } else if value < 0 {
            CellState::Unknown
        } else {
            CellState::Unsettled
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_are_free_below_the_obstacle_threshold() {
        let t = Thresholds::default();
        for (value, expected) in [
            (-1, CellState::Unknown),
            (0, CellState::Free),
            (47, CellState::Free),
            (64, CellState::Free),
            (65, CellState::Occupied),
            (100, CellState::Occupied),
            (-128, CellState::Unknown),
        ] {
            assert_eq!(t.classify(value), expected, "{value}");
        }
    }

    #[test]
    fn between_the_thresholds_is_seen_and_not_settled() {
        let t = Thresholds { free_max: 25, occupied_min: 65 };
        assert_eq!(t.classify(25), CellState::Free);
        assert_eq!(t.classify(26), CellState::Unsettled);
        assert_eq!(t.classify(64), CellState::Unsettled);
        assert_eq!(t.classify(-1), CellState::Unknown);
    }

    #[test]
    fn thresholds_out_of_order_are_refused() {
        for (free_max, occupied_min) in [(65, 65), (70, 65), (-1, 65), (20, 101)] {
            assert!(Thresholds { free_max, occupied_min }.validate().is_err());
        }
    }
}
