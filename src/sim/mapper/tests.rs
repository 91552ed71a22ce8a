//! The mapper: what the rays of a scan say, how the map grows, and greys that add up.

use super::*;
use crate::config::LidarConfig;
use crate::grid::{Cell, GridInfo, Since, Thresholds};
use crate::sim::{Lidar, MapStyle, World};
use proptest::prelude::*;
use std::f64::consts::TAU;

const LIDAR: LidarConfig = LidarConfig {
    mount: Pose::new(0.0, 0.0, 0.0),
    range_min_m: 0.05,
    range_max_m: 6.0,
    field_of_view_rad: TAU,
    rays: 720,
    rate_hz: 10.0,
    noise_std_m: 0.0,
};

/// A room of 8 m x 6 m with pillars, in cells of 0.1 m, at an odd place.
fn pillars(seed: u64) -> OccupancyGrid {
    let info = GridInfo::new(80, 60, 0.1, Pose::new(-3.13, 2.71, 0.0)).unwrap();
    let mut truth = OccupancyGrid::filled(info, 0);
    let mut random = rand_pcg::Pcg32::new(seed, 1);
    for _ in 0..60 {
        use rand::RngExt;
        let (x, y) = (random.random_range(0..80), random.random_range(0..60));
        truth.set(Cell::new(x, y), 100);
        truth.set(Cell::new(x + 1, y), 100);
    }
    truth
}

fn mapper(truth: &OccupancyGrid, start: Point, style: MapStyle) -> Mapper {
    let config =
        MapperConfig { style, resolution_m: 0.1, initial_reach_m: 1.0, growth_m: 0.8, ..MapperConfig::default() };
    Mapper::new(config, start, truth.info().origin_in_map().position()).unwrap()
}

/// Every known cell of a map on the truth's lattice, with the truth's value there.
fn compared(map: &OccupancyGrid, truth: &OccupancyGrid) -> Vec<(i8, i8)> {
    let known = (0..map.data().len()).filter(|&i| map.data()[i] >= 0);
    known
        .map(|i| {
            let cell = truth.info().cell_at(map.info().center(map.info().cell(i)));
            (map.data()[i], truth.get(cell).unwrap_or(100))
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]
    #[test]
    fn noise_free_scans_never_mark_a_cell_wrongly(
        seed in 0u64..1000,
        poses in proptest::collection::vec((0i32..80, 0i32..60, prop_oneof![Just(0.5), Just(0.0), 0.0f64..1.0], -4.0f64..4.0), 1..6),
        (straight, unpublished) in (proptest::bool::ANY, 0u32..64),
    ) {
        let truth = pillars(seed);
        let world = World::new(&truth, &Thresholds::default()).unwrap();
        let start = truth.info().center(Cell::new(40, 30));
        let mut mapper = mapper(&truth, start, MapStyle::Gmapping);
        let mut lidar = Lidar::new(LIDAR, 0);
        for (turn, (x, y, within, yaw)) in poses.into_iter().enumerate() {
            // Only what is touched after this is written again.
            if unpublished >> turn & 1 == 0 {
                mapper.publish().unwrap();
            }
            let at = truth.info().from_grid_units(f64::from(x) + within, f64::from(y) + within);
            let pose = Pose::new(at.x, at.y, if straight { 0.0 } else { yaw });
            mapper.integrate(&pose, &lidar.sweep(&world, &pose, 0.0)).unwrap();
        }
        let map = mapper.publish().unwrap().cells;
        prop_assert_eq!(&*map, &mapper.map().unwrap());
        let cells = compared(&map, &truth);
        prop_assert_eq!(cells.len(), mapper.known_cells());
        for (value, expected) in cells {
            prop_assert_eq!(value, expected);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(100))]
    #[test]
    fn a_scan_says_what_its_rays_say_one_by_one(
        (seed, rays, field) in (0u64..1000, 1u32..900, 0.5f64..TAU),
        (x, y, yaw) in (0.0f64..80.0, 0.0f64..60.0, prop_oneof![Just(0.0), -4.0f64..4.0]),
        gaps in 1usize..9,
        noise_std_m in prop_oneof![Just(0.0), Just(0.05)],
    ) {
        let truth = pillars(seed);
        let world = World::new(&truth, &Thresholds::default()).unwrap();
        let at = truth.info().from_grid_units(x, y);
        let pose = Pose::new(at.x, at.y, yaw);
        let config = LidarConfig { rays, field_of_view_rad: field, noise_std_m, range_max_m: 3.0, ..LIDAR };
        let mut scan = Lidar::new(config, seed).sweep(&world, &pose, 0.0);
        scan.ranges_m.iter_mut().skip(gaps).step_by(7 * gaps).for_each(|range| *range = f32::NAN);
        let (mut whole, mut single) =
            (mapper(&truth, at, MapStyle::Gmapping), mapper(&truth, at, MapStyle::Gmapping));
        whole.integrate(&pose, &scan).unwrap();
        for ray in 0..scan.ranges_m.len() {
            let mut one = LaserScan { ranges_m: vec![f32::NAN; scan.ranges_m.len()], ..scan.clone() };
            one.ranges_m[ray] = scan.ranges_m[ray];
            single.integrate(&pose, &one).unwrap();
        }
        let known = |mapper: &Mapper| {
            let map = mapper.map().unwrap();
            let indices = (0..map.data().len()).filter(|&i| map.data()[i] >= 0);
            let mut cells: Vec<Cell> =
                indices.map(|i| truth.info().cell_at(map.info().center(map.info().cell(i)))).collect();
            cells.sort();
            cells
        };
        prop_assert_eq!(known(&whole), known(&single));
    }
}

#[test]
fn a_room_is_learned_whole_and_the_map_grows_with_it() {
    let info = GridInfo::new(80, 60, 0.1, Pose::new(-3.13, 2.71, 0.0)).unwrap();
    let truth = OccupancyGrid::filled(info, 0);
    let world = World::new(&truth, &Thresholds::default()).unwrap();
    let pose = Pose::new(0.02, 5.0, 0.3);
    let mut mapper = mapper(&truth, pose.position(), MapStyle::Gmapping);
    let first = mapper.publish().unwrap().cells;
    mapper.integrate(&pose, &Lidar::new(LIDAR, 0).sweep(&world, &pose, 0.0)).unwrap();
    let map = mapper.publish().unwrap().cells;
    let (old, new) = (first.info(), map.info());
    assert!(new.width() > old.width() && new.height() > old.height());
    assert_eq!(new.resolution_m(), old.resolution_m());
    let moved = old.to_grid_units(new.origin_in_map().position());
    assert!((moved.0 - moved.0.round()).abs() < 1e-6 && moved.0 < 0.0 && moved.0.round() as i32 % 8 == 0);
    // All free cells within reach, and the walls that close them in.
    let free = (0..truth.data().len()).filter(|&i| map.get(new.cell_at(info.center(info.cell(i)))) == Some(0)).count();
    assert!(free > 4600, "{free} of 4800 cells");
    assert!(map.data().iter().filter(|&&v| v == 100).count() > 200);
}

#[test]
fn a_clear_ray_frees_its_reach_and_a_near_one_says_nothing() {
    let truth = pillars(0);
    let mut mapper = mapper(&truth, Point::new(0.0, 5.0), MapStyle::Gmapping);
    let scan = LaserScan {
        angle_increment_rad: std::f64::consts::FRAC_PI_2,
        range_min_m: 0.1,
        range_max_m: 2.0,
        ranges_m: vec![f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 0.05],
        ..LaserScan::default()
    };
    // The middle of a cell: 2 m are 20 cells and the two halves.
    mapper.integrate(&Pose::new(-3.13 + 2.05, 2.71 + 2.05, 0.0), &scan).unwrap();
    assert_eq!(mapper.known_cells(), 21);
    assert_eq!(mapper.publish().unwrap().cells.data().iter().filter(|&&v| v == 0).count(), 21);
}

/// What a scan saw before the map grew in front of it is published where it lies then.
#[test]
fn what_was_seen_before_the_map_grew_is_published_too() {
    let mut mapper = mapper(&pillars(0), Point::new(0.0, 5.0), MapStyle::Gmapping);
    let first = mapper.publish().unwrap();
    let scan = |range_max_m| LaserScan {
        range_min_m: 0.1,
        range_max_m,
        ranges_m: vec![f32::INFINITY],
        ..LaserScan::default()
    };
    mapper.integrate(&Pose::new(0.0, 5.0, 0.3), &scan(0.8)).unwrap();
    mapper.integrate(&Pose::new(0.0, 5.0, -2.5), &scan(4.0)).unwrap();
    let next = mapper.publish().unwrap();
    assert_eq!(*next.cells, mapper.map().unwrap());
    let since = next.changes.since_on((first.changes.version(), first.cells.info()), next.cells.info());
    let Since::Grown(growth, told) = since else { panic!("{since:?}") };
    assert!(growth.corner().0 > 20 && growth.corner().1 > 10);
    let differ = growth.changed([first.cells.data(), next.cells.data()], &CellRect::of(next.cells.info())).unwrap();
    assert_eq!(told.union(differ), told);
}

/// One ray along a row of cells, from the middle of the first.
fn one_ray(mapper: &mut Mapper, range_m: f32) -> Vec<i8> {
    let scan = LaserScan { range_min_m: 0.01, range_max_m: 2.0, ranges_m: vec![range_m], ..LaserScan::default() };
    mapper.integrate(&Pose::new(0.05, 0.05, 0.0), &scan).unwrap();
    let map = mapper.publish().unwrap().cells;
    let here = map.info().cell_at(Point::new(0.05, 0.05));
    (0..6).map(|x| map.get(here.offset((x, 0))).unwrap()).collect()
}

fn at_origin(style: MapStyle) -> Mapper {
    let config = MapperConfig { style, resolution_m: 0.1, ..MapperConfig::default() };
    Mapper::new(config, Point::origin(), Point::origin()).unwrap()
}

#[test]
fn a_range_to_a_border_hits_the_cell_beyond() {
    assert_eq!(one_ray(&mut at_origin(MapStyle::Gmapping), 0.25), [0, 0, 0, 100, -1, -1]);
    assert_eq!(one_ray(&mut at_origin(MapStyle::Gmapping), 0.30), [0, 0, 0, 100, -1, -1]);
    assert_eq!(one_ray(&mut at_origin(MapStyle::Gmapping), 0.36), [0, 0, 0, 0, 100, -1]);
}

#[test]
fn evidence_adds_up_to_cartographers_greys_and_is_clamped() {
    let mut mapper = at_origin(MapStyle::Cartographer);
    // 1 / (1 + e^0.4) and 1 / (1 + e^-0.85)
    assert_eq!(one_ray(&mut mapper, 0.3), [40, 40, 40, 70, -1, -1]);
    assert_eq!(one_ray(&mut mapper, 0.4), [31, 31, 31, 61, 70, -1]);
    for _ in 0..50 {
        one_ray(&mut mapper, 0.4);
    }
    assert_eq!(one_ray(&mut mapper, 0.4), [12, 12, 12, 12, 97, -1]);
}

#[test]
fn within_a_scan_a_cell_counts_once_and_a_hit_wins() {
    let mut mapper = at_origin(MapStyle::Cartographer);
    let scan = LaserScan {
        range_min_m: 0.01,
        range_max_m: 2.0,
        ranges_m: vec![0.3, 0.3, 0.4, f32::INFINITY],
        ..LaserScan::default()
    };
    mapper.integrate(&Pose::new(0.05, 0.05, 0.0), &scan).unwrap();
    let map = mapper.publish().unwrap().cells;
    let here = map.info().cell_at(Point::new(0.05, 0.05));
    let row: Vec<i8> = (0..6).map(|x| map.get(here.offset((x, 0))).unwrap()).collect();
    assert_eq!(row, [40, 40, 40, 70, 70, 40]);
}

#[test]
fn a_pose_nowhere_and_an_endless_ray_are_errors_and_change_nothing() {
    let mut mapper = at_origin(MapStyle::Gmapping);
    let scan = LaserScan { range_max_m: 1e9, ranges_m: vec![f32::INFINITY], ..LaserScan::default() };
    assert!(matches!(mapper.integrate(&Pose::new(f64::NAN, 0.0, 0.0), &scan), Err(MapperError::PoseNotFinite { .. })));
    assert!(matches!(mapper.integrate(&Pose::default(), &scan), Err(MapperError::TooLarge(_))));
    assert_eq!(mapper.known_cells(), 0);
}

#[test]
fn a_pose_beyond_all_cells_is_an_error_and_no_overflow() {
    let mut mapper = at_origin(MapStyle::Gmapping);
    let scan = LaserScan { range_max_m: 5.0, ranges_m: vec![1.0; 8], angle_increment_rad: 0.7, ..LaserScan::default() };
    for far_m in [1e18, -1e18, 1e300, -1e300] {
        let added = mapper.integrate(&Pose::new(far_m, 0.0, 0.0), &scan);
        assert!(matches!(added, Err(MapperError::TooLarge(_))), "{far_m}: {added:?}");
    }
}
