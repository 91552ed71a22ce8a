//! What exploration needs of the messages in a bag, decoded.
//!
//! Each function takes the bytes of a message of one type, whose md5 sum was looked at
//! before ([`super::MessageType`]).

use super::cursor::{Cursor, Malformed};
use super::definitions::MessageType;
use super::{Nanos, seconds};
use crate::geometry::Pose;
use crate::grid::{Cell, GridInfo, GridPatch, OccupancyGrid};
use crate::scan::{BEYOND_ALL_LIDARS_M, LaserScan, Reading, believable_limits};
use crate::tf::{TransformSample, planar};
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};

/// `std_msgs/Header`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Header {
    /// Counts messages.
    pub seq: u32,
    /// When it was true.
    pub stamp: Nanos,
    /// What its coordinates are in.
    pub frame: String,
}

/// `nav_msgs/OccupancyGrid`.
#[derive(Clone, Debug)]
pub struct MapMessage {
    /// Its header.
    pub header: Header,
    /// The map.
    pub grid: OccupancyGrid,
}

/// `map_msgs/OccupancyGridUpdate`.
#[derive(Clone, Debug)]
pub struct PatchMessage {
    /// Its header.
    pub header: Header,
    /// The rectangle.
    pub patch: GridPatch,
}

/// `sensor_msgs/LaserScan`, in the frame of the lidar itself.
#[derive(Clone, Debug)]
pub struct ScanMessage {
    /// Its header; the frame is the lidar's.
    pub header: Header,
    /// The sweep.
    pub scan: LaserScan,
}

/// `geometry_msgs/PoseStamped`, or one wrapped in an action goal.
#[derive(Clone, Debug, PartialEq)]
pub struct StampedPose {
    /// Its header.
    pub header: Header,
    /// The pose in the plane of the header's frame.
    pub pose: Pose,
}

/// `nav_msgs/Odometry`.
#[derive(Clone, Debug, PartialEq)]
pub struct Odometry {
    /// Its header.
    pub header: Header,
    /// The robot's frame.
    pub child: String,
    /// Where the robot believes it is in the header's frame.
    pub pose: Pose,
}

impl Cursor<'_> {
    pub(super) fn header(&mut self) -> Result<Header, Malformed> {
        Ok(Header { seq: self.u32("seq")?, stamp: self.time("stamp")?, frame: self.text("frame_id")? })
    }

    fn xyz(&mut self) -> Result<[f64; 3], Malformed> {
        Ok([self.f64("x")?, self.f64("y")?, self.f64("z")?])
    }

    fn xyzw(&mut self) -> Result<[f64; 4], Malformed> {
        let [x, y, z] = self.xyz()?;
        Ok([x, y, z, self.f64("w")?])
    }

    fn pose(&mut self) -> Result<Pose, Malformed> {
        let ([x, y, z], [i, j, k, w]) = (self.xyz()?, self.xyzw()?);
        let rotation = Quaternion::new(w, i, j, k);
        // An orientation of all zeros is what a message has when nobody filled it in.
        let rotation =
            if rotation.norm() < 1e-9 { UnitQuaternion::identity() } else { UnitQuaternion::from_quaternion(rotation) };
        let pose = planar(&Isometry3::from_parts(Translation3::new(x, y, z), rotation));
        if pose.is_finite() {
            Ok(pose)
        } else {
            Err(Malformed::Wrong(format!(
                "a pose that is not finite: position ({x}, {y}, {z}), orientation ({i}, {j}, {k}, {w})"
            )))
        }
    }

    fn cells(&mut self) -> Result<Vec<i8>, Malformed> {
        Ok(self.block("data")?.iter().map(|&byte| byte.cast_signed()).collect())
    }

    /// All of a map but its cells.
    fn map_head(&mut self) -> Result<(Header, GridInfo), Malformed> {
        let header = self.header()?;
        self.time("map_load_time")?;
        let resolution = self.f32("resolution")?;
        let (width, height) = (self.u32("width")?, self.u32("height")?);
        let origin = self.pose().map_err(|error| Malformed::Wrong(format!("the map's origin: {error}")))?;
        // The value as it came, as in the nodes: costmap_2d and its planners compute with it.
        let resolution_m = f64::from(resolution);
        let info = GridInfo::new(width, height, resolution_m, origin);
        Ok((header, info.map_err(|error| Malformed::Wrong(error.to_string()))?))
    }

    /// All of a scan but its ranges, and their bytes. Limits that cannot be are replaced.
    fn scan_head(&mut self) -> Result<(Header, LaserScan, &[[u8; 4]]), Malformed> {
        let header = self.header()?;
        let angle_min = self.f32("angle_min")?;
        self.f32("angle_max")?;
        let angle_increment = self.f32("angle_increment")?;
        self.f32("time_increment")?;
        self.f32("scan_time")?;
        let (range_min, range_max) = (self.f32("range_min")?, self.f32("range_max")?);
        let count = self.count(4, "ranges")?;
        let (ranges, _) = self.take(4 * count as u64, "ranges")?.as_chunks::<4>();
        if !(angle_min.is_finite() && angle_increment.is_finite()) {
            return Err(Malformed::Wrong(format!(
                "a scan whose angles are not finite: angle_min {angle_min}, angle_increment {angle_increment}"
            )));
        }
        let (range_min_m, range_max_m) = believable_limits(range_min, range_max);
        let scan = LaserScan {
            stamp_s: seconds(header.stamp),
            angle_min_rad: f64::from(angle_min),
            angle_increment_rad: f64::from(angle_increment),
            range_min_m,
            range_max_m,
            ranges_m: Vec::new(),
        };
        Ok((header, scan, ranges))
    }
}

/// The header that a message begins with.
///
/// # Errors
/// [`Malformed`] when it is cut.
pub fn header(bytes: &[u8]) -> Result<Header, Malformed> {
    Cursor::new(bytes).header()
}

/// The time of a `rosgraph_msgs/Clock`.
///
/// # Errors
/// [`Malformed`] when it is cut.
pub fn clock(bytes: &[u8]) -> Result<Nanos, Malformed> {
    Cursor::new(bytes).time("clock")
}

/// Whether a message of a type can be decoded, without its many numbers.
///
/// # Errors
/// [`Malformed`] with what is wrong.
pub(super) fn check(kind: MessageType, bytes: &[u8]) -> Result<(), Malformed> {
    let mut cursor = Cursor::new(bytes);
    match kind {
        MessageType::Map => {
            let (_, info) = cursor.map_head()?;
            cells_fit(&info, cursor.block("data")?.len())
        }
        _ => Ok(()),
    }
}

/// Whether any reading of a scan tells a distance, or that nothing is there.
///
/// # Errors
/// [`Malformed`] with what is wrong.
pub(super) fn scan_tells(bytes: &[u8]) -> Result<bool, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let (_, scan, ranges) = cursor.scan_head()?;
    let tells = |&bytes: &[u8; 4]| match scan.reading(f32::from_le_bytes(bytes)) {
        Reading::Hit(range_m) => range_m < BEYOND_ALL_LIDARS_M,
        Reading::Clear(_) => true,
        Reading::None => false,
    };
    Ok(ranges.iter().any(tells))
}

fn cells_fit(info: &GridInfo, cells: usize) -> Result<(), Malformed> {
    if cells == info.len() {
        return Ok(());
    }
    Err(Malformed::Wrong(format!("a map of {} x {} cells with {cells} values", info.width(), info.height())))
}

/// A `nav_msgs/OccupancyGrid`. An orientation of the origin of all zeros, which is what a
/// message has when nobody filled it in, is none.
///
/// # Errors
/// [`Malformed`] when it is cut, or no map.
pub fn map(bytes: &[u8]) -> Result<MapMessage, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let (header, info) = cursor.map_head()?;
    let grid = OccupancyGrid::new(info, cursor.cells()?).map_err(|error| Malformed::Wrong(error.to_string()))?;
    Ok(MapMessage { header, grid })
}

/// A `map_msgs/OccupancyGridUpdate`.
///
/// # Errors
/// [`Malformed`] when it is cut.
pub fn patch(bytes: &[u8]) -> Result<PatchMessage, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let header = cursor.header()?;
    let corner = Cell::new(cursor.i32("x")?, cursor.i32("y")?);
    let (width, height) = (cursor.u32("width")?, cursor.u32("height")?);
    Ok(PatchMessage { header, patch: GridPatch { corner, width, height, data: cursor.cells()? } })
}

/// The transforms of a `tf2_msgs/TFMessage` or `tf/tfMessage`.
///
/// # Errors
/// [`Malformed`] when it is cut.
pub fn transforms(bytes: &[u8]) -> Result<Vec<TransformSample>, Malformed> {
    let mut cursor = Cursor::new(bytes);
    // Header, name and numbers of each take at least this.
    let count = cursor.count(76, "transforms")?;
    (0..count)
        .map(|_| {
            let header = cursor.header()?;
            Ok(TransformSample {
                parent: header.frame,
                child: cursor.text("child_frame_id")?,
                stamp_s: seconds(header.stamp),
                translation_m: cursor.xyz()?,
                rotation_xyzw: cursor.xyzw()?,
            })
        })
        .collect()
}

/// A `sensor_msgs/LaserScan`. Where `range_max` tells no limit that can be, it is infinite
/// ([`believable_limits`]).
///
/// # Errors
/// [`Malformed`] when it is cut, or its angles are no numbers.
pub fn scan(bytes: &[u8]) -> Result<ScanMessage, Malformed> {
    let mut cursor = Cursor::new(bytes);
    let (header, scan, ranges) = cursor.scan_head()?;
    let ranges_m = ranges.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect();
    Ok(ScanMessage { header, scan: LaserScan { ranges_m, ..scan } })
}

/// A `nav_msgs/Odometry`.
///
/// # Errors
/// [`Malformed`] when it is cut, or its pose no numbers.
pub fn odometry(bytes: &[u8]) -> Result<Odometry, Malformed> {
    let mut cursor = Cursor::new(bytes);
    Ok(Odometry { header: cursor.header()?, child: cursor.text("child_frame_id")?, pose: cursor.pose()? })
}

/// A `geometry_msgs/PoseStamped`.
///
/// # Errors
/// [`Malformed`] when it is cut, or its pose no numbers.
pub fn pose(bytes: &[u8]) -> Result<StampedPose, Malformed> {
    stamped(&mut Cursor::new(bytes))
}

pub(super) fn stamped(cursor: &mut Cursor<'_>) -> Result<StampedPose, Malformed> {
    Ok(StampedPose { header: cursor.header()?, pose: cursor.pose()? })
}

/// The poses of a `nav_msgs/Path`.
///
/// # Errors
/// [`Malformed`] when it is cut, or a pose no numbers.
pub fn path(bytes: &[u8]) -> Result<(Header, Vec<Pose>), Malformed> {
    let mut cursor = Cursor::new(bytes);
    let header = cursor.header()?;
    let count = cursor.count(72, "poses")?;
    let poses = (0..count).map(|_| stamped(&mut cursor).map(|stamped| stamped.pose)).collect::<Result<_, _>>()?;
    Ok((header, poses))
}
