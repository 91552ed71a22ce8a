//! The path-distance field against the binary-heap Dijkstra of the crate `pathfinding`, on
//! the same costs: `cargo bench --bench path_field`.
//!
//! The map is the office of `maps/`, or the one that `FRONTIER_BENCH_MAP` names, with the
//! robot where `FRONTIER_BENCH_AT` (x,y in metres) says:
//!
//! ```text
//! FRONTIER_BENCH_MAP=willow.yaml FRONTIER_BENCH_AT=25,20 cargo bench --bench path_field
//! ```
//!
//! Before anything is timed, the costs of all cells must be equal.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Cell, Costmap, INSCRIBED_COST, Inflation, NEIGHBOURS_8, Thresholds};
use frontier_explorer::io::load_map;
use frontier_explorer::planning::PathField;
use pathfinding::prelude::dijkstra_all;
use std::hint::black_box;
use std::path::PathBuf;
use std::sync::{Arc, LazyLock};
use std::time::{Duration, Instant};

/// A TurtleBot 2's costmap.
const INFLATION: Inflation =
    Inflation { inscribed_radius_m: 0.19, clear_radius_m: 0.0, inflation_radius_m: 0.5, cost_scaling_factor: 5.0 };

/// How often the ratio is taken; the quietest times count.
const ROUNDS: usize = 5;

/// The costmap and where the robot is.
static MAP: LazyLock<(Arc<Costmap>, Pose)> = LazyLock::new(|| {
    let (path, at) = match std::env::var("FRONTIER_BENCH_MAP") {
        Ok(path) => (PathBuf::from(path), std::env::var("FRONTIER_BENCH_AT").unwrap()),
        Err(_) => (PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml"), "1.5,7.9".to_owned()),
    };
    let (x, y) = at.split_once(',').unwrap();
    let robot = Pose::new(x.trim().parse().unwrap(), y.trim().parse().unwrap(), 0.0);
    let grid = load_map(&path).unwrap().grid;
    (Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &INFLATION)), robot)
});

fn field() -> PathField {
    PathField::new(Arc::clone(&MAP.0), &MAP.1).unwrap()
}

/// The steps from a cell and their costs, restated: 12 along a side and 17 along a
/// diagonal, times navfn's weight of the two cells, and no corner cut.
fn steps(costmap: &Costmap, from: Cell) -> Vec<(Cell, u32)> {
    let is_open = |cell: Cell| costmap.cost(cell) < INSCRIBED_COST;
    let mut steps = Vec::with_capacity(8);
    for (dx, dy) in NEIGHBOURS_8 {
        let to = from.offset((dx, dy));
        if is_open(to) && is_open(from.offset((dx, 0))) && is_open(from.offset((0, dy))) {
            let length = if dx == 0 || dy == 0 { 12 } else { 17 };
            let cost_sum = u32::from(costmap.cost(from)) + u32::from(costmap.cost(to));
            steps.push((to, length * (250 + 2 * cost_sum) / 250));
        }
    }
    steps
}

fn reference() -> std::collections::HashMap<Cell, (Cell, u32)> {
    let (costmap, robot) = &*MAP;
    dijkstra_all(&costmap.info().cell_at(robot.position()), |&cell| steps(costmap, cell)).into_iter().collect()
}

fn quietest<T>(mut work: impl FnMut() -> T) -> Duration {
    let times = (0..ROUNDS).map(|_| {
        let began = Instant::now();
        black_box(work());
        began.elapsed()
    });
    times.min().unwrap_or_default()
}

fn costs_are_equal() -> usize {
    let (costmap, robot) = &*MAP;
    let (field, reference) = (field(), reference());
    let start = costmap.info().cell_at(robot.position());
    for index in 0..costmap.info().len() {
        let cell = costmap.info().cell(index);
        let expected = reference.get(&cell).map(|&(_, cost)| f64::from(cost) / 12.0);
        let expected = if cell == start { Some(0.0) } else { expected };
        assert_eq!(field.cost_cells(cell), expected, "{cell:?}");
    }
    reference.len() + 1
}

fn main() {
    let reached = costs_are_equal();
    println!("{} cells, {reached} reached, all costs equal", MAP.0.info().len());
    let start = MAP.0.info().cell_at(MAP.1.position());
    let theirs = quietest(|| dijkstra_all(&start, |&cell| steps(&MAP.0, cell)));
    let ours = quietest(field);
    let ms = |time: Duration| time.as_secs_f64() * 1e3;
    let ratio = theirs.as_secs_f64() / ours.as_secs_f64();
    println!("pathfinding::dijkstra_all {:.1} ms, PathField {:.1} ms: {ratio:.1} times as fast", ms(theirs), ms(ours));
    divan::main();
}

#[divan::bench]
fn path_field() -> PathField {
    field()
}

#[divan::bench]
fn reach_only() -> PathField {
    PathField::reach_only(Arc::clone(&MAP.0), &MAP.1).unwrap()
}

#[divan::bench]
fn inflate() -> Costmap {
    static GRID: LazyLock<frontier_explorer::grid::OccupancyGrid> = LazyLock::new(|| {
        let path = std::env::var("FRONTIER_BENCH_MAP").map(PathBuf::from);
        load_map(&path.unwrap_or_else(|_| PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml")))
            .unwrap()
            .grid
    });
    Costmap::inflate(&GRID, &Thresholds::default(), &INFLATION)
}
