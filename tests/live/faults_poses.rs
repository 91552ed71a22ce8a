//! Transforms that are no numbers or nowhere, loops that close, clocks that jump ahead, names that
//! a terminal would obey.

use crate::motion::{expect_moving, expect_standing};
use crate::relay::{Relay, Relays};
use crate::rig::{DEADLINE, Heard, Process};
use crate::{EXACT, KIND, SOON, Test, World};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::geometry_msgs::TransformStamped;
use frontier_explorer::ros::msg::nav_msgs::{OccupancyGrid, Odometry};
use frontier_explorer::ros::msg::tf2_msgs::TFMessage;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

pub const TESTS: &[Test] = &[
    ("bad_transforms_among_good_ones_are_named_and_passed_over", among_good_ones),
    ("transforms_that_are_no_numbers_hold_the_robot", no_numbers),
    ("a_robot_that_is_said_to_be_nowhere_stands", nowhere),
    ("a_loop_that_closes_moves_map_and_robot_and_ends_nothing", loop_closure),
    ("a_clock_that_jumps_ahead_ends_nothing", clock_ahead),
    ("names_of_frames_command_no_terminal", names),
];

/// What is said, and how a transform becomes bad.
type BadTransform = (&'static str, fn(&mut TransformStamped));

const BAD: [BadTransform; 6] = [
    ("holds numbers that are not finite", |t| t.transform.translation.x = f64::NAN),
    ("holds numbers that are not finite", |t| t.transform.translation.y = f64::INFINITY),
    ("holds numbers that are not finite", |t| t.transform.rotation.w = f64::NAN),
    ("is no unit quaternion: its norm is 0.000", |t| {
        (t.transform.rotation.w, t.transform.rotation.z) = (0.0, 0.0);
    }),
    ("a transform without a frame's name", |t| t.child_frame_id.clear()),
    ("is its own parent", |t| t.child_frame_id = t.header.frame_id.clone()),
];

/// So long after what it knows of its place is gone the robot stands.
const HOLDS_AFTER: Duration = Duration::from_millis(1500);

/// A robot that drives itself through the house, by the transforms that the test lets pass.
fn drives_itself(world: &World) -> (Relays, Process, Process) {
    let relays = Relays::new(&world.probe);
    let args = [&["_speed:=2.0", "_move_base:=false"], &Relays::REMAPPINGS[..], KIND].concat();
    let sim = world.simulate(&args);
    let explore = world.explore(&["_navigation:={drive: internal}", "_explorer:={turns: {at_start: false}}"]);
    (relays, sim, explore)
}

/// Every third message is spoilt, in one way after another.
fn among_good_ones(world: &World) {
    let (relays, mut sim, mut explore) = drives_itself(world);
    let count = AtomicUsize::new(0);
    relays.tf.set(move |mut message: TFMessage| {
        let nth = count.fetch_add(1, Ordering::Relaxed);
        if nth % 3 == 2 {
            message.transforms.iter_mut().for_each(BAD[nth / 3 % BAD.len()].1);
        }
        Some(message)
    });
    explore.expect_code(0, DEADLINE);
    let log = explore.log();
    assert!(log.contains("complete: "), "{log}");
    for (said, _) in &BAD {
        assert!(log.contains(said), "{said:?} is not in:\n{log}");
    }
    drop(relays);
    world.expect_explored(&mut sim, EXACT);
}

fn no_numbers(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let (relays, _sim, mut explore) = drives_itself(world);
    expect_moving(&odometry, &explore);
    relays.tf.set(|mut message| {
        message.transforms.iter_mut().for_each(BAD[0].1);
        Some(message)
    });
    expect_standing(&odometry, HOLDS_AFTER, &explore, "bad transforms");
    status.expect(SOON, "waiting for the pose", |m| m.phase == ExplorationStatus::WAITING_FOR_POSE);
    relays.tf.pass();
    explore.expect_log("the robot's place is known again", SOON);
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
}

/// Finite, and nowhere on the map.
fn nowhere(world: &World) {
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let (relays, _sim, mut explore) = drives_itself(world);
    for far_m in [1e4, 1e12, -1e300] {
        expect_moving(&odometry, &explore);
        relays.tf.set(move |mut message| {
            for one in message.transforms.iter_mut().filter(|one| one.child_frame_id == "odom") {
                one.transform.translation.x = far_m;
            }
            Some(message)
        });
        expect_standing(&odometry, HOLDS_AFTER, &explore, "bad transforms");
        relays.tf.pass();
    }
    explore.expect_log("the map jumped under the robot by", SOON);
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
}

/// While the robot drives, all of the map moves by a metre and more, and the robot with it; then
/// the transform alone jumps, a moment before its map.
fn loop_closure(world: &World) {
    let (x_m, y_m) = (1.0, -0.7);
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let maps = Relay::<OccupancyGrid>::latched(&world.probe, "/true/map", "/map");
    let tf = Relay::<TFMessage>::new(&world.probe, "/true/tf", "/tf");
    let mut sim =
        world.simulate(&[KIND, &["_speed:=4", "_move_base:=false", "map:=/true/map", "/tf:=/true/tf"]].concat());
    let mut explore = world.explore(&["_navigation:={drive: internal}", "_explorer:={turns: {at_start: false}}"]);
    expect_moving(&odometry, &explore);
    tf.set(move |mut message| {
        for one in message.transforms.iter_mut().filter(|one| one.child_frame_id == "odom") {
            one.transform.translation.x += x_m;
            one.transform.translation.y += y_m;
        }
        Some(message)
    });
    std::thread::sleep(Duration::from_millis(200));
    maps.set(move |mut map| {
        map.info.origin.position.x += x_m;
        map.info.origin.position.y += y_m;
        Some(map)
    });
    explore.expect_log("the map jumped under the robot by 1.", SOON);
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    assert!(world.map().with_extension("pgm").exists());
    sim.signal("TERM");
    sim.expect_code(0, SOON);
    assert!(sim.log().contains(" 0 collisions"), "{}", sim.log());
}

/// By a minute, by an hour, by a year.
fn clock_ahead(world: &World) {
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let (relays, mut sim, mut explore) = drives_itself(world);
    for by_s in [100, 3700, 31_540_000] {
        expect_moving(&odometry, &explore);
        relays.shift(by_s);
        explore.expect_log("ROS time jumped ahead by ", SOON);
        std::thread::sleep(Duration::from_millis(500));
    }
    assert!(explore.log().matches("ROS time jumped ahead by ").count() == 3, "{}", explore.log());
    assert!(!explore.log().contains("failed: "), "{}", explore.log());
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    drop(relays);
    world.expect_explored(&mut sim, EXACT);
}

fn names(world: &World) {
    let tf = world.probe.publish_latched::<TFMessage>("/tf_static").unwrap();
    let mut named = TransformStamped { child_frame_id: "base\u{1b}[2J\u{7}".to_owned(), ..TransformStamped::default() };
    named.header.frame_id = "odom".to_owned();
    named.transform.rotation.w = 1.0;
    tf.send(TFMessage { transforms: vec![named] }).unwrap();
    let _sim = world.simulate_kindly(&[]);
    let explore = world.explore(&["_base_frame:=base_lnk"]);
    explore.expect_log("(~base_frame) is unknown: tf has base", SOON);
    explore.expect_log("base\\u{1b}[2J\\u{7}", SOON);
    assert!(!explore.log().contains(['\u{1b}', '\u{7}']), "{:?}", explore.log());
}
