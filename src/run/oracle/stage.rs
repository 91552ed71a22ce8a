//! The part of a way that the robot's own map knows: where the navigator is sent meanwhile.

use crate::geometry::{Point, Pose};
use crate::grid::{Cell, Costmap, UNKNOWN_COST};

/// A goal nearer than this that is not the last is renewed, metres.
const NEAR_M: f64 = 1.2;
/// A point of a way stands for the passable cell nearest to it, up to this distance, metres.
const SNAP_M: f64 = 0.25;

/// A goal on the way to a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    /// The block.
    pub block: usize,
    /// The goal, metres and radians of the map frame.
    pub goal: Pose,
    /// Whether it is where the block is to be reached.
    pub is_last: bool,
}

impl Stage {
    /// The farthest part that a costmap knows of a way, which leads to `stand` in a block.
    pub fn new(block: usize, way: &[Point], stand: Point, costmap: &Costmap) -> Self {
        let points = way.iter().skip(1).copied().chain([stand]);
        let begin = way.first().and_then(|&point| passable_near(costmap, point));
        let known = points.scan(begin, |last, point| {
            let next = passable_near(costmap, point)?;
            // What lies beyond a strip that is not known may be far away for the navigator.
            let is_linked = last.is_none_or(|last| is_known_line(costmap, last, next));
            *last = Some(next);
            is_linked.then_some(next)
        });
        let known: Vec<Point> = known.collect();
        let is_last = known.len() == way.len().max(1);
        let goal = known.last().copied().or_else(|| way.first().copied()).unwrap_or(stand);
        let before = known.iter().rev().copied().find(|&point| nalgebra::distance(&point, &goal) > 0.3);
        let before = before.or_else(|| way.first().copied()).unwrap_or(goal);
        let yaw = Pose::facing(before, goal).yaw;
        Self { block, goal: Pose::new(goal.x, goal.y, yaw), is_last }
    }

    /// Whether it must be chosen anew for a robot on its way to a block.
    pub fn is_stale(&self, block: usize, robot: &Pose, is_new_map: bool) -> bool {
        self.block != block || !self.is_last && (is_new_map || robot.distance_to(self.goal.position()) < NEAR_M)
    }
}

/// The centre of the passable cell nearest to a point, where there is one near by.
fn passable_near(costmap: &Costmap, point: Point) -> Option<Point> {
    let info = costmap.info();
    let center = info.cell_at(point);
    if costmap.is_passable(center) {
        return Some(info.center(center));
    }
    let reach = info.cells(SNAP_M).floor() as i32;
    let around = (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (dx, dy)));
    let cells = around.map(|offset| center.offset(offset)).filter(|&cell: &Cell| costmap.is_passable(cell));
    let nearest = cells.min_by_key(|&cell| (cell.distance_squared(center), cell.y, cell.x))?;
    Some(info.center(nearest))
}

/// Whether all cells on the line between two points are known; the line may cut a corner.
fn is_known_line(costmap: &Costmap, from: Point, to: Point) -> bool {
    let info = costmap.info();
    let steps = (2.0 * info.cells(nalgebra::distance(&from, &to))).ceil().max(1.0);
    (0..=steps as usize).all(|step| costmap.cost_at(from + (to - from) * (step as f64 / steps)) != UNKNOWN_COST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{FREE_COST, GridInfo};

    /// A corridor of 4 m in cells of 0.1 m, of which some columns are not known.
    fn corridor(unknown: std::ops::Range<usize>) -> Costmap {
        let info = GridInfo::new(40, 5, 0.1, Pose::default()).unwrap();
        let cost = |i: usize| if unknown.contains(&(i % 40)) { UNKNOWN_COST } else { FREE_COST };
        Costmap::from_costs(info, (0..info.len()).map(cost).collect()).unwrap()
    }

    #[test]
    fn a_stage_ends_where_the_map_does_and_before_a_strip_that_is_not_known() {
        let way: Vec<Point> = (1..20).map(|i| Point::new(0.2 * f64::from(i), 0.25)).collect();
        let stand = Point::new(3.85, 0.25);
        let whole = Stage::new(7, &way, stand, &corridor(0..0));
        assert!(whole.is_last && whole.goal.distance_to(stand) < 0.01 && whole.goal.yaw.abs() < 1e-9, "{whole:?}");
        for unknown in [20..40, 20..23] {
            let part = Stage::new(7, &way, stand, &corridor(unknown));
            assert!(!part.is_last && (1.7..2.0).contains(&part.goal.x), "{part:?}");
            let (far, near) = (Pose::new(0.2, 0.25, 0.0), Pose::new(1.0, 0.25, 0.0));
            let stale = [(7, far, false), (7, far, true), (7, near, false), (8, far, false)];
            assert_eq!(stale.map(|(block, pose, new)| part.is_stale(block, &pose, new)), [false, true, true, true]);
        }
        assert!(!whole.is_stale(7, &Pose::new(3.5, 0.25, 0.0), true));
    }
}
