//! Signals while something else is wrong: the node leaves in time, with its map, and the robot is
//! not left driving by it.

use crate::relay::Relays;
use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{KIND, SOON, Test, World};
use frontier_explorer::io::load_map;
use frontier_explorer::ros::Feed;
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::geometry_msgs::Twist;
use frontier_explorer::ros::msg::nav_msgs::Odometry;
use frontier_explorer::ros::msg::std_msgs::String as StringMessage;
use std::path::Path;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

pub const TESTS: &[Test] = &[
    ("signals_are_obeyed_in_time_whatever_else_is_wrong", whatever_is_wrong),
    ("signals_are_obeyed_in_time_without_clock_transforms_or_scans", without_senses),
    ("a_node_that_is_killed_leaves_the_robot_to_move_base_and_goes_on", killed_with_move_base),
    ("a_node_that_drives_itself_and_is_killed_stops_by_the_base_and_goes_on", killed_driver),
];

/// It leaves within two seconds, with exit code 0 and a whole map.
fn expect_leaving(world: &World, explore: &mut Process, signal: &str, what: &str) {
    let began = Instant::now();
    explore.signal(signal);
    let code = explore.wait(SOON).code();
    let within = began.elapsed();
    assert!(within < Duration::from_millis(2100), "{what}, {signal}: {within:?}:\n{}", explore.log());
    assert_eq!(code, Some(0), "{what}, {signal}: {}", explore.log());
    let saved = load_map(&world.map().with_extension("yaml")).unwrap().grid;
    assert!(saved.census(&Default::default()).free > 1000, "{what}, {signal}: {}", explore.log());
    for end in ["pgm", "yaml"] {
        std::fs::remove_file(world.map().with_extension(end)).unwrap();
    }
}

fn whatever_is_wrong(world: &World) {
    let faults = world.probe.publish_latched::<StringMessage>("/sim/fault").unwrap();
    // A house would be explored before the last of them.
    let _sim = world.simulate(&[KIND, &["_speed:=2", "_world:=office", "_start:=[]"]].concat());
    let wrong = ["drop_tf", "abort_goals", "reject_goals", "hang", "dead_move_base", "stop_map"];
    for (fault, signal) in wrong.iter().flat_map(|fault| ["INT", "TERM"].map(|signal| (*fault, signal))) {
        let mut explore = world.explore(&["_explorer:={turns: {at_start: false}}"]);
        explore.expect_log("best of", SOON);
        faults.send(StringMessage { data: fault.to_owned() }).unwrap();
        std::thread::sleep(Duration::from_millis(600));
        expect_leaving(world, &mut explore, signal, fault);
        faults.send(StringMessage { data: "none".to_owned() }).unwrap();
    }
}

/// A name, and what is held back.
type Hold = (&'static str, fn(&Relays));

fn without_senses(world: &World) {
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let relays = Relays::new(&world.probe);
    let _sim = world.simulate(&[&["_speed:=1", "_move_base:=false"], &Relays::REMAPPINGS[..], KIND].concat());
    let holds: [Hold; 3] = [
        ("no clock", |relays| relays.clock.hold()),
        ("no transforms", |relays| relays.tf.hold()),
        ("no scans", |relays| relays.scan.hold()),
    ];
    for (i, (what, hold)) in holds.iter().enumerate() {
        let mut explore = world.explore(&["_navigation:={drive: internal}", "_explorer:={turns: {at_start: false}}"]);
        explore.expect_log("best of", SOON);
        hold(&relays);
        std::thread::sleep(Duration::from_millis(700));
        expect_leaving(world, &mut explore, if i % 2 == 0 { "INT" } else { "TERM" }, what);
        let is_standing = || odometry.last().is_some_and(|m| m.twist.twist.linear.x == 0.0);
        eventually(SOON, is_standing, || format!("{what}: it drives on"));
        relays.clock.pass();
        relays.tf.pass();
        relays.scan.pass();
    }
}

/// A session that is kept and gone on with.
struct Session {
    file: String,
    args: [String; 3],
}

impl Session {
    fn new(world: &World) -> Self {
        let file = world.folder.join("session.json").display().to_string();
        let args =
            [format!("_session_file:={file}"), format!("_resume_from:={file}"), "_session_period:=0.3".to_owned()];
        Self { file, args }
    }

    fn explore(&self, world: &World, more: &[&str]) -> Process {
        let own: Vec<&str> = self.args.iter().map(String::as_str).collect();
        world.explore(&[&own, more].concat())
    }
}

/// What move_base does with its goal then is move_base's; the dead node commands nothing.
fn killed_with_move_base(world: &World) {
    let status = Heard::<ExplorationStatus>::on(&world.probe, "/explore/status");
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let own = Arc::<Mutex<Option<Twist>>>::default();
    let theirs = Arc::clone(&own);
    let _twists = Feed::listen(&world.probe, "/cmd_vel", 50, DEADLINE, move |twist: Twist, caller| {
        if caller == "/explore" {
            *theirs.lock().unwrap() = Some(twist);
        }
    });
    let _sim = world.simulate(&[KIND, &["_speed:=2"]].concat());
    let session = Session::new(world);
    let mut explore = session.explore(world, &[]);
    status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING && m.goals_sent > 0);
    eventually(SOON, || Path::new(&session.file).exists(), || explore.log());
    explore.signal("KILL");
    explore.wait(SOON);
    let last = own.lock().unwrap().clone();
    assert!(last.as_ref().is_none_or(|m| m.linear.x == 0.0 && m.angular.z == 0.0), "its last word was {last:?}");
    let speed = || odometry.last().map_or(1.0, |m| m.twist.twist.linear.x.abs() + m.twist.twist.angular.z.abs());
    eventually(SOON, || speed() == 0.0, || "the goal is never reached".to_owned());
    let began = Instant::now();
    let mut explore = session.explore(world, &[]);
    explore.expect_log("going on with the session of", SOON);
    eventually(SOON, || speed() > 0.1, || explore.log());
    assert!(began.elapsed() < Duration::from_secs(5), "{:?}", began.elapsed());
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
}

/// Nobody can send the zero then: how far the robot goes is for its base to say, which stops when no
/// command comes. A respawned node goes on with the session.
fn killed_driver(world: &World) {
    let odometry = Heard::<Odometry>::on(&world.probe, "/odom");
    let mut sim = world.simulate(&[&["_speed:=2", "_move_base:=false"], KIND].concat());
    let session = Session::new(world);
    let speed = || odometry.last().map_or(0.0, |m| m.twist.twist.linear.x.abs());
    let turns = || odometry.last().map_or(0.0, |m| m.twist.twist.angular.z.abs());
    let place = || odometry.last().map(|m| (m.pose.pose.position.x, m.pose.pose.position.y)).unwrap();
    let mut explore = session.explore(world, &["_navigation:={drive: internal}"]);
    eventually(SOON, || speed() > 0.2 && Path::new(&session.file).exists(), || explore.log());
    explore.signal("KILL");
    let from = place();
    explore.wait(SOON);
    // The base of the simulator waits for 0.6 s of its time, somewhat longer at this speed.
    std::thread::sleep(Duration::from_millis(1500));
    let to = place();
    let driven_m = (from.0 - to.0).hypot(from.1 - to.1);
    eprintln!("{driven_m:.2} m without a command");
    assert!(speed() == 0.0 && turns() == 0.0 && driven_m < 0.8, "{driven_m} m, now at {} m/s", speed());
    let began = Instant::now();
    let mut explore = session.explore(world, &["_navigation:={drive: internal}"]);
    explore.expect_log("going on with the session of", SOON);
    eventually(SOON, || speed() > 0.1 || turns() > 0.1, || explore.log());
    assert!(began.elapsed() < Duration::from_secs(5), "{:?}", began.elapsed());
    explore.expect_code(0, DEADLINE);
    assert!(explore.log().contains("complete: "), "{}", explore.log());
    sim.signal("TERM");
    sim.expect_code(0, SOON);
    assert!(sim.log().contains(" 0 collisions"), "{}", sim.log());
}
