//! Live parameters: each stands for a setting, and what cannot be is refused.

use super::*;
use crate::config::NodeParams;

fn live(preset: &str) -> Live {
    Live { node: NodeParams::default().live_node(), preset: Preset::built_in(preset).unwrap() }
}

fn changed(preset: &str, name: &str, value: Value) -> Result<Live, String> {
    live(preset).with(&[(name.to_owned(), value)]).map_err(|error| error.to_string())
}

#[test]
fn each_parameter_can_be_given_its_own_value_and_changes_its_own_setting() {
    for preset in Preset::names() {
        let before = live(preset);
        for param in before.params().unwrap() {
            assert!(param.name.chars().all(|c| c.is_ascii_lowercase() || c == '_'), "{}", param.name);
            assert!(!param.meaning.is_empty(), "{}", param.name);
            assert_eq!(changed(preset, param.name, param.value.clone()).unwrap(), before, "{}", param.name);
            let other = match &param.value {
                Value::Bool(is) => json!(!is),
                Value::String(text) => json!(param.choices.iter().find(|c| c.name != *text).unwrap().name),
                value if value.is_f64() => json!(0.5 * (param.least + param.most) + 0.015),
                value => json!(value.as_i64().unwrap() + 1),
            };
            let after = changed(preset, param.name, other.clone()).unwrap();
            let now = after.params().unwrap();
            let differ = |(a, b): &(LiveParam, LiveParam)| a.value != b.value;
            let pairs = before.params().unwrap().into_iter().zip(now);
            let changes: Vec<_> = pairs.filter(differ).map(|(_, b)| (b.name, b.value)).collect();
            assert_eq!(changes, [(param.name, other)], "{preset}");
        }
    }
}

#[test]
fn every_name_stands_for_a_setting_of_some_preset_and_in_the_documentation() {
    let docs = include_str!("../../docs/ros.md");
    let mut strategies: Vec<Live> = Preset::names().map(live).collect();
    strategies.push(live("wfd"));
    let found: Vec<&str> = strategies.iter().flat_map(|one| one.params().unwrap()).map(|p| p.name).collect();
    for name in live_names() {
        assert!(found.contains(&name), "{name}");
        assert!(docs.contains(&format!("`{name}`")), "docs/ros.md does not tell {name}");
    }
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    let error = |name: &str, value: Value| changed("tour", name, value).unwrap_err();
    assert_eq!(error("min_size", json!(-1.0)), "min_size is -1.0: must be a number within 0 to 10");
    assert_eq!(error("recoveries", json!(1.5)), "recoveries is 1.5: must be whole and within 0 to 20");
    assert_eq!(error("visualize", json!(1)), "visualize is 1: must be true or false");
    assert_eq!(error("good_enough_share", json!(1.1)), "good_enough_share is 1.1: must be a number within 0 to 1");
    let unknown = error("min_siz", json!(1.0));
    assert!(unknown.starts_with("min_siz is no parameter that can change while the node runs: must be one of min_"));
    assert!(unknown.ends_with("(did you mean min_size?)"), "{unknown}");
    assert!(error("potential_scale", json!(1.0)).contains("is no parameter"), "tour has no such weight");
    let choice = changed("wfd", "nearest_by", json!("air")).unwrap_err();
    assert_eq!(choice, "nearest_by is \"air\": must be one of euclidean, path");
    let one_of_two = [("min_size".to_owned(), json!(1.0)), ("visualize".to_owned(), json!("no"))];
    assert!(live("tour").with(&one_of_two).is_err());
}

#[test]
fn nothing_stands_for_null() {
    let limited = changed("tour", "time_limit", json!(60)).unwrap();
    assert_eq!(limited.preset.explorer.patience.time_limit_s, Some(60.0));
    let free = limited.with(&[("time_limit".to_owned(), json!(0.0))]).unwrap();
    assert_eq!(free.preset.explorer.patience.time_limit_s, None);
    let told = free.params().unwrap().into_iter().find(|p| p.name == "time_limit").unwrap();
    assert_eq!(told.value, json!(0.0));
    assert!(told.meaning.ends_with("0 stands for null."));
}
