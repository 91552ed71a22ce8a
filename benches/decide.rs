//! From a map that changes or grows to a decision: `cargo bench --bench decide`.
//!
//! Offices beside each other, of which 200 x 200 cells around the robot change as by `map_updates`,
//! or which grow by 40 columns and come whole, as gmapping's do. *Anew* is the same map as one of
//! which nothing is known before; both take turns, and after that the robot decides by both maps
//! alike.
//!
//! ```text
//! cargo bench --bench decide -- 2000 4000 explore_lite wfd     # these sizes, these presets
//! ```

#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/scenes.rs"]
#[allow(dead_code)] // shared with the other benches
mod scenes;

use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::grid::{Cell, GridInfo, GridPatch, Live, OccupancyGrid};
use frontier_explorer::io::{load_map, load_preset, load_robot};
use frontier_explorer::robot::{Command, MapSnapshot, Navigation, NavigationState, Observation};
use scenes::Scene;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const ROUNDS: usize = 12;
/// The edge of the patch that changes, and the columns by which a map grows.
const PATCH: usize = 200;
const GROWN: usize = 40;

/// An explorer and the map that it has.
struct Follower<'a> {
    explorer: Explorer,
    map: Live<OccupancyGrid>,
    robot: &'a Pose,
    stamp_s: f64,
    last: Navigation,
}

impl<'a> Follower<'a> {
    fn new(preset: &str, scene: &'a Scene) -> Self {
        let mut settings = load_preset(preset).unwrap().explorer;
        settings.turns.at_start = false;
        settings.goal.reconsider_period_s = Some(1.0);
        let explorer = Explorer::new(settings, &load_robot("turtlebot2").unwrap().traits()).unwrap();
        let map = Live::new(Arc::new(scene.grid.clone()));
        let last = Navigation { command: 0, state: NavigationState::Idle };
        let mut follower = Self { explorer, map, robot: &scene.robot, stamp_s: 0.0, last };
        follower.decide();
        follower
    }

    /// What the explorer says of the map as it is.
    fn decide(&mut self) -> String {
        self.stamp_s += 1.0;
        // It drives to and fro, as one that stands still is taken to be stuck.
        let x = self.robot.x + if self.stamp_s % 2.0 < 1.0 { 0.3 } else { 0.0 };
        let (grid, changes) = (Arc::clone(self.map.newest()), self.map.changes().clone());
        let observation = Observation {
            stamp_s: self.stamp_s,
            pose_in_map: Ok(Pose { x, ..*self.robot }),
            map: Some(MapSnapshot { stamp_s: self.stamp_s, grid, changes, costmap: None }),
            scan: None,
            navigation: self.last.clone(),
        };
        let decision = self.explorer.step(&observation);
        if let Command::Drive { id, .. } = decision.command {
            self.last = Navigation { command: id, state: NavigationState::Active };
        }
        let asked = (&decision.phase, &decision.notice);
        decision.record.as_ref().unwrap_or_else(|| panic!("no decision: {asked:?}")).why.clone()
    }

    /// The time in ms from what becomes of the map to the decision, and the decision.
    fn time(&mut self, becomes: impl FnOnce(&mut Live<OccupancyGrid>)) -> (f64, String) {
        let began = Instant::now();
        becomes(&mut self.map);
        let why = self.decide();
        (began.elapsed().as_secs_f64() * 1e3, why)
    }
}

fn main() {
    let (mut sizes, mut presets) = (Vec::new(), Vec::new());
    for word in std::env::args().skip(1).filter(|word| word != "--bench") {
        match word.parse::<u32>() {
            Ok(size) => sizes.push(size),
            Err(_) => presets.push(word),
        }
    }
    if sizes.is_empty() {
        sizes = vec![1000, 2000, 4000];
    }
    if presets.is_empty() {
        presets = ["explore_lite", "wfd"].map(str::to_owned).to_vec();
    }
    let office = load_map(&Path::new(env!("CARGO_MANIFEST_DIR")).join("maps/office.yaml")).unwrap().grid;
    println!("median ms: preset, edge, patch, patch anew, grown, grown anew");
    for size in sizes {
        let scene = scenes::tiled("office", &office, size);
        for preset in &presets {
            let patch = measure(preset, &scene, |_, round| {
                let patch = patched(&scene.grid, round);
                Box::new(move |map| map.apply(&patch).unwrap())
            });
            let grown = measure(preset, &scene, |grid, round| {
                let next = Arc::new(grown(grid, round));
                Box::new(move |map| map.replace(next))
            });
            let [[patch, patch_anew], [grown, grown_anew]] = [patch, grown];
            println!("{preset:>14} {size:>5} {patch:>8.2} {patch_anew:>8.2} {grown:>8.2} {grown_anew:>8.2}");
        }
    }
}

/// What becomes of a map.
type Becomes = Box<dyn FnOnce(&mut Live<OccupancyGrid>)>;

/// The medians of a map that is followed and of one that is new each time.
fn measure(preset: &str, scene: &Scene, next: impl Fn(&OccupancyGrid, usize) -> Becomes) -> [f64; 2] {
    let (mut kept, mut anew) = (Follower::new(preset, scene), Follower::new(preset, scene));
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..ROUNDS {
        let becomes = next(kept.map.newest(), round);
        let (kept_ms, decided) = kept.time(becomes);
        let whole = Arc::new(OccupancyGrid::clone(kept.map.newest()));
        let (anew_ms, expected) = anew.time(|map| map.replace_unlike(whole));
        assert_eq!(decided, expected, "{preset} {round}");
        // The first one meets memory that is not there yet.
        if round > 0 {
            times[0].push(kept_ms);
            times[1].push(anew_ms);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

/// Values of a square near the robot: some parts of it are unknown, others each time.
fn patched(grid: &OccupancyGrid, round: usize) -> GridPatch {
    let corner = (grid.info().width() / 2 + 30, grid.info().height() / 2 - PATCH / 2);
    let cells = (0..PATCH * PATCH).map(|index| (corner.0 + index % PATCH, corner.1 + index / PATCH));
    let data = cells.map(|(x, y)| match (x / 20 + y / 20 + round) % 9 {
        0 => OccupancyGrid::UNKNOWN,
        _ => grid.get(Cell::new(x as i32, y as i32)).unwrap_or(OccupancyGrid::UNKNOWN),
    });
    let data = data.collect();
    GridPatch { corner: Cell::new(corner.0 as i32, corner.1 as i32), width: PATCH as u32, height: PATCH as u32, data }
}

/// The map with columns more in front, and the next time behind, that are seen in part.
fn grown(grid: &OccupancyGrid, round: usize) -> OccupancyGrid {
    let old = grid.info();
    let front = if round.is_multiple_of(2) { GROWN } else { 0 };
    let corner = old.from_grid_units(-(front as f64), 0.0);
    let (width, height) = (old.width() + GROWN, old.height());
    let origin = Pose::new(corner.x, corner.y, 0.0);
    let info = GridInfo::new(width as u32, height as u32, old.resolution_m(), origin).unwrap();
    let mut larger = OccupancyGrid::filled(info, OccupancyGrid::UNKNOWN);
    for (y, (to, from)) in
        larger.data_mut().chunks_exact_mut(width).zip(grid.data().chunks_exact(old.width())).enumerate()
    {
        if y % 100 < 50 {
            to[..front].fill(OccupancyGrid::FREE);
            to[front + old.width()..].fill(OccupancyGrid::FREE);
        }
        to[front..front + old.width()].copy_from_slice(from);
    }
    larger
}
