//! The worlds in `maps/`: drawn by their code, reachable everywhere, with clear starts.

#![allow(clippy::unwrap_used)] // the helpers below serve tests alone

#[path = "../examples/draw_worlds/canvas.rs"]
mod canvas;
#[path = "../examples/draw_worlds/maze.rs"]
mod maze;
#[path = "../examples/draw_worlds/museum.rs"]
mod museum;
#[path = "../examples/draw_worlds/office.rs"]
mod office;
#[path = "../examples/draw_worlds/warehouse.rs"]
mod warehouse;
#[path = "../examples/draw_worlds/worlds.rs"]
mod worlds;

use frontier_explorer::geometry::Point;
use frontier_explorer::grid::{Neighbourhood, OccupancyGrid, squared_distance_cells};
use frontier_explorer::io::{SaveOptions, load_map, save_map};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A robot with its padding: half of the narrowest slot that may be.
const BODY_RADIUS_M: f64 = 0.4;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn checked_in(name: &str) -> OccupancyGrid {
    load_map(&repository(&format!("maps/{name}.yaml"))).unwrap().grid
}

fn starts() -> BTreeMap<String, Vec<[f64; 2]>> {
    serde_saphyr::from_str(&std::fs::read_to_string(repository("configs/worlds.yaml")).unwrap()).unwrap()
}

/// Metres from each cell's centre to the nearest edge of a cell that is not free.
fn clearances_m(grid: &OccupancyGrid) -> Vec<f64> {
    let squared = squared_distance_cells(grid.info(), |i| grid.data()[i] != OccupancyGrid::FREE);
    squared.into_iter().map(|d| (f64::from(d).sqrt() - 0.5) * grid.info().resolution_m()).collect()
}

#[test]
fn the_files_are_what_the_code_draws() {
    let dir = tempfile::tempdir().unwrap();
    for (name, draw) in worlds::ALL {
        let saved = save_map(&dir.path().join(name), &draw().unwrap(), &SaveOptions::default()).unwrap();
        for path in [saved.yaml, saved.image] {
            let file = Path::new("maps").join(path.file_name().unwrap());
            let same = std::fs::read(&path).unwrap() == std::fs::read(repository("").join(&file)).unwrap();
            assert!(same, "{}: run cargo run --example draw_worlds", file.display());
        }
    }
}

#[test]
fn every_world_has_three_starts_with_room_to_turn() {
    let starts = starts();
    assert_eq!(starts.len(), worlds::ALL.len());
    for (name, _) in worlds::ALL {
        let grid = checked_in(name);
        let clearances = clearances_m(&grid);
        assert_eq!(starts[name].len(), 3, "{name}");
        for &[x, y] in &starts[name] {
            let index = grid.info().index(grid.info().cell_at(Point::new(x, y))).unwrap();
            assert!(clearances[index] >= BODY_RADIUS_M, "{name} ({x}, {y}): {} m", clearances[index]);
        }
    }
}

#[test]
fn every_free_spot_can_be_reached() {
    for (name, _) in worlds::ALL {
        let grid = checked_in(name);
        let info = *grid.info();
        let clearances = clearances_m(&grid);
        for &[x, y] in &starts()[name] {
            let mut reached = vec![false; info.len()];
            let mut open = vec![info.index(info.cell_at(Point::new(x, y))).unwrap()];
            while let Some(index) = open.pop() {
                if !reached[index] && clearances[index] >= BODY_RADIUS_M {
                    reached[index] = true;
                    open.extend(info.neighbours(info.cell(index), Neighbourhood::Four).filter_map(|c| info.index(c)));
                }
            }
            // A right-angled corner is sqrt(2) radii from the disc that fills it.
            let within_m = BODY_RADIUS_M * 2_f64.sqrt() + 0.1;
            let to_reached = squared_distance_cells(&info, |i| reached[i]);
            let lost = (0..info.len()).find(|&i| {
                grid.data()[i] == OccupancyGrid::FREE
                    && f64::from(to_reached[i]).sqrt() * info.resolution_m() > within_m
            });
            let lost = lost.map(|i| info.center(info.cell(i)));
            assert_eq!(lost, None, "{name} from ({x}, {y})");
        }
    }
}

#[test]
fn buildings_are_closed_and_their_outer_walls_solid() {
    for (name, _) in worlds::ALL {
        let grid = checked_in(name);
        let to_unknown = squared_distance_cells(grid.info(), |i| grid.data()[i] == OccupancyGrid::UNKNOWN);
        let free = (0..grid.data().len()).filter(|&i| grid.data()[i] == OccupancyGrid::FREE);
        // More than two cells from centre to centre leave at least two between.
        assert!(free.map(|i| to_unknown[i]).min().unwrap() > 8, "{name}");
    }
}
