//! Messages as bytes, for bags that this program writes.

use super::record::{put_u32, time_bytes};
use super::{Header, Nanos, nanos};
use crate::geometry::{Point, Pose, Twist};
use crate::grid::OccupancyGrid;
use crate::scan::LaserScan;
use crate::tf::TransformSample;

/// Appends values.
#[derive(Default)]
struct Out(Vec<u8>);

impl Out {
    fn u32(&mut self, value: u32) -> &mut Self {
        put_u32(&mut self.0, value);
        self
    }

    fn i32(&mut self, value: i32) -> &mut Self {
        self.0.extend_from_slice(&value.to_le_bytes());
        self
    }

    fn f32(&mut self, value: f64) -> &mut Self {
        self.0.extend_from_slice(&(value as f32).to_le_bytes());
        self
    }

    fn f64s(&mut self, values: &[f64]) -> &mut Self {
        values.iter().for_each(|value| self.0.extend_from_slice(&value.to_le_bytes()));
        self
    }

    fn time(&mut self, time: Nanos) -> &mut Self {
        self.0.extend_from_slice(&time_bytes(time));
        self
    }

    fn text(&mut self, text: &str) -> &mut Self {
        self.u32(text.len() as u32).0.extend_from_slice(text.as_bytes());
        self
    }

    fn header(&mut self, header: &Header) -> &mut Self {
        self.u32(header.seq).time(header.stamp).text(&header.frame)
    }

    fn pose(&mut self, pose: &Pose) -> &mut Self {
        let (sin, cos) = (0.5 * pose.yaw).sin_cos();
        self.f64s(&[pose.x, pose.y, 0.0, 0.0, 0.0, sin, cos])
    }

    fn done(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.0)
    }
}

/// A `rosgraph_msgs/Clock`.
#[must_use]
pub fn clock_message(time: Nanos) -> Vec<u8> {
    Out::default().time(time).done()
}

/// A `nav_msgs/OccupancyGrid`.
#[must_use]
pub fn map_message(header: &Header, grid: &OccupancyGrid) -> Vec<u8> {
    let info = grid.info();
    let mut out = Out::default();
    out.header(header).time(header.stamp).f32(info.resolution_m());
    out.u32(info.width() as u32).u32(info.height() as u32).pose(&info.origin_in_map());
    out.u32(grid.data().len() as u32);
    out.0.extend(grid.data().iter().map(|value| value.cast_unsigned()));
    out.done()
}

/// A `tf2_msgs/TFMessage`.
#[must_use]
pub fn tf_message(samples: &[TransformSample]) -> Vec<u8> {
    let mut out = Out::default();
    out.u32(samples.len() as u32);
    for sample in samples {
        out.u32(0).time(nanos(sample.stamp_s)).text(&sample.parent).text(&sample.child);
        out.f64s(&sample.translation_m).f64s(&sample.rotation_xyzw);
    }
    out.done()
}

/// A `sensor_msgs/LaserScan` of a lidar that takes one sweep in `period_s` seconds.
#[must_use]
pub fn scan_message(header: &Header, scan: &LaserScan, period_s: f64) -> Vec<u8> {
    let mut out = Out::default();
    let last = scan.ranges_m.len().saturating_sub(1);
    out.header(header).f32(scan.angle_min_rad).f32(scan.angle_rad(last)).f32(scan.angle_increment_rad);
    out.f32(0.0).f32(period_s).f32(scan.range_min_m).f32(scan.range_max_m).u32(scan.ranges_m.len() as u32);
    scan.ranges_m.iter().for_each(|range| out.0.extend_from_slice(&range.to_le_bytes()));
    out.u32(0).done()
}

/// A `nav_msgs/Odometry`; its covariances are not known.
#[must_use]
pub fn odometry_message(header: &Header, child: &str, pose: &Pose, twist: &Twist) -> Vec<u8> {
    let mut out = Out::default();
    out.header(header).text(child).pose(pose).f64s(&[0.0; 36]);
    out.f64s(&[twist.linear_mps, 0.0, 0.0, 0.0, 0.0, twist.angular_rps]).f64s(&[0.0; 36]).done()
}

/// A `geometry_msgs/PoseStamped`.
#[must_use]
pub fn pose_message(header: &Header, pose: &Pose) -> Vec<u8> {
    Out::default().header(header).pose(pose).done()
}

/// A `move_base_msgs/MoveBaseActionGoal`.
#[must_use]
pub fn goal_message(header: &Header, id: &str, pose: &Pose) -> Vec<u8> {
    Out::default().header(header).time(header.stamp).text(id).header(header).pose(pose).done()
}

/// A `move_base_msgs/MoveBaseActionResult`; the status is a number of
/// `actionlib_msgs/GoalStatus`.
#[must_use]
pub fn result_message(header: &Header, id: &str, status: u8, text: &str) -> Vec<u8> {
    let mut out = Out::default();
    out.header(header).time(header.stamp).text(id).0.push(status);
    out.text(text).done()
}

/// A `nav_msgs/Path`.
#[must_use]
pub fn path_message(header: &Header, poses: &[Pose]) -> Vec<u8> {
    let mut out = Out::default();
    out.header(header).u32(poses.len() as u32);
    poses.iter().for_each(|pose| {
        out.header(header).pose(pose);
    });
    out.done()
}

/// A `visualization_msgs/MarkerArray` with one marker: squares of `edge_m` metres, blue
/// as `explore_node` shows frontiers that can be chosen.
#[must_use]
pub fn marker_message(header: &Header, namespace: &str, edge_m: f64, points: &[Point]) -> Vec<u8> {
    const CUBE_LIST: i32 = 6;
    const ADD: i32 = 0;
    let mut out = Out::default();
    out.u32(1).header(header).text(namespace).i32(0).i32(CUBE_LIST).i32(ADD).pose(&Pose::default());
    out.f64s(&[edge_m, edge_m, 0.02]).f32(0.1).f32(0.4).f32(1.0).f32(1.0).u32(0).u32(0);
    out.0.push(0);
    out.u32(points.len() as u32);
    points.iter().for_each(|point| {
        out.f64s(&[point.x, point.y, 0.0]);
    });
    out.u32(0).text("").text("").0.push(0);
    out.done()
}
