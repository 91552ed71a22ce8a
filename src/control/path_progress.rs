//! How far along its path a robot is, and which point of the path it steers for.

use super::ControlInput;
use crate::geometry::Path;
use crate::geometry::{Point, Pose};
use crate::grid::{Costmap, INSCRIBED_COST, LETHAL_COST, NARROW_COST, traverse};

/// The progress along one path: the index of the pose nearest to the robot so far.
#[derive(Clone, Copy, Debug, Default)]
pub struct PathProgress(usize);

impl PathProgress {
    /// At the beginning of a path.
    pub const fn new() -> Self {
        Self(0)
    }

    /// Moves the progress on to the nearest pose ahead, looking no farther than
    /// `window_m` along the path so that one that returns to itself is not cut short.
    pub fn advance(&mut self, path: &Path, robot: Point, window_m: f64) {
        let mut along_m = 0.0;
        let mut best = (f64::INFINITY, self.0);
        for (index, pose) in path.poses.iter().enumerate().skip(self.0) {
            let distance = pose.distance_to(robot);
            if distance < best.0 {
                best = (distance, index);
            }
            if let Some(next) = path.poses.get(index + 1) {
                along_m += pose.distance_to(next.position());
            }
            if along_m > window_m {
                break;
            }
        }
        self.0 = best.1;
    }

    /// The farthest point of the path within `lookahead_m` that can be driven to in a
    /// straight line, or the next one when none can. `None` for an empty path.
    pub fn aim(&self, input: &ControlInput<'_>, lookahead_m: f64) -> Option<Point> {
        let robot = input.pose_in_map.position();
        let ahead = input.path.poses.get(self.0..)?;
        let next = ahead.iter().find(|p| p.distance_to(robot) > 1e-3).or(ahead.last())?.position();
        let mut aim = next;
        let mut along_m = 0.0;
        for pair in ahead.windows(2) {
            along_m += pair[0].distance_to(pair[1].position());
            let candidate = pair[1].position();
            if along_m > lookahead_m || !straight_is_free(input.costmap, robot, candidate) {
                break;
            }
            aim = candidate;
        }
        Some(aim)
    }

    /// The points of the path from the progress on, as far as `length_m` leads.
    pub fn ahead(&self, path: &Path, length_m: f64) -> Vec<Point> {
        let rest = path.poses.get(self.0..).unwrap_or_default();
        let mut left_m = length_m;
        let mut points: Vec<Point> = rest.first().map(Pose::position).into_iter().collect();
        for pair in rest.windows(2) {
            left_m -= pair[0].distance_to(pair[1].position());
            points.push(pair[1].position());
            if left_m < 0.0 {
                break;
            }
        }
        points
    }
}

/// Whether the robot's centre can go straight from one point to another: no cell on
/// the line is blocked, except while it is leaving a place that already is. Between places
/// where the robot can turn, the line keeps to such: a long body scrapes along the corners
/// that its inscribed circle just passes.
fn straight_is_free(costmap: &Costmap, from: Point, to: Point) -> bool {
    let line = to - from;
    let ends = costmap.cost_at(from).max(costmap.cost_at(to));
    let blocked = if ends < NARROW_COST { NARROW_COST } else { INSCRIBED_COST };
    let mut leaving = costmap.cost_at(from) >= blocked;
    for (cell, _) in traverse(costmap.info(), from, line.y.atan2(line.x), line.norm()) {
        let cost = costmap.cost(cell);
        if cost < blocked {
            leaving = false;
        } else if !leaving || cost == LETHAL_COST {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::GridInfo;

    #[test]
    fn a_line_between_places_with_room_keeps_to_such() {
        let info = GridInfo::new(5, 1, 1.0, Pose::default()).unwrap();
        let is_free = |costs: [u8; 5]| {
            let costmap = Costmap::from_costs(info, costs.to_vec()).unwrap();
            straight_is_free(&costmap, Point::new(0.5, 0.5), Point::new(4.5, 0.5))
        };
        assert!(is_free([0, 100, NARROW_COST - 1, 100, 0]));
        assert!(!is_free([0, 0, NARROW_COST, 0, 0]), "a corner that its inscribed circle passes");
        assert!(is_free([0, 0, NARROW_COST, NARROW_COST, NARROW_COST]), "into a narrow place");
        assert!(!is_free([0, 0, NARROW_COST, INSCRIBED_COST, NARROW_COST]));
        assert!(is_free([INSCRIBED_COST, INSCRIBED_COST, 0, 0, 0]), "out of where it should not be");
    }
}
