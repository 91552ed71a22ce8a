//! Which frontier next (floor 1): one file for each strategy.

mod nearest;

pub use nearest::Nearest;

use crate::geometry::{Point, Pose};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A frontier that the robot can get to, as the strategies see it.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The frontier's representative point in the map frame.
    pub target: Point,
    /// Where the robot would stand.
    pub goal: Pose,
    /// Number of frontier cells.
    pub size_cells: usize,
    /// Cells times resolution, metres.
    pub size_m: f64,
    /// Euclidean distance from the robot to the target, metres.
    pub distance_m: f64,
    /// Cost of the cheapest way to the goal, in metres of open space.
    pub way_m: f64,
}

/// What a strategy knows besides the candidates.
#[derive(Clone, Copy, Debug)]
pub struct SelectionContext {
    /// Where the robot is.
    pub robot_in_map: Pose,
}

/// How good a candidate is: the smallest total is best.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Score {
    /// What orders the candidates.
    pub total: f64,
    /// What the total is made of, by name, for the decision record.
    pub parts: BTreeMap<&'static str, f64>,
}

/// Scores candidates.
pub trait GoalSelector: Send {
    /// The strategy's name in configuration files.
    fn name(&self) -> &'static str;

    /// One score for each candidate, in the same order.
    fn score(&mut self, candidates: &[Candidate], context: &SelectionContext) -> Vec<Score>;
}

/// The strategies with their parameters, by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
pub enum SelectorConfig {
    /// The Euclidean nearest first (Topiwala 2018).
    Nearest,
}

impl SelectorConfig {
    /// All strategies with their default parameters, for tables of tests and help.
    pub const ALL: &'static [Self] = &[Self::Nearest];

    /// A strategy with these parameters.
    #[must_use]
    pub fn build(&self) -> Box<dyn GoalSelector> {
        match self {
            Self::Nearest => Box::new(Nearest),
        }
    }
}
