//! What is known of each setting of a configuration file: its meaning, its default and what is
//! allowed, from the doc comments, the types and the ranges that validation checks.

use crate::range::Range;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// One of the values that a setting can have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Choice {
    /// As a file has it.
    pub name: String,
    /// What it stands for.
    pub meaning: String,
}

/// A setting, or a table of settings.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Where it stands in its file, with dots between the levels.
    pub path: String,
    /// What it means, with its unit, in whole sentences.
    pub meaning: String,
    /// As configured.
    pub value: Value,
    /// What it is where a file leaves it out; `None` where a file must have it.
    pub default: Option<Value>,
    /// What may be given, in words.
    pub allowed: String,
    /// The range that validation checks, where it is a number that has one.
    pub range: Option<Range>,
    /// The names to choose from, where it is a choice.
    pub choices: Vec<Choice>,
}

impl Setting {
    /// Whether it is a table of settings.
    #[must_use]
    pub fn is_table(&self) -> bool {
        self.value.is_object()
    }

    /// The first sentence of its meaning, and what is allowed.
    #[must_use]
    pub fn summary(&self) -> String {
        let is_end = |at: &usize| self.meaning[at + 2..].starts_with(char::is_uppercase);
        let end = self.meaning.match_indices(". ").map(|(at, _)| at).find(is_end);
        let sentence = self.meaning[..end.unwrap_or(self.meaning.len())].trim_end_matches('.');
        if self.is_table() { sentence.to_owned() } else { format!("{sentence} [{}]", self.allowed) }
    }
}

/// The settings in a table, and in the tables in it, by their paths.
pub(super) struct Settings<'a> {
    /// The ranges of numbers, by path.
    pub ranges: &'a BTreeMap<String, Range>,
    /// What was found.
    pub found: BTreeMap<String, Setting>,
}

impl Settings<'_> {
    /// Adds those of the table at `path`, which a JSON schema describes.
    pub fn add(&mut self, schema: &Value, table: &Map<String, Value>, path: &str) {
        let alternatives = alternatives(schema);
        let schema = alternatives.iter().find(|one| describes(one, table)).unwrap_or(schema);
        for (key, value) in table {
            let path = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
            let property = &schema["properties"][key];
            // The name of an alternative is explained by what is said of the alternative.
            let explained = if property["description"].is_string() { property } else { schema };
            let choices = if property["const"].is_string() {
                alternatives.iter().map(|one| choice(&one["properties"][key]["const"], one)).collect()
            } else {
                choices(property)
            };
            let setting = Setting {
                path: path.clone(),
                meaning: description(explained),
                value: value.clone(),
                default: property.get("default").cloned(),
                allowed: allowed(property, &choices, self.ranges.get(&path)),
                range: self.ranges.get(&path).copied(),
                choices,
            };
            self.found.insert(path.clone(), setting);
            if let Value::Object(table) = value {
                self.add(property, table, &path);
            }
        }
    }
}

/// The alternatives of a schema, if it has some.
fn alternatives(schema: &Value) -> &[Value] {
    schema["oneOf"].as_array().map_or(&[], Vec::as_slice)
}

/// Whether an alternative has all keys of a table, and its own name.
fn describes(schema: &Value, table: &Map<String, Value>) -> bool {
    let properties = &schema["properties"];
    table.iter().all(|(key, value)| properties.get(key).is_some_and(|p| p.get("const").is_none_or(|c| c == value)))
}

/// The values that a schema lists.
fn choices(schema: &Value) -> Vec<Choice> {
    let plain = schema["enum"].as_array().into_iter().flatten().map(|value| choice(value, &Value::Null));
    let told = alternatives(schema).iter().filter(|one| !one["const"].is_null());
    plain.chain(told.map(|one| choice(&one["const"], one))).collect()
}

fn choice(value: &Value, schema: &Value) -> Choice {
    let name = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    Choice { name, meaning: description(schema) }
}

/// A doc comment in one line.
fn description(schema: &Value) -> String {
    schema["description"].as_str().unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What a schema and a range allow, in words.
fn allowed(schema: &Value, choices: &[Choice], range: Option<&Range>) -> String {
    // One type, or a list of them.
    let types = || schema["type"].as_array().into_iter().flatten().chain(schema.get("type"));
    let words = match (range, types().find_map(Value::as_str)) {
        (Some(range), Some("integer")) => format!("whole, {}", range.words),
        (Some(range), _) => range.words.to_owned(),
        _ if !choices.is_empty() => choices.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", "),
        (_, Some("boolean")) => "true or false".to_owned(),
        (_, Some("string")) => "text".to_owned(),
        (_, Some("array")) => "a list".to_owned(),
        (_, Some("integer")) => {
            let least = &schema["minimum"];
            schema.get("maximum").map_or_else(|| format!("whole, >= {least}"), |most| format!("{least} to {most}"))
        }
        _ => String::new(),
    };
    if types().any(|kind| kind == "null") { format!("{words}, or null") } else { words }
}
