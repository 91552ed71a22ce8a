//! From a path to velocity commands (floor 1): one file for each controller.

mod controller;
mod dwa;
mod dwa_config;
mod guard;
mod outline;
mod path_follower;
mod path_progress;
mod surroundings;

pub use controller::{ControlError, ControlInput, Controller};
pub use dwa::Dwa;
pub use dwa_config::{DwaConfig, DwaWeights};
pub use guard::StopGuard;
pub(crate) use outline::Outline;
pub use path_follower::{FollowerConfig, PathFollower};
pub(crate) use surroundings::Surroundings;

use crate::geometry::Body;
use crate::range::{OutOfRange, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The controllers with their parameters, by name.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "name", rename_all = "snake_case", deny_unknown_fields)]
pub enum ControllerConfig {
    /// Pure pursuit with turns on the spot: keeps to the path and looks at nothing else.
    FollowPath(FollowerConfig),
    /// The Dynamic Window Approach: keeps away from obstacles too.
    Dwa(DwaConfig),
}

impl Default for ControllerConfig {
    fn default() -> Self {
        Self::FollowPath(FollowerConfig::DEFAULT)
    }
}

impl ControllerConfig {
    /// All controllers with their default parameters, for tables of tests and help.
    pub const ALL: &'static [Self] = &[Self::FollowPath(FollowerConfig::DEFAULT), Self::Dwa(DwaConfig::DEFAULT)];

    /// Checks the parameters.
    ///
    /// # Errors
    /// [`OutOfRange`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), OutOfRange> {
        Ranged::check_all(self.numbers())
    }

    /// The numbers with their ranges.
    pub(crate) fn numbers(&self) -> Vec<Ranged> {
        match self {
            Self::FollowPath(config) => config.numbers(),
            Self::Dwa(config) => config.numbers(),
        }
    }

    /// A controller with these parameters for a robot.
    #[must_use]
    pub fn build(&self, body: &Body) -> Box<dyn Controller> {
        match self {
            Self::FollowPath(config) => Box::new(PathFollower::new(*config, body.clone())),
            Self::Dwa(config) => Box::new(Dwa::new(*config, body)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Footprint, MotionLimits};

    #[test]
    fn the_configuration_names_are_the_controllers_names() {
        let limits =
            MotionLimits { max_linear_mps: 0.5, max_angular_rps: 2.0, max_linear_mps2: 1.0, max_angular_rps2: 4.0 };
        let body = Body { footprint: Footprint::RadiusM(0.2), limits };
        for config in ControllerConfig::ALL {
            config.validate().unwrap();
            let name = config.build(&body).name();
            assert_eq!(serde_saphyr::from_str::<ControllerConfig>(&format!("{{name: {name}}}")).unwrap(), *config);
            let unknown = serde_saphyr::from_str::<ControllerConfig>(&format!("{{name: {name}, colour: 3}}"));
            assert!(unknown.unwrap_err().to_string().contains("colour"));
        }
    }
}
