//! Whether the robot's outline may be at a pose, for planners that know the heading.

use crate::geometry::{Footprint, Point, Pose};
use crate::grid::{Costmap, LETHAL_COST};

/// The outline over a costmap: its centre must be on a passable cell, and no point of
/// a polygon's outline on an obstacle or an unknown cell. For a disc the centre says
/// it all: the costmap was inflated by its radius.
#[derive(Clone, Debug)]
pub struct Swept<'a> {
    costmap: &'a Costmap,
    outline_in_base: Vec<Point>,
}

impl<'a> Swept<'a> {
    /// Looks at the outline of a polygon twice a cell.
    #[must_use]
    pub fn new(costmap: &'a Costmap, footprint: &Footprint) -> Self {
        let outline_in_base = match footprint {
            Footprint::RadiusM(_) => Vec::new(),
            Footprint::PolygonM(_) => footprint.outline(&Pose::default(), 0.5 * costmap.info().resolution_m()),
        };
        Self { costmap, outline_in_base }
    }

    /// Whether the robot may be at a pose.
    #[must_use]
    pub fn is_free(&self, pose: &Pose) -> bool {
        if !self.costmap.is_passable(self.costmap.info().cell_at(pose.position())) {
            return false;
        }
        let (sin, cos) = pose.yaw.sin_cos();
        self.outline_in_base.iter().all(|p| {
            let point = Point::new(pose.x + cos * p.x - sin * p.y, pose.y + sin * p.x + cos * p.y);
            self.costmap.cost_at(point) < LETHAL_COST
        })
    }

    /// Poses on the straight way to a point, that point included, or `None` when
    /// something stands there. They face the point and are at most half a cell apart.
    #[must_use]
    pub fn straight(&self, from: Point, to: Point) -> Option<Vec<Pose>> {
        let heading = Pose::facing(from, to).yaw;
        let spacing_m = 0.5 * self.costmap.info().resolution_m();
        let count = (nalgebra::distance(&from, &to) / spacing_m).ceil().max(1.0) as usize;
        let poses: Vec<Pose> = (1..=count)
            .map(|i| from + (to - from) * (i as f64 / count as f64))
            .map(|point| Pose::new(point.x, point.y, heading))
            .collect();
        poses.iter().all(|pose| self.is_free(pose)).then_some(poses)
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
        assert!(swept.straight(Point::new(0.5, 1.0), Point::new(1.9, 1.0)).is_none(), "off the map is unknown");
    }
}
