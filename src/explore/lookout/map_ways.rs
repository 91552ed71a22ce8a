//! The ways that strategies ask for, over the map of a decision.

use crate::geometry::{Point, Pose};
use crate::planning::{CoarseWays, PathField};
use crate::selection::{StraightWays, Ways};

/// Searched when they are asked for the first time; straight lines where no field is given.
pub enum MapWays<'a> {
    /// Nobody has asked yet.
    Unasked(&'a PathField, Pose),
    /// Round what is in the way.
    Coarse(Box<CoarseWays>),
    /// Where the robot stands where it cannot, or nobody needs more.
    Straight(StraightWays),
}

impl<'a> MapWays<'a> {
    /// Ways in a field, if there is one.
    pub fn of(field: Option<&'a PathField>, robot_in_map: Pose) -> Self {
        field.map_or(Self::Straight(StraightWays { robot_in_map }), |field| Self::Unasked(field, robot_in_map))
    }

    fn coarse(&mut self) -> Option<&mut CoarseWays> {
        if let Self::Unasked(field, robot) = self {
            *self = Self::Coarse(Box::new(CoarseWays::new(field, *robot)));
        }
        match self {
            Self::Coarse(ways) => Some(ways),
            Self::Unasked(..) | Self::Straight(_) => None,
        }
    }
}

impl Ways for MapWays<'_> {
    fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64> {
        if let Self::Straight(ways) = self {
            return ways.lengths_m(from, to);
        }
        self.coarse().map_or_else(Vec::new, |ways| ways.lengths_m(from, to))
    }

    fn turn_rad(&mut self, to: Point) -> f64 {
        if let Self::Straight(ways) = self {
            return ways.turn_rad(to);
        }
        self.coarse().map_or(0.0, |ways| ways.turn_rad(to))
    }
}
