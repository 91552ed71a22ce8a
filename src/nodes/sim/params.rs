//! The parameters of `sim_node`.

use crate::config::{ParamError, read_params};
use crate::geometry::Pose;
use crate::range::OutOfRange;
use crate::sim::{DriverKind, MapStyle, SlamKind};
use serde::Deserialize;
use serde_json::Value;

/// Parameters that cannot be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SimParamsError {
    /// A name that is not known, or a value of the wrong kind.
    #[error("parameter ~{0}")]
    Wrong(#[from] ParamError),
    /// A number out of its range.
    #[error("parameter ~{0}")]
    OutOfRange(#[from] OutOfRange),
}

/// A part of the stack that misbehaves, for tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fault {
    /// All is well.
    #[default]
    None,
    /// `/tf` falls silent.
    DropTf,
    /// move_base aborts every goal.
    AbortGoals,
    /// move_base turns every goal away.
    RejectGoals,
    /// move_base takes goals, does nothing, and never says so.
    Hang,
    /// move_base is gone: no status, no result.
    DeadMoveBase,
    /// No map comes any more.
    StopMap,
}

impl Fault {
    /// The names of all faults.
    pub const NAMES: &'static str = "none, drop_tf, abort_goals, reject_goals, hang, dead_move_base, stop_map";

    /// A fault by its name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        serde_json::from_value(Value::String(name.to_owned())).ok()
    }
}

/// The parameters, with their defaults.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SimParams {
    /// office, museum, maze, warehouse, or a map_server YAML file.
    pub world: String,
    /// A built-in robot, or a YAML file.
    pub robot: String,
    /// The preset whose `navigation` and planner drive where our own navigator does.
    pub config: String,
    /// How the robot knows where it is: `matched`, with errors as gmapping's, or `perfect`.
    pub slam: SlamKind,
    /// Who drives behind move_base's topics: `move_base`, a stand-in that refuses and fails
    /// as the real one, or `navigator`, our own, which is kind.
    pub driver: DriverKind,
    /// Where the robot begins: x, y and yaw in metres and radians; the most open spot
    /// when empty.
    pub start: Vec<f64>,
    /// Simulated seconds a real second.
    pub speed: f64,
    /// Decides every random number.
    pub seed: u64,
    /// The values of the map: gmapping or cartographer.
    pub map_style: MapStyle,
    /// Standard deviation of the lidar's ranges, metres, instead of the robot's own.
    pub lidar_noise: Option<f64>,
    /// Errors of the odometry: the four alphas of *Probabilistic Robotics*; those of the
    /// SLAM's kind when left out.
    pub odometry_noise: Option<[f64; 4]>,
    /// Whether a stand-in for move_base runs.
    pub move_base: bool,
    /// The robot's frame.
    pub base_frame: String,
    /// What misbehaves from the start.
    pub fault: Fault,
}

impl Default for SimParams {
    fn default() -> Self {
        Self {
            world: "office".to_owned(),
            robot: "turtlebot2".to_owned(),
            config: "wfd".to_owned(),
            slam: SlamKind::Matched,
            driver: DriverKind::MoveBase,
            start: Vec::new(),
            speed: 1.0,
            seed: 1,
            map_style: MapStyle::Gmapping,
            lidar_noise: None,
            odometry_noise: None,
            move_base: true,
            base_frame: "base_link".to_owned(),
            fault: Fault::None,
        }
    }
}

impl SimParams {
    /// Reads a tree of parameters.
    ///
    /// # Errors
    /// [`SimParamsError`] with the parameter, its value and what is allowed.
    pub fn from_tree(tree: Value) -> Result<Self, SimParamsError> {
        let params: Self = read_params(tree)?;
        let speed = params.speed;
        OutOfRange::unless((0.1..=100.0).contains(&speed), "speed", speed, "within 0.1 to 100")?;
        OutOfRange::unless_not_negative("lidar_noise", params.lidar_noise.unwrap_or(0.0))?;
        for value in params.odometry_noise.into_iter().flatten() {
            OutOfRange::unless_not_negative("odometry_noise", value)?;
        }
        params.start_pose()?;
        Ok(params)
    }

    /// Where the robot begins, if that is said.
    ///
    /// # Errors
    /// [`SimParamsError`] for anything but none, two or three finite numbers.
    pub fn start_pose(&self) -> Result<Option<Pose>, SimParamsError> {
        let pose = match *self.start {
            [] => return Ok(None),
            [x, y] => Pose::new(x, y, 0.0),
            [x, y, yaw] => Pose::new(x, y, yaw),
            _ => Pose::new(f64::NAN, 0.0, 0.0),
        };
        if pose.is_finite() {
            return Ok(Some(pose));
        }
        let message = format!("is {:?}: must be x, y or x, y, yaw in metres and radians", self.start);
        Err(ParamError { path: "start".to_owned(), message }.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn defaults_and_mistakes() {
        assert_eq!(SimParams::from_tree(json!({})).unwrap(), SimParams::default());
        let some = SimParams::from_tree(json!({"start": [1.5, 7.9], "speed": 4, "map_style": "cartographer"})).unwrap();
        assert_eq!((some.slam, some.driver), (SlamKind::Matched, DriverKind::MoveBase));
        let kind = SimParams::from_tree(json!({"slam": "perfect", "driver": "navigator"})).unwrap();
        assert_eq!((kind.slam, kind.driver), (SlamKind::Perfect, DriverKind::Navigator));
        assert_eq!(some.start_pose().unwrap(), Some(Pose::new(1.5, 7.9, 0.0)));
        let error = |tree| SimParams::from_tree(tree).unwrap_err().to_string();
        assert_eq!(error(json!({"speed": 0})), "parameter ~speed is 0: must be within 0.1 to 100");
        assert!(error(json!({"wrld": "x"})).contains("unknown field `wrld`"));
        assert!(error(json!({"start": [1.0]})).starts_with("parameter ~start: is [1.0]: must be"));
        assert!(error(json!({"fault": "fire"})).contains("drop_tf"));
    }

    #[test]
    fn all_faults_have_the_names_that_are_listed() {
        for name in Fault::NAMES.split(", ") {
            assert!(Fault::from_name(name).is_some(), "{name}");
        }
        assert_eq!(Fault::from_name("fire"), None);
    }
}
