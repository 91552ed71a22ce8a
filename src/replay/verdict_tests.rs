//! What can be done with bags that lack something, and what is said of it.

use super::*;
use crate::bag::FrameLink;
use crate::replay::Wanted;

/// A bag with scans of `laser` and these transforms, child below parent; those to `odom` and
/// `base_link` move.
fn bag(links: &[(&str, &str)], map_frame: Option<&str>) -> Summary {
    let topic = |topic: &str, kind: MessageType, frame: &str| TopicSummary {
        topic: topic.to_owned(),
        kind: kind.name().to_owned(),
        md5: kind.md5().to_owned(),
        messages: 100,
        frames: [frame.to_owned()].into(),
        frame: frame.to_owned(),
        ..TopicSummary::default()
    };
    let link = |parent: &str, child: &str| FrameLink {
        parent: parent.to_owned(),
        is_static: !["odom", "base_link"].contains(&child),
        messages: 10,
        ..FrameLink::default()
    };
    let map = map_frame.map(|frame| topic("/map", MessageType::Map, frame));
    Summary {
        topics: map.into_iter().chain([topic("/scan", MessageType::Scan, "laser")]).collect(),
        tf: links.iter().map(|(parent, child)| ((*child).to_owned(), link(parent, child))).collect(),
        ..Summary::default()
    }
}

fn verdict(summary: &Summary) -> Verdict {
    Verdict::of(summary, &Inputs::of(summary, &Wanted::default()).unwrap())
}

#[test]
fn odometry_suffices_where_nobody_localised() {
    let bag = bag(&[("odom", "base_link"), ("base_link", "laser")], Some("map"));
    let said = verdict(&bag);
    assert_eq!(said.map_build, Ok("with the scans on /scan and base_link".to_owned()));
    let missing = said.replay.unwrap_err();
    assert_eq!(
        missing,
        "map is not in tf: nothing leads from the map (map) to the robot (base_link); \
         its scans make a map with --map-from-scans"
    );
    let mut inputs = Inputs::of(&bag, &Wanted::default()).unwrap();
    inputs.forget_map();
    assert_eq!((inputs.map_frame.as_deref(), inputs.odom_frame.as_deref()), (Some("odom"), Some("odom")));
    assert!(Verdict::of(&bag, &inputs).replay.is_ok());
}

#[test]
fn a_lidar_outside_of_tf_is_named() {
    for map in [None, Some("map")] {
        let said = verdict(&bag(&[("map", "odom"), ("odom", "base_link")], map));
        let missing = said.map_build.unwrap_err();
        assert!(missing.starts_with("laser is not in tf: nothing leads from the robot (base_link) to the lidar"));
        assert!(missing.contains("record /tf_static too"), "{missing}");
        assert_eq!(said.replay.is_ok(), map.is_some(), "a recorded map needs no scans");
    }
}

#[test]
fn trees_apart_are_named() {
    let said = verdict(&bag(&[("odom", "base_link"), ("base_link", "laser"), ("map", "cup")], Some("map")));
    let missing = said.replay.unwrap_err();
    assert!(missing.starts_with("tf does not connect the trees of map and odom"), "{missing}");
    assert!(verdict(&bag(&[], None)).map_build.unwrap_err().contains("the bag holds no transforms"));
}

#[test]
fn a_topic_that_cannot_be_understood_is_no_input() {
    let mut bag = bag(&[("map", "odom"), ("odom", "base_link"), ("base_link", "laser")], Some("map"));
    if let Some(map) = bag.topics.first_mut() {
        (map.malformed, map.first_fault) = (100, Some("no numbers".to_owned()));
    }
    let missing = verdict(&bag).replay.unwrap_err();
    assert!(missing.starts_with("none of the 100 messages on /map can be understood: no numbers"), "{missing}");
}
