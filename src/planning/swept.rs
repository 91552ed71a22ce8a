//! Whether the robot's outline may be at a pose, for planners that know the heading.

use crate::geometry::{Footprint, Point, Pose};
use crate::grid::{Cell, Costmap, LETHAL_COST};
use std::cell::RefCell;

/// The outline over a costmap: its centre must be on a passable cell, and no point of
/// a polygon's outline on an obstacle or an unknown cell. For a disc the centre says
/// it all: the costmap was inflated by its radius.
#[derive(Clone, Debug)]
pub struct Swept<'a> {
    costmap: &'a Costmap,
    outline_in_base: Vec<Point>,
    /// The cells that a polygon may touch whatever its heading, from its centre's.
    around: Vec<(i32, i32)>,
    /// For each cell whether all of those are free, once it has been asked: then the
    /// heading does not matter.
    any_heading: RefCell<Vec<Option<bool>>>,
}

impl<'a> Swept<'a> {
    /// Looks at the outline of a polygon twice a cell.
    #[must_use]
    pub fn new(costmap: &'a Costmap, footprint: &Footprint) -> Self {
        let outline_in_base = match footprint {
            Footprint::RadiusM(_) => Vec::new(),
            Footprint::PolygonM(_) => footprint.outline(&Pose::default(), 0.5 * costmap.info().resolution_m()),
        };
        let cells = costmap.info().cells(footprint.circumscribed_radius_m()) + std::f64::consts::SQRT_2;
        let (around, any_heading) = if outline_in_base.is_empty() {
            (Vec::new(), Vec::new())
        } else {
            let side = cells.floor() as i32;
            let square = (-side..=side).flat_map(|y| (-side..=side).map(move |x| (x, y)));
            let disc = square.filter(|&(x, y)| f64::from(x).hypot(f64::from(y)) <= cells);
            (disc.collect(), vec![None; costmap.costs().len()])
        };
        Self { costmap, outline_in_base, around, any_heading: RefCell::new(any_heading) }
    }

    /// Whether the robot may be at a pose.
    #[must_use]
    pub fn is_free(&self, pose: &Pose) -> bool {
        let cell = self.costmap.info().cell_at(pose.position());
        if !self.costmap.is_passable(cell) {
            return false;
        }
        if self.outline_in_base.is_empty() || self.is_free_whatever_heading(cell) {
            return true;
        }
        let (sin, cos) = pose.yaw.sin_cos();
        self.outline_in_base.iter().all(|p| {
            let point = Point::new(pose.x + cos * p.x - sin * p.y, pose.y + sin * p.x + cos * p.y);
            self.costmap.cost_at(point) < LETHAL_COST
        })
    }

    fn is_free_whatever_heading(&self, cell: Cell) -> bool {
        let mut known = self.any_heading.borrow_mut();
        let Some(entry) = self.costmap.info().index(cell).and_then(|index| known.get_mut(index)) else {
            return false;
        };
        *entry.get_or_insert_with(|| self.around.iter().all(|&o| self.costmap.cost(cell.offset(o)) < LETHAL_COST))
    }

    /// Poses on the straight way to a point, that point included, or `None` when the
    /// centre cannot go there. They face the point and are at most half a cell apart.
    /// Only the centre is looked at, as in the grid planners: a goal at a frontier has
    /// unknown cells under the outline.
    #[must_use]
    pub fn straight(&self, from: Point, to: Point) -> Option<Vec<Pose>> {
        let heading = Pose::facing(from, to).yaw;
        let spacing_m = 0.5 * self.costmap.info().resolution_m();
        let count = (nalgebra::distance(&from, &to) / spacing_m).ceil().max(1.0) as usize;
        let poses: Vec<Pose> = (1..=count)
            .map(|i| from + (to - from) * (i as f64 / count as f64))
            .map(|point| Pose::new(point.x, point.y, heading))
            .collect();
        let info = self.costmap.info();
        poses.iter().all(|pose| self.costmap.is_passable(info.cell_at(pose.position()))).then_some(poses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridInfo;

    #[test]
    fn a_long_robot_passes_a_gap_only_lengthwise() {
        let info = GridInfo::new(40, 40, 0.05, Pose::default()).unwrap();
        // A corridor 0.3 m wide along x, the walls lethal and not inflated.
        let costs = (0..info.len()).map(|i| if (17..23).contains(&info.cell(i).y) { 0 } else { 254 }).collect();
        let costmap = Costmap::from_costs(info, costs).unwrap();
        let long = Footprint::PolygonM(vec![[-0.25, -0.1], [0.25, -0.1], [0.25, 0.1], [-0.25, 0.1]]);
        let swept = Swept::new(&costmap, &long);
        assert!(swept.is_free(&Pose::new(1.0, 1.0, 0.0)));
        assert!(!swept.is_free(&Pose::new(1.0, 1.0, 1.0)));
        assert!(Swept::new(&costmap, &Footprint::RadiusM(0.2)).is_free(&Pose::new(1.0, 1.0, 1.0)));
        assert!(swept.straight(Point::new(0.5, 1.0), Point::new(1.5, 1.0)).is_some());
        assert!(swept.straight(Point::new(0.5, 1.0), Point::new(2.1, 1.0)).is_none(), "off the map is unknown");
    }
}
