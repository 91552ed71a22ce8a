//! Between ROS messages and the project's own types.

use super::msg::geometry_msgs::{
    Point as PointMsg, Pose as PoseMsg, PoseStamped, Quaternion, Twist as TwistMsg, Vector3,
};
use super::msg::std_msgs::Header;
use super::msg::{map_msgs, nav_msgs, sensor_msgs, tf2_msgs};
use crate::geometry::{Path, Pose, Twist};
use crate::grid::{Cell, GridError, GridInfo, GridInfoError, GridPatch, OccupancyGrid};
use crate::scan::{LaserScan, believable_limits};
use crate::tf::TransformSample;

/// A map message that is no map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapMessageError {
    /// Its size, resolution or origin cannot be.
    #[error(transparent)]
    Info(#[from] GridInfoError),
    /// It holds more or fewer values than cells.
    #[error(transparent)]
    Data(#[from] GridError),
}

/// Seconds of a ROS time.
#[must_use]
pub fn seconds(time: &rosrust::Time) -> f64 {
    f64::from(time.sec) + 1e-9 * f64::from(time.nsec)
}

/// A ROS time of seconds; times before 0 are 0.
#[must_use]
pub fn time(seconds: f64) -> rosrust::Time {
    rosrust::Time::from_nanos((seconds.max(0.0) * 1e9).round() as i64)
}

/// A header with a frame and a time in seconds.
#[must_use]
pub fn header(frame: &str, stamp_s: f64) -> Header {
    Header { seq: 0, stamp: time(stamp_s), frame_id: frame.to_owned() }
}

/// A quaternion about the vertical axis.
#[must_use]
pub fn quaternion(yaw_rad: f64) -> Quaternion {
    let (sin, cos) = (0.5 * yaw_rad).sin_cos();
    Quaternion { x: 0.0, y: 0.0, z: sin, w: cos }
}

/// A pose in the plane.
#[must_use]
pub fn pose_message(pose: &Pose) -> PoseMsg {
    PoseMsg { position: point_message(pose.x, pose.y), orientation: quaternion(pose.yaw) }
}

/// A point in the plane.
#[must_use]
pub const fn point_message(x_m: f64, y_m: f64) -> PointMsg {
    PointMsg { x: x_m, y: y_m, z: 0.0 }
}

/// The pose in the plane of a message; its heading is that of the x axis.
#[must_use]
pub fn pose(message: &PoseMsg) -> Pose {
    let q = &message.orientation;
    let yaw = (2.0 * (q.w * q.z + q.x * q.y)).atan2(q.w * q.w + q.x * q.x - q.y * q.y - q.z * q.z);
    Pose::new(message.position.x, message.position.y, yaw)
}

/// A pose in a frame at a time.
#[must_use]
pub fn stamped(pose: &Pose, frame: &str, stamp_s: f64) -> PoseStamped {
    PoseStamped { header: header(frame, stamp_s), pose: pose_message(pose) }
}

/// A velocity in the plane.
#[must_use]
pub fn twist_message(twist: &Twist) -> TwistMsg {
    let linear = Vector3 { x: twist.linear_mps, ..Vector3::default() };
    TwistMsg { linear, angular: Vector3 { z: twist.angular_rps, ..Vector3::default() } }
}

/// The forward and the turning speed of a message.
#[must_use]
pub const fn twist(message: &TwistMsg) -> Twist {
    Twist::new(message.linear.x, message.angular.z)
}

/// A path in a frame.
#[must_use]
pub fn path_message(path: &Path, frame: &str, stamp_s: f64) -> nav_msgs::Path {
    let poses = path.poses.iter().map(|pose| stamped(pose, frame, stamp_s)).collect();
    nav_msgs::Path { header: header(frame, stamp_s), poses }
}

/// The map of a message; its values are taken over without a copy.
///
/// # Errors
/// [`MapMessageError`] for a size, a resolution, an origin or a number of values that
/// cannot be.
pub fn grid(message: nav_msgs::OccupancyGrid) -> Result<OccupancyGrid, MapMessageError> {
    let info = &message.info;
    // 0.05 is a little more than 0.05 in 32 bits. costmap_2d and its planners compute with
    // the value as it came, and so do we: over a hundred columns the two part by a cell.
    let info = GridInfo::new(info.width, info.height, f64::from(info.resolution), pose(&info.origin))?;
    Ok(OccupancyGrid::new(info, message.data)?)
}

/// The message of a map.
#[must_use]
pub fn grid_message(grid: &OccupancyGrid, frame: &str, stamp_s: f64) -> nav_msgs::OccupancyGrid {
    let info = map_meta_data(grid.info(), stamp_s);
    nav_msgs::OccupancyGrid { header: header(frame, stamp_s), info, data: grid.data().to_vec() }
}

/// Size, resolution and place of a map.
#[must_use]
pub fn map_meta_data(info: &GridInfo, stamp_s: f64) -> nav_msgs::MapMetaData {
    nav_msgs::MapMetaData {
        map_load_time: time(stamp_s),
        resolution: info.resolution_m() as f32,
        width: u32::try_from(info.width()).unwrap_or(u32::MAX),
        height: u32::try_from(info.height()).unwrap_or(u32::MAX),
        origin: pose_message(&info.origin_in_map()),
    }
}

/// The rectangle of an update.
#[must_use]
pub fn patch(message: map_msgs::OccupancyGridUpdate) -> GridPatch {
    let map_msgs::OccupancyGridUpdate { x, y, width, height, data, .. } = message;
    GridPatch { corner: Cell::new(x, y), width, height, data }
}

/// An update with the values of a rectangle.
#[must_use]
pub fn patch_message(patch: GridPatch, frame: &str, stamp_s: f64) -> map_msgs::OccupancyGridUpdate {
    let GridPatch { corner: Cell { x, y }, width, height, data } = patch;
    map_msgs::OccupancyGridUpdate { header: header(frame, stamp_s), x, y, width, height, data }
}

/// A scan, in the lidar's frame.
#[must_use]
pub fn scan(message: &sensor_msgs::LaserScan) -> LaserScan {
    let (range_min_m, range_max_m) = believable_limits(message.range_min, message.range_max);
    LaserScan {
        stamp_s: seconds(&message.header.stamp),
        angle_min_rad: f64::from(message.angle_min),
        angle_increment_rad: f64::from(message.angle_increment),
        range_min_m,
        range_max_m,
        ranges_m: message.ranges.clone(),
    }
}

/// The message of a scan.
#[must_use]
pub fn scan_message(scan: &LaserScan, frame: &str, period_s: f64) -> sensor_msgs::LaserScan {
    let last = scan.ranges_m.len().saturating_sub(1);
    sensor_msgs::LaserScan {
        header: header(frame, scan.stamp_s),
        angle_min: scan.angle_min_rad as f32,
        angle_max: scan.angle_rad(last) as f32,
        angle_increment: scan.angle_increment_rad as f32,
        time_increment: 0.0,
        scan_time: period_s as f32,
        range_min: scan.range_min_m as f32,
        range_max: scan.range_max_m as f32,
        ranges: scan.ranges_m.clone(),
        intensities: Vec::new(),
    }
}

/// The transforms of a tf message.
pub fn transforms(message: tf2_msgs::TFMessage) -> impl Iterator<Item = TransformSample> {
    message.transforms.into_iter().map(|one| {
        let (t, r) = (&one.transform.translation, &one.transform.rotation);
        TransformSample {
            parent: one.header.frame_id,
            child: one.child_frame_id,
            stamp_s: seconds(&one.header.stamp),
            translation_m: [t.x, t.y, t.z],
            rotation_xyzw: [r.x, r.y, r.z, r.w],
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_and_times_come_back() {
        let there = Pose::new(1.5, -2.0, 2.8);
        let back = pose(&pose_message(&there));
        assert!(back.distance_to(there.position()) < 1e-12 && (back.yaw - there.yaw).abs() < 1e-12);
        assert!((seconds(&time(1_234.567_891)) - 1_234.567_891).abs() < 1e-9);
        assert_eq!(seconds(&time(-3.0)), 0.0);
    }

    #[test]
    fn maps_come_back_with_the_resolution_of_the_message() {
        let info = GridInfo::new(3, 2, 0.05, Pose::new(-1.0, 2.0, 0.3)).unwrap();
        let map = OccupancyGrid::new(info, vec![-1, 0, 100, 25, 50, 75]).unwrap();
        let back = grid(grid_message(&map, "map", 3.0)).unwrap();
        assert_eq!(back.data(), map.data());
        assert_eq!(back.info().resolution_m(), f64::from(0.05_f32));
        let (a, b) = (back.info().origin_in_map(), info.origin_in_map());
        assert!(a.distance_to(b.position()) < 1e-12 && (a.yaw - b.yaw).abs() < 1e-12);
        let mut short = grid_message(&map, "map", 3.0);
        short.data.pop();
        assert!(matches!(grid(short), Err(MapMessageError::Data(_))));
        let mut flat = grid_message(&map, "map", 3.0);
        flat.info.resolution = f32::NAN;
        assert!(matches!(grid(flat), Err(MapMessageError::Info(_))));
    }

    #[test]
    fn a_lidar_upside_down_sweeps_the_other_way() {
        let message = sensor_msgs::LaserScan {
            angle_min: -0.5,
            angle_increment: 0.5,
            range_max: 5.0,
            ranges: vec![1.0, 2.0, 3.0],
            ..sensor_msgs::LaserScan::default()
        };
        let (upright, hanging) = (scan(&message), scan(&message).turned_upright());
        assert_eq!((upright.angle_rad(0), upright.angle_rad(2)), (-0.5, 0.5));
        assert_eq!((hanging.angle_rad(0), hanging.angle_rad(2)), (0.5, -0.5));
    }
}
