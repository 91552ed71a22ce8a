//! What is said of the settings, in `docs/settings.md` and by `frontier explore --print-config`,
//! is what the code has: names, meanings, defaults and ranges.
//!
//! `FRONTIER_WRITE_DOCS=1 cargo test --test settings_docs` writes `docs/settings.md` anew.

#![allow(clippy::unwrap_used)]

mod page;

use frontier_explorer::config::{BUILTIN_ROBOTS, Explained, Preset, RobotConfig, Setting, builtin_robot};
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

/// The settings of a preset.
fn settings(preset: &Preset) -> Vec<Setting> {
    Explained::preset(preset).unwrap().settings().cloned().collect()
}

/// The settings of a robot.
fn robot_settings(robot: &RobotConfig) -> Vec<Setting> {
    Explained::robot(robot).unwrap().settings().cloned().collect()
}

/// The default preset, and it with each other alternative of the tables that have a `name`, so
/// that each setting that there is occurs.
fn variants() -> Vec<Preset> {
    let default = Preset::default();
    let tree = serde_json::to_value(&default).unwrap();
    let mut variants = vec![default];
    for tag in settings(&variants[0]).iter().filter(|s| !s.choices.is_empty() && s.default.is_none()) {
        for choice in tag.choices.iter().filter(|choice| Some(choice.name.as_str()) != tag.value.as_str()) {
            let mut tree = tree.clone();
            let table = tag.path.trim_end_matches("name");
            *tree.pointer_mut(pointer(table).trim_end_matches('/')).unwrap() = json!({ "name": choice.name });
            variants.push(serde_json::from_value(tree).unwrap());
        }
    }
    variants
}

/// A path as JSON writes it.
fn pointer(path: &str) -> String {
    format!("/{}", path.replace('.', "/"))
}

#[test]
fn the_page_is_up_to_date() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/settings.md");
    let page = page::write();
    if std::env::var_os("FRONTIER_WRITE_DOCS").is_some() {
        std::fs::write(file, &page).unwrap();
    }
    let is_equal = std::fs::read_to_string(file).unwrap_or_default() == page;
    assert!(is_equal, "docs/settings.md is out of date: FRONTIER_WRITE_DOCS=1 cargo test --test settings_docs");
}

#[test]
fn comments_change_nothing_and_fit_on_a_line() {
    let built_in = Preset::names().map(|name| Preset::built_in(name).unwrap());
    let odd = Preset { preset: "a\nexplorer:\n  goal: # b".to_owned(), ..Preset::default() };
    for preset in built_in.chain(variants()).chain([odd]) {
        let text = Explained::preset(&preset).unwrap().yaml();
        assert_eq!(Preset::from_yaml(&text, "").unwrap(), preset);
        let is_comment = |line: &&str| line.trim_start().starts_with("# ");
        let plain: String = text.lines().filter(|line| !is_comment(line)).map(|line| format!("{line}\n")).collect();
        assert_eq!(plain, serde_saphyr::to_string(&preset).unwrap());
        let mut lines = text.lines().peekable();
        while let Some(line) = lines.next() {
            assert!(line.len() <= 160, "{} characters: {line}", line.len());
            let follows = lines.peek().is_none_or(|next| !is_comment(next));
            assert!(follows || !is_comment(&line), "two comments for one setting: {line}");
        }
    }
}

#[test]
fn every_setting_is_described() {
    let robots = BUILTIN_ROBOTS.map(|(name, _)| robot_settings(&builtin_robot(name).unwrap()));
    for setting in variants().iter().map(settings).chain(robots).flatten() {
        let (path, meaning) = (&setting.path, &setting.meaning);
        assert!(meaning.len() > 10 && meaning.ends_with('.'), "{path}: {meaning:?}");
        assert!(!meaning.contains("[`") && !meaning.contains("Self::"), "{path} links to code: {meaning}");
        assert!(setting.is_table() || !setting.allowed.is_empty(), "{path} does not say what is allowed");
        let is_explained = setting.choices.iter().all(|c| c.meaning.ends_with('.') || c.name.parse::<u8>().is_ok());
        assert!(is_explained, "{path}: {:?}", setting.choices);
        let (unit, words) = page::unit(path);
        assert!(unit.is_empty() || words.iter().any(|w| meaning.contains(w)), "{path} does not say {unit}: {meaning}");
    }
}

#[test]
fn the_yaml_has_every_setting_in_it() {
    fn count(tree: &Value) -> usize {
        tree.as_object().map_or(0, |table| table.values().map(|value| 1 + count(value)).sum())
    }
    for preset in variants() {
        assert_eq!(settings(&preset).len(), count(&serde_json::to_value(&preset).unwrap()));
    }
    for (name, _) in BUILTIN_ROBOTS {
        let robot = builtin_robot(name).unwrap();
        assert_eq!(robot_settings(&robot).len(), count(&serde_json::to_value(&robot).unwrap()), "{name}");
    }
}

#[test]
fn a_stated_default_is_what_an_empty_file_has() {
    let mut told = 0;
    for setting in variants().iter().flat_map(settings).filter(|s| !s.is_table()) {
        // The name of an alternative is the one thing that its table must have.
        assert!(setting.default.is_some() || setting.path.ends_with(".name"), "{}", setting.path);
        if let Some(default) = &setting.default {
            assert_eq!(&setting.value, default, "{}", setting.path);
            told += 1;
        }
    }
    assert!(told > 60, "{told}");
    // A robot has defaults for what it may leave out: without it, it is the same as with it.
    let robot = builtin_robot("turtlebot2").unwrap();
    for setting in robot_settings(&robot).iter().filter(|s| s.path.matches('.').count() < 2) {
        let mut tree = serde_json::to_value(&robot).unwrap();
        let (table, key) = setting.path.rsplit_once('.').map_or(("", setting.path.as_str()), |parts| parts);
        let table = if table.is_empty() { &mut tree } else { tree.pointer_mut(&pointer(table)).unwrap() };
        table.as_object_mut().unwrap().remove(key);
        let without = serde_json::from_value::<RobotConfig>(tree).map(|r| serde_json::to_value(r).unwrap());
        let default = without.ok().map(|tree| tree.pointer(&pointer(&setting.path)).unwrap().clone());
        assert_eq!(default, setting.default, "{}", setting.path);
    }
}

/// Puts numbers outside of their range, and at its ends, into a configuration that is valid
/// otherwise.
fn check_ranges<T: DeserializeOwned>(tree: &Value, settings: &[Setting], validate: fn(&T) -> Result<(), String>) {
    for setting in settings {
        let path = &setting.path;
        let load = |value: Value| {
            let mut tree = tree.clone();
            *tree.pointer_mut(&pointer(path)).unwrap() = value;
            serde_json::from_value(tree).map_err(|e| e.to_string()).and_then(|config| validate(&config))
        };
        let Some(range) = setting.range else {
            assert!(!setting.value.is_f64(), "{path} has no range");
            continue;
        };
        let is_whole = setting.value.is_i64();
        let number = |value: f64| if is_whole { json!(value as i64) } else { json!(value) };
        let refused = |value: f64| {
            let error = load(number(value)).unwrap_err();
            let (key, words) = (path.rsplit('.').next().unwrap(), range.words);
            assert!(error.contains(key) && error.contains(words), "{path}: {words} against {error}");
        };
        assert!(setting.allowed.contains(range.words), "{path}: {}", setting.allowed);
        // All that is above 0 begins with the least number that there is.
        let is_above_zero = range.least > 0.0 && range.least < 1e-300;
        let bounds = [if is_above_zero { 0.0 } else { range.least }, range.most];
        // The words of some ranges name another setting, or pi.
        let is_plain = !(range.words.contains('_') || range.words.contains(" pi"));
        for bound in bounds.into_iter().filter(|bound| is_plain && bound.abs() < f64::MAX) {
            assert!(range.words.contains(&bound.to_string()), "{path}: {} against {bound}", range.words);
        }
        let step = if is_whole { 1.0 } else { 1e-3 };
        if range.least > f64::MIN {
            refused(if is_above_zero { 0.0 } else { range.least - step });
            let least = if is_above_zero && is_whole { 1.0 } else { range.least.max(1e-30) };
            assert_eq!(load(number(if range.least > 0.0 { least } else { range.least })), Ok(()), "{path}");
        }
        if range.most < f64::MAX {
            refused(range.most + step);
            assert_eq!(load(number(range.most)), Ok(()), "{path}");
        }
    }
}

#[test]
fn the_stated_ranges_are_those_that_are_checked() {
    for preset in variants() {
        let tree = serde_json::to_value(&preset).unwrap();
        check_ranges(&tree, &settings(&preset), |preset: &Preset| preset.validate().map_err(|e| e.to_string()));
    }
    for (name, _) in BUILTIN_ROBOTS {
        let robot = builtin_robot(name).unwrap();
        let tree = serde_json::to_value(&robot).unwrap();
        let validate = |robot: &RobotConfig| robot.validate().map_err(|e| e.to_string());
        check_ranges(&tree, &robot_settings(&robot), validate);
    }
}
