//! `docs/settings.md` as text: the settings in tables, with what the built-in presets and robots
//! make of them.

use super::{robot_settings, settings, variants};
use frontier_explorer::config::{BUILTIN_ROBOTS, Preset, Setting, builtin_robot};
use serde_json::Value;
use std::collections::BTreeMap;

const HEAD: &str = "\
# Settings

A **preset** says how to explore, a **robot** says what the robot is and can do. Both are YAML
files; those of `configs/` and `configs/robots/` are built in and go by their names.

- **On the command line**: `--config` of `explore`, `replay` and others takes the name of a
  built-in preset or a file, `--robot` the name of a built-in robot or a file.
- **As a file**: `frontier explore --config liang --print-config > mine.yaml` writes a whole preset
  with a comment on each setting. A setting that is left out has its default, so that a file needs
  to say only what is its own. In a path below, each dot is a level:

  ```yaml
  preset: mine
  explorer:
    goal:
      commit_radius_m: 0.5       # explorer.goal.commit_radius_m
    planner:
      name: breadth_first
  ```
- **As ROS parameters** of `explore_node`: `~config` and `~robot` take the same names and files, and
  each setting of a preset is a private parameter, with slashes for the dots, laid over the preset:

  ```xml
  <param name=\"config\" value=\"liang\"/>
  <param name=\"explorer/goal/commit_radius_m\" value=\"0.5\"/>
  <rosparam file=\"mine.yaml\"/>
  ```

  A table that is given another `name` (`selection`, `planner`, `controller`) is replaced as a whole.
  [ros.md](ros.md) lists the node's other parameters, those of explore_lite among them.

Units are SI, and the last part of a name tells its own: `_m` metres, `_s` seconds, `_rad` radians,
`_mps` m/s, `_rps` rad/s, `_mps2` m/s², `_rps2` rad/s², `_hz` 1/s, `_cells` cells of the map. A name
that is not known, or a value that is not allowed, is refused with a sentence that says what is.

This page is made of the code's own comments, defaults and checks:
`FRONTIER_WRITE_DOCS=1 cargo test --test settings_docs` writes it anew.
";

/// The unit that the name of a setting ends with, and the words one of which its meaning has.
pub fn unit(path: &str) -> (&'static str, &'static [&'static str]) {
    let units: [(&str, &str, &[&str]); 9] = [
        ("_mps2", "m/s²", &["metres per second squared"]),
        ("_rps2", "rad/s²", &["radians per second squared"]),
        ("_mps", "m/s", &["metres per second"]),
        ("_rps", "rad/s", &["radians per second"]),
        ("_rad", "rad", &["radians"]),
        ("_hz", "Hz", &["Hz"]),
        ("_cells", "cells", &["cells"]),
        ("_m", "m", &["metres"]),
        ("_s", "s", &["seconds"]),
    ];
    units.into_iter().find(|(end, ..)| path.ends_with(end)).map_or(("", &[]), |(_, unit, words)| (unit, words))
}

/// The whole page.
pub fn write() -> String {
    format!("{HEAD}\n## Presets\n{}\n## Robots\n{}", presets(), robots())
}

/// A value as a file has it, with its unit.
fn literal(setting: &Setting, value: &Value) -> String {
    let unit = unit(&setting.path).0;
    let unit = if value.is_number() && !unit.is_empty() { format!(" {unit}") } else { String::new() };
    match value.as_str() {
        Some("") => "empty".to_owned(),
        Some(text) => format!("`{text}`"),
        None => format!("`{value}`{unit}"),
    }
}

/// The table in which a setting stands.
fn table_of(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(table, _)| table)
}

/// The value of the `name` beside a setting, where its table is one of several alternatives.
fn alternative(settings: &[Setting], path: &str) -> Option<String> {
    let name = format!("{}.name", table_of(path));
    let is_tag = |s: &&Setting| s.path == name && s.default.is_none() && !s.choices.is_empty();
    settings.iter().find(is_tag).and_then(|s| s.value.as_str().map(str::to_owned))
}

/// A part of the page: what a table of settings holds.
#[derive(Default)]
struct Section {
    title: String,
    text: String,
    rows: Vec<String>,
    choices: Vec<String>,
}

impl Section {
    fn write(&self, columns: &str) -> String {
        let mut out = format!("\n### {}\n\n{}\n", self.title, self.text);
        if !self.rows.is_empty() {
            let rule = "---|".repeat(columns.matches('|').count() - 1);
            out += &format!("\n{columns}\n|{rule}\n{}", self.rows.concat());
        }
        self.choices.iter().for_each(|list| out += list);
        out
    }
}

/// What each name of a choice stands for, as a list.
fn choices(setting: &Setting) -> Option<String> {
    let told = setting.choices.iter().filter(|choice| !choice.meaning.is_empty());
    let lines: String = told.map(|c| format!("- `{}`: {}\n", c.name, c.meaning)).collect();
    let key = setting.path.rsplit('.').next()?;
    (!lines.is_empty()).then(|| format!("\n`{key}` is one of\n\n{lines}"))
}

fn presets() -> String {
    let built_in: Vec<(&str, Vec<Setting>)> =
        Preset::names().map(|name| (name, settings(&Preset::built_in(name).unwrap()))).collect();
    let all: Vec<Vec<Setting>> = variants().iter().map(settings).collect();
    let mut sections: Vec<Section> = Vec::new();
    for (settings, setting) in all.iter().flat_map(|settings| settings.iter().map(move |s| (settings, s))) {
        let alternative = alternative(settings, &setting.path);
        let table = table_of(&setting.path);
        let title = |table: &str, name: Option<&str>| match name {
            _ if table.is_empty() => "The preset itself".to_owned(),
            Some(name) => format!("`{table}` with `name: {name}`"),
            None => format!("`{table}`"),
        };
        let key = setting.path.rsplit('.').next().unwrap();
        if setting.is_table() {
            let title = title(&setting.path, None);
            if !sections.iter().any(|section| section.title == title) {
                sections.push(Section { title, text: setting.meaning.clone(), ..Section::default() });
            }
            continue;
        }
        let is_tag = alternative.is_some() && key == "name";
        let title = title(table, alternative.as_deref().filter(|_| !is_tag));
        let index = sections.iter().position(|section| section.title == title).unwrap_or_else(|| {
            // What belongs to one alternative follows what is said of them all.
            let before = format!("`{table}`");
            let last = sections.iter().rposition(|s| s.title.starts_with(&before)).map_or(sections.len(), |i| i + 1);
            let text = settings.iter().find(|s| s.path == format!("{table}.name")).map(|s| s.meaning.clone());
            let text = text.unwrap_or_else(|| "Beside the tables below.".to_owned());
            sections.insert(last, Section { title, text, ..Section::default() });
            last
        });
        let default = setting.default.as_ref().unwrap_or(&setting.value);
        let others = differing(setting, default, alternative.as_deref().filter(|_| !is_tag), &built_in);
        let row = format!(
            "| `{key}` | {} | {} | {} | {others} |\n",
            if is_tag { "Which of those below." } else { &setting.meaning },
            literal(setting, default),
            setting.allowed,
        );
        let section = &mut sections[index];
        let is_known = section.rows.iter().any(|known| known.starts_with(&format!("| `{key}` |")));
        if !is_known {
            section.rows.push(row);
            section.choices.extend(choices(setting));
        }
    }
    sections.retain(|section| !section.rows.is_empty());
    sections.iter().map(|s| s.write("| setting | meaning | default | allowed | other in presets |")).collect()
}

/// Which presets give a setting another value, by value.
fn differing(setting: &Setting, default: &Value, name: Option<&str>, built_in: &[(&str, Vec<Setting>)]) -> String {
    if setting.path == "preset" {
        return "each its own".to_owned();
    }
    let mut values: BTreeMap<String, Vec<&str>> = BTreeMap::new();
    for (preset, settings) in built_in {
        let is_same = alternative(settings, &setting.path).as_deref() == name || name.is_none();
        let found = settings.iter().find(|s| is_same && s.path == setting.path && s.value != *default);
        if let Some(found) = found {
            values.entry(literal(found, &found.value)).or_default().push(preset);
        }
    }
    values.iter().map(|(value, presets)| format!("{value}: {}", presets.join(", "))).collect::<Vec<_>>().join("; ")
}

fn robots() -> String {
    let robots = BUILTIN_ROBOTS.map(|(name, _)| robot_settings(&builtin_robot(name).unwrap()));
    let mut sections: Vec<Section> = vec![Section {
        title: "The robot itself".to_owned(),
        text: "Settings without a default must be given.".to_owned(),
        ..Section::default()
    }];
    for setting in robots.iter().flatten() {
        let table = table_of(&setting.path);
        let key = setting.path.rsplit('.').next().unwrap();
        let title = |path: &str| if path.is_empty() { sections[0].title.clone() } else { format!("`{path}`") };
        let (own, title) = (title(&setting.path), title(table));
        if setting.is_table() {
            if !sections.iter().any(|section| section.title == own) {
                let all = setting.default.as_ref().map(|all| format!(" Without this table it is `{all}`."));
                let text = format!("{}{}", setting.meaning, all.unwrap_or_default());
                sections.push(Section { title: own, text, ..Section::default() });
            }
            continue;
        }
        let default = setting.default.as_ref().map_or_else(|| "none".to_owned(), |value| literal(setting, value));
        let value = |robot: &Vec<Setting>| {
            let found = robot.iter().find(|s| s.path == setting.path);
            found.map_or_else(|| "not given".to_owned(), |s| literal(s, &s.value))
        };
        let values: Vec<String> = robots.iter().map(value).collect();
        let (meaning, allowed) = (&setting.meaning, &setting.allowed);
        let row = format!("| `{key}` | {meaning} | {default} | {allowed} | {} |\n", values.join(" | "));
        if let Some(section) = sections.iter_mut().find(|section| section.title == title)
            && !section.rows.contains(&row)
        {
            section.rows.push(row);
        }
    }
    let names = BUILTIN_ROBOTS.map(|(name, _)| format!("`{name}`")).join(" | ");
    let columns = format!("| setting | meaning | default | allowed | {names} |");
    sections.iter().map(|section| section.write(&columns)).collect()
}
