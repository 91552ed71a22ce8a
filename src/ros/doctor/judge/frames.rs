//! The way from the map's frame to the robot's, and what its times are worth.

use super::super::facts::{FrameFacts, Wanted};
use super::super::finding::Finding;
use super::words::{nearest, set_param};
use crate::robot::PoseError;
use crate::ros::directory::list;
use crate::tf::frame_name;

const CHECK: &str = "frames";

/// What is to be said of the transforms; `has_time` where they can be compared with ROS time.
pub fn judge(wanted: &Wanted, frames: &FrameFacts, has_time: bool) -> Finding {
    let FrameFacts { map_frame, base_frame, known, publishers, .. } = frames;
    let links = match &frames.links {
        Ok(links) => links,
        Err(missing) => {
            let what = format!("no transform from {map_frame} to {base_frame} (~base_frame): {missing}");
            return Finding::error(CHECK, what, missing_remedy(wanted, frames));
        }
    };
    // The chain is told from the robot upwards.
    let chain: Vec<String> = links.iter().rev().map(|link| format!("{} -> {}", link.parent, link.child)).collect();
    match (&frames.pose, has_time) {
        (Some(Err(error)), true) => {
            let told = format!("of {}; `rosrun tf tf_monitor {map_frame} {base_frame}` shows delays", list(publishers));
            let remedy = match error {
                PoseError::Skewed { .. } | PoseError::Lagging { .. } => {
                    format!("set the clocks of all computers alike (chrony), or mend the one that sends it {told}")
                }
                _ => format!("see whether the one that sends it still runs {told}"),
            };
            Finding::error(CHECK, error.to_string(), remedy)
        }
        (_, false) | (None, true) => {
            let what = format!(
                "{} leads from {map_frame} to {base_frame}; without ROS time nobody knows how old it is",
                list(&chain)
            );
            Finding::warning(CHECK, what, "mend the clock first")
        }
        (Some(Ok(())), true) => {
            let late_s = links.iter().filter_map(|link| Some(link.arrived_s? - link.stamp_s)).fold(0.0, f64::max);
            let known = known.len();
            Finding::ok(
                CHECK,
                format!("{map_frame} to {base_frame} by {}, at most {late_s:.2} s late; {known} frames", list(&chain)),
            )
        }
    }
}

fn missing_remedy(wanted: &Wanted, frames: &FrameFacts) -> String {
    let FrameFacts { map_frame, base_frame, known, .. } = frames;
    let is_known = |frame: &str| known.iter().any(|name| name == frame_name(frame));
    if known.is_empty() {
        return "start the robot's driver, robot_state_publisher and the SLAM, which tell transforms".to_owned();
    }
    if !is_known(base_frame) {
        let names = known.iter().map(String::as_str).filter(|name| *name != frame_name(map_frame));
        return match nearest(frame_name(base_frame), names) {
            Some(name) => set_param(&wanted.node, "base_frame", name),
            None => set_param(&wanted.node, "base_frame", "FRAME").replace("FRAME", "ONE_OF_THEM"),
        };
    }
    if !is_known(map_frame) {
        return format!("start the SLAM or amcl that tells where {map_frame} is");
    }
    "start what tells the missing link: a SLAM tells map -> odom, the robot's driver odom -> base, \
     robot_state_publisher what is fixed to it"
        .to_owned()
}

#[cfg(test)]
mod tests {
    use super::super::super::finding::FindingLevel::{Error, Ok as Well, Warning};
    use super::super::testing::{nodes, wanted};
    use super::*;
    use crate::ros::frames::ToldLink;

    fn link(parent: &str, child: &str, late_s: f64) -> ToldLink {
        ToldLink { parent: parent.to_owned(), child: child.to_owned(), stamp_s: 100.0, arrived_s: Some(100.0 + late_s) }
    }

    fn facts() -> FrameFacts {
        FrameFacts {
            map_frame: "map".to_owned(),
            base_frame: "base_link".to_owned(),
            known: ["base_link", "map", "odom"].map(str::to_owned).to_vec(),
            links: Ok(vec![link("odom", "base_link", 0.0), link("map", "odom", 0.2)]),
            pose: Some(Ok(())),
            publishers: nodes(&["/slam"]),
        }
    }

    #[test]
    fn a_way_that_is_fresh_is_well() {
        let finding = judge(&wanted(), &facts(), true);
        let what = "map to base_link by map -> odom, odom -> base_link, at most 0.20 s late; 3 frames";
        assert_eq!((finding.level, finding.what.as_str()), (Well, what));
        assert_eq!(judge(&wanted(), &facts(), false).level, Warning, "without a clock");
    }

    #[test]
    fn a_frame_that_is_missing_comes_with_the_one_that_was_meant() {
        let lacking = |base: &str, map: &str| {
            let links = Err("what is missing".to_owned());
            let (map_frame, base_frame) = (map.to_owned(), base.to_owned());
            judge(&wanted(), &FrameFacts { map_frame, base_frame, links, ..facts() }, true)
        };
        let base = lacking("base_lnk", "map");
        assert_eq!(base.level, Error);
        assert_eq!(base.what, "no transform from map to base_lnk (~base_frame): what is missing");
        assert!(base.remedy.unwrap().starts_with("`rosparam set /explore/base_frame base_link`"));
        assert!(lacking("trunk", "map").remedy.unwrap().contains("base_frame ONE_OF_THEM"));
        assert!(lacking("base_link", "world").remedy.unwrap().contains("tells where world is"));
        assert!(lacking("base_link", "map").remedy.unwrap().starts_with("start what tells the missing link"));
        let nothing = FrameFacts { known: Vec::new(), links: Err("no frame yet".to_owned()), ..facts() };
        assert!(judge(&wanted(), &nothing, true).remedy.unwrap().contains("robot_state_publisher"));
    }

    #[test]
    fn wrong_clocks_and_silence_are_named_by_their_link() {
        let (parent, child) = ("map".to_owned(), "odom".to_owned());
        let skew = PoseError::Skewed { parent, child, ahead_s: 120.0, limit_s: 1.5 };
        let finding = judge(&wanted(), &FrameFacts { pose: Some(Err(skew)), ..facts() }, true);
        assert_eq!(finding.level, Error);
        assert!(finding.what.starts_with("clock skew: map -> odom is stamped 120.0 s ahead"), "{finding:?}");
        assert!(finding.remedy.unwrap().contains("chrony"));
        let (map_frame, base_frame) = ("map".to_owned(), "base_link".to_owned());
        let stale = PoseError::Stale { map_frame, base_frame, age_s: 9.0, limit_s: 0.5 };
        let finding = judge(&wanted(), &FrameFacts { pose: Some(Err(stale)), ..facts() }, true);
        assert!(finding.remedy.unwrap().starts_with("see whether the one that sends it still runs of /slam"));
    }
}
