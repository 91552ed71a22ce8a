//! What a detector takes once it has seen a map: no allocation, and a byte a cell at most.

#![allow(clippy::unwrap_used)]

#[path = "../benches/support/scenes.rs"]
#[allow(dead_code)] // shared with the benches
mod scenes;

use frontier_explorer::frontier::{DetectionInput, DetectorParams, FromScratch, Reachability, Repair};
use frontier_explorer::grid::{Cell, CellRect, Neighbourhood, OccupancyGrid};
use frontier_explorer::io::load_map;
use scenes::Scene;
use std::path::Path;

fn office(size: u32) -> Scene {
    let office = load_map(&Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml")).unwrap().grid;
    scenes::tiled("office", &office, size)
}

/// The scenes, each with another map that differs in a patch.
fn maps() -> Vec<(Scene, OccupancyGrid)> {
    let noise = [("shut-in", 33), ("noise", 70)].map(|(name, free)| scenes::salt_and_pepper(name, 1000, free));
    let scenes = [office(1000), scenes::empty(1000), scenes::maze(1000)].into_iter().chain(noise);
    let with_patch = |scene: Scene| {
        let mut changed = scene.grid.clone();
        for (dx, dy) in [(40, 0), (-60, 30), (20, 70)] {
            scenes::disc(&mut changed, Cell::new(500 + dx, 500 + dy), 20, OccupancyGrid::UNKNOWN);
        }
        (scene, changed)
    };
    scenes.map(with_patch).collect()
}

fn all_params() -> Vec<DetectorParams> {
    let mut all = Vec::new();
    for reachability in [Reachability::Textbook, Reachability::WallsBlock] {
        for neighbours in [Neighbourhood::Four, Neighbourhood::Eight] {
            all.push(DetectorParams { reachability, neighbours, ..DetectorParams::default() });
        }
    }
    all
}

#[test]
fn nothing_is_allocated_in_the_steady_state() {
    let patch = Some(CellRect { x: 400, y: 400, width: 200, height: 200 });
    for (scene, changed) in maps() {
        let inputs = [&scene.grid, &changed].map(|grid| DetectionInput::new(grid, scene.robot));
        for params in all_params() {
            let mut bitplane = FromScratch::new(params);
            let mut kept = Repair::new(params);
            let mut detect_all = || {
                let mut cells = 0;
                for input in &inputs {
                    cells += bitplane.detect_cells(input).unwrap().len();
                    cells += kept.update(input, patch).unwrap().len();
                    cells += kept.update(input, None).unwrap().len();
                }
                cells
            };
            let expected = detect_all();
            // The second time the buffers have seen both maps follow each other.
            assert_eq!(detect_all(), expected);
            let mut found = 0;
            let allocations = allocation_counter::measure(|| found = detect_all());
            assert_eq!((found, allocations.count_total), (expected, 0), "{} {params:?}", scene.name);
        }
    }
}

#[test]
fn the_state_is_a_byte_a_cell_at_most() {
    for (scene, changed) in maps() {
        let inputs = [&scene.grid, &changed].map(|grid| DetectionInput::new(grid, scene.robot));
        for params in all_params() {
            let mut bitplane = FromScratch::new(params);
            let mut kept = Repair::new(params);
            for input in &inputs {
                bitplane.detect_cells(input).unwrap();
                kept.update(input, None).unwrap();
            }
            let cells = scene.grid.data().len();
            for bytes in [bitplane.memory_bytes(), kept.memory_bytes()] {
                assert!(bytes <= cells, "{} {params:?}: {bytes} bytes for {cells} cells", scene.name);
            }
        }
    }
}

#[test]
fn the_account_of_memory_is_what_is_allocated() {
    let scene = office(1000);
    let input = DetectionInput::new(&scene.grid, scene.robot);
    for params in all_params() {
        let mut detectors = None;
        let mut accounted = 0;
        let allocated = allocation_counter::measure(|| {
            let (mut bitplane, mut kept) = (FromScratch::new(params), Repair::new(params));
            let found = bitplane.detect_cells(&input).unwrap().memory_bytes();
            let kept_found = kept.update(&input, None).unwrap().memory_bytes();
            accounted = bitplane.memory_bytes() + found + kept.memory_bytes() + kept_found;
            detectors = Some((bitplane, kept));
        });
        let allocated = allocated.bytes_current as f64;
        let off = (accounted as f64 - allocated).abs() / allocated;
        assert!(off < 0.01, "{accounted} bytes accounted for, {allocated} allocated with {params:?}");
    }
}
