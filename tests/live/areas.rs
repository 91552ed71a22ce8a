//! Regions and no-go areas set while the node runs, in any frame, and what is shown of them.

use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{SOON, Test, World};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::geometry_msgs::{Point32, PointStamped, Polygon, PolygonStamped, TransformStamped};
use frontier_explorer::ros::msg::move_base_msgs::MoveBaseActionGoal;
use frontier_explorer::ros::msg::tf2_msgs::TFMessage;
use frontier_explorer::ros::msg::visualization_msgs::{Marker, MarkerArray};

pub const TESTS: &[Test] = &[
    ("explores_a_region_given_in_another_frame", other_frame),
    ("a_no_go_area_added_while_it_runs_is_kept_out_of", no_go_while_running),
    ("areas_are_drawn_taken_back_and_cleared_by_clicks", clicks),
    ("what_failed_is_shown_with_the_reason", blacklist),
];

fn polygon(frame: &str, corners: &[(f32, f32)]) -> PolygonStamped {
    let points = corners.iter().map(|&(x, y)| Point32 { x, y, z: 0.0 }).collect();
    let mut message = PolygonStamped { polygon: Polygon { points }, ..PolygonStamped::default() };
    message.header.frame_id = frame.to_owned();
    message
}

/// The left room of the house, as the frame `site` has it: its origin lies at (3.7, 0) m of the map,
/// turned by a quarter.
fn other_frame(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let shown = Heard::<PolygonStamped>::on(&world.probe, "/explore/region");
    let fixed = world.probe.publish_latched::<TFMessage>("/tf_static").unwrap();
    let mut site = TransformStamped { child_frame_id: "site".to_owned(), ..TransformStamped::default() };
    site.header.frame_id = "map".to_owned();
    (site.transform.translation.x, site.transform.rotation.w) = (3.7, 0.5_f64.sqrt());
    site.transform.rotation.z = 0.5_f64.sqrt();
    fixed.send(TFMessage { transforms: vec![site] }).unwrap();
    let regions = world.probe.publish_latched::<PolygonStamped>("/explore/set_region").unwrap();
    regions.send(polygon("site", &[(0.0, 0.0), (3.5, 0.0), (3.5, 3.7), (0.0, 3.7)])).unwrap();
    let _sim = world.simulate_kindly(&[]);
    let mut explore = world.explore(&["_exit_when_done:=false"]);
    let region = shown.expect(SOON, "the region", |m| m.polygon.points.len() == 4);
    let corners: Vec<(f32, f32)> = region.polygon.points.iter().map(|p| (p.x, p.y)).collect();
    let expected: [(f32, f32); 4] = [(3.7, 0.0), (3.7, 3.5), (0.0, 3.5), (0.0, 0.0)];
    let is_near = |(a, b): (&(f32, f32), &(f32, f32))| (a.0 - b.0).abs() < 1e-3 && (a.1 - b.1).abs() < 1e-3;
    assert!(corners.iter().zip(&expected).all(is_near), "{corners:?}");
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "outside_region", "{}", explore.log());
    // The room has 3.5 x 3.1 m, and its walls are known as well.
    assert!(end.known_area_m2 < 3.7 * 3.5 && end.known_area_m2 > 10.0, "{} m2", end.known_area_m2);
    regions.send(polygon("nowhere", &[(0.0, 0.0), (9.0, 0.0), (9.0, 9.0)])).unwrap();
    explore
        .expect_log("the corners on ~set_region cannot be brought from the frame nowhere to the map's frame map", SOON);
    // Without a region the rest of the house is explored.
    regions.send(polygon("", &[])).unwrap();
    status.expect(DEADLINE, "another end", |m| m.end_reason == "complete" && m.known_area_m2 > 20.0);
    explore.signal("INT");
    explore.expect_code(0, SOON);
}

/// The door between the rooms is closed while the robot looks round.
fn no_go_while_running(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let goals = Heard::<MoveBaseActionGoal>::on(&world.probe, "/move_base/goal");
    let no_go = world.probe.publish_latched::<PolygonStamped>("/explore/add_no_go").unwrap();
    let _sim = world.simulate_kindly(&["_speed:=2.0"]);
    let mut explore = world.explore(&[]);
    status.expect(SOON, "a turn", |m| m.phase == ExplorationStatus::TURNING);
    no_go.send(polygon("map", &[(3.6, 0.0), (4.2, 0.0), (4.2, 3.5), (3.6, 3.5)])).unwrap();
    let end = status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "outside_region", "{}", explore.log());
    assert!(end.message.contains("or in no-go areas"), "{}", end.message);
    assert!(explore.log().contains("a no-go area is kept out of from now on: there are 1"), "{}", explore.log());
    let x = |m: &MoveBaseActionGoal| m.goal.target_pose.pose.position.x;
    assert!(goals.all().iter().all(|m| x(m) < 3.6), "{:?}", goals.all().iter().map(x).collect::<Vec<_>>());
    explore.expect_code(0, SOON);
}

/// How many corners the drawing has, from the newest markers.
fn drawn(markers: &Heard<MarkerArray>) -> usize {
    let is_drawing = |m: &&Marker| m.ns == "drawing" && m.type_ == i32::from(Marker::SPHERE_LIST) && m.action == 0;
    markers.last().and_then(|m| m.markers.iter().find(is_drawing).map(|m| m.points.len())).unwrap_or(0)
}

/// How many outlines of a kind there are.
fn outlines(markers: &Heard<MarkerArray>, ns: &str) -> usize {
    markers.last().map_or(0, |m| m.markers.iter().filter(|m| m.ns == ns && m.action == 0).count())
}

fn clicks(world: &World) {
    let markers = Heard::<MarkerArray>::on(&world.probe, "/explore/areas");
    let shown = Heard::<PolygonStamped>::on(&world.probe, "/explore/region");
    let region = world.probe.publish::<PointStamped>("/clicked_point", 5).unwrap();
    let no_go = world.probe.publish::<PointStamped>("/explore/no_go_point", 5).unwrap();
    let _sim = world.simulate_kindly(&[]);
    let explore = world.explore(&["_exit_when_done:=false"]);
    markers.expect(SOON, "markers", |_| true);
    eventually(SOON, || region.subscriber_count() > 0 && no_go.subscriber_count() > 0, || explore.log());
    let click = |publisher: &rosrust::Publisher<PointStamped>, (x, y): (f64, f64), corners: usize| {
        let mut message = PointStamped::default();
        message.header.frame_id = "map".to_owned();
        (message.point.x, message.point.y) = (x, y);
        publisher.send(message).unwrap();
        eventually(SOON, || drawn(&markers) == corners, || format!("{corners} corners: {}", explore.log()));
    };
    let count = |ns: &str, expected: usize, explore: &Process| {
        eventually(SOON, || outlines(&markers, ns) == expected, || format!("{expected} {ns}: {}", explore.log()));
    };
    click(&region, (0.2, 0.2), 1);
    click(&region, (2.0, 0.2), 2);
    click(&region, (2.1, 0.3), 1);
    click(&region, (3.6, 0.2), 2);
    click(&region, (3.6, 3.3), 3);
    click(&region, (0.2, 3.3), 4);
    click(&region, (0.3, 0.3), 0);
    count("region", 1, &explore);
    shown.expect(SOON, "the region", |m| m.polygon.points.len() == 4);
    assert!(explore.log().contains("the last corner of the region is taken back: 1 are left"), "{}", explore.log());
    for (corner, number) in [((0.5, 2.0), 1), ((1.2, 2.0), 2), ((1.2, 3.0), 3), ((0.5, 2.1), 0)] {
        click(&no_go, corner, number);
    }
    count("no_go", 1, &explore);
    count("no_go_fill", 1, &explore);
    click(&no_go, (1.3, 3.1), 0);
    count("no_go", 0, &explore);
    click(&region, (3.5, 3.2), 0);
    count("region", 0, &explore);
    eventually(SOON, || shown.last().is_some_and(|m| m.polygon.points.is_empty()), || explore.log());
    assert!(explore.log().contains("the region is cleared"), "{}", explore.log());
}

fn blacklist(world: &World) {
    let markers = Heard::<MarkerArray>::on(&world.probe, "/explore/areas");
    let _sim = world.simulate_kindly(&["_fault:=abort_goals"]);
    let mut explore = world.explore(&[]);
    let says_why = |m: &Marker| m.ns == "reasons" && m.text.contains("aborted by a fault");
    markers.expect(DEADLINE, "a reason", |m| m.markers.iter().any(says_why));
    explore.expect_code(3, DEADLINE);
}
