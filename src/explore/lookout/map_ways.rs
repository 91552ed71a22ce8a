//! The ways that strategies ask for, over the map of a decision.

use crate::geometry::{Point, Pose};
use crate::planning::{CoarseWays, PathField};
use crate::selection::{StraightWays, Ways};

/// Ways round what is in the way, searched when they are asked for the first time; straight
/// lines where no field is given.
pub struct MapWays<'a> {
    field: Option<&'a PathField>,
    robot_in_map: Pose,
    coarse: Option<CoarseWays>,
}

impl<'a> MapWays<'a> {
    /// Ways in a field, if there is one.
    pub const fn of(field: Option<&'a PathField>, robot_in_map: Pose) -> Self {
        Self { field, robot_in_map, coarse: None }
    }

    fn coarse(&mut self) -> Option<&mut CoarseWays> {
        let field = self.field?;
        Some(self.coarse.get_or_insert_with(|| CoarseWays::new(field, self.robot_in_map)))
    }

    const fn straight(&self) -> StraightWays {
        StraightWays { robot_in_map: self.robot_in_map }
    }
}

impl Ways for MapWays<'_> {
    fn set_out(&mut self, to: Point) -> (f64, f64) {
        let coarse = self.coarse().map(|ways| ways.set_out(to));
        coarse.unwrap_or_else(|| self.straight().set_out(to))
    }

    fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64> {
        let coarse = self.coarse().map(|ways| ways.lengths_m(from, to));
        coarse.unwrap_or_else(|| self.straight().lengths_m(from, to))
    }
}
