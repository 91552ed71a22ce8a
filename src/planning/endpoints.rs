//! Where a search may start and end on a costmap.

use super::{Path, PlanError};
use crate::geometry::{Point, Pose};
use crate::grid::{Cell, Costmap, GridInfo, LETHAL_COST, Neighbourhood};

/// How far a robot that stands too near to an obstacle looks for a way out, metres.
/// The map may close in on it by a cell or two as it becomes known.
pub const ESCAPE_RADIUS_M: f64 = 0.4;

/// Index of the cell from which to search: the robot's own, or the nearest passable
/// one that it can get to without crossing an obstacle.
///
/// # Errors
/// [`PlanError::StartOutsideMap`], or [`PlanError::StartOccupied`] when no passable
/// cell lies within [`ESCAPE_RADIUS_M`].
pub fn start_index(costmap: &Costmap, start: &Pose) -> Result<usize, PlanError> {
    let info = costmap.info();
    let cell = info.cell_at(start.position());
    let Some(index) = info.index(cell) else {
        return Err(PlanError::StartOutsideMap { x: start.x, y: start.y });
    };
    if costmap.is_passable(cell) {
        return Ok(index);
    }
    nearest_passable(costmap, cell, ESCAPE_RADIUS_M)
        .and_then(|cell| info.index(cell))
        .ok_or(PlanError::StartOccupied { x: start.x, y: start.y })
}

/// Index of the goal's cell.
///
/// # Errors
/// [`PlanError::GoalOutsideMap`] or [`PlanError::GoalOccupied`].
pub fn goal_index(costmap: &Costmap, goal: &Pose) -> Result<usize, PlanError> {
    let cell = costmap.info().cell_at(goal.position());
    match costmap.info().index(cell) {
        None => Err(PlanError::GoalOutsideMap { x: goal.x, y: goal.y }),
        Some(_) if !costmap.is_passable(cell) => Err(PlanError::GoalOccupied { x: goal.x, y: goal.y }),
        Some(index) => Ok(index),
    }
}

/// The passable cell nearest to `from` by a flood that no obstacle lets through.
fn nearest_passable(costmap: &Costmap, from: Cell, radius_m: f64) -> Option<Cell> {
    let reach = costmap.info().cells(radius_m).floor() as i64;
    let is_open = |cell| costmap.cost(cell) != LETHAL_COST;
    costmap
        .info()
        .flood(from, Neighbourhood::Eight, is_open)
        .take_while(|cell| cell.distance_squared(from) <= 2 * reach * reach)
        .filter(|cell| cell.distance_squared(from) <= reach * reach)
        .find(|&cell| costmap.is_passable(cell))
}

/// A path along cells: it starts at the robot's own position, passes the cells'
/// centres, but for that of its own cell, each pose facing the next, and ends at the goal with the goal's heading.
#[must_use]
pub fn path_along(info: &GridInfo, cells: &[usize], start: &Pose, goal: &Pose, cost: f64) -> Path {
    let inner = cells.len().saturating_sub(1);
    let own = info.cell_at(start.position());
    let inner = cells.iter().take(inner).map(|&index| info.cell(index)).filter(|&cell| cell != own);
    let mut points: Vec<Point> = vec![start.position()];
    points.extend(inner.map(|cell| info.center(cell)));
    points.push(goal.position());
    let mut poses: Vec<Pose> = points.windows(2).map(|pair| Pose::facing(pair[0], pair[1])).collect();
    poses.push(*goal);
    Path { poses, cost }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_leads_by_the_cell_that_the_robot_escapes_to() {
        let info = GridInfo::new(4, 1, 1.0, Pose::default()).unwrap();
        let (start, goal) = (Pose::new(0.2, 0.5, 0.0), Pose::new(3.5, 0.5, 1.0));
        let x = |cells: &[usize]| -> Vec<f64> {
            path_along(&info, cells, &start, &goal, 1.0).poses.iter().map(|pose| pose.x).collect()
        };
        assert_eq!(x(&[0, 1, 2, 3]), [0.2, 1.5, 2.5, 3.5]);
        assert_eq!(x(&[1, 2, 3]), [0.2, 1.5, 2.5, 3.5]);
        assert_eq!(x(&[3]), [0.2, 3.5]);
    }
}
