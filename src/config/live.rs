//! The parameters of `explore_node` that may change while it runs: their flat names, which setting
//! of the preset each stands for, and what is allowed.

use super::explained::{ExplainError, Explained};
use super::names::hint;
use super::params::{ParamError, read_params};
use super::preset::{Preset, PresetError};
use super::setting::{Choice, Setting};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A live parameter of the preset: its name, its setting, and the bounds of a slider for it. A
/// value of 0 stands for null where the setting may be null.
type Row = (&'static str, &'static str, f64, f64);

/// A week, seconds.
const WEEK_S: f64 = 604_800.0;

const SETTINGS: &[Row] = &[
    ("min_size", "explorer.detector.min_size_m", 0.0, 10.0),
    ("search_radius", "explorer.goal.search_radius_m", 0.1, 10.0),
    ("reconsider_period", "explorer.goal.reconsider_period_s", 0.0, 60.0),
    ("commit_radius", "explorer.goal.commit_radius_m", 0.0, 20.0),
    ("beside_way", "explorer.goal.beside_way_m", 0.0, 20.0),
    ("turn_at_goal", "explorer.turns.at_goal", 0.0, 1.0),
    ("recoveries", "explorer.turns.recoveries", 0.0, 20.0),
    ("max_failures", "explorer.taboo.max_failures", 1.0, 100.0),
    ("max_visits", "explorer.taboo.max_visits", 1.0, 100.0),
    ("progress_timeout", "explorer.patience.progress_timeout_s", 0.5, 3600.0),
    ("progress_distance", "explorer.patience.progress_distance_m", 0.01, 10.0),
    ("goal_timeout", "explorer.patience.goal_timeout_s", 1.0, WEEK_S),
    ("stall_timeout", "explorer.patience.stall_s", 0.5, 3600.0),
    ("settle_time", "explorer.patience.settle_s", 0.0, 60.0),
    ("failing_timeout", "explorer.patience.failing_s", 0.0, WEEK_S),
    ("no_news_timeout", "explorer.patience.no_news_s", 1.0, WEEK_S),
    ("time_limit", "explorer.patience.time_limit_s", 0.0, WEEK_S),
    ("good_enough_share", "explorer.finish.good_enough_share", 0.0, 1.0),
    ("explore_what_the_audit_sees", "explorer.finish.explore_what_the_audit_sees", 0.0, 1.0),
    ("return_to_start", "explorer.return_to_start", 0.0, 1.0),
    ("nearest_by", "explorer.selection.distance", 0.0, 0.0),
    ("size_weight", "explorer.selection.size_weight", 0.0, 1000.0),
    ("distance_weight", "explorer.selection.distance_weight", 0.0, 1000.0),
    ("potential_scale", "explorer.selection.potential_scale", 0.0, 1000.0),
    ("orientation_scale", "explorer.selection.orientation_scale", 0.0, 1000.0),
    ("gain_scale", "explorer.selection.gain_scale", 0.0, 1000.0),
    ("gain_decay", "explorer.selection.lambda_per_m", 0.0, 10.0),
    ("tour_turn_cost", "explorer.selection.turn_m_per_rad", 0.0, 100.0),
    ("tour_stay", "explorer.selection.stay_m", 0.0, 100.0),
];

/// Those of the node itself, each with its meaning.
const NODE: &[(&str, &str, f64, f64)] = &[
    ("transform_tolerance", "How old the robot's transform may be, seconds.", 0.01, 60.0),
    ("yield_to_others", "How long goals of others are left to their end, seconds.", 0.0, WEEK_S),
    ("clear_costmaps", "Ask move_base to clear its costmaps when a goal failed.", 0.0, 1.0),
    ("visualize", "Publish markers for RViz.", 0.0, 1.0),
    ("exit_when_done", "Leave when the exploration that is under way, or else the next one, has ended.", 0.0, 1.0),
];

/// The names of all live parameters, also of those that only some presets have.
pub fn live_names() -> impl Iterator<Item = &'static str> {
    SETTINGS.iter().chain(NODE).map(|row| row.0)
}

/// A change that is refused.
#[derive(Debug, thiserror::Error)]
pub enum LiveError {
    /// No parameter has this name, with this preset.
    #[error("{name} is no parameter that can change while the node runs: must be one of {valid}{hint}")]
    Unknown {
        /// As given.
        name: String,
        /// The valid names.
        valid: String,
        /// The nearest of them, if one is near.
        hint: String,
    },
    /// A value that cannot be.
    #[error("{name} is {value}: must be {allowed}")]
    Refused {
        /// The parameter.
        name: String,
        /// As given.
        value: Value,
        /// What is allowed.
        allowed: String,
    },
    /// The values contradict each other.
    #[error(transparent)]
    Preset(#[from] PresetError),
    /// The values are no settings.
    #[error(transparent)]
    Params(#[from] ParamError),
    /// What is known of the settings cannot be had.
    #[error(transparent)]
    Explain(#[from] ExplainError),
}

/// A live parameter as it is now. Its value is a boolean, an integer, a number or a text.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveParam {
    /// Its name, an identifier.
    pub name: &'static str,
    /// What it means, with its unit.
    pub meaning: String,
    /// As it is.
    pub value: Value,
    /// The smallest number that is taken.
    pub least: f64,
    /// The largest one.
    pub most: f64,
    /// The names to choose from, where it is a choice.
    pub choices: Vec<Choice>,
    /// Where its setting stands.
    pub(super) path: String,
    /// Whether 0 stands for null.
    pub(super) is_optional: bool,
}

impl LiveParam {
    fn of_setting(row: &Row, setting: &Setting) -> Self {
        let &(name, path, least, most) = row;
        let is_optional = setting.allowed.ends_with("or null");
        let value = if setting.value.is_null() { json!(0.0) } else { setting.value.clone() };
        let none = if is_optional { " 0 stands for null." } else { "" };
        let most = value.as_f64().map_or(most, |now| most.max(now));
        Self {
            name,
            meaning: format!("{}{none}", setting.meaning),
            least: value.as_f64().map_or(least, |now| least.min(now)),
            most,
            value,
            choices: setting.choices.clone(),
            path: path.to_owned(),
            is_optional,
        }
    }

    /// What may be given, in words.
    #[must_use]
    pub fn allowed(&self) -> String {
        match &self.value {
            Value::Bool(_) => "true or false".to_owned(),
            Value::String(_) => {
                format!("one of {}", self.choices.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", "))
            }
            value if value.is_f64() => format!("a number within {} to {}", self.least, self.most),
            _ => format!("whole and within {} to {}", self.least, self.most),
        }
    }

    /// The value as the settings have it.
    fn checked(&self, value: &Value) -> Result<Value, LiveError> {
        let is_within = |number: f64| (self.least..=self.most).contains(&number);
        let is_allowed = match (&self.value, value) {
            (Value::Bool(_), Value::Bool(_)) => true,
            (Value::String(_), Value::String(text)) => self.choices.iter().any(|choice| choice.name == *text),
            (now, Value::Number(number)) if now.is_f64() => number.as_f64().is_some_and(is_within),
            (Value::Number(_), Value::Number(number)) => number.as_i64().is_some_and(|number| is_within(number as f64)),
            _ => false,
        };
        if !is_allowed {
            let (name, allowed) = (self.name.to_owned(), self.allowed());
            return Err(LiveError::Refused { name, value: value.clone(), allowed });
        }
        Ok(if self.is_optional && value.as_f64() == Some(0.0) { Value::Null } else { value.clone() })
    }
}

/// What of the node itself may change.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LiveNode {
    /// How old the robot's transform may be, seconds.
    pub transform_tolerance: f64,
    /// How long goals of others are left to their end, seconds.
    pub yield_to_others: f64,
    /// Ask the server to clear its costmaps when a goal failed.
    pub clear_costmaps: bool,
    /// Publish markers for RViz.
    pub visualize: bool,
    /// Leave when the exploration has ended.
    pub exit_when_done: bool,
}

impl LiveNode {
    /// The names of all of them.
    pub const NAMES: [&str; 5] =
        ["transform_tolerance", "yield_to_others", "clear_costmaps", "visualize", "exit_when_done"];
}

/// Everything that may change while the node runs, as it is now.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Live {
    /// The node's own.
    pub node: LiveNode,
    /// The preset, of which a part may change.
    #[serde(flatten)]
    pub preset: Preset,
}

impl Live {
    /// The parameters that there are with this preset, in a fixed order.
    ///
    /// # Errors
    /// [`LiveError::Explain`] when the preset cannot be explained.
    pub fn params(&self) -> Result<Vec<LiveParam>, LiveError> {
        let mut found = of_preset(&self.preset)?;
        let node = serde_json::to_value(self.node).map_err(ExplainError::from)?;
        found.extend(NODE.iter().map(|&(name, meaning, least, most)| {
            let value = node[name].clone();
            let now = value.as_f64();
            LiveParam {
                name,
                meaning: meaning.to_owned(),
                least: now.map_or(least, |now| least.min(now)),
                most: now.map_or(most, |now| most.max(now)),
                value,
                choices: Vec::new(),
                path: format!("node.{name}"),
                is_optional: false,
            }
        }));
        Ok(found)
    }

    /// The same with other values; nothing is changed where one of them cannot be.
    ///
    /// # Errors
    /// [`LiveError`] that names the parameter, its value and what is allowed.
    pub fn with(&self, changes: &[(String, Value)]) -> Result<Self, LiveError> {
        let params = self.params()?;
        let mut tree = serde_json::to_value(self).map_err(ExplainError::from)?;
        for (name, value) in changes {
            let param = params.iter().find(|param| param.name == name).ok_or_else(|| {
                let names = || params.iter().map(|param| param.name);
                let valid = names().collect::<Vec<_>>().join(", ");
                LiveError::Unknown { name: name.clone(), valid, hint: hint(name, names()) }
            })?;
            set(&mut tree, &param.path, param.checked(value)?);
        }
        let changed = Self { node: read_params(tree["node"].take())?, preset: preset_of(tree)? };
        changed.preset.validate()?;
        Ok(changed)
    }
}

/// The live parameters of a preset.
pub(super) fn of_preset(preset: &Preset) -> Result<Vec<LiveParam>, ExplainError> {
    let explained = Explained::preset(preset)?;
    let settings: BTreeMap<&str, &Setting> = explained.settings().map(|s| (s.path.as_str(), s)).collect();
    let param = |row: &Row| Some(LiveParam::of_setting(row, settings.get(row.1)?));
    Ok(SETTINGS.iter().filter_map(param).collect())
}

fn preset_of(mut tree: Value) -> Result<Preset, ParamError> {
    if let Value::Object(table) = &mut tree {
        table.remove("node");
    }
    read_params(tree)
}

/// Sets what stands at a path that is there.
pub(super) fn set(tree: &mut Value, path: &str, value: Value) {
    if let Some(place) = tree.pointer_mut(&format!("/{}", path.replace('.', "/"))) {
        *place = value;
    }
}

#[cfg(test)]
#[path = "live_tests.rs"]
mod tests;
