//! The map: does one come, and what is in it.

use super::super::facts::{MapFacts, MapSeen, TopicFacts, Wanted};
use super::super::finding::Finding;
use super::words::{nearest, offers, set_param};
use crate::ros::directory::list;

const CHECK: &str = "map";
/// The type of maps.
const KIND: &str = "nav_msgs/OccupancyGrid";

/// What is to be said of the map.
pub fn judge(wanted: &Wanted, map: &MapFacts) -> Finding {
    let topic = &map.topic;
    let name = format!("{} (~map_topic)", topic.topic);
    if topic.publishers.is_empty() {
        let what = format!("nobody publishes {name}; topics with maps: {}", offers(topic));
        return Finding::error(CHECK, what, another(wanted, topic));
    }
    let publishers = list(&topic.publishers);
    if let Some(kind) = topic.kind.as_deref().filter(|kind| *kind != KIND) {
        let what = format!("{name} of {publishers} is a {kind}, not a {KIND}; topics with maps: {}", offers(topic));
        return Finding::error(CHECK, what, another(wanted, topic));
    }
    let Some(seen) = &map.newest else {
        let silent = format!("no map has come on {name} for {:.0} s", topic.listened_s);
        return match &map.broken {
            Some(why) => {
                let what = format!("what {publishers} sends on {name} is no map: {why}");
                Finding::error(CHECK, what, "mend the node that sends it")
            }
            None => Finding::error(
                CHECK,
                format!("{silent}, though {publishers} publishes it"),
                format!("see the log of {publishers}: a SLAM needs scans and transforms before its first map"),
            ),
        };
    };
    let MapSeen { width, height, resolution_m, free, unknown } = seen;
    let again = map.period_s.map_or_else(String::new, |period_s| format!(", again after {period_s:.1} s"));
    let what = format!("{width} x {height} cells of {resolution_m:.3} m on {} of {publishers}{again}", topic.topic);
    if *free == 0 {
        let what = format!("{what}; none of them is free, and exploration begins on free ground");
        return Finding::warning(CHECK, what, "see whether scans reach the SLAM, and drive a little by hand");
    }
    if *unknown == 0 {
        let what = format!("{what}; none of them is unknown: there is nothing to explore");
        let remedy = "take the map of a SLAM that is still mapping, not a finished one of map_server, and not a \
                      costmap without track_unknown_space";
        return Finding::warning(CHECK, what, remedy);
    }
    Finding::ok(CHECK, what)
}

/// Which other topic to take: one that is no costmap, where there is one.
fn another(wanted: &Wanted, topic: &TopicFacts) -> String {
    let is_costmap = |name: &&str| name.contains("costmap");
    let maps = nearest(&topic.topic, topic.other_names().filter(|name| !is_costmap(name)));
    match maps.or_else(|| topic.other_names().find(|name| !is_costmap(name))) {
        Some(name) => set_param(&wanted.node, "map_topic", name),
        None => "start a SLAM such as gmapping or Cartographer".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::finding::FindingLevel::{Error, Ok, Warning};
    use super::super::testing::{nodes, wanted};
    use super::*;

    fn facts() -> MapFacts {
        let others = vec![("/map".to_owned(), nodes(&["/slam"])), ("/x/costmap".to_owned(), nodes(&["/x"]))];
        let (topic, kind) = ("/map".to_owned(), Some(KIND.to_owned()));
        let topic = TopicFacts { topic, kind, publishers: nodes(&["/slam"]), others, listened_s: 10.0 };
        let newest = Some(MapSeen { width: 608, height: 736, resolution_m: 0.05, free: 900, unknown: 9000 });
        MapFacts { topic, newest, broken: None, period_s: Some(2.04) }
    }

    #[test]
    fn a_map_that_comes_is_well() {
        let finding = judge(&wanted(), &facts());
        let what = "608 x 736 cells of 0.050 m on /map of /slam, again after 2.0 s";
        assert_eq!((finding.level, finding.what.as_str(), finding.remedy), (Ok, what, None));
    }

    #[test]
    fn a_wrong_topic_is_named_with_the_right_one() {
        let topic = TopicFacts { topic: "/mapp".to_owned(), publishers: nodes(&[]), ..facts().topic };
        let finding = judge(&wanted(), &MapFacts { topic, newest: None, ..facts() });
        assert_eq!(finding.level, Error);
        let what = "nobody publishes /mapp (~map_topic); topics with maps: /map (of /slam), /x/costmap (of /x)";
        assert_eq!(finding.what, what);
        assert!(finding.remedy.unwrap().starts_with("`rosparam set /explore/map_topic /map`"));
        let nothing = TopicFacts { topic: "/map".to_owned(), ..TopicFacts::default() };
        let finding = judge(&wanted(), &MapFacts { topic: nothing, ..MapFacts::default() });
        assert!(finding.what.ends_with("topics with maps: none"), "{finding:?}");
        assert!(finding.remedy.unwrap().starts_with("start a SLAM"));
    }

    #[test]
    fn other_types_silence_and_broken_maps_are_named() {
        let kind = TopicFacts { kind: Some("sensor_msgs/Image".to_owned()), ..facts().topic };
        let finding = judge(&wanted(), &MapFacts { topic: kind, ..facts() });
        assert!(finding.what.contains("is a sensor_msgs/Image, not a nav_msgs/OccupancyGrid"), "{finding:?}");
        let silent = judge(&wanted(), &MapFacts { newest: None, ..facts() });
        assert!(silent.level == Error && silent.what.contains("for 10 s, though /slam publishes it"), "{silent:?}");
        let broken = MapFacts { newest: None, broken: Some("too few cells".to_owned()), ..facts() };
        assert!(judge(&wanted(), &broken).what.ends_with("is no map: too few cells"));
    }

    #[test]
    fn maps_that_leave_nothing_to_explore_are_worth_a_warning() {
        let with = |free, unknown| {
            let newest = facts().newest.map(|seen| MapSeen { free, unknown, ..seen });
            judge(&wanted(), &MapFacts { newest, ..facts() })
        };
        assert_eq!((with(0, 5).level, with(5, 0).level, with(5, 5).level), (Warning, Warning, Ok));
    }
}
