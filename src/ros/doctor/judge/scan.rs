//! The scans, where our own driving, backing off or a detector needs them.

use super::super::facts::{ScanFacts, Wanted};
use super::super::finding::Finding;
use super::words::offers;
use crate::ros::directory::list;

const CHECK: &str = "scan";
const KIND: &str = "sensor_msgs/LaserScan";

/// What is to be said of the scans: an error where they are driven by, else a warning.
pub fn judge(wanted: &Wanted, scans: &ScanFacts) -> Finding {
    let topic = &scans.topic;
    let name = &topic.topic;
    let bad = |what: String, remedy: String| {
        if wanted.move_base.is_none() {
            Finding::error(CHECK, what, remedy)
        } else {
            Finding::warning(CHECK, format!("{what}; without scans the robot does not back off"), remedy)
        }
    };
    if topic.publishers.is_empty() {
        let other = topic.other_names().next().unwrap_or("/OTHER");
        let remedy = format!("start the lidar's driver, or remap: `scan:={other}` for explore_node");
        return bad(format!("nobody publishes {name}; topics with scans: {}", offers(topic)), remedy);
    }
    let publishers = list(&topic.publishers);
    if let Some(kind) = topic.kind.as_deref().filter(|kind| *kind != KIND) {
        return bad(
            format!("{name} of {publishers} is a {kind}, not a {KIND}"),
            "remap scan to the right topic".to_owned(),
        );
    }
    match &scans.last {
        None => bad(
            format!("no scan has come on {name} for {:.0} s, though {publishers} publishes it", topic.listened_s),
            format!("see the log of {publishers}"),
        ),
        Some(Err(why)) => bad(
            format!("the scans on {name} show nothing: {why}"),
            format!("see whether the lidar is covered, and what range_min and range_max {publishers} tells"),
        ),
        Some(Ok(())) => Finding::ok(CHECK, format!("{name} of {publishers} shows something")),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::facts::TopicFacts;
    use super::super::super::finding::FindingLevel::{Error, Ok as Well, Warning};
    use super::super::testing::{nodes, wanted};
    use super::*;

    fn facts() -> ScanFacts {
        let (topic, kind) = ("/scan".to_owned(), Some(KIND.to_owned()));
        let topic =
            TopicFacts { topic, kind, publishers: nodes(&["/lidar"]), listened_s: 10.0, ..TopicFacts::default() };
        ScanFacts { topic, last: Some(Ok(())) }
    }

    #[test]
    fn scans_that_show_something_are_well() {
        assert_eq!(judge(&wanted(), &facts()).level, Well);
    }

    #[test]
    fn missing_and_blind_scans_are_graver_where_we_drive_by_them() {
        let own = Wanted { move_base: None, ..wanted() };
        let others = vec![("/front".to_owned(), nodes(&["/lidar"]))];
        let topic = TopicFacts { publishers: nodes(&[]), others, ..facts().topic };
        let missing = ScanFacts { topic, last: None };
        let finding = judge(&own, &missing);
        assert_eq!(finding.level, Error);
        assert_eq!(finding.what, "nobody publishes /scan; topics with scans: /front (of /lidar)");
        assert!(finding.remedy.unwrap().contains("scan:=/front"));
        assert_eq!(judge(&wanted(), &missing).level, Warning);
        let blind = judge(&own, &ScanFacts { last: Some(Err("all NaN".to_owned())), ..facts() });
        assert_eq!(blind.what, "the scans on /scan show nothing: all NaN");
        let silent = judge(&own, &ScanFacts { last: None, ..facts() });
        assert!(silent.what.contains("no scan has come on /scan for 10 s"), "{silent:?}");
        let kind = TopicFacts { kind: Some("std_msgs/Bool".to_owned()), ..facts().topic };
        assert!(judge(&own, &ScanFacts { topic: kind, ..facts() }).what.contains("is a std_msgs/Bool"));
    }
}
