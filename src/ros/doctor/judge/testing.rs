//! What the tests of the judgements begin with: all is well.

use super::super::facts::{OwnOutline, PlanAnswer, ServerFacts, Wanted};
use std::collections::BTreeSet;

pub fn nodes(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(|name| (*name).to_owned()).collect()
}

pub fn wanted() -> Wanted {
    Wanted {
        node: "/explore".to_owned(),
        map_topic: "/map".to_owned(),
        base_frame: "base_link".to_owned(),
        tolerance_s: 0.5,
        move_base: Some("/move_base".to_owned()),
        plans_on_costmap: false,
        scan_topic: Some("/scan".to_owned()),
        outline: OwnOutline { robot: "turtlebot2".to_owned(), inscribed_m: 0.18, circumscribed_m: 0.18 },
    }
}

pub fn server() -> ServerFacts {
    let topics = ["goal", "cancel", "status", "feedback", "result"];
    ServerFacts {
        name: "/move_base".to_owned(),
        served: topics.map(|topic| (topic, nodes(&["/move_base"]))).to_vec(),
        has_told: true,
        under_way: Vec::new(),
        others: vec!["/move_base".to_owned()],
        make_plan: PlanAnswer::Plan(7),
    }
}
