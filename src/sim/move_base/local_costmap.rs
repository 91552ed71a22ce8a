//! What stands around the robot, as costmap_2d's obstacle layer has it: a rolling window
//! in the odometry's frame, marked where rays of the lidar end and cleared where they pass.

use crate::geometry::{Footprint, Point, Pose};
use crate::grid::{Cell, Costmap, GridInfo, Inflation, OccupancyGrid, Thresholds, traverse};
use crate::scan::{LaserScan, Reading};

/// Edge of the window, metres, and of its cells.
const WINDOW_M: f64 = 4.0;
const CELL_M: f64 = 0.05;
const SIDE: u32 = 80;
/// How far obstacles are marked and how far rays clear, metres: costmap_2d's
/// `obstacle_range` and `raytrace_range`.
const MARK_M: f64 = 2.5;
const CLEAR_M: f64 = 3.0;

/// The window.
#[derive(Clone, Debug)]
pub struct LocalCostmap {
    grid: OccupancyGrid,
}

impl LocalCostmap {
    /// An empty window around a place; `None` for one that is not finite.
    pub fn around(place: Point) -> Option<Self> {
        Some(Self { grid: OccupancyGrid::filled(window(place)?, OccupancyGrid::FREE) })
    }

    /// Moves the window along with the robot, keeping what it shows.
    pub fn follow(&mut self, place: Point) {
        let Some(info) = window(place) else { return };
        if info == *self.grid.info() {
            return;
        }
        let mut grid = OccupancyGrid::filled(info, OccupancyGrid::FREE);
        for index in 0..info.len() {
            let cell = info.cell(index);
            if let Some(value) = self.grid.get(self.grid.info().cell_at(info.center(cell))) {
                grid.set(cell, value);
            }
        }
        self.grid = grid;
    }

    /// Clears what the rays of a scan pass and marks where they end.
    pub fn add(&mut self, lidar_in_odom: &Pose, scan: &LaserScan) {
        let info = *self.grid.info();
        for (angle_rad, reading) in scan.readings() {
            let (length_m, is_hit) = match reading {
                Reading::Hit(range_m) => (range_m.min(CLEAR_M), range_m <= CLEAR_M),
                Reading::Clear(range_m) => (range_m.min(CLEAR_M), false),
                Reading::None => continue,
            };
            let heading_rad = lidar_in_odom.yaw + angle_rad;
            let end = is_hit.then(|| info.cell_at(at(lidar_in_odom, heading_rad, length_m)));
            for (cell, _) in traverse(&info, lidar_in_odom.position(), heading_rad, length_m) {
                if Some(cell) != end {
                    self.grid.set(cell, OccupancyGrid::FREE);
                }
            }
        }
        for point in scan.hits(lidar_in_odom) {
            let cell = info.cell_at(point);
            let is_near = (point - lidar_in_odom.position()).norm() <= MARK_M;
            if is_near && info.contains(cell) {
                self.grid.set(cell, OccupancyGrid::OCCUPIED);
            }
        }
    }

    /// Forgets the obstacles beyond a distance, as clear_costmap_recovery does.
    pub fn clear_beyond(&mut self, place: Point, distance_m: f64) {
        let info = *self.grid.info();
        for index in 0..info.len() {
            let cell = info.cell(index);
            let offset = info.center(cell) - place;
            if offset.x.abs() > distance_m || offset.y.abs() > distance_m {
                self.grid.set(cell, OccupancyGrid::FREE);
            }
        }
    }

    /// Whether an outline touches an obstacle.
    pub fn touches(&self, footprint: &Footprint, pose_in_odom: &Pose) -> bool {
        let outline = footprint.outline(pose_in_odom, 0.5 * CELL_M);
        outline.into_iter().any(|point| self.is_marked(self.grid.info().cell_at(point)))
    }

    /// With the costs of an inflation layer.
    pub fn inflated(&self, inflation: &Inflation) -> Costmap {
        Costmap::inflate(&self.grid, &Thresholds::default(), inflation)
    }

    fn is_marked(&self, cell: Cell) -> bool {
        self.grid.get(cell) == Some(OccupancyGrid::OCCUPIED)
    }
}

fn at(from: &Pose, heading_rad: f64, distance_m: f64) -> Point {
    Point::new(from.x + distance_m * heading_rad.cos(), from.y + distance_m * heading_rad.sin())
}

/// The window around a place, on a fixed lattice.
fn window(place: Point) -> Option<GridInfo> {
    let corner = |middle_m: f64| ((middle_m - 0.5 * WINDOW_M) / CELL_M).round() * CELL_M;
    GridInfo::new(SIDE, SIDE, CELL_M, Pose::new(corner(place.x), corner(place.y), 0.0)).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scan(range_m: f32) -> LaserScan {
        LaserScan {
            angle_increment_rad: 0.02,
            range_min_m: 0.1,
            range_max_m: 5.0,
            ranges_m: vec![range_m; 20],
            ..LaserScan::default()
        }
    }

    #[test]
    fn hits_are_marked_and_cleared_again_and_the_window_moves() {
        let mut local = LocalCostmap::around(Point::new(0.0, 0.0)).unwrap();
        local.add(&Pose::default(), &scan(0.6));
        let body = Footprint::RadiusM(0.2);
        let there = Pose::new(0.42, 0.05, 0.0);
        assert!(local.touches(&body, &there) && !local.touches(&body, &Pose::default()));
        local.follow(Point::new(1.0, 0.3));
        assert!(local.touches(&body, &there), "it moves with the robot and keeps what it shows");
        local.add(&Pose::default(), &scan(3.5));
        assert!(!local.touches(&body, &there), "what is seen through is cleared");
        local.add(&Pose::default(), &scan(0.6));
        local.clear_beyond(Point::new(0.0, 0.0), 0.5);
        assert!(!local.touches(&body, &there), "forgotten from a distance on");
    }
}
