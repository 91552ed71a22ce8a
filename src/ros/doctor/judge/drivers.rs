//! Whether somebody else drives the same robot.

use super::super::facts::{DriverFacts, Wanted};
use super::super::finding::Finding;
use crate::ros::directory::list;
use std::collections::BTreeSet;

const CHECK: &str = "explorers";

/// Two explorers on one robot take the goals from each other; other clients do so at times.
pub fn judge(wanted: &Wanted, drivers: &DriverFacts) -> Finding {
    let namespace = wanted.node.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    let is_beside = |node: &&String| node.rsplit_once('/').is_some_and(|(other, _)| other == namespace);
    let drives = |node: &&String| drivers.goal_clients.contains(*node) || drivers.velocity_clients.contains(*node);
    let ours = drivers.explorers.iter().filter(|node| drives(node) || is_beside(node));
    // Others may show frontiers as well: explore_lite sends goals.
    let here: BTreeSet<&String> = ours.chain(drivers.explore_lite.iter().filter(drives)).collect();
    if here.len() > 1 {
        let named: Vec<String> =
            here.iter()
                .map(|node| {
                    if drivers.explore_lite.contains(*node) {
                        format!("{node} (explore_lite)")
                    } else {
                        (*node).clone()
                    }
                })
                .collect();
        let what = format!("{} explorers drive one robot: {}", here.len(), list(&named));
        let spare = here.iter().find(|node| ***node != wanted.node).map_or("NODE", |node| node.as_str());
        return Finding::error(CHECK, what, format!("stop all but one: `rosnode kill {spare}`"));
    }
    let strangers: BTreeSet<&String> = drivers.goal_clients.iter().filter(|node| !here.contains(node)).collect();
    if !strangers.is_empty() {
        let what = format!("other clients may send goals to the same server: {}", list(strangers.iter().copied()));
        let remedy = "stop them while the robot explores: the server takes one goal at a time";
        return Finding::warning(CHECK, what, remedy);
    }
    Finding::ok(
        CHECK,
        match here.first() {
            Some(node) if **node == wanted.node => format!("{node} runs, and nobody else drives"),
            Some(node) => format!("{node} explores here, and {} does not run", wanted.node),
            None => format!("{} does not run yet, and nobody else drives", wanted.node),
        },
    )
}

#[cfg(test)]
mod tests {
    use super::super::super::finding::FindingLevel::{Error, Ok, Warning};
    use super::super::testing::{nodes, wanted};
    use super::*;

    fn check(explorers: &[&str], explore_lite: &[&str], goal_clients: &[&str]) -> Finding {
        let (explorers, explore_lite, goal_clients) = (nodes(explorers), nodes(explore_lite), nodes(goal_clients));
        judge(&wanted(), &DriverFacts { explorers, explore_lite, goal_clients, ..DriverFacts::default() })
    }

    #[test]
    fn one_explorer_or_none_is_well() {
        assert_eq!(check(&[], &[], &[]).level, Ok);
        assert_eq!(check(&["/explore"], &[], &["/explore"]).what, "/explore runs, and nobody else drives");
        assert_eq!(check(&["/explore", "/other/explore"], &[], &["/explore"]).level, Ok, "of another robot");
    }

    #[test]
    fn two_explorers_on_one_robot_are_an_error() {
        let two = check(&["/explore", "/second"], &[], &["/explore", "/second"]);
        assert_eq!((two.level, two.what.as_str()), (Error, "2 explorers drive one robot: /explore, /second"));
        assert_eq!(two.remedy.unwrap(), "stop all but one: `rosnode kill /second`");
        let lite = check(&["/explore"], &["/lite"], &["/explore", "/lite"]);
        assert_eq!(lite.what, "2 explorers drive one robot: /explore, /lite (explore_lite)");
        assert_eq!(check(&["/explore"], &["/viewer"], &["/explore"]).level, Ok, "it shows frontiers and sends no goal");
        assert_eq!(check(&["/a/x", "/b/x"], &[], &["/a/x", "/b/x"]).level, Error, "by one server");
        let velocities = DriverFacts {
            explorers: nodes(&["/a/x", "/explore"]),
            velocity_clients: nodes(&["/a/x"]),
            ..DriverFacts::default()
        };
        assert_eq!(judge(&wanted(), &velocities).level, Error, "by cmd_vel");
    }

    #[test]
    fn other_clients_are_named() {
        let other = check(&["/explore"], &[], &["/explore", "/patrol"]);
        assert!(other.level == Warning && other.what.ends_with("the same server: /patrol"), "{other:?}");
    }
}
