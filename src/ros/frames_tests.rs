//! Which transforms are believed, and which are not.

use super::*;

const LIMIT_S: f64 = 0.5;

fn tell(frames: &mut Frames, child: &str, stamp_s: f64, now_s: f64, x_m: f64) {
    let parent = if child == "odom" { "map" } else { "odom" };
    let sample = TransformSample::planar(stamp_s, parent, child, &Pose::new(x_m, 0.0, 0.0));
    frames.take(&sample, false, now_s).unwrap();
}

/// `map -> odom -> base` told ten times a second up to a time, stamped so much ahead.
fn told(until_s: f64, odom_ahead_s: f64, base_ahead_s: f64) -> Frames {
    let mut frames = Frames::new();
    for i in (0..=20).rev() {
        let now_s = until_s - 0.1 * f64::from(i);
        tell(&mut frames, "odom", now_s + odom_ahead_s, now_s, 0.0);
        tell(&mut frames, "base", now_s + base_ahead_s, now_s, now_s);
    }
    frames
}

fn pose(frames: &Frames, now_s: f64) -> Result<f64, String> {
    frames.robot("map", "base", now_s, LIMIT_S).map(|pose| pose.x).map_err(|error| error.to_string())
}

#[test]
fn stamps_ahead_as_of_gmapping_are_fresh_until_they_come_no_more() {
    for ahead_s in [0.0, 0.2, 0.25, 0.5, 1.0] {
        let frames = told(100.0, ahead_s, 0.0);
        assert!((pose(&frames, 100.1).unwrap() - 100.0).abs() < 1e-9, "{ahead_s}");
        assert!(pose(&frames, 100.6).is_err(), "{ahead_s}");
    }
    let both = told(100.0, 0.9, 0.9);
    assert!(pose(&both, 100.4).is_ok());
    assert_eq!(pose(&both, 100.7).unwrap_err(), "odom -> base has not come for 0.7 s: must come every 0.5 s");
}

#[test]
fn a_wrong_clock_is_named() {
    let message = "clock skew: map -> odom is stamped 120.0 s ahead of ROS time: must be at most 1.5 s; \
                   set the clocks of the robot's computers alike";
    assert_eq!(pose(&told(100.0, 120.0, 0.0), 100.0).unwrap_err(), message);
    assert!(pose(&told(100.0, 120.0, 120.0), 100.0).unwrap_err().contains("odom -> base is stamped 120.0 s"));
    let behind = pose(&told(100.0, 0.0, -3.0), 100.0).unwrap_err();
    assert!(behind.starts_with("clock skew: odom -> base comes stamped 3.0 s behind ROS time"), "{behind}");
    let late = pose(&told(100.0, 0.0, -1.0), 100.0).unwrap_err();
    assert_eq!(late, "the transform from map to base is 1.0 s old: must be at most 0.5 s");
    let silent = pose(&told(100.0, 0.0, -3.0), 100.6).unwrap_err();
    assert_eq!(silent, "the transform from map to base is 3.6 s old: must be at most 0.5 s");
}

#[test]
fn a_late_message_from_before_a_jump_back_freezes_nothing() {
    let mut frames = told(230.0, 0.0, 0.0);
    frames.notice_time(230.0, 100.0);
    assert!(pose(&frames, 100.0).is_err());
    tell(&mut frames, "odom", 100.1, 100.1, 0.0);
    tell(&mut frames, "base", 100.1, 100.1, 1.0);
    // One that was under way when time jumped.
    tell(&mut frames, "base", 230.0, 100.12, 9.0);
    assert_eq!(pose(&frames, 100.12), Ok(1.0), "it is dropped");
    tell(&mut frames, "odom", 100.2, 100.2, 0.0);
    tell(&mut frames, "base", 100.2, 100.2, 2.0);
    assert_eq!(pose(&frames, 100.2), Ok(2.0));
    // Nor does one that comes before the jump was noticed.
    let mut unnoticed = told(230.0, 0.0, 0.0);
    tell(&mut unnoticed, "odom", 100.1, 100.1, 0.0);
    tell(&mut unnoticed, "base", 100.1, 100.1, 3.0);
    assert_eq!(pose(&unnoticed, 100.1), Ok(3.0));
    // And one that comes first gives way to the next.
    let mut first = told(230.0, 0.0, 0.0);
    first.notice_time(230.0, 100.0);
    tell(&mut first, "base", 230.0, 100.0, 9.0);
    tell(&mut first, "odom", 100.1, 100.1, 0.0);
    assert!(pose(&first, 100.1).unwrap_err().contains("clock skew"));
    tell(&mut first, "base", 100.1, 100.1, 4.0);
    assert_eq!(pose(&first, 100.1), Ok(4.0));
}

#[test]
fn a_clock_that_goes_wrong_is_named_after_a_second() {
    let mut frames = told(100.0, 0.0, 0.0);
    for i in 1..=15 {
        let now_s = 100.0 + 0.1 * f64::from(i);
        tell(&mut frames, "odom", now_s + 120.0, now_s, 0.0);
        tell(&mut frames, "base", now_s, now_s, 0.0);
    }
    assert!(pose(&frames, 101.5).unwrap_err().contains("clock skew: map -> odom is stamped 120.0 s ahead"));
}

#[test]
fn a_place_is_that_of_its_time_or_the_newest() {
    let frames = told(100.0, 0.0, 0.0);
    let x = |stamp_s| frames.place("/map", "base", stamp_s).map(|place| place.translation.x).ok();
    assert!(x(99.0).is_some_and(|x| (x - 99.0).abs() < 1e-9));
    assert!([0.0, 1.0, 500.0].map(x).iter().all(|x| x.is_some_and(|x| (x - 100.0).abs() < 1e-9)));
    assert!(frames.place("map", "laser", 99.0).is_err());
}

#[test]
fn the_frame_that_is_missing_is_named() {
    let frames = told(100.0, 0.0, 0.0);
    let error = frames.robot("map", "base_lnk", 100.0, LIMIT_S).unwrap_err().to_string();
    let said = "the robot's frame base_lnk (~base_frame) is unknown: tf has base, map, odom; \
                set ~base_frame to the robot's";
    assert_eq!(error, format!("no transform from map to base_lnk yet: {said}"));
    let error = frames.robot("mapp", "base", 100.0, LIMIT_S).unwrap_err().to_string();
    assert!(error.contains("the map's frame mapp is unknown"), "{error}");
    let error = Frames::new().robot("map", "base", 100.0, LIMIT_S).unwrap_err().to_string();
    assert!(error.contains("neither frame is known: tf has no frame yet"), "{error}");
}
