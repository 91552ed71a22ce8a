//! Where frames are in each other over time: the part of tf2's buffer that a robot's
//! pose needs (floor 0). Pure; what fills it stands on the rim.

mod buffer;
mod link;

pub use buffer::{MovingLink, Stamped, TransformBuffer, TransformError};
pub use link::{RejectedTransform, TransformSample};

use crate::geometry::Pose;
use nalgebra::{Isometry3, Vector3};

/// The pose in the plane of a transform between frames that stand upright: position,
/// and the heading of the x axis.
#[must_use]
pub fn planar(transform: &Isometry3<f64>) -> Pose {
    let ahead = transform.rotation * Vector3::x();
    Pose::new(transform.translation.x, transform.translation.y, ahead.y.atan2(ahead.x))
}

/// Whether a frame stands on its head in another: its z axis points down.
#[must_use]
pub(crate) fn is_upside_down(transform: &Isometry3<f64>) -> bool {
    (transform.rotation * Vector3::z()).z < 0.0
}

/// The transform of a pose in the plane.
#[must_use]
pub(crate) fn upright(pose: &Pose) -> Isometry3<f64> {
    Isometry3::new(Vector3::new(pose.x, pose.y, 0.0), Vector3::z() * pose.yaw)
}

/// A frame's name without the leading slash of tf 1.
#[must_use]
pub(crate) fn frame_name(name: &str) -> &str {
    name.trim_start_matches('/')
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn a_pose_goes_to_space_and_back() {
        let pose = Pose::new(1.0, -2.0, 2.5);
        let back = planar(&upright(&pose));
        assert!(back.distance_to(pose.position()) < 1e-12 && (back.yaw - pose.yaw).abs() < 1e-12);
        assert!(!is_upside_down(&upright(&pose)));
        assert!(is_upside_down(&Isometry3::rotation(Vector3::x() * PI)));
    }

    #[test]
    fn tf_1_names_have_a_slash() {
        assert_eq!((frame_name("/map"), frame_name("robot/base")), ("map", "robot/base"));
    }
}
