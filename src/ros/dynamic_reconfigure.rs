//! dynamic_reconfigure's server: parameters that `dynparam` and rqt_reconfigure list and set.
//!
//! A service takes some values and answers with all; a latched topic describes the parameters, and
//! another tells the values at each change. The protocol knows no refusal but a failed call.

use super::msg::dynamic_reconfigure::{
    BoolParameter, Config, ConfigDescription, DoubleParameter, Group, GroupState, IntParameter, ParamDescription,
    Reconfigure, ReconfigureReq, ReconfigureRes, StrParameter,
};
use super::node::{Node, NodeError};
use rosrust::{Publisher, Service};
use std::sync::{Arc, Mutex, PoisonError};

/// The name of the one group, which holds all parameters.
const GROUP: &str = "Default";

/// A value of one of the four kinds.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// `bool`.
    Bool(bool),
    /// `int`.
    Int(i32),
    /// `double`.
    Double(f64),
    /// `str`.
    Str(String),
}

impl ParamValue {
    const fn kind(&self) -> &'static str {
        match self {
            Self::Bool(_) => "bool",
            Self::Int(_) => "int",
            Self::Double(_) => "double",
            Self::Str(_) => "str",
        }
    }
}

/// A parameter as tools are told of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, an identifier.
    pub name: String,
    /// What it means.
    pub description: String,
    /// As it was at the start.
    pub default: ParamValue,
    /// The smallest value.
    pub min: ParamValue,
    /// The largest value.
    pub max: ParamValue,
    /// The values to choose from, each with its meaning; empty where all in the range will do.
    pub choices: Vec<(String, String)>,
}

/// Named values, in their order.
pub type Values = Vec<(String, ParamValue)>;

/// The description of all parameters.
#[must_use]
pub fn description(parameters: &[Parameter]) -> ConfigDescription {
    let of = |value: fn(&Parameter) -> &ParamValue| {
        config(&parameters.iter().map(|p| (p.name.clone(), value(p).clone())).collect::<Values>())
    };
    let described = |p: &Parameter| ParamDescription {
        name: p.name.clone(),
        type_: p.default.kind().to_owned(),
        level: 0,
        description: p.description.clone(),
        edit_method: edit_method(&p.choices),
    };
    let group = Group {
        name: GROUP.to_owned(),
        type_: String::new(),
        parameters: parameters.iter().map(described).collect(),
        parent: 0,
        id: 0,
    };
    ConfigDescription { groups: vec![group], max: of(|p| &p.max), min: of(|p| &p.min), dflt: of(|p| &p.default) }
}

/// The choices as the tools read them: the text of a Python dictionary.
fn edit_method(choices: &[(String, String)]) -> String {
    if choices.is_empty() {
        return String::new();
    }
    let quoted = |text: &str| format!("'{}'", text.replace('\\', "\\\\").replace('\'', "\\'").replace('\n', " "));
    let constant = |(name, meaning): &(String, String)| {
        let (name, meaning) = (quoted(name), quoted(meaning));
        format!(
            "{{'name': {name}, 'value': {name}, 'type': 'str', 'description': {meaning}, 'srcline': 0, 'srcfile': \
             '', 'ctype': 'std::string', 'cconsttype': 'const char * const'}}"
        )
    };
    let all = choices.iter().map(constant).collect::<Vec<_>>().join(", ");
    format!("{{'enum_description': '', 'enum': [{all}]}}")
}

/// Values as a message.
#[must_use]
pub fn config(values: &[(String, ParamValue)]) -> Config {
    let state = GroupState { name: GROUP.to_owned(), state: true, id: 0, parent: 0 };
    let mut message = Config { groups: vec![state], ..Config::default() };
    for (name, value) in values {
        let name = name.clone();
        match value.clone() {
            ParamValue::Bool(value) => message.bools.push(BoolParameter { name, value }),
            ParamValue::Int(value) => message.ints.push(IntParameter { name, value }),
            ParamValue::Double(value) => message.doubles.push(DoubleParameter { name, value }),
            ParamValue::Str(value) => message.strs.push(StrParameter { name, value }),
        }
    }
    message
}

/// The values of a message.
#[must_use]
pub fn values(message: &Config) -> Values {
    let bools = message.bools.iter().map(|p| (p.name.clone(), ParamValue::Bool(p.value)));
    let ints = message.ints.iter().map(|p| (p.name.clone(), ParamValue::Int(p.value)));
    let doubles = message.doubles.iter().map(|p| (p.name.clone(), ParamValue::Double(p.value)));
    let strs = message.strs.iter().map(|p| (p.name.clone(), ParamValue::Str(p.value.clone())));
    bools.chain(ints).chain(doubles).chain(strs).collect()
}

/// Offers parameters as long as the service lives. `change` takes the values that are asked for
/// and returns all that hold now, or why nothing was changed; it is called for one request at a
/// time.
///
/// # Errors
/// [`NodeError::Offer`] when the topics or the service cannot be offered.
pub fn offer(
    node: &Node,
    parameters: &[Parameter],
    change: impl Fn(Values) -> Result<Values, String> + Send + Sync + 'static,
) -> Result<Offer, NodeError> {
    let descriptions = node.publish_latched("~parameter_descriptions")?;
    let updates = node.publish_latched("~parameter_updates")?;
    // Nobody who listens is no error of ours.
    let _ = descriptions.send(description(parameters));
    let now: Values = parameters.iter().map(|p| (p.name.clone(), p.default.clone())).collect();
    let _ = updates.send(config(&now));
    let told = Arc::new(Told { _descriptions: descriptions, updates, change: Mutex::new(Box::new(change)) });
    // rosrust keeps the handler of a service that is withdrawn: it must hold neither topics nor node.
    let theirs = Arc::downgrade(&told);
    let service = node.serve::<Reconfigure>("~set_parameters", move |request: ReconfigureReq| {
        let told = theirs.upgrade().ok_or("the node is leaving")?;
        let change = told.change.lock().unwrap_or_else(PoisonError::into_inner);
        let now = config(&change(values(&request.config))?);
        let _ = told.updates.send(now.clone());
        Ok(ReconfigureRes { config: now })
    })?;
    Ok(Offer { _service: service, _told: told })
}

/// Takes values, all or none, and tells all that hold then.
type Change = Box<dyn Fn(Values) -> Result<Values, String> + Send + Sync>;

/// What is told as long as the parameters are offered.
struct Told {
    _descriptions: Publisher<ConfigDescription>,
    updates: Publisher<Config>,
    /// One change at a time.
    change: Mutex<Change>,
}

/// The parameters, offered as long as this lives.
pub struct Offer {
    _service: Service,
    _told: Arc<Told>,
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters() -> Vec<Parameter> {
        let parameter = |name: &str, default, min, max, choices: &[(&str, &str)]| Parameter {
            name: name.to_owned(),
            description: format!("what {name} means"),
            default,
            min,
            max,
            choices: choices.iter().map(|(a, b)| ((*a).to_owned(), (*b).to_owned())).collect(),
        };
        use ParamValue::{Bool, Double, Int, Str};
        let text = |text: &str| Str(text.to_owned());
        vec![
            parameter("on", Bool(true), Bool(false), Bool(true), &[]),
            parameter("count", Int(3), Int(1), Int(9), &[]),
            parameter("size", Double(0.5), Double(0.0), Double(2.0), &[]),
            parameter("by", text("path"), text(""), text(""), &[("air", "it's straight"), ("path", "by \\ way")]),
        ]
    }

    #[test]
    fn values_come_back_as_they_were_sent() {
        let sent: Values = parameters().into_iter().map(|p| (p.name, p.default)).collect();
        let message = config(&sent);
        assert_eq!(values(&message), sent);
        assert_eq!((message.groups[0].name.as_str(), message.groups[0].state), ("Default", true));
        assert_eq!(values(&Config::default()), []);
    }

    #[test]
    fn each_parameter_is_described_with_its_kind_and_range() {
        let told = description(&parameters());
        let group = &told.groups[0];
        let kinds: Vec<(&str, &str)> = group.parameters.iter().map(|p| (p.name.as_str(), p.type_.as_str())).collect();
        assert_eq!(kinds, [("on", "bool"), ("count", "int"), ("size", "double"), ("by", "str")]);
        assert_eq!(group.parameters[1].description, "what count means");
        assert_eq!((told.min.ints[0].value, told.max.ints[0].value, told.dflt.ints[0].value), (1, 9, 3));
        assert_eq!((told.min.doubles[0].value, told.max.doubles[0].value), (0.0, 2.0));
        assert_eq!(told.dflt.strs[0].value, "path");
    }

    #[test]
    fn choices_are_a_python_dictionary() {
        let told = description(&parameters());
        let methods: Vec<&str> = told.groups[0].parameters.iter().map(|p| p.edit_method.as_str()).collect();
        assert_eq!(methods[..3], ["", "", ""]);
        assert!(methods[3].starts_with("{'enum_description': '', 'enum': [{'name': 'air', 'value': 'air',"));
        assert!(methods[3].contains("'description': 'it\\'s straight'"), "{}", methods[3]);
        assert!(methods[3].contains("'description': 'by \\\\ way'"), "{}", methods[3]);
    }
}
