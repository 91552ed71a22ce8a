//! Which frontier next (floor 1): one file for each strategy.

mod explore_lite;
mod gain_decay;
mod joint_cost;
mod max_gain;
mod mrtsp;
mod nearest;
mod open_tour;
mod radius_distance;
mod tour;
mod ways;

pub use explore_lite::{ExploreLite, ExploreLiteConfig};
pub use gain_decay::{GainDecay, GainDecayConfig};
pub use joint_cost::{JointCost, JointCostConfig};
pub use max_gain::MaxGain;
pub use mrtsp::Mrtsp;
pub use nearest::{DistanceMeasure, Nearest, NearestConfig};
// The oracle orders its views by it.
#[cfg(feature = "report")]
pub(crate) use open_tour::OpenTour;
pub use radius_distance::RadiusDistance;
pub use tour::{PLACE, TOUR_M, Tour, TourConfig};
pub use ways::{StraightWays, Ways};

use crate::geometry::{Point, Pose};
use crate::grid::{Costmap, OccupancyGrid, Thresholds};
use crate::range::{OutOfRange, Ranged};
use crate::scan::Sight;
use schemars::JsonSchema;
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
    /// Radius of the smallest circle around the frontier, metres; present for the
    /// strategies that need it.
    pub radius_m: Option<f64>,
    /// Euclidean distance from the robot to the target, metres.
    pub distance_m: f64,
    /// Euclidean distance from the robot to the nearest frontier cell, metres; present
    /// for the strategies that need it.
    pub nearest_m: Option<f64>,
    /// Cost of the cheapest way to the goal, in metres of open space; present for the
    /// strategies that need it.
    pub way_m: Option<f64>,
}

impl Candidate {
    /// A candidate with what is known of each: its frontier's point and number of cells of
    /// `resolution_m` metres, and where the robot is and would stand.
    #[must_use]
    pub fn new(target: Point, goal: Pose, size_cells: usize, resolution_m: f64, robot_in_map: &Pose) -> Self {
        Self {
            target,
            goal,
            size_cells,
            size_m: size_cells as f64 * resolution_m,
            radius_m: None,
            distance_m: robot_in_map.distance_to(target),
            nearest_m: None,
            way_m: None,
        }
    }
}

/// What takes time to find out of each frontier, and is left out unless needed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// [`Candidate::radius_m`].
    pub radius: bool,
    /// [`Candidate::nearest_m`].
    pub nearest: bool,
    /// [`Candidate::way_m`].
    pub way: bool,
    /// [`SelectionContext::ways`] that go round obstacles.
    pub ways: bool,
}

/// What a strategy knows besides the candidates.
pub struct SelectionContext<'a> {
    /// When it chooses, seconds.
    pub now_s: f64,
    /// Where the robot is.
    pub robot_in_map: Pose,
    /// How far and how wide it sees.
    pub sight: Sight,
    /// The target that it is on its way to.
    pub under_way: Option<Point>,
    /// The map and the costs over it; `None` where nothing is in the way.
    pub ground: Option<Ground<'a>>,
    /// Ways between places: straight lines unless [`Needs::ways`] asks for more.
    pub ways: &'a mut dyn Ways,
}

/// What the candidates lie on.
#[derive(Clone, Copy, Debug)]
pub struct Ground<'a> {
    /// The map.
    pub grid: &'a OccupancyGrid,
    /// Which of its values are free and which occupied.
    pub thresholds: Thresholds,
    /// What the robot may drive over; its cells need not be the map's.
    pub costmap: &'a Costmap,
}

impl<'a> SelectionContext<'a> {
    /// That of a robot that is on its way to nothing, where nothing is in the way.
    #[must_use]
    pub fn straight(ways: &'a mut StraightWays) -> Self {
        let (robot_in_map, sight) = (ways.robot_in_map, Sight::EVERYWHERE);
        Self { now_s: 0.0, robot_in_map, sight, under_way: None, ground: None, ways }
    }
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

    /// What it needs to know of each candidate.
    fn needs(&self) -> Needs {
        Needs::default()
    }

    /// Whether it weighs itself when to give a goal up for a better one; otherwise the
    /// explorer keeps a goal as long as its frontier is there.
    fn keeps_goals(&self) -> bool {
        false
    }

    /// One score for each candidate, in the same order.
    fn score(&mut self, candidates: &[Candidate], context: &mut SelectionContext<'_>) -> Vec<Score>;
}

/// The strategies with their parameters, by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
pub enum SelectorConfig {
    /// The nearest first (Topiwala 2018, Yamauchi 1997).
    Nearest(NearestConfig),
    /// The largest enclosing circle first (baseline of Liang 2020).
    MaxGain {},
    /// The largest radius for its distance first (Liang 2020).
    RadiusDistance {},
    /// Size and distance, scaled and weighted (Alghfeli).
    JointCost(JointCostConfig),
    /// explore_lite's cost.
    ExploreLite(ExploreLiteConfig),
    /// The longest first, discounted by its way.
    GainDecay(GainDecayConfig),
    /// A tour over all frontiers (Scientific Reports 2025).
    Mrtsp {},
    /// The shortest tour over the real ways, planned anew with every map.
    Tour(TourConfig),
}

impl Default for SelectorConfig {
    fn default() -> Self {
        Self::Nearest(NearestConfig::default())
    }
}

impl SelectorConfig {
    /// All strategies with their default parameters, for tables of tests and help.
    #[must_use]
    pub fn all() -> [Self; 8] {
        [
            Self::default(),
            Self::MaxGain {},
            Self::RadiusDistance {},
            Self::JointCost(JointCostConfig::default()),
            Self::ExploreLite(ExploreLiteConfig::default()),
            Self::GainDecay(GainDecayConfig::default()),
            Self::Mrtsp {},
            Self::Tour(TourConfig::default()),
        ]
    }

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the parameter.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        Ranged::check_all(self.numbers())
    }

    /// The numbers with their ranges.
    pub(crate) fn numbers(&self) -> Vec<Ranged> {
        match self {
            Self::JointCost(config) => config.numbers(),
            Self::ExploreLite(config) => config.numbers(),
            Self::GainDecay(config) => config.numbers(),
            Self::Tour(config) => config.numbers(),
            Self::Nearest(_) | Self::MaxGain {} | Self::RadiusDistance {} | Self::Mrtsp {} => Vec::new(),
        }
    }

    /// A strategy with these parameters.
    #[must_use]
    pub fn build(&self) -> Box<dyn GoalSelector> {
        match *self {
            Self::Nearest(config) => Box::new(Nearest(config)),
            Self::MaxGain {} => Box::new(MaxGain),
            Self::RadiusDistance {} => Box::new(RadiusDistance),
            Self::JointCost(config) => Box::new(JointCost(config)),
            Self::ExploreLite(config) => Box::new(ExploreLite(config)),
            Self::GainDecay(config) => Box::new(GainDecay(config)),
            Self::Mrtsp {} => Box::new(Mrtsp),
            Self::Tour(config) => Box::new(Tour(config)),
        }
    }
}

#[cfg(test)]
mod tests;
