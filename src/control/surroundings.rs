//! The obstacles around the robot, ready for thousands of questions a tick.
//!
//! An obstacle is a point: the centre of a lethal cell, as the costmap's inflation
//! measures it, or where a ray of the newest scan ended. They are sorted into a small
//! grid around the robot whose distance transform answers most questions at once; only
//! close to an obstacle are the points themselves looked at, so that the answer is
//! exact. O(cells around + points) to build, O(1) to O(points near) to ask.

use super::ControlInput;
use super::outline::Outline;
use crate::geometry::{Point, Pose};
use crate::grid::{Cell, CellRect, GridInfo, GridInfoError, LETHAL_COST, squared_distance_cells};

/// Edge of a cell of the local grid, metres.
const CELL_M: f64 = 0.05;
/// No farther is looked for obstacles, metres.
const FARTHEST_M: f64 = 50.0;

/// Obstacles within reach of the robot.
#[derive(Clone, Debug)]
pub struct Surroundings {
    info: GridInfo,
    /// The points of cell `i` are `points[first[i]..first[i + 1]]`.
    points: Vec<Point>,
    first: Vec<usize>,
    squared_cells: Vec<u32>,
}

impl Surroundings {
    /// The obstacles within `reach_m` of the robot to either side, at most [`FARTHEST_M`].
    ///
    /// # Errors
    /// [`GridInfoError`] when the pose or the reach is no finite number.
    pub fn new(input: &ControlInput<'_>, reach_m: f64) -> Result<Self, GridInfoError> {
        let robot = input.pose_in_map;
        // A reach that is no number stays one, and makes no grid.
        let reach_m = if reach_m > FARTHEST_M { FARTHEST_M } else { reach_m };
        let side = if reach_m.is_nan() { 0 } else { (2.0 * reach_m / CELL_M).ceil() as u32 + 1 };
        let half_m = 0.5 * f64::from(side) * CELL_M;
        let info = GridInfo::new(side, side, CELL_M, Pose::new(robot.x - half_m, robot.y - half_m, 0.0))?;
        let mut found: Vec<(usize, Point)> = Vec::new();
        let mut add = |point: Point| {
            if let Some(index) = info.index(info.cell_at(point)) {
                found.push((index, point));
            }
        };
        let costmap = input.costmap.info();
        let center = costmap.cell_at(robot.position());
        // The corner of a square is sqrt 2 times as far as its side, however it is turned.
        let cells = costmap.cells(half_m * std::f64::consts::SQRT_2).ceil() as i32;
        let near = CellRect::around(center, cells, costmap);
        for y in near.rows(costmap) {
            for x in near.columns(costmap) {
                let cell = Cell::new(x as i32, y as i32);
                if input.costmap.cost(cell) == LETHAL_COST {
                    add(costmap.center(cell));
                }
            }
        }
        if let Some((lidar_in_map, scan)) = input.scan {
            scan.hits(lidar_in_map).for_each(add);
        }
        Ok(Self::sorted(info, &found))
    }

    fn sorted(info: GridInfo, found: &[(usize, Point)]) -> Self {
        let mut first = vec![0; info.len() + 1];
        for &(index, _) in found {
            first[index + 1] += 1;
        }
        for index in 0..info.len() {
            first[index + 1] += first[index];
        }
        let mut next = first.clone();
        let mut points = vec![Point::origin(); found.len()];
        for &(index, point) in found {
            points[next[index]] = point;
            next[index] += 1;
        }
        let squared_cells = squared_distance_cells(&info, |i| first[i] < first[i + 1]);
        Self { info, points, first, squared_cells }
    }

    /// Metres from a point to the nearest obstacle, to within a cell and a half; at
    /// most what the local grid covers.
    pub fn distance_m(&self, point: Point) -> f64 {
        self.info.index(self.info.cell_at(point)).map_or(0.0, |i| f64::from(self.squared_cells[i]).sqrt() * CELL_M)
    }

    /// Metres between the outline at a pose and the nearest obstacle, negative when it
    /// stands inside; `enough_m` at most. `reach_m` is the outline's circumscribed radius.
    pub fn clearance_m(&self, outline: &Outline, reach_m: f64, pose: &Pose, enough_m: f64) -> f64 {
        let near_m = reach_m + enough_m;
        // Both the pose and the obstacle lie anywhere in their cells.
        if self.distance_m(pose.position()) - std::f64::consts::SQRT_2 * CELL_M > near_m {
            return enough_m;
        }
        let center = self.info.cell_at(pose.position());
        let cells = self.info.cells(near_m).ceil() as i32;
        let (sin, cos) = pose.yaw.sin_cos();
        let mut clearance_m = enough_m;
        for point in self.points_around(center, cells) {
            let (dx, dy) = (point.x - pose.x, point.y - pose.y);
            if dx * dx + dy * dy < near_m * near_m {
                let in_base = Point::new(cos * dx + sin * dy, cos * dy - sin * dx);
                clearance_m = clearance_m.min(outline.distance_m(in_base));
            }
        }
        clearance_m
    }

    /// The points of the cells in a square around a cell.
    fn points_around(&self, center: Cell, cells: i32) -> impl Iterator<Item = &Point> {
        let near = CellRect::around(center, cells, &self.info);
        let columns = near.columns(&self.info);
        near.rows(&self.info).flat_map(move |y| {
            let row = y * self.info.width();
            let (from, to) = (row + columns.start, row + columns.end);
            &self.points[self.first[from]..self.first[to]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Path;
    use crate::geometry::{Footprint, Twist};
    use crate::grid::Costmap;
    use crate::scan::LaserScan;
    use proptest::prelude::*;

    #[test]
    fn a_reach_beyond_all_places_is_cut_and_one_that_is_no_number_refused() {
        let info = GridInfo::new(40, 40, 0.05, Pose::default()).unwrap();
        let mut costs = vec![0; 1600];
        costs[0] = 254;
        let costmap = Costmap::from_costs(info, costs).unwrap();
        let path = Path::default();
        let pose_in_map = Pose::new(1.0, 1.0, 0.0);
        let input =
            ControlInput { pose_in_map, twist: Twist::ZERO, path: &path, costmap: &costmap, scan: None, dt_s: 0.1 };
        let vast = Surroundings::new(&input, f64::INFINITY).unwrap();
        assert!(vast.info.width() as f64 * CELL_M < 2.0 * FARTHEST_M + 1.0);
        let outline = Outline::new(&Footprint::RadiusM(0.18));
        let clearance_m = vast.clearance_m(&outline, 0.18, &pose_in_map, f64::MAX);
        assert!((clearance_m - (0.975 * std::f64::consts::SQRT_2 - 0.18)).abs() < 1e-9, "{clearance_m}");
        assert!(Surroundings::new(&input, f64::NAN).is_err());
    }

    proptest! {
        #[test]
        fn clearances_are_exact(
            lethal in proptest::collection::vec(0usize..1600, 0..30),
            ranges in proptest::collection::vec(0.1f32..2.0, 0..20),
            x in 0.5f64..1.5, y in 0.5f64..1.5, yaw in -3.0f64..3.0, polygon in any::<bool>(),
        ) {
            let info = GridInfo::new(40, 40, 0.05, Pose::new(0.0, 0.0, 0.3)).unwrap();
            let costs = (0..1600).map(|i| if lethal.contains(&i) { 254 } else { 0 }).collect();
            let costmap = Costmap::from_costs(info, costs).unwrap();
            let scan = LaserScan { angle_increment_rad: 0.3, range_max_m: 9.0, ranges_m: ranges, ..Default::default() };
            let robot = Pose::new(0.7, 1.2, 0.5);
            let path = Path::default();
            let input = ControlInput {
                pose_in_map: robot, twist: Twist::ZERO, path: &path, costmap: &costmap, scan: Some((&robot, &scan)), dt_s: 0.1,
            };
            let surroundings = Surroundings::new(&input, 1.5).unwrap();
            let footprint = if polygon {
                Footprint::PolygonM(vec![[-0.2, -0.15], [0.1, -0.15], [0.1, 0.15], [-0.2, 0.15]])
            } else {
                Footprint::RadiusM(0.18)
            };
            let outline = Outline::new(&footprint);
            let pose = Pose::new(x, y, yaw);
            let points = lethal.iter().map(|&i| info.center(info.cell(i))).chain(scan.hits(&robot));
            let expected = points
                .map(|p| outline.distance_m(pose.inverse().transform(p)))
                .fold(0.1, f64::min);
            let found = surroundings.clearance_m(&outline, footprint.circumscribed_radius_m(), &pose, 0.1);
            // A polygon's corner region counts as nearer than it is, from any distance.
            if polygon && found > expected + 1e-9 {
                prop_assert!(expected > 0.0);
            } else {
                prop_assert!((found - expected).abs() < 1e-9, "{} {}", found, expected);
            }
        }
    }
}
