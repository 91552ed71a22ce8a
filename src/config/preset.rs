//! Presets: one YAML file for each document that is implemented, in `configs/`.

use super::names::{hint, one_line};
use crate::control::ControllerConfig;
use crate::explore::{ExplorerSettings, SettingsError};
use crate::geometry::Body;
use crate::grid::Thresholds;
use crate::navigation::{Navigator, NavigatorConfig};
use crate::range::{OutOfRange, Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// A preset that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PresetError {
    /// The YAML is not a preset.
    #[error("{0}")]
    Syntax(String),
    /// A setting of the explorer that cannot be.
    #[error("explorer.{0}")]
    Explorer(#[from] SettingsError),
    /// A setting of the navigation that cannot be.
    #[error("navigation.{0}")]
    Navigation(#[from] OutOfRange),
    /// A name that no built-in preset has.
    #[error("there is no preset {name:?}: must be one of {valid}{hint}")]
    Unknown {
        /// As given.
        name: String,
        /// The valid names.
        valid: String,
        /// The nearest of them, if one is near.
        hint: String,
    },
}

/// How an exploration is done: what the explorer decides and how goals are driven to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Preset {
    /// What reports call the preset.
    pub preset: String,
    /// What the explorer decides, and how.
    pub explorer: ExplorerSettings,
    /// How goals are driven to.
    pub navigation: NavigationSettings,
}

/// Who drives to a goal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// The stack's move_base, or what serves its action.
    #[default]
    MoveBase,
    /// Our own planner and controller, with velocity commands.
    Internal,
}

/// How goals are driven to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NavigationSettings {
    /// Who drives a robot behind ROS; the simulator always drives by itself.
    pub drive: Drive,
    /// Tolerances and patience of our own navigation.
    pub navigator: NavigatorConfig,
    /// How paths become velocity commands in our own navigation.
    pub controller: ControllerConfig,
}

/// The presets in the binary, by name, as in `configs/`.
const BUILT_IN: &[(&str, &str)] = &[
    ("wfd", include_str!("../../configs/wfd.yaml")),
    ("wfd_360", include_str!("../../configs/wfd_360.yaml")),
    ("yamauchi", include_str!("../../configs/yamauchi.yaml")),
    ("liang", include_str!("../../configs/liang.yaml")),
    ("liang_closest", include_str!("../../configs/liang_closest.yaml")),
    ("liang_max_gain", include_str!("../../configs/liang_max_gain.yaml")),
    ("alghfeli", include_str!("../../configs/alghfeli.yaml")),
    ("northwestern", include_str!("../../configs/northwestern.yaml")),
    ("explore_lite", include_str!("../../configs/explore_lite.yaml")),
    ("mrtsp", include_str!("../../configs/mrtsp.yaml")),
    ("nearest_by_way", include_str!("../../configs/nearest_by_way.yaml")),
    ("gain_decay", include_str!("../../configs/gain_decay.yaml")),
    ("tour", include_str!("../../configs/tour.yaml")),
];

impl Preset {
    /// The preset where none is named.
    pub const DEFAULT: &'static str = "tour";

    /// The names of the built-in presets.
    pub fn names() -> impl Iterator<Item = &'static str> {
        BUILT_IN.iter().map(|(name, _)| *name)
    }

    /// A built-in preset.
    ///
    /// # Errors
    /// [`PresetError::Unknown`] with the valid names.
    pub fn built_in(name: &str) -> Result<Self, PresetError> {
        let known = BUILT_IN.iter().find(|(known, _)| *known == name);
        let unknown = || {
            let valid = Self::names().collect::<Vec<_>>().join(", ");
            PresetError::Unknown { name: name.to_owned(), valid, hint: hint(name, Self::names()) }
        };
        let (name, text) = known.ok_or_else(unknown)?;
        Self::from_yaml(text, name)
    }

    /// Reads and validates the text of a preset; `name` serves where it has none.
    ///
    /// # Errors
    /// [`PresetError`] that names the key, the value and what is allowed.
    pub fn from_yaml(text: &str, name: &str) -> Result<Self, PresetError> {
        let mut preset: Self =
            serde_saphyr::from_str(text).map_err(|e| PresetError::Syntax(one_line(&e.to_string())))?;
        if preset.preset.is_empty() {
            name.clone_into(&mut preset.preset);
        }
        preset.validate()?;
        Ok(preset)
    }

    /// Checks every number.
    ///
    /// # Errors
    /// [`PresetError`] that names the key, the value and what is allowed.
    pub fn validate(&self) -> Result<(), PresetError> {
        self.explorer.validate()?;
        Ok(Ranged::check_all(self.navigation.numbers())?)
    }

    /// The ranges of all numbers, by their paths.
    pub(super) fn ranges(&self) -> BTreeMap<String, Range> {
        let explorer = &self.explorer;
        let (free_max, occupied_min) =
            (f64::from(explorer.thresholds.free_max), f64::from(explorer.thresholds.occupied_min));
        // These two are checked together, by `Thresholds::validate`.
        let thresholds = [
            Range::within(0.0, occupied_min - 1.0, Thresholds::ALLOWED).of("thresholds.free_max", free_max),
            Range::within(free_max + 1.0, 100.0, Thresholds::ALLOWED).of("thresholds.occupied_min", occupied_min),
        ];
        let explorer = explorer.numbers().into_iter().chain(explorer.detector_params().numbers()).chain(thresholds);
        let navigation = self.navigation.numbers().into_iter().map(|n| (format!("navigation.{}", n.key), n.range));
        explorer.map(|n| (format!("explorer.{}", n.key), n.range)).chain(navigation).collect()
    }

    /// What drives a body to goals with our own planner and controller.
    #[must_use]
    pub fn navigator(&self, body: &Body) -> Navigator {
        let NavigationSettings { navigator, controller, .. } = self.navigation;
        let mut navigator = Navigator::new(navigator, self.explorer.planner.build(body), controller.build(body), body);
        navigator.set_areas(self.explorer.areas());
        navigator
    }
}

impl NavigationSettings {
    /// The numbers with their ranges.
    fn numbers(&self) -> Vec<Ranged> {
        let navigator = &self.navigator;
        let positive = [
            ("navigator.control_period_s", navigator.control_period_s),
            ("navigator.xy_goal_tolerance_m", navigator.xy_goal_tolerance_m),
            ("navigator.yaw_goal_tolerance_rad", navigator.yaw_goal_tolerance_rad),
            ("navigator.replan_period_s", navigator.replan_period_s),
            ("navigator.planner_patience_s", navigator.planner_patience_s),
            ("navigator.controller_patience_s", navigator.controller_patience_s),
            ("navigator.turn_speed_rps", navigator.turn_speed_rps),
        ];
        let positive = positive.map(|(key, value)| Range::POSITIVE.of(key, value));
        positive.into_iter().chain(self.controller.numbers()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_preset_loads_under_its_own_name() {
        for name in Preset::names() {
            assert_eq!(Preset::built_in(name).unwrap().preset, name);
        }
    }

    #[test]
    fn every_preset_file_is_built_in() {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/configs");
        let mut files: Vec<String> = std::fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .filter(|path| path.extension().is_some_and(|e| e == "yaml") && !path.ends_with("worlds.yaml"))
            .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
            .collect();
        files.sort();
        let mut names: Vec<&str> = Preset::names().collect();
        names.sort_unstable();
        assert_eq!(files, names);
    }

    #[test]
    fn mistakes_are_named() {
        let error = |yaml: &str| Preset::from_yaml(yaml, "test").unwrap_err().to_string();
        assert!(error("explorer: {detecter: {}}").contains("detecter"), "{}", error("explorer: {detecter: {}}"));
        let wrong = error("explorer: {detector: {name: wavefrunt}}");
        assert!(wrong.contains("wavefrunt") && wrong.contains("wavefront"), "{wrong}");
        let unknown = error("explorer: {detector: {name: wavefront, min_size: 3}}");
        assert!(unknown.contains("min_size"), "{unknown}");
        let negative = error("explorer: {detector: {min_size_m: -1}}");
        assert_eq!(negative, "explorer.detector.min_size_m is -1: must be finite and >= 0");
        let nested = error("explorer: {detector: {name: dbscan, dbscan: {eps: 3}}}");
        assert!(nested.contains("eps") && nested.contains("eps_cells"), "{nested}");
        let eps = error("explorer: {detector: {dbscan: {eps_cells: 0}}}");
        assert_eq!(eps, "explorer.detector.dbscan.eps_cells is 0: must be within 1 to 100 cells");
        let element = error("explorer: {detector: {image: {element_m: -0.1}}}");
        assert_eq!(element, "explorer.detector.image.element_m is -0.1: must be within 0 to 5 m");
        let edges = error("explorer: {detector: {canny: {low_threshold: 50, high_threshold: 40}}}");
        assert_eq!(edges, "explorer.detector.canny.high_threshold is 40: must be finite and >= low_threshold");
        let neighbours = error("explorer: {detector: {neighbours: 6}}");
        assert!(neighbours.contains("must be 4 or 8"), "{neighbours}");
        let zero = error("navigation: {navigator: {control_period_s: 0}}");
        assert_eq!(zero, "navigation.navigator.control_period_s is 0: must be finite and > 0");
        let window = error("navigation: {controller: {name: dwa, horizon_s: -1}}");
        assert_eq!(window, "navigation.controller.horizon_s is -1: must be finite and > 0");
        let hybrid = error("explorer: {planner: {name: hybrid_astar, primitive_s: 0}}");
        assert_eq!(hybrid, "explorer.planner.primitive_s is 0: must be finite and > 0");
        let name = Preset::built_in("wdf").unwrap_err().to_string();
        assert!(name.starts_with("there is no preset \"wdf\": must be one of wfd"), "{name}");
    }
}
