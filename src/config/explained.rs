//! Configurations as YAML in which each setting is explained.

use super::setting::{Setting, Settings};
use super::{Preset, RobotConfig};
use crate::range::Range;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// A configuration that cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum ExplainError {
    /// As YAML.
    #[error("cannot write the configuration as YAML: {0}")]
    Yaml(#[from] serde_saphyr::ser::Error),
    /// As a tree.
    #[error("cannot read the configuration's settings: {0}")]
    Tree(#[from] serde_json::Error),
}

/// A whole configuration, defaults included, with what is known of each setting.
#[derive(Clone, Debug)]
pub struct Explained {
    /// The lines of its YAML, with the setting that begins there.
    lines: Vec<(String, Option<Setting>)>,
}

impl Explained {
    /// Explains a preset.
    ///
    /// ```
    /// use frontier_explorer::config::{Explained, Preset};
    ///
    /// let explained = Explained::preset(&Preset::built_in("yamauchi")?)?;
    /// let room = explained.settings().find(|s| s.path == "explorer.planner.max_cost").unwrap();
    /// assert_eq!((room.value.as_i64(), room.allowed.as_str()), (Some(160), "0 to 255"));
    /// assert_eq!(Preset::from_yaml(&explained.yaml(), "")?, Preset::built_in("yamauchi")?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`ExplainError`] when the preset cannot be written.
    pub fn preset(preset: &Preset) -> Result<Self, ExplainError> {
        Self::new(preset, &preset.ranges())
    }

    /// Explains a robot.
    ///
    /// # Errors
    /// [`ExplainError`] when the robot cannot be written.
    pub fn robot(robot: &RobotConfig) -> Result<Self, ExplainError> {
        Self::new(robot, &robot.ranges())
    }

    fn new<T: JsonSchema + Serialize>(config: &T, ranges: &BTreeMap<String, Range>) -> Result<Self, ExplainError> {
        let generator = SchemaSettings::default().with(|settings| settings.inline_subschemas = true).into_generator();
        let schema = generator.into_root_schema_for::<T>().to_value();
        let mut settings = Settings { ranges, found: BTreeMap::new() };
        if let Value::Object(table) = serde_json::to_value(config)? {
            settings.add(&schema, &table, "");
        }
        let yaml = serde_saphyr::to_string(config)?;
        let mut open: Vec<(usize, &str)> = Vec::new();
        let mut lines = Vec::new();
        for line in yaml.lines() {
            let indent = indent(line);
            open.retain(|&(outer, _)| outer < indent);
            // A key such as `y` stands in quotes, as it would be a yes.
            let key = line[indent..].split_once(':').map(|(key, _)| key.trim_matches(['"', '\'']));
            open.extend(key.map(|key| (indent, key)));
            let path = open.iter().map(|&(_, key)| key).collect::<Vec<_>>().join(".");
            // Of text that goes on for several lines only the first has the path of a setting.
            lines.push((line.to_owned(), settings.found.remove(&path)));
        }
        Ok(Self { lines })
    }

    /// What is known of each setting, in the order of the file.
    pub fn settings(&self) -> impl Iterator<Item = &Setting> {
        self.lines.iter().filter_map(|(_, setting)| setting.as_ref())
    }

    /// The YAML, with a comment before each setting.
    #[must_use]
    pub fn yaml(&self) -> String {
        let mut text = String::new();
        for (line, setting) in &self.lines {
            if let Some(setting) = setting {
                text += &format!("{:indent$}# {}\n", "", setting.summary(), indent = indent(line));
            }
            text += line;
            text.push('\n');
        }
        text
    }
}

/// By how many spaces a line is indented.
fn indent(line: &str) -> usize {
    line.len() - line.trim_start().len()
}
