//! Maps that go wrong: each fault is made by changing the simulator's maps on their way.

use crate::relay::Relay;
use crate::rig::{DEADLINE, Heard, Process, eventually};
use crate::{EXACT, KIND, SOON, Test, World};
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::nav_msgs::{MapMetaData, OccupancyGrid};
use frontier_explorer::ros::msg::std_msgs::String as StringMessage;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

pub const TESTS: &[Test] = &[
    ("bad_maps_among_good_ones_are_named_and_passed_over", among_good_ones),
    ("a_map_that_is_bad_from_the_start_is_named_and_waited_for", bad_from_the_start),
    ("a_map_that_grows_with_a_moved_origin_is_explored", grows),
    ("maps_with_one_stamp_for_all_are_explored", one_stamp),
    ("a_map_without_anything_known_is_no_end", all_unknown),
    ("a_map_that_stops_ends_no_map", stops),
    ("a_robot_off_the_map_waits_for_a_map_around_it", off_the_map),
    ("a_robot_inside_an_obstacle_waits_for_a_map_around_it", inside_an_obstacle),
];

/// A simulator whose maps pass through the test, and what an explorer says.
struct Stage {
    maps: Relay<OccupancyGrid>,
    status: Heard<ExplorationStatus>,
    sim: Process,
}

fn stage(world: &World, more: &[&str]) -> Stage {
    let maps = Relay::latched(&world.probe, "/true/map", "/map");
    let status = Heard::on(&world.probe, "/explore/status");
    let sim = world.simulate(&[KIND, &["map:=/true/map"], more].concat());
    Stage { maps, status, sim }
}

impl Stage {
    /// It ends as if nothing had been.
    fn expect_complete(&mut self, world: &World, explore: &mut Process) {
        explore.expect_code(0, DEADLINE);
        assert!(explore.log().contains("complete: "), "{}", explore.log());
        assert!(world.map().with_extension("pgm").exists(), "{}", explore.log());
        world.expect_explored(&mut self.sim, EXACT);
    }

    /// So far no goal was sent, and there was no end.
    fn waits(&self) {
        let is_waiting = |m: &ExplorationStatus| m.goals_sent == 0 && m.phase != ExplorationStatus::ENDED;
        assert!(self.status.all().iter().all(is_waiting), "{:?}", self.status.last());
    }

    fn is_driving(&self) {
        self.status.expect(DEADLINE, "driving", |m| m.phase == ExplorationStatus::DRIVING);
    }
}

/// What is said, and how a map becomes bad.
type BadMap = (&'static str, fn(&mut OccupancyGrid));

/// Maps that are none.
const NO_MAPS: [BadMap; 10] = [
    ("resolution 0 m per cell: must be", |map| map.info.resolution = 0.0),
    ("resolution NaN m per cell: must be", |map| map.info.resolution = f32::NAN),
    ("resolution -0.0", |map| map.info.resolution *= -1.0),
    ("resolution 1000000015047466200000000000000 m per cell", |map| map.info.resolution = 1e30),
    ("a grid of 0 x ", |map| map.info.width = 0),
    ("must have at least 1 and at most", |map| (map.info.width, map.info.height) = (u32::MAX, u32::MAX)),
    ("values", |map| map.data.truncate(7)),
    ("values", |map| map.data.push(0)),
    ("grid origin (NaN", |map| map.info.origin.position.x = f64::NAN),
    ("grid origin (1", |map| map.info.origin.position.x = 1e300),
];

/// Maps that are maps, and show what cannot be so soon.
const STRANGE_MAPS: [BadMap; 2] = [
    ("a map came that knows 0 cells, and the last one knew", |map| map.data.fill(-1)),
    ("a map came that knows", |map| *map = cropped(map, |x, y| x < 20 && y < 20)),
];

/// Every second map is a bad one.
fn among_good_ones(world: &World) {
    let mut stage = stage(world, &["_speed:=4"]);
    let count = AtomicUsize::new(0);
    stage.maps.set(move |mut map| {
        let nth = count.fetch_add(1, Ordering::Relaxed);
        if nth % 2 == 1 {
            let all: Vec<BadMap> = [&NO_MAPS[..], &STRANGE_MAPS[..]].concat();
            all[nth / 2 % all.len()].1(&mut map);
        }
        Some(map)
    });
    let mut explore = world.explore(&[]);
    stage.expect_complete(world, &mut explore);
    let log = explore.log();
    for (said, _) in NO_MAPS.iter().chain(&STRANGE_MAPS) {
        assert!(log.contains(said), "{said:?} is not in:\n{log}");
    }
    assert!(log.contains("a map on map from /probe: "), "{log}");
}

/// Holds all maps back and returns the last one of them.
fn held_back(stage: &Stage) -> OccupancyGrid {
    let last = Arc::new(Mutex::new(None));
    let theirs = Arc::clone(&last);
    stage.maps.set(move |map| {
        *theirs.lock().unwrap() = Some(map);
        None
    });
    eventually(SOON, || last.lock().unwrap().is_some(), || "no map".to_owned());
    let map = last.lock().unwrap().take();
    map.unwrap()
}

/// The map is bad in every way, for as long as it takes; then it is good.
fn bad_from_the_start(world: &World) {
    let mut stage = stage(world, &["_speed:=4"]);
    let map = held_back(&stage);
    let mut explore = world.explore(&[]);
    for (said, spoil) in &NO_MAPS {
        let mut bad = map.clone();
        spoil(&mut bad);
        let mut is_said = || {
            stage.maps.send(bad.clone());
            std::thread::sleep(Duration::from_millis(200));
            explore.log().contains(said)
        };
        eventually(SOON, &mut is_said, || format!("{said:?} is not in:\n{}", explore.log()));
    }
    stage.status.expect(SOON, "waiting", |m| m.phase == ExplorationStatus::WAITING_FOR_MAP);
    stage.waits();
    stage.maps.pass();
    stage.maps.send(map);
    stage.expect_complete(world, &mut explore);
}

/// The first map is one on which nothing can be decided; what is said of it, and that a good one
/// is explored after it.
fn useless_at_first(world: &World, said: &str, spoil: impl Fn(&mut OccupancyGrid)) {
    let mut stage = stage(world, &["_speed:=4"]);
    let map = held_back(&stage);
    let mut bad = map.clone();
    spoil(&mut bad);
    stage.maps.send(bad);
    let mut explore = world.explore(&["_explorer:={turns: {at_start: false}}"]);
    explore.expect_log(said, SOON);
    stage.waits();
    stage.maps.send(map.clone());
    stage.maps.send(map);
    stage.maps.pass();
    stage.expect_complete(world, &mut explore);
}

fn all_unknown(world: &World) {
    let said = "another map is waited for: no free cell lies within 0.5 m of the robot";
    useless_at_first(world, said, |map| map.data.fill(-1));
}

fn off_the_map(world: &World) {
    let said = "another map is waited for: the robot at (2.00, 1.70) m is outside the map of";
    useless_at_first(world, said, |map| map.info.origin.position.x += 100.0);
}

fn inside_an_obstacle(world: &World) {
    let said = "another map is waited for: no free cell lies within 0.5 m of the robot";
    useless_at_first(world, said, |map| {
        let width = map.info.width as usize;
        let (cell, origin) = (f64::from(map.info.resolution), &map.info.origin.position);
        for (i, value) in map.data.iter_mut().enumerate() {
            let (x, y) = (origin.x + (i % width) as f64 * cell, origin.y + (i / width) as f64 * cell);
            if (x - 2.0).hypot(y - 1.7) < 0.7 {
                *value = 100;
            }
        }
    });
}

/// The cells that are kept, as a map of its own: the rectangle around them.
fn cropped(map: &OccupancyGrid, is_kept: impl Fn(usize, usize) -> bool) -> OccupancyGrid {
    let width = map.info.width as usize;
    let kept = (0..map.data.len()).map(|i| (i % width, i / width)).filter(|&(x, y)| is_kept(x, y));
    let kept: Vec<(usize, usize)> = kept.collect();
    let range = |of: fn(&(usize, usize)) -> usize| {
        let values = kept.iter().map(of);
        values.clone().min().unwrap()..values.max().unwrap() + 1
    };
    let (xs, ys) = (range(|cell| cell.0), range(|cell| cell.1));
    let mut info = MapMetaData { width: xs.len() as u32, height: ys.len() as u32, ..map.info.clone() };
    info.origin.position.x += xs.start as f64 * f64::from(map.info.resolution);
    info.origin.position.y += ys.start as f64 * f64::from(map.info.resolution);
    let data = ys.flat_map(|y| xs.clone().map(move |x| y * width + x)).map(|i| map.data[i]).collect();
    OccupancyGrid { header: map.header.clone(), info, data }
}

/// Each map shows more than the last one on both sides of the robot: its size and its origin change
/// all the time.
fn grows(world: &World) {
    let mut stage = stage(world, &["_speed:=4"]);
    let origins = Arc::new(Mutex::new(Vec::new()));
    let theirs = Arc::clone(&origins);
    stage.maps.set(move |map| {
        let mut origins = theirs.lock().unwrap();
        let (origin_m, cell_m) = (map.info.origin.position.x, f64::from(map.info.resolution));
        let reach_m = 1.5 + 0.3 * origins.len() as f64;
        let map = cropped(&map, |x, _| (origin_m + x as f64 * cell_m - 2.0).abs() < reach_m);
        origins.push((map.info.origin.position.x, map.info.width));
        Some(map)
    });
    let mut explore = world.explore(&[]);
    stage.expect_complete(world, &mut explore);
    let mut origins = origins.lock().unwrap().clone();
    origins.dedup();
    assert!(origins.len() > 3, "it hardly grew: {origins:?}");
}

fn one_stamp(world: &World) {
    let mut stage = stage(world, &[]);
    stage.maps.set(|mut map| {
        (map.header.stamp.sec, map.header.stamp.nsec) = (5, 0);
        Some(map)
    });
    let mut explore = world.explore(&[]);
    stage.expect_complete(world, &mut explore);
}

fn stops(world: &World) {
    let mut stage = stage(world, &[]);
    let faults = world.probe.publish_latched::<StringMessage>("/sim/fault").unwrap();
    let mut explore = world.explore(&["_explorer:={patience: {map_timeout_s: 30.0}}"]);
    stage.is_driving();
    faults.send(StringMessage { data: "stop_map".to_owned() }).unwrap();
    explore.expect_log("the map is stale: no newer one has come for", SOON);
    let end = stage.status.expect(DEADLINE, "the end", |m| m.phase == ExplorationStatus::ENDED);
    assert_eq!(end.end_reason, "no_map", "{end:?}\n{}", explore.log());
    explore.expect_code(3, SOON);
    assert!(world.map().with_extension("pgm").exists(), "{}", explore.log());
    stage.sim.signal("INT");
    stage.sim.expect_code(0, SOON);
}
