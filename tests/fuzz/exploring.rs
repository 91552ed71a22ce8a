//! An explorer on maps that nobody would draw, with scans that no lidar has.

use super::engine::{Answer, Target};
use super::messages::{Cut, claims_too_much, encoded};
use frontier_explorer::config::{Preset, builtin_robot};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{GridInfo, Live, OccupancyGrid};
use frontier_explorer::robot::{Command, MapSnapshot, Navigation, NavigationState, Observation};
use frontier_explorer::ros::convert;
use frontier_explorer::ros::msg::{nav_msgs, sensor_msgs};
use frontier_explorer::scan::LaserScan;
use rosrust::RosMsg as _;
use std::sync::Arc;

#[test]
fn exploring() {
    // Costmaps, fields, planes and their like of a cell, and what a footprint of cells costs.
    Target { name: "exploring", run: explore, seeds, memory: (256 << 20, 2000), least_taken_percent: 10.0 }.fuzz();
}

/// Presets that differ in all their parts.
const PRESETS: [&str; 6] = ["tour", "wfd", "liang", "alghfeli", "northwestern", "mrtsp"];

/// A preset's number, where the robot is, a map and a scan.
fn explore(input: &[u8]) -> Answer {
    let mut cut = Cut(input);
    let [number] = cut.array().ok_or("no preset")?;
    let place = [cut.float(), cut.float(), cut.float()].map(|value| value.map(f64::from));
    let [Some(x), Some(y), Some(yaw)] = place else { return Err("no place".to_owned()) };
    let pose = Pose::new(x, y, yaw);
    let message = cut.message(|bytes| claims_too_much(bytes, 76)).ok_or("a map's array is too long")?;
    let map = nav_msgs::OccupancyGrid::decode(message).map_err(|error| error.to_string())?;
    let grid = convert::grid(map).map_err(|error| error.to_string())?;
    let scan = cut.message(|bytes| claims_too_much(bytes, 28));
    let scan = scan.and_then(|bytes| sensor_msgs::LaserScan::decode(bytes).ok()).map(|scan| convert::scan(&scan));
    let preset = Preset::built_in(PRESETS[usize::from(number) % PRESETS.len()]).unwrap();
    // One is a disc, and the other a polygon.
    let robot = if number < 128 { "turtlebot2" } else { "turtlebot3_waffle" };
    let mut explorer = Explorer::new(preset.explorer, &builtin_robot(robot).unwrap().traits()).unwrap();
    Ok(a_while(&mut explorer, grid, pose, scan.as_ref()))
}

/// What an explorer does on a map that changes a little, while some of its goals are reached.
pub fn a_while(explorer: &mut Explorer, grid: OccupancyGrid, pose: Pose, scan: Option<&LaserScan>) -> String {
    let (mut said, mut pose) = (String::new(), pose);
    let mut navigation = Navigation { command: 0, state: NavigationState::Idle };
    let mut changed = grid.clone();
    changed.data_mut().rotate_right(3);
    let mut live = Live::new(Arc::new(grid));
    for tick in 0..6 {
        let map = MapSnapshot {
            stamp_s: f64::from(tick),
            grid: Arc::clone(live.newest()),
            changes: live.changes().clone(),
            costmap: None,
        };
        let scan = scan.map(|scan| (pose, Arc::new(scan.clone())));
        let stamp_s = f64::from(tick);
        let decision = explorer.step(&Observation { stamp_s, pose_in_map: Ok(pose), map: Some(map), scan, navigation });
        let (command, state) = match decision.command {
            Command::Hold => (0, NavigationState::Idle),
            Command::Drive { id, goal_in_map } if tick % 3 != 1 => {
                assert!(goal_in_map.is_finite(), "{goal_in_map:?}");
                pose = goal_in_map;
                (id, NavigationState::Succeeded)
            }
            Command::Drive { id, .. } => (id, NavigationState::Aborted("a wall".to_owned())),
            Command::Turn { id, .. } | Command::BackOff { id } => (id, NavigationState::Succeeded),
        };
        said += match decision.command {
            Command::Hold => "h",
            Command::Drive { .. } => "d",
            Command::Turn { .. } => "t",
            Command::BackOff { .. } => "b",
        };
        navigation = Navigation { command, state };
        if tick == 2 {
            live.replace(Arc::new(changed.clone()));
        }
        if let Some(end) = decision.end {
            return format!("{said}{:?}", end.reason);
        }
    }
    said
}

/// A room with a door, of 30 x 20 cells.
pub fn room() -> OccupancyGrid {
    let mut rows = vec!["#".repeat(20) + &"?".repeat(10)];
    rows.extend((0..8).map(|_| format!("#{}#{}", ".".repeat(18), "?".repeat(10))));
    rows.extend((0..3).map(|_| format!("#{}{}", ".".repeat(19), "?".repeat(10))));
    rows.extend((0..7).map(|_| format!("#{}#{}", ".".repeat(18), "?".repeat(10))));
    rows.push("#".repeat(20) + &"?".repeat(10));
    let drawn = OccupancyGrid::from_ascii(&rows.join("\n")).unwrap();
    let info = drawn.info();
    let info = GridInfo::new(info.width() as u32, info.height() as u32, 0.2, Pose::new(-1.0, -1.0, 0.0)).unwrap();
    OccupancyGrid::new(info, drawn.data().to_vec()).unwrap()
}

/// A scan of what is near.
pub fn sweep() -> LaserScan {
    LaserScan {
        stamp_s: 100.0,
        angle_min_rad: -1.5,
        angle_increment_rad: 0.1,
        range_min_m: 0.1,
        range_max_m: 8.0,
        ranges_m: (0..31).map(|i| 1.0 + 0.1 * i as f32).collect(),
    }
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    let seed = |number: usize| {
        let mut bytes = vec![number as u8 + 128 * u8::from(number > 2)];
        bytes.extend([1.0_f32, 1.0, 0.3].iter().flat_map(|value| value.to_le_bytes()));
        bytes.extend(encoded(&convert::grid_message(&room(), "map", 100.0)));
        if number.is_multiple_of(2) {
            bytes.extend(encoded(&convert::scan_message(&sweep(), "laser", 0.1)));
        }
        (PRESETS[number].to_owned(), bytes)
    };
    (0..PRESETS.len()).map(seed).collect()
}
