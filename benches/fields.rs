//! Distances and rays: `cargo bench --bench fields`.
//!
//! What the limits are, and what these cost beside them, is told in docs/performance.md.

#![allow(clippy::unwrap_used)]

#[path = "support/scenes.rs"]
#[allow(dead_code)] // shared with the other benches
mod scenes;

use divan::counter::ItemsCount;
use divan::{Bencher, black_box};
use frontier_explorer::geometry::Point;
use frontier_explorer::grid::{Costmap, Inflation, OccupancyGrid, Thresholds, squared_distance_cells, traverse};
use frontier_explorer::io::load_map;
use std::path::Path;

fn main() {
    divan::main();
}

const SIZES: [u32; 3] = [1000, 2000, 4000];

fn office(size: u32) -> scenes::Scene {
    let office = load_map(&Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml")).unwrap().grid;
    scenes::tiled("office", &office, size)
}

/// What all of these must at least do: look at each byte.
#[divan::bench(args = SIZES)]
fn byte_sum(bencher: Bencher, size: u32) {
    let grid = office(size).grid;
    bencher
        .counter(ItemsCount::new(grid.data().len()))
        .bench_local(|| grid.data().iter().map(|&value| i64::from(value)).sum::<i64>());
}

/// The distance to the nearest obstacle from every cell, four bytes written for each.
#[divan::bench(args = SIZES)]
fn exact_distances(bencher: Bencher, size: u32) {
    let grid = office(size).grid;
    bencher
        .counter(ItemsCount::new(grid.data().len()))
        .bench_local(|| squared_distance_cells(grid.info(), |i| grid.data()[i] == OccupancyGrid::OCCUPIED));
}

/// The same as far as an inflation of 0.5 m needs it, as costs.
#[divan::bench(args = SIZES)]
fn inflation(bencher: Bencher, size: u32) {
    let grid = office(size).grid;
    let inflation =
        Inflation { inscribed_radius_m: 0.19, clear_radius_m: 0.0, inflation_radius_m: 0.5, cost_scaling_factor: 5.0 };
    bencher
        .counter(ItemsCount::new(grid.data().len()))
        .bench_local(|| Costmap::inflate(&grid, &Thresholds::default(), &inflation));
}

/// Rays of 8 m all round until the first cell that is not free: items are cells passed.
#[divan::bench(args = [360, 3600])]
fn rays_to_the_first_obstacle(bencher: Bencher, rays: u32) {
    let scene = office(1000);
    let (grid, from) = (&scene.grid, Point::new(scene.robot.x, scene.robot.y));
    let cast = || {
        let headings = (0..rays).map(|i| f64::from(i) / f64::from(rays) * std::f64::consts::TAU);
        let seen = |heading| {
            let ray = traverse(grid.info(), from, heading, 8.0);
            ray.take_while(|&(cell, _)| grid.get(cell) == Some(OccupancyGrid::FREE)).count()
        };
        headings.map(seen).sum::<usize>()
    };
    bencher.counter(ItemsCount::new(cast())).bench_local(|| black_box(cast()));
}
