//! What a detection costs against the size of the map: `cargo bench --bench detect`.
//!
//! Each way of detecting is timed beside the textbook's detector and beside one pass that
//! sums the map's bytes, in turns, so that what disturbs one disturbs all; the fastest
//! round of each counts. Before that, what they find must be equal.
//!
//! ```text
//! cargo bench --bench detect -- 1000 2000 office        # these sizes, this scene
//! cargo bench --bench detect -- --svg docs/performance.svg --markdown
//! FRONTIER_BENCH_MAP=willow.yaml FRONTIER_BENCH_AT=25,20 cargo bench --bench detect
//!                                                       # that floor, tiled, too
//! ```

#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/plot.rs"]
mod plot;
#[path = "support/scenes.rs"]
mod scenes;
#[path = "support/table.rs"]
mod table;

use frontier_explorer::frontier::{
    DetectionInput, DetectorParams, FromScratch, Frontier, FrontierDetector, Repair, Wavefront,
};
use frontier_explorer::geometry::{Point, Pose};
use frontier_explorer::grid::{Cell, CellRect, GridInfo, OccupancyGrid};
use frontier_explorer::io::load_map;
use scenes::Scene;
use std::cell::RefCell;
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

const SIZES: [u32; 5] = [500, 1000, 2000, 4000, 8000];

/// The edge of the patch that changes, cells.
const PATCH: usize = 200;

/// Columns to the left and rows below by which a map grows.
const GROWN: [usize; 2] = [40, 24];

/// The times of one scene, milliseconds.
pub struct Row {
    /// What the map shows.
    pub scene: &'static str,
    /// Its edge, cells.
    pub size: u32,
    /// How many were found.
    pub frontiers: usize,
    /// Of one pass that sums the bytes.
    pub byte_sum_ms: f64,
    /// Of the textbook's detector.
    pub textbook_ms: f64,
    /// Of the detector on bit planes, from scratch.
    pub bitplane_ms: f64,
    /// Of a patch changed, told which, after all that the others read and wrote.
    pub patch_ms: f64,
    /// The same once more at once, with its memory at hand.
    pub patch_again_ms: f64,
    /// Of a patch changed, not told which.
    pub resent_ms: f64,
    /// Of a map that grew by unknown cells on two sides, told that nothing else changed: the first
    /// time, when the planes grow too, and the second.
    pub grown_ms: [f64; 2],
    /// The state of the detector from scratch and of the one that keeps the map, bytes a cell.
    pub memory: [f64; 2],
}

/// The arguments after `--`.
#[derive(Default)]
struct Options {
    sizes: Vec<u32>,
    scenes: Vec<String>,
    svg: Option<PathBuf>,
    markdown: bool,
}

fn options() -> Options {
    let mut options = Options::default();
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        match arg.as_str() {
            "--bench" => {}
            "--svg" => options.svg = args.next().map(PathBuf::from),
            "--markdown" => options.markdown = true,
            word => match word.parse() {
                Ok(size) => options.sizes.push(size),
                Err(_) => options.scenes.push(word.to_owned()),
            },
        }
    }
    if options.sizes.is_empty() {
        options.sizes = SIZES.to_vec();
    }
    options
}

fn main() {
    let options = options();
    let office = load_map(&Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml")).unwrap().grid;
    let other = std::env::var_os("FRONTIER_BENCH_MAP").map(|path| {
        let at = std::env::var("FRONTIER_BENCH_AT").unwrap();
        let (x, y) = at.split_once(',').unwrap();
        (load_map(Path::new(&path)).unwrap().grid, Point::new(x.parse().unwrap(), y.parse().unwrap()))
    });
    let mut rows = Vec::new();
    for &size in &options.sizes {
        for name in ["office", "other", "noise", "shut-in", "maze", "empty"] {
            if !options.scenes.is_empty() && !options.scenes.iter().any(|wanted| wanted == name) {
                continue;
            }
            let scene = match name {
                "office" => scenes::tiled(name, &office, size),
                "other" => match &other {
                    Some((floor, at)) => scenes::standing(scenes::tiled(name, floor, size), floor, *at),
                    None => continue,
                },
                "noise" => scenes::salt_and_pepper(name, size, 70),
                "shut-in" => scenes::salt_and_pepper(name, size, 33),
                "maze" => scenes::maze(size),
                _ => scenes::empty(size),
            };
            let row = measure(&scene, size);
            if rows.is_empty() {
                println!("{}", table::header());
            }
            println!("{}", table::line(&row));
            rows.push(row);
        }
    }
    if options.markdown {
        println!("\n{}", table::markdown(&rows));
    }
    if let Some(path) = options.svg {
        plot::draw(&path, &rows).unwrap();
        println!("drawn to {}", path.display());
    }
}

/// Something that is timed: the least of its times, and what all of them took.
struct Contender<'a> {
    /// What is done before, and not timed.
    prepare: Box<dyn FnMut() + 'a>,
    work: Box<dyn FnMut() + 'a>,
    least_ms: f64,
    spent_ms: f64,
}

impl<'a> Contender<'a> {
    fn new(work: impl FnMut() + 'a) -> Self {
        Self::prepared(|| (), work)
    }

    fn prepared(prepare: impl FnMut() + 'a, work: impl FnMut() + 'a) -> Self {
        Self { prepare: Box::new(prepare), work: Box::new(work), least_ms: f64::INFINITY, spent_ms: 0.0 }
    }
}

/// Rounds at most, and how long one contender may take in all.
const ROUNDS: usize = 41;
const BUDGET_MS: f64 = 2000.0;

fn measure(scene: &Scene, size: u32) -> Row {
    let params = DetectorParams::default();
    let changed = with_patch(&scene.grid);
    let patch = CellRect { x: changed.1.x, y: changed.1.y, width: PATCH, height: PATCH };
    let inputs = [&scene.grid, &changed.0].map(|grid| DetectionInput::new(grid, scene.robot));
    let mut bitplane = FromScratch::new(params);
    let mut textbook = Wavefront::new(params);
    let frontiers = bitplane.detect(&inputs[0]).unwrap();
    let mut kept = [Repair::new(params), Repair::new(params)];
    for kept in &mut kept {
        assert_eq!(kept.update(&inputs[0], None).unwrap().len(), frontiers.len());
        for (input, told) in
            [(&inputs[1], None), (&inputs[0], Some(patch)), (&inputs[1], Some(patch)), (&inputs[0], None)]
        {
            let expected = bitplane.detect(input).unwrap();
            assert!(
                Frontier::all_of(&Arc::new(kept.update(input, told).unwrap().clone())) == expected,
                "{} {size}",
                scene.name
            );
        }
    }
    if size <= 2000 {
        assert!(textbook.detect(&inputs[0]).unwrap() == frontiers, "{} {size}", scene.name);
    }
    let larger = [grown(&scene.grid), grown(&grown(&scene.grid))];
    let larger = larger.each_ref().map(|grid| DetectionInput::new(grid, scene.robot));
    let mut before = vec![kept[0].clone()];
    for input in &larger {
        let mut grows = before[before.len() - 1].clone();
        let found = Arc::new(grows.update(input, Some(CellRect::default())).unwrap().clone());
        assert!(Frontier::all_of(&found) == bitplane.detect(input).unwrap(), "{} {size}", scene.name);
        before.push(grows);
    }
    let grows = RefCell::new(Repair::new(params));
    let grow = |at: usize| {
        let (grows, before, input) = (&grows, &before[at], &larger[at]);
        Contender::prepared(
            || grows.borrow_mut().clone_from(before),
            || {
                black_box(grows.borrow_mut().update(input, Some(CellRect::default())).unwrap());
            },
        )
    };
    bitplane.detect_cells(&inputs[0]).unwrap();
    let cells = scene.grid.data().len() as f64;
    let memory = [bitplane.memory_bytes() as f64 / cells, kept[0].memory_bytes() as f64 / cells];
    let [by_patch, by_grid] = &mut kept;
    let by_patch = RefCell::new((by_patch, 0));
    let told = || {
        let (kept, turn) = &mut *by_patch.borrow_mut();
        *turn = 1 - *turn;
        black_box(kept.update(&inputs[*turn], Some(patch)).unwrap());
    };
    let mut turn = 0;
    let mut contenders = [
        Contender::new(|| {
            black_box(scene.grid.data().iter().map(|&value| i64::from(value)).sum::<i64>());
        }),
        Contender::new(|| {
            black_box(textbook.detect(&inputs[0]).unwrap());
        }),
        Contender::new(|| {
            black_box(bitplane.detect_cells(&inputs[0]).unwrap());
        }),
        Contender::new(told),
        Contender::new(told),
        Contender::new(|| {
            turn = 1 - turn;
            black_box(by_grid.update(&inputs[turn], None).unwrap());
        }),
        grow(0),
        grow(1),
    ];
    for _ in 0..ROUNDS {
        for contender in contenders.iter_mut().filter(|c| c.spent_ms < BUDGET_MS) {
            (contender.prepare)();
            let began = Instant::now();
            (contender.work)();
            let took_ms = began.elapsed().as_secs_f64() * 1e3;
            contender.spent_ms += took_ms;
            contender.least_ms = contender.least_ms.min(took_ms);
        }
    }
    let [byte_sum_ms, textbook_ms, bitplane_ms, patch_ms, patch_again_ms, resent_ms, grown_ms, grown_again_ms] =
        contenders.map(|contender| contender.least_ms);
    Row {
        scene: scene.name,
        size,
        frontiers: frontiers.len(),
        byte_sum_ms,
        textbook_ms,
        bitplane_ms,
        patch_ms,
        patch_again_ms,
        resent_ms,
        grown_ms: [grown_ms, grown_again_ms],
        memory,
    }
}

/// The map with unknown cells more to the left and below.
fn grown(grid: &OccupancyGrid) -> OccupancyGrid {
    let old = grid.info();
    let corner = old.from_grid_units(-(GROWN[0] as f64), -(GROWN[1] as f64));
    let (width, height) = (old.width() + GROWN[0], old.height() + GROWN[1]);
    let origin = Pose::new(corner.x, corner.y, 0.0);
    let info = GridInfo::new(width as u32, height as u32, old.resolution_m(), origin).unwrap();
    let mut larger = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
    let rows = larger.data_mut().chunks_exact_mut(width).skip(GROWN[1]);
    for (to, from) in rows.zip(grid.data().chunks_exact(old.width())) {
        to[GROWN[0]..].copy_from_slice(from);
    }
    larger
}

/// The map with another patch near the robot: part unknown, part specks.
fn with_patch(grid: &OccupancyGrid) -> (OccupancyGrid, CellRect) {
    let mut changed = grid.clone();
    let middle = (grid.info().width() / 2, grid.info().height() / 2);
    let (x, y) = (middle.0 + 30, middle.1 - PATCH / 2);
    let rect = CellRect { x, y, width: PATCH, height: PATCH };
    for row in y..y + PATCH {
        for column in x..x + PATCH {
            let cell = Cell::new(column as i32, row as i32);
            if (column / 20 + row / 20).is_multiple_of(3) {
                changed.set(cell, OccupancyGrid::UNKNOWN);
            } else if (column * 31 + row * 17).is_multiple_of(53) {
                changed.set(cell, OccupancyGrid::FREE);
            }
        }
    }
    (changed, rect)
}
