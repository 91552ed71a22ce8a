//! Plans as GlobalPlanner makes them with its defaults (`old_navfn_behavior` false).
//!
//! What it does with a goal, from its source: the costmap's resolution is the map message's
//! `float32`; a point's place in cells is `(wx - origin) / resolution - 0.5`, and the goal's
//! cell what is left when the fraction is cut off. So the centre of a cell, computed with
//! 0.05, falls into the cell before. There is no tolerance: a goal in a cell that costs 252
//! or more, inscribed ones among them, has no plan. Unknown cells are passed
//! (`allow_unknown`) at the highest cost. A cell weighs `50 + 3 cost`, at most 252. The
//! robot's own cell is cleared and the wave begins in a square of two cells, so that a robot
//! deeper than that in inscribed cells has no plan either. The map's rim is lethal.
//!
//! The search is our A* with these weights: the ways cost what Dijkstra's do; GlobalPlanner's
//! follow the gradient and are a little smoother.

use crate::geometry::{Path, Point, Pose};
use crate::grid::{Cell, Costmap, GridInfo, HIGHEST_COST, LETHAL_COST, UNKNOWN_COST};
use crate::planning::{Astar, GlobalPlanner, PlanError};
use std::collections::HashMap;
use std::sync::Arc;

/// GlobalPlanner's `cost_factor` and the highest weight beyond `neutral_cost`, 50.
const COST_FACTOR: u32 = 3;
const HIGHEST_WEIGHT: u32 = 202;

/// The planner; it keeps its weights while the costmap is the same.
#[derive(Debug, Default)]
pub struct InflatedPlanner {
    allow_unknown: bool,
    search: Astar,
    weighed: Option<(Arc<Costmap>, Arc<Costmap>)>,
}

impl InflatedPlanner {
    /// A planner; unknown cells are passed or not.
    #[must_use]
    pub fn new(allow_unknown: bool) -> Self {
        Self { allow_unknown, ..Self::default() }
    }

    /// A plan from where the robot is to a goal.
    ///
    /// # Errors
    /// [`PlanError`] that says why there is none.
    pub fn plan_on(&mut self, costmap: &Arc<Costmap>, start: &Pose, goal: &Pose) -> Result<Path, PlanError> {
        let weighed = match &self.weighed {
            Some((of, weighed)) if Arc::ptr_eq(of, costmap) => Arc::clone(weighed),
            _ => Arc::new(weigh(costmap, self.allow_unknown)),
        };
        self.weighed = Some((Arc::clone(costmap), Arc::clone(&weighed)));
        self.search_on(&weighed, start, goal)
    }

    fn search_on(&mut self, weighed: &Costmap, start: &Pose, goal: &Pose) -> Result<Path, PlanError> {
        let info = weighed.info();
        if !info.contains(info.cell_at(goal.position())) {
            return Err(PlanError::GoalOutsideMap { x: goal.x, y: goal.y });
        }
        let Some(start_cell) = global_planner_cell(info, start.position()) else {
            return Err(PlanError::StartOutsideMap { x: start.x, y: start.y });
        };
        let Some(goal_cell) = global_planner_cell(info, goal.position()) else {
            return Err(PlanError::GoalOutsideMap { x: goal.x, y: goal.y });
        };
        let begin = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|offset| (start_cell.offset(offset), 0));
        let cleared = weighed.with_costs(&HashMap::from(begin));
        // The wave does not enter a lethal goal, though it may begin in one.
        let center = info.center(goal_cell);
        let mut path =
            self.search.plan(&cleared, &on(info, start_cell, start), &Pose::new(center.x, center.y, goal.yaw))?;
        if let Some(first) = path.poses.first_mut() {
            *first = Pose::new(start.x, start.y, first.yaw);
        }
        path.poses.push(*goal);
        Ok(path)
    }
}

impl GlobalPlanner for InflatedPlanner {
    fn name(&self) -> &'static str {
        "inflated"
    }

    fn plan(&mut self, costmap: &Costmap, start_in_map: &Pose, goal_in_map: &Pose) -> Result<Path, PlanError> {
        self.search_on(&weigh(costmap, self.allow_unknown), start_in_map, goal_in_map)
    }
}

/// The cell that GlobalPlanner takes a point of the map frame for; `None` outside. The
/// costmap's own rotation is ignored there, too.
#[must_use]
fn global_planner_cell(info: &GridInfo, point_in_map: Point) -> Option<Cell> {
    let resolution = f64::from(info.resolution_m() as f32);
    let origin = info.origin_in_map();
    let (x, y) = (point_in_map.x - origin.x, point_in_map.y - origin.y);
    let (x_cells, y_cells) = (x / resolution - 0.5, y / resolution - 0.5);
    let cell = Cell::new(x_cells as i32, y_cells as i32);
    (x >= 0.0 && y >= 0.0 && info.contains(cell)).then_some(cell)
}

/// A pose in the middle of a cell.
fn on(info: &GridInfo, cell: Cell, pose: &Pose) -> Pose {
    let center = info.center(cell);
    Pose::new(center.x, center.y, pose.yaw)
}

/// The costmap with GlobalPlanner's weights in the scale of our own search, which weighs
/// `50 + 0.8 cost`.
fn weigh(costmap: &Costmap, allow_unknown: bool) -> Costmap {
    let weight = |cost: u8| match cost {
        UNKNOWN_COST if allow_unknown => (HIGHEST_WEIGHT * 5 / 4) as u8,
        0..HIGHEST_COST => ((COST_FACTOR * u32::from(cost)).min(HIGHEST_WEIGHT) * 5 / 4) as u8,
        _ => LETHAL_COST,
    };
    let info = *costmap.info();
    let (width, height) = (info.width(), info.height());
    let mut costs: Vec<u8> = costmap.costs().iter().map(|&cost| weight(cost)).collect();
    for (y, row) in costs.chunks_exact_mut(width).enumerate() {
        if y == 0 || y + 1 == height {
            row.fill(LETHAL_COST);
        } else if let [first, .., last] = row {
            (*first, *last) = (LETHAL_COST, LETHAL_COST);
        }
    }
    Costmap::from_costs(info, costs).unwrap_or_else(|| costmap.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    const RESOLUTION_M: f64 = 0.05;

    /// Open ground of 480 x 40 cells with costs as told.
    fn ground(cost: impl Fn(Cell) -> u8) -> Arc<Costmap> {
        let info = GridInfo::new(480, 40, RESOLUTION_M, Pose::default()).unwrap();
        Arc::new(Costmap::from_costs(info, (0..info.len()).map(|i| cost(info.cell(i))).collect()).unwrap())
    }

    fn plan(costmap: &Arc<Costmap>, goal: Point) -> Result<Path, PlanError> {
        InflatedPlanner::new(true).plan_on(costmap, &Pose::new(1.0, 1.0, 0.0), &Pose::new(goal.x, goal.y, 0.5))
    }

    #[test]
    fn a_centre_computed_with_0_05_lands_one_cell_off_and_a_goal_point_does_not() {
        let costmap = ground(|_| 0);
        let info = costmap.info();
        let off = (0..480).map(|x| Cell::new(x, 20)).filter(|&cell| {
            let (x, y) = (f64::from(cell.x) * RESOLUTION_M + 0.025, f64::from(cell.y) * RESOLUTION_M + 0.025);
            let found = global_planner_cell(info, Point::new(x, y)).unwrap();
            assert!(
                found == cell || found == cell.offset((-1, -1)) || found == cell.offset((0, -1)),
                "{cell:?} {found:?}"
            );
            found != cell
        });
        assert!(off.count() >= 479, "of 480 columns");
        for cell in (0..info.len()).map(|index| info.cell(index)) {
            assert_eq!(global_planner_cell(info, info.goal_point(cell)), Some(cell));
        }
    }

    #[test]
    fn goals_in_inscribed_lethal_and_252_cells_are_refused_and_others_are_not() {
        for (cost, is_open) in
            [(0, true), (80, true), (251, true), (252, false), (253, false), (254, false), (255, true)]
        {
            let costmap = ground(|cell| if cell.x > 100 { cost } else { 0 });
            let goal = costmap.info().goal_point(Cell::new(140, 20));
            assert_eq!(plan(&costmap, goal).is_ok(), is_open, "cost {cost}");
        }
        let costmap = ground(|_| 0);
        assert!(matches!(plan(&costmap, Point::new(99.0, 1.0)), Err(PlanError::GoalOutsideMap { .. })));
        assert!(plan(&costmap, costmap.info().goal_point(Cell::new(479, 20))).is_err(), "the rim is lethal");
    }

    #[test]
    fn a_goal_beside_inscribed_cells_fails_by_its_centre_and_not_by_its_goal_point() {
        // Inscribed up to column 100: the centre of column 101 falls into it.
        let costmap = ground(|cell| if cell.x <= 100 && cell.x > 60 { 253 } else { 0 });
        let info = *costmap.info();
        let start = Pose::new(10.0, 1.0, 0.0);
        let mut planner = InflatedPlanner::new(true);
        let mut is_planned = |x: f64, y: f64| planner.plan_on(&costmap, &start, &Pose::new(x, y, 0.0)).is_ok();
        assert!(!is_planned(101.0 * RESOLUTION_M + 0.025, 20.0 * RESOLUTION_M + 0.025));
        let point = info.goal_point(Cell::new(101, 20));
        assert!(is_planned(point.x, point.y));
    }

    #[test]
    fn a_robot_deep_in_inscribed_cells_has_no_plan_and_one_at_their_rim_has() {
        let goal = Point::new(5.0, 1.0);
        let deep = ground(|cell| if cell.x < 30 { 253 } else { 0 });
        assert!(plan(&deep, goal).is_err());
        let rim = ground(|cell| if cell.x < 20 { 253 } else { 0 });
        let path = plan(&rim, goal).unwrap();
        assert_eq!(path.poses.last(), Some(&Pose::new(5.0, 1.0, 0.5)));
    }

    #[test]
    fn ways_lead_through_the_unknown_where_there_is_no_other() {
        let strip =
            |known: bool| ground(move |cell| if (50..60).contains(&cell.x) && (known || cell.y > 2) { 255 } else { 0 });
        let goal = Point::new(5.0, 1.0);
        assert!(plan(&strip(true), goal).is_ok());
        let mut strict = InflatedPlanner::new(false);
        assert!(strict.plan_on(&strip(true), &Pose::new(1.0, 1.0, 0.0), &Pose::new(5.0, 1.0, 0.0)).is_err());
    }
}
