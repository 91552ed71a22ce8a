//! Maps and their updates as they come over TCP, on top of the map of an earlier session.

use super::engine::{Answer, Target};
use super::exploring::room;
use super::messages::{Cut, claims_too_much, encoded};
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Cell, GridPatch, Live, MapMemory, OccupancyGrid, Thresholds};
use frontier_explorer::ros::msg::{map_msgs, nav_msgs};
use frontier_explorer::ros::{Remembered, convert};
use rosrust::RosMsg as _;

#[test]
fn maps() {
    // A far origin makes the earlier map and the new one lie in a large one, which is bounded.
    Target { name: "maps", run: take_in, seeds, memory: (1 << 30, 100), least_taken_percent: 10.0 }.fuzz();
}

/// Two maps, each with two updates.
fn take_in(input: &[u8]) -> Answer {
    let mut cut = Cut(input);
    let mut earlier = Remembered::new(Some(MapMemory::new(room(), Thresholds::default())));
    let mut live: Option<Live<OccupancyGrid>> = None;
    let mut said = String::new();
    while let Some(message) = cut.message(|bytes| claims_too_much(bytes, 76)) {
        let message = nav_msgs::OccupancyGrid::decode(message).map_err(|error| error.to_string())?;
        let grid = convert::grid(message).map_err(|error| error.to_string())?;
        Live::renew(&mut live, earlier.whole(grid));
        for _ in 0..2 {
            let Some(message) = cut.message(|bytes| claims_too_much(bytes, 16)) else { break };
            let message = map_msgs::OccupancyGridUpdate::decode(message).map_err(|error| error.to_string())?;
            let (patch, live) = (convert::patch(message), live.as_mut().unwrap());
            let applied = match earlier.patch(&patch) {
                Some(joined) => joined.map(|joined| live.replace(joined)),
                None => live.apply(&patch),
            };
            said += &applied.err().map_or_else(|| "laid ".to_owned(), |error| error.to_string());
        }
        let newest = live.as_ref().unwrap().newest();
        assert_eq!(newest.data().len(), newest.info().len());
        let census = newest.census(&Thresholds::default());
        said += &format!("{:?} {}", earlier.state(), census.known() > 0);
    }
    Ok(said)
}

fn seeds() -> Vec<(String, Vec<u8>)> {
    let update = |x: i32| {
        let patch = GridPatch { corner: Cell::new(x, 5), width: 4, height: 3, data: vec![0; 12] };
        encoded(&convert::patch_message(patch, "map", 100.0))
    };
    let map = |shift_m: f64| {
        let room = room();
        let info = room.info();
        let (x, y) = (info.origin_in_map().x, info.origin_in_map().y);
        let mut message = convert::grid_message(&room, "map", 100.0);
        message.info.origin = convert::pose_message(&Pose::new(x + shift_m, y, 0.0));
        [encoded(&message), update(2), update(20)].concat()
    };
    [("same", 0.0), ("moved", 0.2), ("elsewhere", 2.0)]
        .map(|(name, shift_m)| (name.to_owned(), [map(0.0), map(shift_m)].concat()))
        .into()
}
