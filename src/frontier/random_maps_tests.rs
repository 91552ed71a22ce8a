//! Random maps for the tests of detectors.

use crate::geometry::Pose;
use crate::grid::{Cell, GridInfo, OccupancyGrid};
use proptest::prelude::*;

/// A grid of 1 m cells with the robot's cell free.
pub fn with_robot(width: u32, height: u32, values: Vec<i8>, robot: usize) -> (OccupancyGrid, Cell) {
    let info = GridInfo::new(width, height, 1.0, Pose::default()).unwrap();
    let mut grid = OccupancyGrid::new(info, values).unwrap();
    let seed = info.cell(robot);
    grid.set(seed, OccupancyGrid::FREE);
    (grid, seed)
}

/// Cells drawn at random, from nearly all unknown to nearly all free or occupied, and the
/// robot on a free one.
pub fn noise(max_width: u32, max_height: u32) -> impl Strategy<Value = (OccupancyGrid, Cell)> {
    (1u32..=max_width, 1u32..=max_height, 0.0f64..1.0, 0.0f64..1.0)
        .prop_flat_map(|(width, height, known, free)| {
            let value = prop_oneof![
                ((1.0 - known) * 100.0) as u32 + 1 => Just(OccupancyGrid::UNKNOWN),
                (known * free * 100.0) as u32 + 1 => 0i8..=64,
                (known * (1.0 - free) * 100.0) as u32 + 1 => 65i8..=100,
            ];
            let values = proptest::collection::vec(value, (width * height) as usize);
            (Just((width, height)), values, any::<prop::sample::Index>())
        })
        .prop_map(|((width, height), values, robot)| {
            let robot = robot.index(values.len());
            with_robot(width, height, values, robot)
        })
}
