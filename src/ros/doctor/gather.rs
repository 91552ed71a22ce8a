//! Looks and listens for some seconds of real time.

use super::costmap_params::CostmapParams;
use super::ears::{Ears, costmap_topic, lock};
use super::facts::{
    ClockFacts, CostmapFacts, DriverFacts, Facts, FrameFacts, MapFacts, PlanAnswer, ScanFacts, ServerFacts, TopicFacts,
    Wanted,
};
use crate::geometry::Pose;
use crate::grid::unknown_share_hidden_by;
use crate::ros::call::{CallError, call};
use crate::ros::clock_watch::ClockWatch;
use crate::ros::convert;
use crate::ros::directory::Listing;
use crate::ros::msg::nav_msgs::{GetPlan, GetPlanReq};
use crate::ros::node::Node;
use crate::tf::frame_name;
use std::collections::BTreeSet;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The master is asked for so long at the most before there is nothing to say.
const MASTER_LIMIT: Duration = Duration::from_secs(5);
/// How old an answer of the master may be while there is listened.
const LISTING_AGE: Duration = Duration::from_secs(1);
/// So long is listened even where everything has come: a clock takes two seconds to stand.
const LISTEN_AT_LEAST: Duration = Duration::from_millis(2800);
/// So long is waited for transforms that do not lead anywhere yet.
const FRAMES_LIMIT: Duration = Duration::from_secs(5);
/// A transform that is late for a moment is waited for so long.
const LATE_TRANSFORM: Duration = Duration::from_millis(400);
/// How long `make_plan` may think.
const PLAN_LIMIT: Duration = Duration::from_secs(3);
/// From one look to the next.
const SLICE: Duration = Duration::from_millis(50);

/// Looks at what is wanted, for `limit` and some seconds at the most.
///
/// # Errors
/// A sentence when the master does not tell what there is.
pub fn gather(node: &Node, wanted: &Wanted, limit: Duration) -> Result<Facts, String> {
    let first = listing_within(node, MASTER_LIMIT).ok_or("the ROS master does not tell its topics")?;
    let ears = Ears::open(node, wanted, &first);
    let began = Instant::now();
    // Before the first message of /clock there is no time to begin with.
    let mut clock_began = None;
    let (mut watch, mut listing) = (ClockWatch::new(), first);
    let is_simulated = node.is_simulated_time();
    loop {
        std::thread::sleep(SLICE);
        let now_s = node.now_s();
        watch.stands_for(now_s);
        if now_s > 0.0 {
            clock_began.get_or_insert((Instant::now(), now_s));
        }
        listing = node.listing(LISTING_AGE).unwrap_or(listing);
        let elapsed = began.elapsed();
        let frames_done = elapsed >= FRAMES_LIMIT || pose(node, wanted, &ears).is_ok();
        let clock_done = !is_simulated || node.now_s() > 0.0 || elapsed >= FRAMES_LIMIT;
        let is_done = clock_done && frames_done && ears.have_heard(wanted, &listing);
        if !node.is_ok() || elapsed >= limit || (elapsed >= LISTEN_AT_LEAST && is_done) {
            break;
        }
    }
    let (now_s, listened_s) = (node.now_s(), began.elapsed().as_secs_f64());
    let clock = ClockFacts {
        is_simulated,
        publishers: listing.publishers("/clock"),
        now_s,
        stands_s: watch.stands_for(now_s).as_secs_f64(),
        pace: clock_began.map_or(0.0, |(at, began_s)| (now_s - began_s) / at.elapsed().as_secs_f64()),
    };
    let frames = frame_facts(node, wanted, &ears, &listing);
    let topic = |name: &str, kind: &str| topic_facts(&listing, name, kind, listened_s);
    let map = {
        let heard = lock(&ears.map);
        MapFacts {
            topic: topic(&wanted.map_topic, "nav_msgs/OccupancyGrid"),
            newest: heard.seen(),
            broken: heard.broken.clone(),
            period_s: heard.period_s(),
        }
    };
    let server = wanted.move_base.as_ref().map(|name| server_facts(node, wanted, name, &ears, &listing));
    let costmap = wanted.move_base.as_ref().map(|name| {
        let topic = topic(&costmap_topic(name), "nav_msgs/OccupancyGrid");
        costmap_facts(node, name, topic, &ears)
    });
    let scans = wanted
        .scan_topic
        .as_ref()
        .map(|name| ScanFacts { topic: topic(name, "sensor_msgs/LaserScan"), last: lock(&ears.scan).clone() });
    let drivers = driver_facts(wanted, &listing, server.as_ref());
    Ok(Facts { clock, map, frames, server, costmap, drivers, scans })
}

fn listing_within(node: &Node, limit: Duration) -> Option<Arc<Listing>> {
    let mut listing = None;
    node.wait_until(limit, || {
        listing = node.listing(LISTING_AGE);
        listing.is_some()
    });
    listing
}

fn topic_facts(listing: &Listing, topic: &str, kind: &str, listened_s: f64) -> TopicFacts {
    TopicFacts {
        topic: topic.to_owned(),
        kind: listing.type_of(topic).map(ToOwned::to_owned),
        publishers: listing.publishers(topic),
        others: listing.published(kind).map(|(topic, nodes)| (topic.to_owned(), nodes.clone())).collect(),
        listened_s,
    }
}

fn pose(node: &Node, wanted: &Wanted, ears: &Ears) -> Result<Pose, crate::robot::PoseError> {
    ears.transforms.robot(&ears.map_frame(), &wanted.base_frame, node.now_s(), wanted.tolerance_s)
}

fn frame_facts(node: &Node, wanted: &Wanted, ears: &Ears, listing: &Listing) -> FrameFacts {
    let mut found = pose(node, wanted, ears);
    let began = Instant::now();
    while found.is_err() && began.elapsed() < LATE_TRANSFORM {
        std::thread::sleep(SLICE);
        found = pose(node, wanted, ears);
    }
    let (map_frame, known) = (ears.map_frame(), ears.transforms.names());
    let has = if known.is_empty() { "no frame yet".to_owned() } else { known.join(", ") };
    let lacking: Vec<&str> = [map_frame.as_str(), wanted.base_frame.as_str()]
        .into_iter()
        .filter(|frame| !known.iter().any(|name| name == frame_name(frame)))
        .collect();
    let links = ears.transforms.links(&map_frame, &wanted.base_frame).map_err(|error| match lacking[..] {
        [] => error.to_string(),
        _ => format!("tf does not know {}; it has {has}", lacking.join(" and ")),
    });
    FrameFacts {
        base_frame: wanted.base_frame.clone(),
        links,
        pose: (node.now_s() > 0.0).then(|| found.map(|_| ())),
        publishers: listing.publishers("/tf"),
        map_frame,
        known,
    }
}

fn server_facts(node: &Node, wanted: &Wanted, name: &str, ears: &Ears, listing: &Listing) -> ServerFacts {
    let topic = |part: &str| format!("{name}/{part}");
    let heard = ["goal", "cancel"].map(|part| (part, listing.subscribers(&topic(part))));
    let told = ["status", "feedback", "result"].map(|part| (part, listing.publishers(&topic(part))));
    let (has_told, under_way) = {
        let status = lock(&ears.status);
        (status.has_come, status.under_way.clone())
    };
    let mut server = ServerFacts {
        name: name.to_owned(),
        served: heard.into_iter().chain(told).collect(),
        has_told,
        under_way,
        others: listing.driving_servers().into_iter().collect(),
        make_plan: PlanAnswer::NotAsked,
    };
    if !server.whole().is_empty() {
        server.make_plan = make_plan(node, wanted, &server, ears, listing);
    }
    server
}

/// Asks for the way to where the robot is, which is short.
fn make_plan(node: &Node, wanted: &Wanted, server: &ServerFacts, ears: &Ears, listing: &Listing) -> PlanAnswer {
    let service = format!("{}/make_plan", server.name);
    if listing.servers(&service).is_empty() {
        return PlanAnswer::Absent;
    }
    if !server.under_way.is_empty() {
        return PlanAnswer::Busy;
    }
    let Ok(place) = pose(node, wanted, ears) else { return PlanAnswer::NotAsked };
    let frame = ears.map_frame();
    // An empty frame of the start means where the robot is.
    let request =
        GetPlanReq { goal: convert::stamped(&place, &frame, node.now_s()), tolerance: 0.0, ..GetPlanReq::default() };
    match call::<GetPlan>(node, &service, request, PLAN_LIMIT) {
        Ok(answer) => PlanAnswer::Plan(answer.plan.poses.len()),
        Err(CallError::Absent { .. }) => PlanAnswer::Absent,
        Err(error) => PlanAnswer::Failed(error.to_string()),
    }
}

fn costmap_facts(node: &Node, server: &str, topic: TopicFacts, ears: &Ears) -> CostmapFacts {
    let params = node.params_below(&format!("{server}/global_costmap")).unwrap_or_default();
    let (costmap, map) = (lock(&ears.costmap), lock(&ears.map));
    let hidden_unknown = match (&costmap.newest, &map.newest) {
        (Some((costs, frame)), Some((grid, map_frame))) if frame_name(frame) == frame_name(map_frame) => {
            unknown_share_hidden_by(costs, grid)
        }
        _ => None,
    };
    CostmapFacts { topic, has_come: costmap.newest.is_some(), hidden_unknown, params: CostmapParams::of(&params) }
}

fn driver_facts(wanted: &Wanted, listing: &Listing, server: Option<&ServerFacts>) -> DriverFacts {
    let published = |kind| listing.published(kind);
    let explorers: BTreeSet<String> =
        published("frontier_explorer/ExplorationStatus").flat_map(|(_, nodes)| nodes.clone()).collect();
    let shows_frontiers =
        published("visualization_msgs/MarkerArray").filter(|(topic, _)| topic.ends_with("/frontiers"));
    let explore_lite = shows_frontiers.flat_map(|(_, nodes)| nodes.clone()).filter(|node| !explorers.contains(node));
    let serving = server.map(ServerFacts::whole).unwrap_or_default();
    let clients = |topic: String| listing.publishers(&topic).difference(&serving).cloned().collect();
    let namespace = wanted.node.rsplit_once('/').map_or("", |(namespace, _)| namespace);
    DriverFacts {
        explore_lite: explore_lite.collect(),
        explorers,
        goal_clients: server.map(|server| clients(format!("{}/goal", server.name))).unwrap_or_default(),
        velocity_clients: clients(format!("{namespace}/cmd_vel")),
    }
}
