//! The parameters that may change while the node runs (dynamic_reconfigure), and what is told of
//! the effective settings on the parameter server.

use super::areas::AreaInputs;
use super::connect::Connected;
use super::operator::Operator;
use super::outputs::Outputs;
use super::settings::{ExploreNodeError, Settings};
use crate::config::{Live, LiveError, LiveParam, is_same};
use crate::explore::Explorer;
use crate::ros::bell::Bell;
use crate::ros::dynamic_reconfigure::{Offer, ParamValue, Parameter, Values, offer};
use crate::ros::tuning::{Tuned, Tuning};
use crate::ros::{Node, NodeError, ParamTree};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The parameters, offered as long as this lives. What nobody set is taken from the parameter
/// server at the end: the next run may have another preset.
pub struct LiveParams {
    shared: Arc<Shared>,
    _offer: Offer,
}

struct Shared {
    node: Node,
    bell: Arc<Bell>,
    tuning: Tuning,
    robot: Value,
    /// Tells this process from another of the same node.
    run: String,
    state: Mutex<State>,
}

struct State {
    live: Live,
    /// What the node has written on the parameter server, by name.
    written: Map<String, Value>,
    /// Of these, what was set while it ran.
    changed: BTreeSet<String>,
    /// Whether there was a change since the last look.
    is_new: bool,
}

impl LiveParams {
    /// Offers the parameters, and tells them on the parameter server.
    ///
    /// # Errors
    /// [`ExploreNodeError`] when a topic or the service cannot be offered.
    pub fn offer(node: &Node, settings: &Settings, connected: &Connected) -> Result<Self, ExploreNodeError> {
        let found = &settings.params.live;
        let live = Live { node: settings.params.live_node(), preset: settings.preset.clone() };
        let params = live.params()?;
        let told = params.iter().filter(|param| !found.given.contains_key(param.name));
        let mut written: Map<String, Value> = told.map(|param| (param.name.to_owned(), param.value.clone())).collect();
        // What another preset had is kept for it.
        written.extend(found.held.clone());
        for (name, value) in &found.held {
            node.log().info(format_args!(
                "~{name} is {value}, as it was set while the node ran; `rosparam delete {}/{name}` forgets that",
                node.name()
            ));
        }
        let shared = Arc::new(Shared {
            node: node.clone(),
            bell: Arc::clone(&connected.bell),
            tuning: connected.tuning.clone(),
            robot: serde_json::to_value(&settings.robot).unwrap_or_default(),
            run: run_name(),
            state: Mutex::new(State { live, written, changed: found.held.keys().cloned().collect(), is_new: false }),
        });
        let names: Vec<String> = shared.lock().written.keys().cloned().collect();
        shared.tell(&names);
        let parameters: Vec<Parameter> = params.iter().map(parameter).collect();
        let theirs = Arc::clone(&shared);
        let offer = offer(node, &parameters, move |asked| theirs.change(asked))?;
        Ok(Self { shared, _offer: offer })
    }

    /// As they are.
    pub fn now(&self) -> Live {
        self.shared.lock().live.clone()
    }

    /// Has a change done, where there was one since the last call: for the exploration that is
    /// under way or was last, and for what is shown.
    pub fn apply_news(
        &self,
        operator: &Operator,
        explorer: Option<&mut Explorer>,
        outputs: &Outputs,
        areas: &AreaInputs,
    ) {
        let live = {
            let mut state = self.shared.lock();
            if !std::mem::take(&mut state.is_new) {
                return;
            }
            state.live.clone()
        };
        outputs.show_markers(live.node.visualize);
        areas.show_markers(live.node.visualize);
        if let Some(Err(error)) = explorer.map(|explorer| explorer.adjust(&operator.wanted(&live.preset.explorer))) {
            self.shared.node.log().warn(format_args!("the exploration goes on with its old settings: {error}"));
        }
    }
}

impl Drop for LiveParams {
    fn drop(&mut self) {
        self.shared.forget();
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes other values, all or none; all that hold then.
    fn change(&self, asked: Values) -> Result<Values, String> {
        let asked: Vec<(String, Value)> = asked.into_iter().map(|(name, value)| (name, json_of(value))).collect();
        match self.exchange(&asked) {
            Ok((now, changes)) => {
                if !changes.is_empty() {
                    self.bell.ring();
                    self.tell(&changes);
                }
                Ok(now.iter().map(|param| (param.name.to_owned(), value_of(&param.value))).collect())
            }
            Err(error) => {
                let why = format!("~set_parameters: {error}; nothing is changed");
                self.node.log().warn(&why);
                Err(why)
            }
        }
    }

    /// All parameters after a change, and the names of those that are others now.
    fn exchange(&self, asked: &[(String, Value)]) -> Result<(Vec<LiveParam>, Vec<String>), LiveError> {
        let mut state = self.lock();
        let before = state.live.params()?;
        let live = state.live.with(asked)?;
        let now = live.params()?;
        let changes: Vec<LiveParam> = now
            .iter()
            .filter(|param| before.iter().any(|old| old.name == param.name && old.value != param.value))
            .cloned()
            .collect();
        if !changes.is_empty() {
            self.tuning.set(Tuned {
                transform_tolerance_s: live.node.transform_tolerance,
                yield_s: live.node.yield_to_others,
                clear_costmaps: live.node.clear_costmaps,
            });
            (state.live, state.is_new) = (live, true);
        }
        for param in &changes {
            self.node.log().info(format_args!("~{} is {} from now on", param.name, param.value));
            state.written.insert(param.name.to_owned(), param.value.clone());
            state.changed.insert(param.name.to_owned());
        }
        Ok((now, changes.into_iter().map(|param| param.name.to_owned()).collect()))
    }

    /// Writes parameters on the parameter server, and all effective settings.
    fn tell(&self, names: &[String]) {
        let (values, effective) = {
            let state = self.lock();
            let values: Vec<(String, Value)> =
                names.iter().filter_map(|name| Some((name.clone(), state.written.get(name)?.clone()))).collect();
            let preset = serde_json::to_value(&state.live.preset).unwrap_or_default();
            let State { written, changed, .. } = &*state;
            let (robot, run) = (&self.robot, &self.run);
            (values, json!({"preset": preset, "robot": robot, "written": written, "changed": changed, "run": run}))
        };
        let told = values.iter().try_for_each(|(name, value)| self.set(name, value));
        if let Err(error) = told.and_then(|()| self.set("effective", &effective)) {
            self.node.log().warn(format_args!("the effective settings are not on the parameter server: {error}"));
        }
    }

    /// Takes back what was told and never set, unless another process has begun to tell it.
    fn forget(&self) {
        // Whether a master is still there is nobody's business at an end.
        let Ok(tree) = self.node.private_params() else { return };
        if tree["effective"]["run"] != self.run {
            return;
        }
        let state = self.lock();
        let (kept, told): (Map<String, Value>, Map<String, Value>) =
            state.written.clone().into_iter().partition(|(name, _)| state.changed.contains(name));
        drop(state);
        if self.set("effective/written", &Value::Object(kept)).is_ok() {
            for (name, _) in told.iter().filter(|(name, value)| is_same(&tree[name.as_str()], value)) {
                let _ = self.node.delete_param(&format!("{}/{name}", self.node.name()));
            }
        }
    }

    fn set(&self, name: &str, value: &Value) -> Result<(), NodeError> {
        self.node.set_param(&format!("{}/{name}", self.node.name()), &ParamTree(value))
    }
}

/// A name that no other process has.
fn run_name() -> String {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH).unwrap_or_default();
    format!("{}-{}", std::process::id(), since.as_nanos())
}

/// A parameter as dynamic_reconfigure tells it.
fn parameter(param: &LiveParam) -> Parameter {
    let default = value_of(&param.value);
    let (min, max) = match &default {
        ParamValue::Bool(_) => (ParamValue::Bool(false), ParamValue::Bool(true)),
        ParamValue::Int(_) => (ParamValue::Int(param.least as i32), ParamValue::Int(param.most as i32)),
        ParamValue::Double(_) => (ParamValue::Double(param.least), ParamValue::Double(param.most)),
        ParamValue::Str(_) => (ParamValue::Str(String::new()), ParamValue::Str(String::new())),
    };
    let choices = param.choices.iter().map(|choice| (choice.name.clone(), choice.meaning.clone())).collect();
    Parameter { name: param.name.to_owned(), description: param.meaning.clone(), default, min, max, choices }
}

fn value_of(value: &Value) -> ParamValue {
    match value {
        Value::Bool(is) => ParamValue::Bool(*is),
        Value::Number(number) => match number.as_i64().and_then(|whole| i32::try_from(whole).ok()) {
            Some(whole) => ParamValue::Int(whole),
            None => ParamValue::Double(number.as_f64().unwrap_or(f64::NAN)),
        },
        Value::String(text) => ParamValue::Str(text.clone()),
        other => ParamValue::Str(other.to_string()),
    }
}

fn json_of(value: ParamValue) -> Value {
    match value {
        ParamValue::Bool(is) => json!(is),
        ParamValue::Int(whole) => json!(whole),
        ParamValue::Double(number) => json!(number),
        ParamValue::Str(text) => json!(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::{NodeParams, Preset};

    #[test]
    fn each_parameter_is_told_with_its_own_kind_and_within_its_range() {
        for preset in Preset::names() {
            let live = Live { node: NodeParams::default().live_node(), preset: Preset::built_in(preset).unwrap() };
            for param in live.params().unwrap() {
                let told = parameter(&param);
                assert_eq!(json_of(told.default.clone()), param.value, "{}", param.name);
                let is_within = match (&told.min, &told.default, &told.max) {
                    (ParamValue::Int(min), ParamValue::Int(now), ParamValue::Int(max)) => min <= now && now <= max,
                    (ParamValue::Double(min), ParamValue::Double(now), ParamValue::Double(max)) => {
                        min <= now && now <= max
                    }
                    (ParamValue::Bool(min), ParamValue::Bool(_), ParamValue::Bool(max)) => !min && *max,
                    (ParamValue::Str(_), ParamValue::Str(now), ParamValue::Str(_)) => {
                        told.choices.iter().any(|(name, _)| name == now)
                    }
                    _ => false,
                };
                assert!(is_within, "{told:?}");
            }
        }
    }
}
