//! The node's parameters: how they are laid over presets, and what is said of wrong ones.

use super::*;
use serde_json::json;

fn preset(tree: Value) -> Result<Preset, NodeParamsError> {
    let params = NodeParams::from_tree(tree)?;
    params.apply_to(Preset::built_in(params.base_preset()).unwrap())
}

#[test]
fn without_parameters_it_is_the_built_in_preset() {
    assert_eq!(preset(json!({})).unwrap(), Preset::built_in(Preset::DEFAULT).unwrap());
    let alghfeli = preset(json!({"config": "alghfeli", "tick_rate": 10})).unwrap();
    assert_eq!(alghfeli, Preset::built_in("alghfeli").unwrap());
}

#[test]
fn single_settings_are_laid_over_the_preset() {
    let over = json!({"turns": {"at_goal": false}, "patience": {"time_limit_s": 600}});
    let changed = preset(json!({"config": "wfd", "explorer": over}));
    let changed = changed.unwrap();
    let mut expected = Preset::built_in("wfd").unwrap();
    expected.explorer.turns.at_goal = false;
    expected.explorer.patience.time_limit_s = Some(600.0);
    assert_eq!(changed, expected);
    let selection = json!({"explorer": {"selection": {"name": "mrtsp"}}});
    assert!(matches!(preset(selection).unwrap().explorer.selection, SelectorConfig::Mrtsp {}));
}

#[test]
fn every_built_in_preset_may_come_from_rosparam_load() {
    for name in Preset::names() {
        let whole = Preset::built_in(name).unwrap();
        assert_eq!(preset(serde_json::to_value(&whole).unwrap()).unwrap(), whole, "{name}");
    }
}

#[test]
fn the_launch_file_of_explore_lite_is_understood() {
    let params = json!({
        "robot_base_frame": "base_footprint", "costmap_topic": "map", "costmap_updates_topic": "map_updates",
        "visualize": true, "planner_frequency": 0.5, "progress_timeout": 25.0, "potential_scale": 2.0,
        "orientation_scale": 0.0, "gain_scale": 1.5, "transform_tolerance": 0.3, "min_frontier_size": 0.6,
    });
    let read = NodeParams::from_tree(params.clone()).unwrap();
    assert_eq!((read.base_frame.as_str(), read.map_topic.as_str()), ("base_footprint", "map"));
    let explorer = preset(params).unwrap().explorer;
    let weights = ExploreLiteConfig { potential_scale: 2.0, orientation_scale: 0.0, gain_scale: 1.5 };
    assert_eq!(explorer.selection, SelectorConfig::ExploreLite(weights));
    assert_eq!(explorer.goal.reconsider_period_s, Some(2.0));
    assert_eq!((explorer.patience.progress_timeout_s, explorer.detector.min_size_m), (25.0, 0.6));
}

#[test]
fn a_costmap_in_the_place_of_the_map_has_one_kind_of_obstacle() {
    let costmap = json!({"costmap_topic": "move_base/global_costmap/costmap", "potential_scale": 3.0});
    assert_eq!(preset(costmap).unwrap().explorer.thresholds, Thresholds { free_max: 99, occupied_min: 100 });
}

#[test]
fn mistakes_are_named_with_what_is_allowed() {
    let error = |tree: Value| preset(tree).unwrap_err().to_string();
    let unknown = error(json!({"base_frme": "x"}));
    assert!(unknown.starts_with("parameter ~base_frme: unknown field") && unknown.contains("base_frame"), "{unknown}");
    let kind = error(json!({"tick_rate": "fast"}));
    assert!(kind.starts_with("parameter ~tick_rate: invalid type: string \"fast\""), "{kind}");
    let range = error(json!({"tick_rate": 0}));
    assert_eq!(range, "parameter ~tick_rate is 0: must be within 0.1 to 50 observations a second");
    let nested = error(json!({"explorer": {"goal": {"search_radius_m": -1.0}}}));
    assert_eq!(nested, "parameter ~explorer.goal.search_radius_m is -1: must be finite and > 0");
    let deep = error(json!({"explorer": {"goal": {"serch": 1}}}));
    assert!(deep.starts_with("parameter ~explorer.goal.serch: unknown field `serch`"), "{deep}");
    let region = error(json!({"region": [[0, 0], [1, 1]]}));
    assert!(region.starts_with("parameter ~region: "), "{region}");
    let no_go = error(json!({"no_go": [[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1]]]}));
    assert_eq!(no_go, "parameter ~no_go: area 1: an area needs at least 3 corners, and 2 were given");
    assert_eq!(error(json!({"map_topic": ""})), "parameter ~map_topic: is empty: must be a name");
}

#[test]
fn a_name_that_nobody_knows_comes_with_the_command_that_removes_it() {
    let removal = |tree: Value| preset(tree).unwrap_err().removal("/explore");
    let expected = |name: &str| Some(format!("rosparam delete /explore/{name}"));
    assert_eq!(removal(json!({"base_frme": "x"})), expected("base_frme"));
    assert_eq!(removal(json!({"explorer": {"goal": {"serch": 1}}})), expected("explorer/goal/serch"));
    let deep = json!({"explorer": {"selection": {"name": "explore_lite", "gain_scl": 1.0}}});
    assert_eq!(removal(deep), expected("explorer/selection/gain_scl"));
    assert_eq!(removal(json!({"tick_rate": 0})), None);
    assert_eq!(removal(json!({"tick_rate": "fast"})), None);
}
