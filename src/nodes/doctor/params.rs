//! The private parameters of `explore_node`, read as the node reads them, and what is wrong with
//! them.

use crate::config::{NodeParams, NodeParamsError, Preset, RobotConfig};
use crate::io::{load_preset, load_robot};
use crate::ros::doctor::Finding;
use serde_json::Value;

const CHECK: &str = "parameters";
/// So many wrong parameters are told.
const MOST: usize = 20;

/// What the node would go by, and what is to be said of it.
pub struct ReadParams {
    pub params: NodeParams,
    pub preset: Preset,
    pub robot: RobotConfig,
    pub finding: Finding,
}

/// A parameter that is wrong: what is allowed, and the command that removes it if nobody knows it.
struct Wrong {
    text: String,
    removal: Option<String>,
}

/// Reads the tree below a node's name. Where parameters are wrong, the others are read as if
/// those were not set.
///
/// # Errors
/// A sentence where even the defaults cannot be had.
pub fn read(node: &str, mut tree: Value) -> Result<ReadParams, String> {
    let count = tree.as_object().map_or(0, serde_json::Map::len);
    let mut wrong = Vec::new();
    loop {
        match interpret(node, &tree) {
            Ok((params, preset, robot)) => {
                return Ok(ReadParams { params, preset, robot, finding: finding(node, count, &wrong) });
            }
            Err(error) if wrong.len() > MOST => return Err(error.text),
            Err(error) => {
                if wrong.len() == MOST || !leave_out(&mut tree, &error.text) {
                    tree = Value::Null;
                }
                wrong.push(error);
            }
        }
        if tree.is_null() {
            tree = Value::Object(serde_json::Map::new());
        }
    }
}

fn interpret(node: &str, tree: &Value) -> Result<(NodeParams, Preset, RobotConfig), Wrong> {
    let params_error = |error: NodeParamsError| Wrong { text: error.to_string(), removal: error.removal(node) };
    let file_error = |name: &str, why: String| Wrong { text: format!("parameter ~{name}: {why}"), removal: None };
    let params = NodeParams::from_tree(tree.clone()).map_err(params_error)?;
    let base = load_preset(params.base_preset()).map_err(|error| file_error("config", error.to_string()))?;
    let robot = load_robot(&params.robot).map_err(|error| file_error("robot", error.to_string()))?;
    let preset = params.apply_to(base).map_err(params_error)?;
    Ok((params, preset, robot))
}

/// Takes the parameter that an error names, `parameter ~explorer.goal.x ...`, out of the tree;
/// whether there is one.
fn leave_out(tree: &mut Value, error: &str) -> bool {
    let Some((_, named)) = error.split_once('~') else { return false };
    let path = named.split([' ', ':', '[']).next().unwrap_or_default();
    let mut levels: Vec<&str> = path.split('.').filter(|level| !matches!(*level, "" | "?")).collect();
    let mut table = tree;
    let last = levels.pop();
    for level in levels {
        match table.get_mut(level) {
            // What a table of several kinds holds is known by its name alone.
            Some(below) if below.is_object() => table = below,
            _ => return false,
        }
    }
    last.is_some_and(|last| table.as_object_mut().is_some_and(|table| table.remove(last).is_some()))
}

fn finding(node: &str, count: usize, wrong: &[Wrong]) -> Finding {
    if wrong.is_empty() {
        return Finding::ok(
            CHECK,
            match count {
                0 => format!("{node} has none: the defaults hold"),
                _ => format!("{node} has {count}, and all are known and allowed"),
            },
        );
    }
    let what = wrong.iter().map(|wrong| shortened(&wrong.text)).collect::<Vec<_>>().join("; ");
    let removals: Vec<String> =
        wrong.iter().filter_map(|wrong| Some(format!("`{}`", wrong.removal.as_ref()?))).collect();
    let remedy = if removals.is_empty() {
        format!("`rosparam set {node}/NAME VALUE` with a value that is allowed, and correct the launch file")
    } else {
        format!("{}, and correct the launch file: a wrong name stays on the parameter server", removals.join(", "))
    };
    Finding::error(CHECK, what, remedy)
}

/// Where the nearest name is told, the long list of all is left out.
fn shortened(text: &str) -> String {
    match (text.split_once(", expected "), text.split_once(" (did you mean ")) {
        (Some((wrong, _)), Some((_, hint))) => format!("{wrong} (did you mean {hint}"),
        _ => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::doctor::FindingLevel::{Error, Ok};
    use serde_json::json;

    fn check(tree: Value) -> ReadParams {
        read("/explore", tree).unwrap()
    }

    #[test]
    fn known_parameters_and_none_are_well() {
        let none = check(json!({}));
        assert_eq!((none.finding.level, none.params.base_frame.as_str()), (Ok, "base_link"));
        let some = check(json!({"base_frame": "base", "explorer": {"turns": {"at_goal": false}}}));
        assert_eq!(some.finding.what, "/explore has 2, and all are known and allowed");
        assert!(!some.preset.explorer.turns.at_goal);
    }

    #[test]
    fn a_misspelt_name_comes_with_the_nearest_one_and_the_command_that_removes_it() {
        let read = check(json!({"base_frme": "base", "map_topic": "/map2"}));
        assert_eq!((read.finding.level, read.params.map_topic.as_str()), (Error, "/map2"), "the others are read");
        let what = &read.finding.what;
        assert_eq!(what, "parameter ~base_frme: unknown field `base_frme` (did you mean base_frame?)");
        assert!(read.finding.remedy.unwrap().starts_with("`rosparam delete /explore/base_frme`, and correct"));
    }

    #[test]
    fn all_wrong_parameters_are_named_at_once() {
        let explorer = json!({"goal": {"serch": 1, "search_radius_m": -1.0}, "selection": {"name": "mrtsp", "x": 1}});
        let read = check(json!({"tick_rate": 0, "explorer": explorer, "frme": 1, "robot": "turtle", "config": "wdf"}));
        let what = &read.finding.what;
        for said in [
            "~frme: unknown",
            "~tick_rate is 0: must be",
            "~explorer.goal.serch: unknown field",
            "~explorer.goal.search_radius_m is -1: must be",
            "~robot: no robot is called 'turtle'",
            "~config: there is no preset \"wdf\"",
        ] {
            assert!(what.contains(said), "{said}: {what}");
        }
        let remedy = read.finding.remedy.unwrap();
        assert!(
            remedy.contains("`rosparam delete /explore/frme`, `rosparam delete /explore/explorer/goal/serch`"),
            "{remedy}"
        );
        assert_eq!(read.params.tick_rate, 5.0);
    }

    #[test]
    fn a_wrong_value_comes_with_what_is_allowed() {
        let read = check(json!({"tick_rate": "fast"}));
        assert!(read.finding.what.starts_with("parameter ~tick_rate: invalid type: string \"fast\""));
        assert!(read.finding.remedy.unwrap().starts_with("`rosparam set /explore/NAME VALUE`"));
        assert_eq!(check(json!("no table")).finding.level, Error);
    }
}
