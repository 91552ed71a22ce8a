//! Clocks, transforms and scans that go wrong. Stamps are moved by tenths of a second here:
//! the simulator is the kind one, whose own are exact.

use crate::motion::{expect_moving, expect_standing};
use crate::relay::{Relays, later};
use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{KIND, SOON, Test, World};
use frontier_explorer::ros::msg::actionlib_msgs::GoalID;
use frontier_explorer::ros::msg::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::geometry_msgs::{TransformStamped, Twist};
use frontier_explorer::ros::msg::move_base_msgs::MoveBaseActionGoal;
use frontier_explorer::ros::msg::nav_msgs::Odometry;
use frontier_explorer::ros::msg::sensor_msgs::LaserScan;
use frontier_explorer::ros::msg::tf2_msgs::TFMessage;
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("a_transform_stamped_far_ahead_is_named_and_holds_the_robot", skewed_transforms),
    ("a_late_transform_after_a_jump_back_freezes_nothing", jump_back),
    ("scans_that_show_nothing_stop_the_robot", blind_scans),
    ("zero_is_the_last_word_when_clock_transforms_or_scans_stop", last_word),
    ("a_transform_late_for_an_instant_cancels_no_goal", late_for_an_instant),
];

/// A robot that drives itself in the office, at the pace of the wall clock.
fn drives_itself(world: &World) -> (Relays, Process, Process) {
    let relays = Relays::new(&world.probe);
    let mut args = vec!["_world:=office", "_start:=[]", "_speed:=1.0", "_move_base:=false"];
    args.extend(Relays::REMAPPINGS);
    args.extend(KIND);
    let sim = world.simulate(&args);
    let explore = world.explore(&["_navigation:={drive: internal}", "_explorer:={turns: {at_start: false}}"]);
    (relays, sim, explore)
}

fn is_zero(twist: &Twist) -> bool {
    twist.linear.x == 0.0 && twist.angular.z == 0.0
}

fn skewed_transforms(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let health = Heard::<DiagnosticArray>::on(&world.probe, "/diagnostics");
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let twists = Heard::<Twist>::on(&world.probe, "/cmd_vel");
    let (relays, _sim, explore) = drives_itself(world);
    // gmapping stamps map -> odom ahead on purpose.
    let ahead = |message: TFMessage| {
        let shift = |mut transform: TransformStamped| {
            if transform.child_frame_id == "odom" {
                let stamp = rosrust::Time::from_nanos(transform.header.stamp.nanos() + 500_000_000);
                transform.header.stamp = stamp;
            }
            transform
        };
        Some(TFMessage { transforms: message.transforms.into_iter().map(shift).collect() })
    };
    relays.tf.set(ahead);
    expect_moving(&odometry, &explore);
    assert!(!explore.log().contains("clock skew"), "{}", explore.log());
    relays.tf.set(|message| Some(later(message, 120)));
    explore.expect_log("clock skew: odom -> base_link is stamped", SOON);
    assert!(explore.log().contains("s ahead of ROS time: must be at most 1.5 s"), "{}", explore.log());
    status.expect(SOON, "a status that names it", |m| m.message.contains("ahead of ROS time"));
    health.expect(SOON, "a warning", |m| {
        m.status.iter().any(|s| s.level == DiagnosticStatus::WARN && s.message.contains("clock skew"))
    });
    expect_standing(&odometry, Duration::from_millis(500), &explore, "stamps ahead");
    relays.tf.hold();
    expect_standing(&odometry, Duration::from_secs(2), &explore, "stamps ahead, then silence");
    assert!(is_zero(&twists.last().unwrap()));
    relays.tf.set(ahead);
    explore.expect_log("the robot's place is known again", SOON);
    expect_moving(&odometry, &explore);
    // Stamped 0.5 s ahead, and then it comes no more.
    relays.tf.hold();
    expect_standing(&odometry, Duration::from_millis(1500), &explore, "silence");
}

fn jump_back(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let (relays, _sim, explore) = drives_itself(world);
    relays.shift(200);
    let last = Heard::<TFMessage>::on(&world.probe, "/tf");
    expect_moving(&odometry, &explore);
    let before = last.last().unwrap();
    relays.shift(70);
    std::thread::sleep(Duration::from_millis(1500));
    // It was under way when time jumped.
    relays.tf.send(before);
    let sent = Instant::now();
    // What was seen before the message serves for a second.
    std::thread::sleep(Duration::from_secs(3));
    let driven_m = || status.last().map_or(0.0, |m| m.distance_m);
    let from_m = driven_m();
    let drives_on = || driven_m() > from_m + 0.3;
    eventually(Duration::from_secs(20), drives_on, || format!("{from_m} m and no further:\n{}", explore.log()));
    eprintln!("driven on {:.1} s after the late message", sent.elapsed().as_secs_f64());
}

/// A name, what is said, and how a scan becomes blind.
type BlindScan = (&'static str, &'static str, fn(&mut LaserScan));

fn blind_scans(world: &World) {
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let (relays, _sim, explore) = drives_itself(world);
    let cases: [BlindScan; 5] = [
        ("NaN", "ranges is a measurement", |scan| scan.ranges.fill(f32::NAN)),
        ("empty", "it has no ranges", |scan| scan.ranges.clear()),
        ("zero", "ranges is a measurement", |scan| scan.ranges.fill(0.0)),
        ("angle_min NaN", "angle_min is NaN", |scan| scan.angle_min = f32::NAN),
        ("angle_increment NaN", "angle_increment NaN", |scan| scan.angle_increment = f32::NAN),
    ];
    for (name, said, blind) in cases {
        relays.scan.pass();
        expect_moving(&odometry, &explore);
        relays.scan.set(move |mut scan| {
            blind(&mut scan);
            Some(scan)
        });
        // A second without sight, and another to brake from 1.92 rad/s at 2 rad/s2.
        expect_standing(&odometry, Duration::from_millis(2200), &explore, name);
        let log = explore.log();
        assert!(log.contains("the scans on scan show nothing") && log.contains(said), "{name}: {log}");
    }
}

fn last_word(world: &World) {
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let twists = Heard::<Twist>::on(&world.probe, "/cmd_vel");
    let (relays, _sim, mut explore) = drives_itself(world);
    let expect_zero = |what: &str, limit: Duration| {
        let began = Instant::now();
        eventually(limit, || twists.last().is_some_and(|m| is_zero(&m)), || format!("{what}: {:?}", twists.last()));
        eprintln!("{what} stops: zero after {:.2} s", began.elapsed().as_secs_f64());
        std::thread::sleep(Duration::from_secs(1));
        assert!(is_zero(&twists.last().unwrap()), "{what}: {:?}", twists.last());
    };
    expect_moving(&odometry, &explore);
    relays.clock.hold();
    expect_zero("the clock", Duration::from_millis(900));
    explore.expect_log("/clock stands at", SOON);
    relays.clock.pass();
    expect_moving(&odometry, &explore);
    relays.tf.hold();
    expect_zero("tf", Duration::from_millis(1200));
    relays.tf.pass();
    expect_moving(&odometry, &explore);
    relays.scan.hold();
    expect_zero("the scans", Duration::from_millis(1800));
    explore.expect_log("the last scan on scan is", SOON);
    relays.scan.pass();
    expect_moving(&odometry, &explore);
    explore.signal("TERM");
    explore.expect_code(0, Duration::from_secs(3));
    eventually(SOON, || is_zero(&twists.last().unwrap()), || format!("{:?}", twists.last()));
}

fn late_for_an_instant(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let cancels = Heard::<GoalID>::on(&world.probe, "/move_base/cancel");
    let goals = Heard::<MoveBaseActionGoal>::on(&world.probe, "/move_base/goal");
    let relays = Relays::new(&world.probe);
    let mut args = vec!["_world:=office", "_start:=[]", "_speed:=1.0"];
    args.extend(Relays::REMAPPINGS);
    args.extend(KIND);
    let _sim = world.simulate(&args);
    let explore = world.explore(&["_explorer:={turns: {at_start: false}}"]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    eventually(SOON, || !goals.all().is_empty(), || explore.log());
    for _ in 0..3 {
        std::thread::sleep(Duration::from_secs(1));
        relays.tf.hold();
        std::thread::sleep(Duration::from_millis(600));
        relays.tf.pass();
        std::thread::sleep(Duration::from_secs(1));
    }
    assert!(cancels.all().is_empty(), "{} cancellations:\n{}", cancels.all().len(), explore.log());
    let place = |m: &MoveBaseActionGoal| (m.goal.target_pose.pose.position.x, m.goal.target_pose.pose.position.y);
    let repeated = goals.all().windows(2).filter(|pair| place(&pair[0]) == place(&pair[1])).count();
    assert_eq!(repeated, 0, "goals were sent again:\n{}", explore.log());
}
