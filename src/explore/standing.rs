//! Where to stand for a frontier.

use crate::geometry::{Point, Pose};
use crate::grid::LETHAL_COST;
use crate::planning::{PathField, flood};
use serde::{Deserialize, Serialize};

/// Which way the robot looks at its goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum GoalHeading {
    /// Towards the frontier.
    #[default]
    TowardFrontier,
    /// As it comes from where it is now: no turn on arrival.
    AsApproached,
}

/// The place nearest to `target` where the robot can stand and to which it can get,
/// found by a flood that no obstacle lets through: never a place on the other side of
/// a wall. `None` when there is none within `radius_m`.
pub fn standing_goal(
    field: &PathField,
    robot: &Pose,
    target: Point,
    radius_m: f64,
    heading: GoalHeading,
) -> Option<Pose> {
    let costmap = field.costmap();
    let info = costmap.info();
    let center = info.cell_at(target);
    let reach = info.cells(radius_m).ceil() as i64;
    let near = |cell: crate::grid::Cell| cell.distance_squared(center) <= reach * reach;
    let place = flood(info, center, |cell| near(cell) && costmap.cost(cell) != LETHAL_COST)
        .find(|&cell| field.reaches(cell))
        .map(|cell| info.center(cell))?;
    let yaw = match heading {
        GoalHeading::TowardFrontier => Pose::facing(place, target).yaw,
        GoalHeading::AsApproached => Pose::facing(robot.position(), place).yaw,
    };
    Some(Pose::new(place.x, place.y, yaw))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Costmap, Inflation, OccupancyGrid, Thresholds};
    use std::sync::Arc;

    fn goal(drawing: &str, target: (f64, f64), radius_m: f64) -> Option<(f64, f64)> {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let inflation = Inflation { inscribed_radius_m: 1.0, inflation_radius_m: 1.0, cost_scaling_factor: 1.0 };
        let costmap = Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &inflation));
        let robot = Pose::new(1.5, 1.5, 0.0);
        let field = PathField::new(costmap, &robot).unwrap();
        let target = Point::new(target.0, target.1);
        standing_goal(&field, &robot, target, radius_m, GoalHeading::TowardFrontier).map(|p| (p.x, p.y))
    }

    #[test]
    fn stands_in_known_space_beside_the_unknown() {
        assert_eq!(goal("...??\n...??\n...??", (3.5, 1.5), 3.0), Some((2.5, 1.5)));
    }

    #[test]
    fn keeps_the_inscribed_radius_from_walls_and_does_not_look_through_them() {
        assert_eq!(goal("....#??\n....#??\n....???\n....#??", (4.5, 1.5), 3.0), Some((3.5, 1.5)));
        assert_eq!(goal("...#???\n...#???\n...#???", (4.5, 1.5), 3.0), None);
        assert_eq!(goal("..?????\n..?????\n..?????", (6.5, 1.5), 3.0), None);
    }
}
