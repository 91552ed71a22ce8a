//! The live parameters as a node finds them on the parameter server when it starts: what its user
//! gave, what was set while an earlier run went on, and what that run had merely told.

use super::live::{LiveNode, live_names, of_preset, set};
use super::names::{hint, unknown};
use super::params::{ParamError, read_params};
use super::preset::Preset;
use crate::range::{OutOfRange, Range};
use serde_json::{Map, Value};

/// The live parameters that a node finds when it starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundLive {
    /// Set by the user.
    pub given: Map<String, Value>,
    /// Set while an earlier run of the node went on.
    pub held: Map<String, Value>,
}

impl FoundLive {
    /// Takes out of a tree of parameters what the node has written there: `effective`, and the
    /// values that an earlier run told and nobody set. What was set while it ran is kept apart,
    /// and so is what the user gave by names that are no others; `is_own` says which are.
    pub fn take(tree: &mut Value, is_own: impl Fn(&str) -> bool) -> Self {
        let mut found = Self::default();
        let Some(table) = tree.as_object_mut() else { return found };
        let effective = table.remove("effective").unwrap_or_default();
        for name in live_names() {
            let Some(value) = table.get(name).cloned() else { continue };
            let told = &effective["written"][name];
            let is_changed = effective["changed"].as_array().is_some_and(|all| all.iter().any(|one| one == name));
            if !is_same(told, &value) {
                if !is_own(name) {
                    table.remove(name);
                }
                found.given.insert(name.to_owned(), value);
            } else if is_changed {
                if !LiveNode::NAMES.contains(&name) {
                    table.remove(name);
                }
                found.held.insert(name.to_owned(), value);
            } else {
                table.remove(name);
            }
        }
        found
    }

    /// Lays what was found over a preset, but for the names that are read elsewhere. What was set
    /// while another preset ran is left out where this one has no such setting.
    ///
    /// # Errors
    /// [`ParamError`] or [`OutOfRange`] with the parameter, its value and what is allowed.
    pub fn lay_over<E: From<ParamError> + From<OutOfRange>>(
        &self,
        preset: Preset,
        is_own: impl Fn(&str) -> bool,
    ) -> Result<Preset, E> {
        let wrong = |name: &str, message: String| ParamError { path: name.to_owned(), message };
        let failed = |name: &str, error: &dyn std::fmt::Display| wrong(name, error.to_string());
        let params = of_preset(&preset).map_err(|error| failed("explorer", &error))?;
        let ranges = preset.ranges();
        let mut tree = serde_json::to_value(preset).map_err(|error| failed("explorer", &error))?;
        let given = self.given.iter().filter(|(name, _)| !is_own(name)).map(|one| (one, true));
        for ((name, value), is_given) in given.chain(self.held.iter().map(|one| (one, false))) {
            let Some(param) = params.iter().find(|param| param.name == name) else {
                if is_given {
                    return Err(wrong(name, "the preset has no such setting".to_owned()).into());
                }
                continue;
            };
            let is_none = param.is_optional && value.as_f64() == Some(0.0);
            if let (Some(range), Some(number), false) = (ranges.get(&param.path), value.as_f64(), is_none) {
                let Range { least, most, words } = *range;
                OutOfRange::unless((least..=most).contains(&number), param.name, number, words)?;
            }
            set(&mut tree, &param.path, if is_none { Value::Null } else { value.clone() });
            // One at a time: an error is that of this one.
            read_params::<Preset>(tree.clone()).map_err(|error| wrong(name, error.message))?;
        }
        Ok(read_params(tree)?)
    }
}

/// What is said of a name that nobody knows, with the nearest of the live parameters where no
/// other name is near.
pub(super) fn hinted(mut error: ParamError) -> ParamError {
    let is_top_level = !error.path.contains('.');
    if let (Some((wanted, _)), true) = (unknown(&error.message), is_top_level)
        && !error.message.contains("did you mean")
    {
        error.message = format!("{}{}", error.message, hint(wanted, live_names()));
    }
    error
}

/// Whether two values are the same, however a number is written.
#[must_use]
pub fn is_same(a: &Value, b: &Value) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a == b,
        _ => a == b,
    }
}

#[cfg(test)]
mod tests {
    use super::super::NodeParams;
    use super::*;
    use serde_json::json;

    fn read(tree: Value) -> (NodeParams, Result<Preset, String>) {
        let params = NodeParams::from_tree(tree).unwrap();
        let preset = params.apply_to(Preset::built_in(params.base_preset()).unwrap());
        (params, preset.map_err(|error| error.to_string()))
    }

    #[test]
    fn what_a_user_gives_is_laid_over_the_preset() {
        let (_, preset) = read(json!({"min_size": 1, "time_limit": 90.5, "turn_at_goal": true, "tour_stay": 3.5}));
        let explorer = preset.unwrap().explorer;
        assert_eq!((explorer.detector.min_size_m, explorer.patience.time_limit_s), (1.0, Some(90.5)));
        assert!(explorer.turns.at_goal);
        let none = read(json!({"explorer": {"patience": {"time_limit_s": 20}}, "time_limit": 0})).1.unwrap();
        assert_eq!(none.explorer.patience.time_limit_s, None);
        let error = |tree: Value| read(tree).1.unwrap_err();
        assert_eq!(error(json!({"min_size": -1})), "parameter ~min_size is -1: must be finite and >= 0");
        assert!(error(json!({"min_size": "much"})).starts_with("parameter ~min_size: invalid type"));
        let foreign = json!({"config": "wfd", "tour_stay": 3.5});
        assert_eq!(error(foreign), "parameter ~tour_stay: the preset has no such setting");
    }

    #[test]
    fn what_an_earlier_run_told_binds_no_later_one_and_what_was_set_does() {
        let effective = json!({
            "preset": {"preset": "tour"},
            "written": {"min_size": 0.75, "goal_timeout": 60.0, "visualize": false, "transform_tolerance": 0.5},
            "changed": ["goal_timeout", "visualize"],
        });
        let tree = json!({
            "config": "wfd", "effective": effective, "min_size": 0.75, "goal_timeout": 60, "visualize": false,
            "transform_tolerance": 0.9,
        });
        let (params, preset) = read(tree);
        let preset = preset.unwrap();
        assert_eq!(preset.explorer.detector.min_size_m, 0.3, "the preset's own");
        assert_eq!(preset.explorer.patience.goal_timeout_s, 60.0);
        assert_eq!((params.visualize, params.transform_tolerance), (false, 0.9));
        assert_eq!(params.live.held.keys().collect::<Vec<_>>(), ["goal_timeout", "visualize"]);
        assert_eq!(params.live.given.keys().collect::<Vec<_>>(), ["transform_tolerance"]);
    }

    #[test]
    fn a_misspelt_name_is_answered_with_the_nearest() {
        let error = |tree: Value| NodeParams::from_tree(tree).unwrap_err().to_string();
        assert!(error(json!({"min_siz": 1})).ends_with("(did you mean min_size?)"));
        assert!(error(json!({"base_frme": "x"})).ends_with("(did you mean base_frame?)"));
    }

    #[test]
    fn weights_that_were_set_live_choose_no_preset() {
        let held = json!({"written": {"potential_scale": 2.0}, "changed": ["potential_scale"]});
        let weights = json!({"selection": {"name": "explore_lite"}});
        let (params, preset) = read(json!({"effective": held, "potential_scale": 2.0, "explorer": weights}));
        assert_eq!(params.base_preset(), Preset::DEFAULT);
        let selection = serde_json::to_value(preset.unwrap().explorer.selection).unwrap();
        assert_eq!(selection["potential_scale"], 2.0);
        // Under another strategy they mean nothing.
        let (_, preset) = read(json!({"effective": held, "potential_scale": 2.0}));
        assert_eq!(preset.unwrap(), Preset::built_in(Preset::DEFAULT).unwrap());
    }
}
