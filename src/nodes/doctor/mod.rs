//! A look at a running system before an exploration: what the parameters of `explore_node` say,
//! and what there is of it.

mod params;

pub use crate::ros::doctor::{Finding, FindingLevel};

use crate::config::{Drive, NodeParams, Preset, RobotConfig};
use crate::frontier::DetectorKind;
use crate::io::{MapImage, check_map_path};
use crate::ros::Node;
use crate::ros::doctor::{OwnOutline, Wanted, gather, judge};
use params::{ReadParams, read};
use std::path::Path;
use std::time::Duration;

/// What to look at.
#[derive(Clone, Debug)]
pub struct DoctorOptions {
    /// The node that is to explore, by its full name; its parameters are read.
    pub node: String,
    /// Instead of the parameter `map_topic`.
    pub map_topic: Option<String>,
    /// Instead of the parameter `base_frame`.
    pub base_frame: Option<String>,
    /// Instead of the parameter `move_base`.
    pub move_base: Option<String>,
    /// The topic of the scans; `scan` in the node's namespace without.
    pub scan_topic: Option<String>,
    /// How long to wait for what does not come.
    pub limit: Duration,
}

/// Looks at everything, for the time in the options and some seconds at the most, and returns one
/// finding for each check.
///
/// # Errors
/// A sentence when the master does not tell what there is.
pub fn examine(node: &Node, options: &DoctorOptions) -> Result<Vec<Finding>, String> {
    let uri = std::env::var("ROS_MASTER_URI").unwrap_or_else(|_| "http://localhost:11311".to_owned());
    let mut findings = vec![Finding::ok("master", format!("the ROS master answers at {uri}"))];
    let options = &DoctorOptions { node: node.full_name(options.node.trim_end_matches('/')), ..options.clone() };
    let tree = node.params_below(&options.node).map_err(|error| error.to_string())?;
    let ReadParams { mut params, preset, robot, finding } = read(&options.node, tree)?;
    if let Some(prefix) = tf_prefix(node, &options.node).filter(|_| !params.base_frame.starts_with('/')) {
        params.base_frame = format!("{prefix}/{}", params.base_frame);
    }
    let wanted = wanted(options, &params, &preset, &robot);
    let seen = judge(&wanted, &gather(node, &wanted, options.limit)?);
    // The clock comes first: without time nothing can be judged.
    let (clock, others): (Vec<_>, Vec<_>) = seen.into_iter().partition(|finding| finding.check == "clock");
    findings.extend(clock);
    findings.push(finding);
    findings.extend(others);
    findings.push(judge_map_file(&options.node, &params.map_file));
    Ok(findings)
}

fn wanted(options: &DoctorOptions, params: &NodeParams, preset: &Preset, robot: &RobotConfig) -> Wanted {
    let full = |name: &str| full_name(&options.node, name);
    let or = |option: &Option<String>, parameter: &str| option.clone().unwrap_or_else(|| parameter.to_owned());
    let drives_itself = preset.navigation.drive == Drive::Internal;
    let needs_scans = drives_itself || params.back_off || preset.explorer.detector.name == DetectorKind::Fast;
    let (map_topic, server) =
        (full(&or(&options.map_topic, &params.map_topic)), full(&or(&options.move_base, &params.move_base)));
    let costmap = format!("{server}/global_costmap/costmap");
    Wanted {
        node: options.node.clone(),
        plans_on_costmap: map_topic == costmap || full(&params.global_costmap_topic) == costmap,
        map_topic,
        base_frame: or(&options.base_frame, &params.base_frame),
        tolerance_s: params.transform_tolerance,
        move_base: (!drives_itself).then_some(server),
        scan_topic: needs_scans.then(|| full(&or(&options.scan_topic, "scan"))),
        outline: OwnOutline {
            robot: robot.name.clone(),
            inscribed_m: robot.footprint.inscribed_radius_m(),
            circumscribed_m: robot.footprint.circumscribed_radius_m(),
        },
    }
}

/// A name as a node sees it: absolute, private, or in its namespace.
fn full_name(node: &str, name: &str) -> String {
    if name.starts_with('/') {
        return name.to_owned();
    }
    if let Some(private) = name.strip_prefix('~') {
        return format!("{node}/{private}");
    }
    let namespace = node.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    format!("{namespace}/{name}")
}

/// tf 1's prefix of frames, looked for from a node's own name upwards.
fn tf_prefix(node: &Node, of: &str) -> Option<String> {
    let places = std::iter::successors(Some(of), |place| place.rsplit_once('/').map(|(above, _)| above));
    let found = places.filter_map(|place| node.params_below(&format!("{place}/tf_prefix")).ok());
    let texts = found.filter_map(|value| value.as_str().map(|text| text.trim_matches('/').to_owned()));
    texts.into_iter().next().filter(|text| !text.is_empty())
}

fn judge_map_file(node: &str, file: &str) -> Finding {
    const CHECK: &str = "map_file";
    if file.is_empty() {
        return Finding::ok(CHECK, "~map_file is not set: the map is saved on request alone (~save_map)");
    }
    match check_map_path(Path::new(file), MapImage::default()) {
        Ok(paths) => {
            let whose =
                if Path::new(file).is_relative() { ", seen from this folder: the node has its own" } else { "" };
            Finding::ok(CHECK, format!("{} can be written from this computer{whose}", paths.yaml.display()))
        }
        Err(error) => Finding::error(
            CHECK,
            format!("the map could not be saved from this computer as ~map_file says: {error}"),
            format!("let the node's user write there, or `rosparam set {node}/map_file FILE` and start the node again"),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn options() -> DoctorOptions {
        let node = "/robot/explore".to_owned();
        let (map_topic, base_frame, move_base, scan_topic) = (None, None, None, None);
        DoctorOptions { node, map_topic, base_frame, move_base, scan_topic, limit: Duration::from_secs(1) }
    }

    fn look_at(options: &DoctorOptions, tree: serde_json::Value) -> Wanted {
        let ReadParams { params, preset, robot, finding } = read(&options.node, tree).unwrap();
        assert_eq!(finding.level, FindingLevel::Ok, "{finding:?}");
        wanted(options, &params, &preset, &robot)
    }

    #[test]
    fn names_are_those_that_the_node_sees() {
        let by_default = look_at(&options(), json!({}));
        assert_eq!(by_default.map_topic, "/robot/map");
        assert_eq!(by_default.move_base.as_deref(), Some("/robot/move_base"));
        assert_eq!(by_default.scan_topic.as_deref(), Some("/robot/scan"));
        assert_eq!((by_default.base_frame.as_str(), by_default.plans_on_costmap), ("base_link", false));
        let set = look_at(&options(), json!({"map_topic": "/map", "move_base": "~driver", "base_frame": "base"}));
        assert_eq!((set.map_topic.as_str(), set.base_frame.as_str()), ("/map", "base"));
        assert_eq!(set.move_base.as_deref(), Some("/robot/explore/driver"));
        let told = DoctorOptions { map_topic: Some("other".to_owned()), ..options() };
        assert_eq!(look_at(&told, json!({"map_topic": "/map"})).map_topic, "/robot/other", "options come first");
    }

    #[test]
    fn what_is_not_needed_is_not_looked_at() {
        let own = look_at(&options(), json!({"navigation": {"drive": "internal"}, "back_off": false}));
        assert!(own.move_base.is_none() && own.scan_topic.is_some());
        assert!(look_at(&options(), json!({"back_off": false})).scan_topic.is_none());
        assert!(
            look_at(&options(), json!({"back_off": false, "explorer": {"detector": {"name": "fast"}}}))
                .scan_topic
                .is_some()
        );
        let costmap = json!({"global_costmap_topic": "move_base/global_costmap/costmap"});
        assert!(look_at(&options(), costmap).plans_on_costmap);
    }

    #[test]
    fn a_map_file_that_cannot_be_written_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("map").display().to_string();
        assert_eq!(judge_map_file("/explore", &file).level, FindingLevel::Ok);
        assert_eq!(judge_map_file("/explore", "").level, FindingLevel::Ok);
        let finding = judge_map_file("/explore", "/nowhere/at/all/map");
        assert_eq!(finding.level, FindingLevel::Error);
        assert!(finding.what.contains("from this computer") && finding.what.contains("/nowhere/at/all/map.pgm"));
        assert!(finding.remedy.unwrap().contains("rosparam set /explore/map_file"));
    }
}
