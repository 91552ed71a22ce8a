//! move_base: its action, its service, and goals under way.

use super::super::facts::{PlanAnswer, ServerFacts, Wanted};
use super::super::finding::Finding;
use super::words::{nearest, set_param};
use crate::ros::directory::list;

/// Whether there is such a server.
pub fn judge(wanted: &Wanted, server: &ServerFacts) -> Finding {
    const CHECK: &str = "move_base";
    let name = &server.name;
    let whole = server.whole();
    if !whole.is_empty() {
        let nodes = list(&whole);
        return if server.has_told {
            Finding::ok(CHECK, format!("{nodes} serves the action {name}"))
        } else {
            let what = format!("{nodes} offers the action {name} and tells no status: it hangs");
            Finding::error(CHECK, what, format!("start {nodes} again"))
        };
    }
    if server.served.iter().all(|(_, nodes)| nodes.is_empty()) {
        let others = list(&server.others);
        let what = format!("no action server is called {name} (~move_base); action servers that drive: {others}");
        let remedy = match nearest(name, server.others.iter().map(String::as_str))
            .or(server.others.first().map(String::as_str))
        {
            Some(other) => set_param(&wanted.node, "move_base", other),
            None => "start move_base; or let explore_node drive itself: `~navigation/drive: internal`".to_owned(),
        };
        return Finding::error(CHECK, what, remedy);
    }
    let lacking = server.served.iter().filter(|(_, nodes)| nodes.is_empty()).map(|(topic, _)| *topic);
    let lacking: Vec<String> = lacking.map(|topic| format!("{name}/{topic}")).collect();
    let what = if lacking.is_empty() {
        format!("no single node serves all topics of the action {name}")
    } else {
        format!("the action server {name} is not whole: nobody serves {}", list(&lacking))
    };
    Finding::error(CHECK, what, "start it again, and see that nothing remaps some of its topics alone")
}

/// Whether `make_plan` answers.
pub fn judge_make_plan(server: &ServerFacts) -> Finding {
    const CHECK: &str = "make_plan";
    let service = format!("{}/make_plan", server.name);
    let fallback = "without it our own planner decides what can be reached";
    match &server.make_plan {
        PlanAnswer::Plan(0) => Finding::warning(
            CHECK,
            format!("{service} finds no way to the robot's own place: move_base takes it for an obstacle"),
            format!(
                "look at its global costmap in RViz: `rosservice call {}/clear_costmaps` clears what is no more; \
                 see whether footprint and inflation fit the robot",
                server.name
            ),
        ),
        PlanAnswer::Plan(_) => Finding::ok(CHECK, format!("{service} answers")),
        PlanAnswer::Busy => {
            Finding::ok(CHECK, format!("{service} is there, and answers nobody while a goal is under way"))
        }
        PlanAnswer::NotAsked => Finding::ok(CHECK, format!("{service} was not asked: the robot's place is not known")),
        PlanAnswer::Absent => {
            Finding::warning(CHECK, format!("nobody offers {service}: {fallback}"), "leave ~check_with_make_plan false")
        }
        PlanAnswer::Failed(why) => {
            let what = format!("{service} does not answer: {why}; {fallback}");
            Finding::warning(CHECK, what, "see the log of move_base; leave ~check_with_make_plan false")
        }
    }
}

/// Whether the server is free.
pub fn judge_goals(wanted: &Wanted, server: &ServerFacts) -> Finding {
    const CHECK: &str = "goals";
    let is_ours = |id: &String| id.starts_with(&format!("{}-", wanted.node));
    let (ours, others): (Vec<_>, Vec<_>) = server.under_way.iter().partition(|id| is_ours(id));
    if !others.is_empty() {
        let what = format!("a goal of somebody else is under way: {}", list(others));
        let remedy = format!(
            "stop its client, or cancel it: `rostopic pub -1 {}/cancel actionlib_msgs/GoalID -- {{}}`",
            server.name
        );
        return Finding::warning(CHECK, what, remedy);
    }
    Finding::ok(CHECK, if ours.is_empty() { "no goal is under way" } else { "the goal under way is the node's own" })
}

#[cfg(test)]
mod tests {
    use super::super::super::finding::FindingLevel::{Error, Ok, Warning};
    use super::super::testing::{server, wanted};
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn a_whole_server_that_tells_its_status_is_well() {
        assert_eq!(judge(&wanted(), &server()).what, "/move_base serves the action /move_base");
        let hanging = judge(&wanted(), &ServerFacts { has_told: false, ..server() });
        assert!(hanging.level == Error && hanging.what.contains("tells no status"), "{hanging:?}");
    }

    #[test]
    fn a_wrong_name_comes_with_the_server_that_there_is() {
        let served = server().served.into_iter().map(|(topic, _)| (topic, BTreeSet::new())).collect();
        let absent = ServerFacts { name: "/move_bse".to_owned(), served, has_told: false, ..server() };
        let finding = judge(&wanted(), &absent);
        let what = "no action server is called /move_bse (~move_base); action servers that drive: /move_base";
        assert_eq!((finding.level, finding.what.as_str()), (Error, what));
        assert!(finding.remedy.unwrap().starts_with("`rosparam set /explore/move_base /move_base`"));
        let none = judge(&wanted(), &ServerFacts { others: Vec::new(), ..absent });
        assert!(none.remedy.unwrap().starts_with("start move_base"));
    }

    #[test]
    fn a_server_that_lacks_a_topic_is_not_whole() {
        let mut lacking = server();
        lacking.served[4].1.clear();
        let finding = judge(&wanted(), &lacking);
        let what = "the action server /move_base is not whole: nobody serves /move_base/result";
        assert_eq!((finding.level, finding.what.as_str()), (Error, what));
    }

    #[test]
    fn make_plan_is_judged_by_its_answer() {
        let with = |make_plan| judge_make_plan(&ServerFacts { make_plan, ..server() });
        assert_eq!(with(PlanAnswer::Plan(7)).level, Ok);
        assert_eq!(with(PlanAnswer::Busy).level, Ok);
        assert_eq!(with(PlanAnswer::NotAsked).level, Ok);
        assert!(with(PlanAnswer::Plan(0)).what.contains("no way to the robot's own place"));
        assert_eq!(with(PlanAnswer::Absent).level, Warning);
        assert!(with(PlanAnswer::Failed("late".to_owned())).what.contains("does not answer: late"));
    }

    #[test]
    fn a_goal_of_somebody_else_is_named() {
        let with = |id: &str| judge_goals(&wanted(), &ServerFacts { under_way: vec![id.to_owned()], ..server() });
        assert_eq!(judge_goals(&wanted(), &server()).what, "no goal is under way");
        assert_eq!(with("/explore-1-12.5").level, Ok);
        let other = with("/patrol-1-12.5");
        assert!(other.level == Warning && other.what.ends_with("under way: /patrol-1-12.5"), "{other:?}");
        assert!(other.remedy.unwrap().contains("rostopic pub -1 /move_base/cancel"));
    }
}
