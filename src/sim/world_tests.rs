//! The world: what is solid, where robots may start, and rays against the textbook walk.

use super::*;
use crate::grid::traverse;
use proptest::prelude::*;

fn world(drawing: &str) -> World {
    World::new(&OccupancyGrid::from_ascii(drawing).unwrap(), &Thresholds::default()).unwrap()
}

#[test]
fn unknown_and_outside_are_solid() {
    let w = world("..?\n...");
    assert!(w.is_solid(Cell::new(2, 1)) && w.is_solid(Cell::new(-1, 0)) && !w.is_solid(Cell::new(2, 0)));
    assert_eq!(w.free_cells(), 5);
    assert_eq!(w.clearance_squared_cells(Cell::new(1, 0)), 1);
}

#[test]
fn a_world_without_room_is_refused() {
    let full = OccupancyGrid::from_ascii("##\n?#").unwrap();
    let error = World::new(&full, &Thresholds::default()).unwrap_err();
    assert_eq!(error, WorldError::NoFreeCell { width: 2, height: 2 });
}

#[test]
fn a_ray_along_a_border_ends() {
    let info = GridInfo::new(80, 60, 0.1, Pose::new(-3.13, 2.71, 0.0)).unwrap();
    let w = World::new(&OccupancyGrid::filled(info, 0), &Thresholds::default()).unwrap();
    for (x, y) in (0..=80).flat_map(|x| (0..=60).map(move |y| (x, y))) {
        let from = info.from_grid_units(f64::from(x), f64::from(y));
        for quarter in -4..=4 {
            let heading = f64::from(quarter) * std::f64::consts::FRAC_PI_2;
            assert!(w.cast(from, heading, 20.0).is_some());
        }
    }
}

proptest! {
    #[test]
    fn casting_equals_the_textbook_walk(
        (width, height, solid) in (1usize..40, 1usize..40).prop_flat_map(|(w, h)| {
            (Just(w), Just(h), proptest::collection::vec(proptest::bool::weighted(0.02), w * h))
        }),
        yaw in prop_oneof![Just(0.0), -3.0f64..3.0],
        (u, v) in (0.0f64..1.0, 0.0f64..1.0),
        heading in -4.0f64..4.0,
    ) {
        let info = GridInfo::new(width as u32, height as u32, 0.05, Pose::new(-0.7, 0.3, yaw)).unwrap();
        let data = solid.iter().map(|&s| if s { 100 } else { 0 }).collect();
        let Ok(w) = World::new(&OccupancyGrid::new(info, data).unwrap(), &Thresholds::default()) else {
            return Ok(());
        };
        let from = info.from_grid_units(u * width as f64, v * height as f64);
        let expected = traverse(&info, from, heading, 10.0).find(|&(cell, _)| w.is_solid(cell)).unwrap().1;
        let cast = w.cast(from, heading, 10.0).unwrap();
        prop_assert!((cast - expected * 0.05).abs() < 1e-9, "{} for {}", cast, expected * 0.05);
        prop_assert_eq!(w.cast(from, heading, 0.5 * cast - 1e-9), None);
    }
}
