//! The robots of `configs/robots/`, carried in the library so that their names work
//! wherever it runs.

use super::names::hint;
use super::{RobotConfig, RobotConfigError};

/// Every built-in robot: its name, and the text of its file.
pub const BUILTIN_ROBOTS: [(&str, &str); 4] = [
    ("turtlebot2", include_str!("../../configs/robots/turtlebot2.yaml")),
    ("turtlebot2_astra", include_str!("../../configs/robots/turtlebot2_astra.yaml")),
    ("turtlebot3_burger", include_str!("../../configs/robots/turtlebot3_burger.yaml")),
    ("turtlebot3_waffle", include_str!("../../configs/robots/turtlebot3_waffle.yaml")),
];

/// A built-in robot by its name.
///
/// ```
/// let robot = frontier_explorer::config::builtin_robot("turtlebot3_burger").unwrap();
/// assert_eq!(robot.limits.max_linear_mps, 0.22);
/// ```
///
/// # Errors
/// [`RobotConfigError::UnknownName`] with the names that there are.
pub fn builtin_robot(name: &str) -> Result<RobotConfig, RobotConfigError> {
    match BUILTIN_ROBOTS.iter().find(|(known, _)| *known == name) {
        Some((_, text)) => RobotConfig::from_yaml(text),
        None => Err(RobotConfigError::UnknownName {
            name: name.to_owned(),
            known: BUILTIN_ROBOTS.map(|(known, _)| known).join(", "),
            hint: hint(name, BUILTIN_ROBOTS.iter().map(|(known, _)| *known)),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn every_file_is_built_in_and_valid() {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/robots");
        let mut names: Vec<String> = std::fs::read_dir(directory)
            .unwrap()
            .map(|entry| entry.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        names.sort();
        assert_eq!(names, BUILTIN_ROBOTS.map(|(name, _)| name));
        for name in names {
            assert_eq!(builtin_robot(&name).unwrap().name, name);
        }
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_known_ones() {
        let message = builtin_robot("turtlebot").unwrap_err().to_string();
        assert_eq!(
            message,
            "no robot is called 'turtlebot': must be one of turtlebot2, turtlebot2_astra, turtlebot3_burger, \
             turtlebot3_waffle (did you mean turtlebot2?)"
        );
    }

    #[test]
    fn the_doors_of_the_worlds_let_every_robot_through() {
        for (name, _) in BUILTIN_ROBOTS {
            let robot = builtin_robot(name).unwrap();
            let padded_m = robot.footprint.circumscribed_radius_m() + robot.costmap.padding_m;
            assert!(padded_m < 0.4, "{name}: {padded_m} m");
        }
    }
}
