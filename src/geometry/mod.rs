//! Poses, twists, circles, polygons and footprints in the plane (floor 0).
//!
//! Lengths are metres, angles radians, counter-clockwise positive from the x axis
//! (REP 103). Where a value belongs to a frame, its name says so (`pose_in_map`).

mod areas;
mod body;
mod circle;
mod footprint;
mod motion;
mod path;
mod polygon;
mod pose;

pub use areas::Areas;
pub use body::Body;
pub use circle::Circle;
pub use footprint::{Footprint, FootprintError};
pub use motion::{MotionLimits, Twist};
pub use path::Path;
pub(crate) use polygon::spans_at;
pub use polygon::{Polygon, PolygonError};
pub(crate) use pose::normalize_angle;
pub use pose::{Pose, shortest_angle};

/// A point in the plane, in metres.
pub type Point = nalgebra::Point2<f64>;
