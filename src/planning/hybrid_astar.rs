//! Hybrid A*: a path of arcs that the robot can drive, from pose to pose.
//!
//! Alghfeli, Alhosani and Almheiri, "Frontier-Based Exploration Algorithm using 2D
//! LiDAR: Hybrid A* Path Planning & DWA Controller Approach", section B; after Dolgov,
//! Thrun, Montemerlo and Diebel (2010). States are (x, y, theta); a motion primitive
//! holds the robot's largest speed straight on or at its largest turning speed to
//! either side for [`HybridAstarConfig::primitive_s`] seconds (eqs. 1 to 3, as exact
//! arcs), and is checked for collisions every half cell along the way; g is the
//! length travelled, h the Euclidean distance. A path within `goal_threshold_m` of the
//! goal is good enough; its last stretch to the goal is straight and looked at for the
//! centre alone, as a goal at a frontier has unknown cells under the outline. When the first
//! heading finds nothing, the robot turns on the spot and begins 90, 180 and 270
//! degrees aside, where its outline is free so. A robot too near to an obstacle first drives straight to the nearest
//! passable cell, as with the other planners.
//!
//! The path's cost is its length in metres. An expansion takes about two microseconds
//! for a disc, four for a polygon. A flood asks beforehand whether there is a way
//! at all, so that a goal behind walls costs no expansions. Limits: the path is not the
//! shortest possible (few motions, one state kept per bin), a narrow place may be
//! missed, and obstacles thinner than half a cell may be clipped. With the paper's
//! heuristic a goal behind many rooms spends the default limit in dead ends (about one
//! in four of 5 to 20 m in an office building); [`HybridHeuristic::Grid`] finds most of
//! those, or a larger limit does in more time. The explorer tries its other goals then,
//! and when none is left drives part of the way and asks again.

use super::endpoints::{goal_index, start_index};
use super::hybrid_search::{Outcome, Primitive, Task, search};
use super::lattice::{Lattice, STRAIGHT};
use super::reach::{connected, passable};
use super::search::Search;
use super::swept::Swept;
use super::{GlobalPlanner, Path, PlanError};
use crate::geometry::{Body, Point, Pose, Twist};
use crate::grid::{Costmap, GridInfo};
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// What guides the search to the goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum HybridHeuristic {
    /// The straight line, as the paper has it: it looks into every dead end on the way.
    #[default]
    Euclidean,
    /// The cost of the cheapest way over the grid, in metres of open space (the
    /// heuristic "with obstacles" of Dolgov et al.): a fraction of the expansions, and
    /// paths that keep away from obstacles.
    Grid,
}

/// Parameters of the planner.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct HybridAstarConfig {
    /// How long a motion primitive lasts (the paper's dt), seconds.
    pub primitive_s: f64,
    /// Edge of a bin of the state lattice, metres. It is smaller where a primitive is so short
    /// that a straight one would end in the bin where it began.
    pub lattice_m: f64,
    /// Into how many bins the lattice divides the headings.
    pub lattice_headings: u32,
    /// A path that ends within this distance of the goal has found it, metres.
    pub goal_threshold_m: f64,
    /// The search is given up after so many expansions, those of other headings included.
    pub max_expansions: u32,
    /// What guides the search to the goal.
    pub heuristic: HybridHeuristic,
}

impl HybridAstarConfig {
    /// The default parameters.
    pub const DEFAULT: Self = Self {
        primitive_s: 0.5,
        lattice_m: 0.2,
        lattice_headings: 8,
        goal_threshold_m: 0.3,
        max_expansions: 12_000,
        heuristic: HybridHeuristic::Euclidean,
    };

    /// The numbers with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        let (headings, expansions) = (f64::from(self.lattice_headings), f64::from(self.max_expansions));
        vec![
            Range::POSITIVE.of("planner.primitive_s", self.primitive_s),
            Range::POSITIVE.of("planner.lattice_m", self.lattice_m),
            Range::POSITIVE.of("planner.goal_threshold_m", self.goal_threshold_m),
            Range::within(4.0, 360.0, "4 to 360").of("planner.lattice_headings", headings),
            Range::within(1.0, 1e7, "1 to 10000000").of("planner.max_expansions", expansions),
        ]
    }
}

impl Default for HybridAstarConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// The planner for one robot.
///
/// The robot looks aside: it drives a bow, where other planners lead straight to the goal.
///
/// ```
/// use frontier_explorer::config::builtin_robot;
/// use frontier_explorer::geometry::Pose;
/// use frontier_explorer::grid::{Costmap, GridInfo};
/// use frontier_explorer::planning::{Astar, GlobalPlanner, HybridAstar, HybridAstarConfig};
///
/// let costmap = Costmap::from_costs(GridInfo::new(40, 40, 0.1, Pose::default())?, vec![0; 1600]).unwrap();
/// let (start, goal) = (Pose::new(1.0, 2.0, 0.0), Pose::new(1.0, 3.0, 3.1));
/// let mut planner = HybridAstar::new(HybridAstarConfig::default(), builtin_robot("turtlebot2")?.body());
/// let bow = planner.plan(&costmap, &start, &goal)?;
/// assert!(bow.length_m() > Astar::default().plan(&costmap, &start, &goal)?.length_m());
/// assert!(bow.poses.iter().any(|pose| pose.x > 1.1), "it begins straight on or in an arc");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct HybridAstar {
    config: HybridAstarConfig,
    body: Body,
    grid_search: Search,
    expansions: u32,
}

impl HybridAstar {
    /// A planner for a robot.
    #[must_use]
    pub fn new(config: HybridAstarConfig, body: Body) -> Self {
        Self { config, body, grid_search: Search::default(), expansions: 0 }
    }

    /// States expanded by the last plan.
    #[must_use]
    pub const fn expansions(&self) -> u32 {
        self.expansions
    }

    /// Straight on, to the left, to the right, at the robot's largest speeds.
    fn primitives(&self, info: &GridInfo) -> [Primitive; 3] {
        let limits = &self.body.limits;
        let spacing_m = 0.5 * info.resolution_m();
        [0.0, limits.max_angular_rps, -limits.max_angular_rps].map(|angular_rps| {
            Primitive::new(Twist::new(limits.max_linear_mps, angular_rps), self.config.primitive_s, spacing_m)
        })
    }

    /// Edge of a bin: a straight primitive leads out of it in any direction.
    fn lattice_m(&self) -> f64 {
        let primitive_m = self.body.limits.max_linear_mps * self.config.primitive_s;
        self.config.lattice_m.min(primitive_m * std::f64::consts::FRAC_1_SQRT_2)
    }

    /// Metres left from a pose: straight, or over the grid as far as it was searched.
    fn estimate_m(&self, info: &GridInfo, start: usize, pose: &Pose, goal: Point) -> f64 {
        let straight_m = pose.distance_to(goal);
        match self.config.heuristic {
            HybridHeuristic::Euclidean => straight_m,
            HybridHeuristic::Grid => {
                let here = info.index(info.cell_at(pose.position()));
                // The search stopped at the start: what it did not reach is farther.
                let cost = here.and_then(|index| self.grid_search.cost(index)).or(self.grid_search.cost(start));
                let grid_m = cost.map_or(0.0, |cost| f64::from(cost) / f64::from(STRAIGHT) * info.resolution_m());
                straight_m.max(grid_m)
            }
        }
    }
}

impl GlobalPlanner for HybridAstar {
    fn name(&self) -> &'static str {
        "hybrid_astar"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        self.expansions = 0;
        let info = costmap.info();
        let start = start_index(costmap, start_in_map)?;
        let goal = goal_index(costmap, goal_in_map)?;
        let has_way = match self.config.heuristic {
            HybridHeuristic::Euclidean => connected(&passable(costmap), start).contains(info.cell(goal)),
            HybridHeuristic::Grid => self.grid_search.run(&Lattice::new(costmap), goal, Some(start), false),
        };
        if !has_way {
            return Err(PlanError::no_path(goal_in_map.position()));
        }
        let swept = Swept::new(costmap, &self.body.footprint);
        let primitives = self.primitives(info);
        let goal_point = goal_in_map.position();
        let threshold_m = self.config.goal_threshold_m;
        let task = Task {
            swept: &swept,
            primitives: &primitives,
            lattice_m: self.lattice_m(),
            headings: self.config.lattice_headings,
            estimate_m: |pose: &Pose| self.estimate_m(info, start, pose, goal_point),
            is_goal: |pose: &Pose| {
                pose.distance_to(goal_point) <= threshold_m && swept.straight(pose.position(), goal_point).is_some()
            },
        };
        let first = first_state(info, start, start_in_map);
        let limit = self.config.max_expansions;
        let mut left = limit;
        let mut result = Err(PlanError::no_path(goal_point));
        for quarter in [0.0, 1.0, 3.0, 2.0] {
            let turned = Pose::new(first.x, first.y, crate::geometry::normalize_angle(first.yaw + quarter * FRAC_PI_2));
            // The robot turns to no heading in which its outline would touch; the one that it has
            // it must leave in any case.
            if quarter != 0.0 && !swept.is_free(&turned) {
                continue;
            }
            match search(&task, turned, &mut left) {
                Outcome::Found(poses, length_m) => {
                    result = Ok(complete(poses, length_m, start_in_map, goal_in_map, &swept));
                    break;
                }
                Outcome::Exhausted => {}
                Outcome::Limit => {
                    result = Err(PlanError::IterationLimit { limit: limit as usize });
                    break;
                }
            }
        }
        self.expansions = limit - left;
        result
    }
}

/// Where the search begins: at the robot, or, when that is too near to an obstacle, in
/// the cell it escapes to, with the heading of the way there.
fn first_state(info: &GridInfo, start: usize, start_in_map: &Pose) -> Pose {
    let cell = info.cell(start);
    if cell == info.cell_at(start_in_map.position()) {
        return *start_in_map;
    }
    let escape = info.center(cell);
    Pose::new(escape.x, escape.y, Pose::facing(start_in_map.position(), escape).yaw)
}

/// Adds the way out of the start and the way into the goal.
fn complete(poses: Vec<Pose>, length_m: f64, start: &Pose, goal: &Pose, swept: &Swept<'_>) -> Path {
    let mut path = Path { poses, cost: length_m };
    if let Some(first) = path.poses.first().copied().filter(|first| first.position() != start.position()) {
        path.cost += first.distance_to(start.position());
        path.poses.insert(0, Pose::facing(start.position(), first.position()));
    }
    if let Some(last) = path.poses.last().copied() {
        path.cost += last.distance_to(goal.position());
        path.poses.extend(swept.straight(last.position(), goal.position()).unwrap_or_default());
    }
    // The goal itself, with its heading, in place of the last point of that way.
    if path.poses.len() > 1 {
        path.poses.pop();
    }
    path.poses.push(*goal);
    path
}

#[cfg(test)]
#[path = "hybrid_astar_tests.rs"]
mod tests;
