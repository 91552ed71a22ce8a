//! Values on the command line that are more than a word or a number.

use frontier_explorer::geometry::Pose;
use frontier_explorer::sim::SlamKind;
use std::f64::consts::TAU;

/// Reads `X,Y` or `X,Y,YAW` in metres and radians.
pub fn pose(text: &str) -> Result<Pose, String> {
    let wrong = || format!("{text:?} is no pose: must be X,Y or X,Y,YAW in metres and radians");
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|part| part.trim().parse::<f64>()).collect();
    let pose = match *numbers.map_err(|_| wrong())? {
        [x, y] => Pose::new(x, y, 0.0),
        [x, y, yaw] => Pose::new(x, y, yaw),
        _ => return Err(wrong()),
    };
    if !pose.is_finite() {
        return Err(wrong());
    }
    if pose.yaw.abs() > TAU {
        let radians = pose.yaw.to_radians();
        return Err(format!("a yaw of {} is more than a turn: if degrees were meant, say {radians:.4}", pose.yaw));
    }
    Ok(pose)
}

/// Reads the name of a SLAM.
pub fn slam(text: &str) -> Result<SlamKind, String> {
    let kinds = [SlamKind::Perfect, SlamKind::Matched];
    kinds.into_iter().find(|kind| kind.name() == text).ok_or_else(|| "must be perfect or matched".to_owned())
}

/// Reads a word of a list, without the spaces that follow a comma.
pub fn trimmed(text: &str) -> Result<String, std::convert::Infallible> {
    Ok(text.trim().to_owned())
}

/// Reads a number of metres greater than 0.
pub fn positive_metres(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(metres) if metres.is_finite() && metres > 0.0 => Ok(metres),
        _ => Err(format!("{text:?}: must be a number of metres > 0")),
    }
}

/// Reads a number of seconds greater than 0.
pub fn positive_seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(seconds) if seconds.is_finite() && seconds > 0.0 => Ok(seconds),
        _ => Err(format!("{text:?}: must be a number of seconds > 0")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_have_two_or_three_numbers() {
        assert_eq!(pose("25,20"), Ok(Pose::new(25.0, 20.0, 0.0)));
        assert_eq!(pose("-1.5, 2, 0.5"), Ok(Pose::new(-1.5, 2.0, 0.5)));
        let degrees = pose("5,5,90").unwrap_err();
        assert_eq!(degrees, "a yaw of 90 is more than a turn: if degrees were meant, say 1.5708");
        for wrong in ["", "1", "1,x", "1,2,3,4", "1,nan", "1,inf"] {
            assert!(pose(wrong).is_err(), "{wrong}");
        }
    }
}
