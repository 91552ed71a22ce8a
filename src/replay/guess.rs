//! Guesses at topics and frames by their types and names.

use crate::bag::{MessageType, Summary};
use crate::tf::frame_name;
use std::collections::{BTreeMap, BTreeSet};

/// All frames that tf names.
pub fn frames(summary: &Summary) -> BTreeSet<&str> {
    summary.tf.iter().flat_map(|(child, link)| [child.as_str(), link.parent.as_str()]).collect()
}

/// The topic of a type with the lowest rank, and among those the most messages.
pub fn best(summary: &Summary, kind: MessageType, rank: impl Fn(&str) -> Option<u32>) -> Option<String> {
    let topics = summary.topics_of(kind);
    let ranked = topics.iter().filter_map(|t| rank(&t.topic).map(|rank| (rank, t)));
    ranked.min_by_key(|(rank, _)| *rank).map(|(_, t)| t.topic.clone())
}

/// A map is called so; a costmap is none, unless there is nothing else.
pub fn map_rank(topic: &str) -> Option<u32> {
    let last = topic.rsplit('/').next().unwrap_or_default();
    Some(match last {
        "map" if topic == "/map" => 0,
        "map" => 1,
        _ if topic.contains("local_costmap") => return None,
        _ if topic.contains("costmap") => 3,
        _ => 2,
    })
}

/// The frame in most of the map's headers; without a map, the root above `odom`, or `odom`.
pub fn map_frame(summary: &Summary, map_topic: Option<&str>) -> Option<String> {
    let headers = map_topic.and_then(|topic| summary.topics.iter().find(|t| t.topic == topic));
    let named = headers.and_then(|t| [&t.frame].into_iter().chain(&t.frames).find(|name| !frame_name(name).is_empty()));
    if let Some(frame) = named {
        return Some(frame_name(frame).to_owned());
    }
    let frames = frames(summary);
    let odom = frames.iter().find(|name| name.rsplit('/').next() == Some("odom"));
    if let Some(odom) = odom {
        return Some((*odom).to_owned());
    }
    // The root of the tree with the most transforms.
    let moving = summary.tf.iter().filter(|(_, link)| !link.is_static).max_by_key(|(_, link)| link.messages);
    moving.map(|(child, _)| chain(summary, child).last().map_or(child.as_str(), |&root| root).to_owned())
}

/// The frames above one, the nearest first.
fn chain<'a>(summary: &'a Summary, frame: &str) -> Vec<&'a str> {
    let mut above: Vec<&str> = Vec::new();
    let mut at = frame;
    while let Some(link) = summary.tf.get(at) {
        if above.len() > 64 {
            break;
        }
        above.push(link.parent.as_str());
        at = &link.parent;
    }
    above
}

/// The top of the tree that a frame is in.
pub fn root<'a>(summary: &'a Summary, frame: &'a str) -> &'a str {
    chain(summary, frame).last().copied().unwrap_or(frame)
}

/// Whether tf leads from one frame to another.
pub fn is_connected(summary: &Summary, a: &str, b: &str) -> bool {
    let is_known = |frame: &str| frames(summary).contains(frame);
    is_known(a) && is_known(b) && root(summary, a) == root(summary, b)
}

/// The frames whose places in their parents lead from one frame to another.
pub fn between<'a>(summary: &'a Summary, a: &'a str, b: &'a str) -> Vec<&'a str> {
    let up = |frame: &'a str| {
        let mut all = vec![frame];
        all.extend(chain(summary, frame));
        all
    };
    let (mut from_a, mut from_b) = (up(a), up(b));
    while from_a.last().is_some() && from_a.last() == from_b.last() {
        from_a.pop();
        from_b.pop();
    }
    from_a.append(&mut from_b);
    from_a
}

/// The frame above the robot that is called `odom`.
pub fn odom_frame(summary: &Summary, base_frame: &str) -> Option<String> {
    let above = chain(summary, base_frame);
    above.into_iter().find(|name| name.rsplit('/').next() == Some("odom")).map(str::to_owned)
}

/// The robot's frame: named as REP 105 has it, or the frame below the map in which most of
/// the tree hangs.
pub fn base_frame(summary: &Summary, map_frame: &str) -> Option<String> {
    let tree = root(summary, map_frame);
    let names: Vec<&str> = summary.tf.keys().map(String::as_str).filter(|name| root(summary, name) == tree).collect();
    for usual in ["base_footprint", "base_link", "base"] {
        if let Some(found) = names.iter().find(|name| name.rsplit('/').next() == Some(usual)) {
            return Some((*found).to_owned());
        }
    }
    let below = names.into_iter().filter(|name| chain(summary, name).contains(&map_frame));
    let moving = below.filter(|name| summary.tf.get(*name).is_some_and(|link| !link.is_static));
    moving.max_by_key(|name| (chain(summary, name).len(), std::cmp::Reverse(*name))).map(str::to_owned)
}

/// The top of the tree with the most transforms that move, where odometry is without a map.
pub fn odometry_root(summary: &Summary) -> Option<&str> {
    let mut messages = BTreeMap::<&str, u64>::new();
    for (child, link) in summary.tf.iter().filter(|(_, link)| !link.is_static) {
        *messages.entry(root(summary, child)).or_default() += link.messages;
    }
    messages.into_iter().max_by_key(|(name, count)| (*count, std::cmp::Reverse(*name))).map(|(name, _)| name)
}
