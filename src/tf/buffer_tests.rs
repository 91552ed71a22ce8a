//! Transforms between frames over time: chains, interpolation, what is missing, what is forgotten.

use super::super::planar;
use super::*;
use std::f64::consts::{FRAC_PI_2, PI};

fn sample(parent: &str, child: &str, stamp_s: f64, x: f64, yaw: f64) -> TransformSample {
    let (sin, cos) = (0.5 * yaw).sin_cos();
    TransformSample {
        parent: parent.to_owned(),
        child: child.to_owned(),
        stamp_s,
        translation_m: [x, 0.0, 0.0],
        rotation_xyzw: [0.0, 0.0, sin, cos],
    }
}

/// map -> odom -> base_link -> laser (fixed, looking left).
fn robot() -> TransformBuffer {
    let mut buffer = TransformBuffer::new(10.0);
    for i in 0..5 {
        let at_s = 100.0 + 0.1 * f64::from(i);
        buffer.insert(&sample("odom", "base_link", at_s, f64::from(i), 0.0), false).unwrap();
    }
    buffer.insert(&sample("map", "odom", 100.0, 10.0, 0.0), false).unwrap();
    buffer.insert(&sample("map", "odom", 100.3, 10.0, 0.0), false).unwrap();
    buffer.insert(&sample("/base_link", "/laser", 0.0, 0.2, FRAC_PI_2), true).unwrap();
    buffer
}

#[test]
fn the_latest_common_time_counts() {
    let pose = robot().latest("map", "base_link").unwrap();
    assert_eq!(pose.stamp_s, 100.3);
    assert!((planar(&pose.transform).x - 13.0).abs() < 1e-9);
}

#[test]
fn chains_go_up_and_down_and_through_fixed_links() {
    let buffer = robot();
    let laser = planar(&buffer.at("map", "laser", 100.2).unwrap());
    assert!((laser.x - 12.2).abs() < 1e-9 && (laser.yaw - FRAC_PI_2).abs() < 1e-9);
    let back = planar(&buffer.at("laser", "map", 100.2).unwrap());
    assert!(laser.compose(&back).distance_to(crate::geometry::Point::origin()) < 1e-9);
    let fixed = buffer.latest("base_link", "laser").unwrap();
    assert_eq!(fixed.stamp_s, f64::INFINITY);
    assert!(buffer.latest("laser", "laser").unwrap().transform.translation.vector.norm() < 1e-12);
}

#[test]
fn positions_and_rotations_are_interpolated_the_short_way() {
    let mut buffer = TransformBuffer::new(10.0);
    buffer.insert(&sample("odom", "base", 1.0, 0.0, PI - 0.1), false).unwrap();
    buffer.insert(&sample("odom", "base", 2.0, 4.0, -PI + 0.1), false).unwrap();
    for (at_s, x, yaw) in [(1.0, 0.0, PI - 0.1), (1.25, 1.0, PI - 0.05), (1.75, 3.0, -PI + 0.05)] {
        let pose = planar(&buffer.at("odom", "base", at_s).unwrap());
        assert!((pose.x - x).abs() < 1e-9 && (pose.yaw - yaw).abs() < 1e-9, "{pose:?}");
    }
}

#[test]
fn what_is_missing_is_named() {
    let mut buffer = robot();
    let error = |buffer: &TransformBuffer, a: &str, b: &str| buffer.latest(a, b).unwrap_err().to_string();
    let unknown = error(&buffer, "map", "base_footprint");
    assert_eq!(unknown, "the frame base_footprint is unknown: tf has base_link, laser, map, odom");
    buffer.insert(&sample("world", "cup", 1.0, 0.0, 0.0), false).unwrap();
    let apart = error(&buffer, "map", "cup");
    assert_eq!(apart, "nothing connects map and cup: their roots are map and world");
    let future = buffer.at("map", "base_link", 100.35).unwrap_err();
    assert!(matches!(future, TransformError::OutOfHistory { ref frame, .. } if frame == "odom"), "{future}");
    assert!(buffer.at("map", "base_link", 99.0).is_err());
    let empty = error(&TransformBuffer::new(1.0), "map", "base");
    assert_eq!(empty, "the frame map is unknown: tf has no frame yet");
}

#[test]
fn garbage_is_turned_away_and_circles_end() {
    let mut buffer = TransformBuffer::new(10.0);
    assert!(buffer.insert(&sample("", "a", 0.0, 0.0, 0.0), false).is_err());
    assert!(buffer.insert(&sample("a", "a", 0.0, 0.0, 0.0), false).is_err());
    assert!(buffer.insert(&sample("a", "b", 0.0, f64::NAN, 0.0), false).is_err());
    let no_rotation = TransformSample { rotation_xyzw: [0.0; 4], ..sample("a", "b", 0.0, 0.0, 0.0) };
    assert!(buffer.insert(&no_rotation, false).is_err());
    let too_long = TransformSample { rotation_xyzw: [0.0, 0.0, 0.0, 1.01], ..sample("a", "b", 0.0, 0.0, 0.0) };
    let error = buffer.insert(&too_long, false).unwrap_err().to_string();
    assert_eq!(error, "the rotation from a to b is no unit quaternion: its norm is 1.010, must be 1");
    let rounded = TransformSample { rotation_xyzw: [0.0, 0.0, 0.0, 1.004], ..sample("c", "d", 0.0, 0.0, 0.0) };
    assert!(buffer.insert(&rounded, false).is_ok(), "tf2 lets 1 % of the square pass");
    buffer.insert(&sample("a", "b", 0.0, 0.0, 0.0), false).unwrap();
    buffer.insert(&sample("b", "a", 0.0, 0.0, 0.0), false).unwrap();
    assert_eq!(buffer.latest("a", "b").unwrap_err(), TransformError::Circle("a".to_owned()));
}

#[test]
fn memory_is_bounded_and_a_new_parent_starts_anew() {
    let mut buffer = TransformBuffer::new(1.0);
    for i in 0..10_000 {
        buffer.insert(&sample("odom", "base", f64::from(i) * 0.01, 0.0, 0.0), false).unwrap();
    }
    let error = buffer.at("odom", "base", 98.0).unwrap_err();
    assert!(matches!(error, TransformError::OutOfHistory { oldest_s, .. } if oldest_s > 98.9), "{error}");
    buffer.insert(&sample("wheel", "base", 5.0, 1.0, 0.0), false).unwrap();
    assert_eq!(buffer.latest("wheel", "base").unwrap().stamp_s, 5.0);
    assert!(buffer.latest("odom", "base").is_err());
    for i in 0..2 * MAX_FRAMES {
        let _ = buffer.insert(&sample("odom", &format!("f{i}"), 0.0, 0.0, 0.0), false);
    }
    assert_eq!(buffer.links.len(), MAX_FRAMES);
}

#[test]
fn a_jump_back_forgets_what_moves_alone() {
    let mut buffer = robot();
    buffer.clear_moving();
    assert!(buffer.latest("map", "base_link").is_err());
    assert!(buffer.latest("base_link", "laser").is_ok());
    buffer.insert(&sample("odom", "base_link", 1.0, 0.0, 0.0), false).unwrap();
    buffer.insert(&sample("map", "odom", 1.0, 0.0, 0.0), false).unwrap();
    assert_eq!(buffer.latest("map", "laser").unwrap().stamp_s, 1.0);
}

#[test]
fn what_lies_ahead_can_be_forgotten_and_moving_links_are_named() {
    let mut buffer = robot();
    let links = |buffer: &TransformBuffer| {
        let links = buffer.moving_links("map", "laser").unwrap();
        links.iter().map(|link| (link.parent.to_owned(), link.child.to_owned(), link.newest_s)).collect::<Vec<_>>()
    };
    let link = |parent: &str, child: &str, newest_s| (parent.to_owned(), child.to_owned(), newest_s);
    assert_eq!(links(&buffer), [link("odom", "base_link", 100.4), link("map", "odom", 100.3)]);
    buffer.forget_after("/base_link", 100.25);
    buffer.forget_after("laser", -1.0);
    assert_eq!(links(&buffer), [link("odom", "base_link", 100.2), link("map", "odom", 100.3)]);
    assert_eq!(buffer.latest("map", "laser").unwrap().stamp_s, 100.2);
}
