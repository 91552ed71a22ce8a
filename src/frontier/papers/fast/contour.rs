//! The contour of a scan on a map: its end points by angle, joined by straight lines.

use crate::frontier::DetectionInput;
use crate::geometry::{Point, Pose};
use crate::grid::{Cell, CellState, GridInfo, Thresholds, traverse};
use crate::scan::Reading;
use imageproc::drawing::BresenhamLineIter;
use std::f64::consts::TAU;

/// The cells of the contour, some of them more than once and some outside the grid.
/// `None` without a scan that says something, taken from a place on the map.
pub(crate) fn contour(input: &DetectionInput<'_>, thresholds: &Thresholds) -> Option<Vec<Cell>> {
    let (lidar_in_map, scan) = input.scan?;
    let info = input.grid.info();
    let lidar = info.cell_at(lidar_in_map.position());
    if !(lidar_in_map.is_finite() && info.contains(lidar)) {
        return None;
    }
    // Beyond the far corner of the map no ray ends that matters.
    let longest_m = info.resolution_m() * (info.width() as f64).hypot(info.height() as f64);
    let mut ends: Vec<(f64, Cell)> = scan
        .readings()
        .filter(|(angle_rad, _)| angle_rad.is_finite())
        .filter_map(|(angle_rad, reading)| {
            let heading_rad = lidar_in_map.yaw + angle_rad;
            let end = match reading {
                Reading::Hit(range_m) => end_of_ray(info, lidar_in_map, heading_rad, range_m.min(longest_m)),
                Reading::Clear(range_m) => {
                    let mut ray = traverse(info, lidar_in_map.position(), heading_rad, range_m.min(longest_m));
                    let left = ray.find(|&(cell, _)| input.grid.state(cell, thresholds) != CellState::Free);
                    match left {
                        Some((cell, _)) => cell,
                        None => end_of_ray(info, lidar_in_map, heading_rad, range_m.min(longest_m)),
                    }
                }
                Reading::None => return None,
            };
            Some((angle_rad, end))
        })
        .collect();
    ends.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (first, last) = (*ends.first()?, *ends.last()?);
    // A scan all round closes upon itself; any other one through the lidar.
    let gap_rad = TAU - (last.0 - first.0);
    if gap_rad > 2.0 * scan.angle_increment_rad.abs() + 1e-6 {
        ends.push((last.0, lidar));
    }
    let followers = ends.iter().cycle().skip(1);
    let lines = ends.iter().zip(followers).flat_map(|(a, b)| line(a.1, b.1));
    Some(lines.collect())
}

fn end_of_ray(info: &GridInfo, lidar_in_map: &Pose, heading_rad: f64, range_m: f64) -> Cell {
    let (sin, cos) = heading_rad.sin_cos();
    info.cell_at(Point::new(lidar_in_map.x + range_m * cos, lidar_in_map.y + range_m * sin))
}

/// Bresenham's line, both ends included.
fn line(a: Cell, b: Cell) -> impl Iterator<Item = Cell> {
    BresenhamLineIter::new((a.x as f32, a.y as f32), (b.x as f32, b.y as f32)).map(|(x, y)| Cell::new(x, y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::OccupancyGrid;
    use crate::scan::LaserScan;
    use std::f64::consts::{FRAC_PI_2, PI};

    fn scan(angle_min_rad: f64, ranges_m: &[f32]) -> LaserScan {
        LaserScan {
            angle_min_rad,
            angle_increment_rad: FRAC_PI_2,
            range_min_m: 0.1,
            range_max_m: 30.0,
            ranges_m: ranges_m.to_vec(),
            ..LaserScan::default()
        }
    }

    fn corners(scan: &LaserScan, lidar: &Pose) -> Option<Vec<Cell>> {
        let grid = OccupancyGrid::from_ascii("?????????\n?.......?\n?.......?\n?.......?\n?????????").unwrap();
        let input = DetectionInput { scan: Some((lidar, scan)), ..DetectionInput::new(&grid, *lidar) };
        contour(&input, &Thresholds::default())
    }

    #[test]
    fn clear_rays_end_at_the_rim_of_the_known_and_hits_where_they_hit() {
        let lidar = Pose::new(4.5, 2.5, 0.0);
        let cells = corners(&scan(-PI, &[f32::INFINITY, 1.0, 2.0, f32::INFINITY]), &lidar).unwrap();
        for (x, y) in [(0, 2), (4, 1), (6, 2), (4, 4)] {
            assert!(cells.contains(&Cell::new(x, y)), "({x}, {y}) in {cells:?}");
        }
        assert!(!cells.contains(&Cell::new(4, 2)), "a scan all round does not pass the lidar: {cells:?}");
    }

    #[test]
    fn a_scan_ahead_closes_through_the_lidar() {
        let lidar = Pose::new(4.5, 2.5, 0.0);
        let cells = corners(&scan(0.0, &[3.0, f32::NAN, 3.0]), &lidar).unwrap();
        assert!(cells.contains(&Cell::new(4, 2)) && cells.contains(&Cell::new(1, 2)), "{cells:?}");
    }

    #[test]
    fn without_a_usable_scan_there_is_none() {
        let lidar = Pose::new(4.5, 2.5, 0.0);
        assert_eq!(corners(&scan(0.0, &[]), &lidar), None);
        assert_eq!(corners(&scan(0.0, &[f32::NAN, 0.0]), &lidar), None);
        assert_eq!(corners(&scan(0.0, &[1.0]), &Pose::new(99.0, 0.0, 0.0)), None);
        assert_eq!(corners(&scan(0.0, &[1.0]), &Pose::new(f64::NAN, 0.0, 0.0)), None);
        let far = corners(&scan(0.0, &[1.0]), &Pose::new(4.5, 2.5, 0.0)).map(|cells| cells.len());
        assert!(far.is_some_and(|cells| cells < 10));
    }
}
