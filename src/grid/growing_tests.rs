//! Maps that change and grow on any side, and what is kept of them: as if made anew.

use super::*;
use crate::geometry::{Areas, Point, Polygon, Pose};
use proptest::prelude::*;
use std::sync::Arc;

/// What becomes of a map.
#[derive(Clone, Debug)]
pub struct Step {
    /// The columns in front and behind, and the rows below and above, that come.
    sides: [u32; 4],
    /// Cells by their share of all, with what they become.
    cells: Vec<(f64, i8)>,
    /// What the cells that come are drawn from.
    seed: u64,
    /// Whether those who keep something look at this version.
    pub is_seen: bool,
}

fn value() -> impl Strategy<Value = i8> {
    prop_oneof![8 => Just(0i8), 2 => Just(-1), 1 => Just(100)]
}

fn step() -> impl Strategy<Value = Step> {
    let side = || prop_oneof![3 => Just(0u32), 1 => 1u32..9, 1 => 60u32..70];
    let sides = prop_oneof![1 => Just([0; 4]), 1 => [side(), side(), side(), side()]];
    let cells = proptest::collection::vec((0.0..1.0, value()), 0..5);
    (sides, cells, any::<u64>(), prop::bool::weighted(0.8)).prop_map(|(sides, cells, seed, is_seen)| Step {
        sides,
        cells,
        seed,
        is_seen,
    })
}

/// Cells that look like drawn, of which one in `walls` is a wall.
fn drawn(index: usize, seed: u64, walls: u64) -> i8 {
    let mixed = (index as u64 ^ seed).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    match (mixed >> 32) % walls {
        0 => 100,
        1 | 2 => -1,
        _ => 0,
    }
}

/// A first map with cells of 0.1 m, and what becomes of it.
pub fn growing() -> impl Strategy<Value = (Live<OccupancyGrid>, Vec<Step>)> {
    let steps = proptest::collection::vec(step(), 1..7);
    (1u32..40, 1u32..40, any::<u64>(), steps).prop_map(|(width, height, seed, steps)| {
        let info = GridInfo::new(width, height, 0.1, Pose::new(-1.0, 0.3, 0.0)).unwrap();
        let values = (0..info.len()).map(|index| drawn(index, seed, 30)).collect();
        (Live::new(Arc::new(OccupancyGrid::new(info, values).unwrap())), steps)
    })
}

impl Step {
    /// Takes the step; the map is compared with the last one.
    pub fn take(&self, map: &mut Live<OccupancyGrid>) {
        let old = *map.newest().info();
        let [left, right, low, high] = self.sides;
        let corner = old.from_grid_units(-f64::from(left), -f64::from(low));
        let origin = Pose::new(corner.x, corner.y, 0.0);
        let size = (old.width() as u32 + left + right, old.height() as u32 + low + high);
        let info = if self.sides == [0; 4] { old } else { GridInfo::new(size.0, size.1, 0.1, origin).unwrap() };
        let mut next = OccupancyGrid::filled(info, 0);
        for index in 0..info.len() {
            let cell = info.cell(index);
            let before = map.newest().get(cell.offset((-(left as i32), -(low as i32))));
            next.set(cell, before.unwrap_or_else(|| drawn(index, self.seed, 30)));
        }
        for &(share, value) in &self.cells {
            next.set(info.cell((share * info.len() as f64) as usize), value);
        }
        map.replace(Arc::new(next));
    }
}

/// Whether what is told of two states holds all cells in which they differ.
pub fn is_told<T: CellValues>(last: &Snapshot<T>, next: &Snapshot<T>) -> bool {
    let (old, new) = (last.cells.info(), next.cells.info());
    let values = [last.cells.values(), next.cells.values()];
    let (growth, told) = match next.changes.since_on((last.changes.version(), old), new) {
        Since::Part(told) => (Growth::none(new), told),
        Since::Grown(growth, told) => (growth, told),
        Since::All => return false,
    };
    let differs = growth.changed(values, &CellRect::of(new)).unwrap_or_default();
    told.union(differs) == told || differs.is_empty()
}

proptest! {
    #[test]
    fn costs_of_a_growing_map_are_as_if_inflated_anew(
        (mut map, steps) in growing(),
        inflation_radius_m in 0.0f64..1.0,
        clear_radius_m in 0.0f64..0.3,
    ) {
        let thresholds = Thresholds::default();
        let inflation = Inflation { inscribed_radius_m: 0.1, clear_radius_m, inflation_radius_m, cost_scaling_factor: 3.0 };
        let (mut live, mut roomy) = (LiveCostmap::new(thresholds, inflation), Roomy::default());
        let mut last = live.update(map.newest(), map.changes());
        let mut last_roomy = roomy.update(&last);
        for step in steps {
            step.take(&mut map);
            if step.is_seen {
                let costs = live.update(map.newest(), map.changes());
                let all = Costmap::inflate(map.newest(), &thresholds, &inflation);
                prop_assert_eq!(&*costs.cells, &all);
                prop_assert!(is_told(&last, &costs));
                let made = roomy.update(&costs);
                prop_assert_eq!(&*made.cells, &all.without_narrow().unwrap_or(all));
                prop_assert!(is_told(&last_roomy, &made));
                (last, last_roomy) = (costs, made);
            }
        }
    }

    #[test]
    fn a_growing_map_is_counted_as_if_anew((mut map, steps) in growing(), (x, y) in (-2.0f64..2.0, -2.0f64..2.0)) {
        let thresholds = Thresholds::default();
        let corners = [(x, y), (x + 2.0, y), (x, y + 3.0)].map(|(x, y)| Point::new(x, y));
        let areas = Areas { region: Some(Polygon::new(corners.to_vec()).unwrap()), no_go: Vec::new() };
        let (mut all, mut everywhere, mut inside) =
            (LiveCensus::new(thresholds), AreaCensus::new(thresholds), AreaCensus::new(thresholds));
        inside.set_areas(&areas);
        for step in steps {
            if step.is_seen {
                let (grid, changes) = (map.newest(), map.changes());
                let census = grid.census(&thresholds);
                prop_assert_eq!([all.update(grid, changes), everywhere.update(grid, changes)], [census; 2]);
                let census = AreaCells::of(grid.info(), &areas, 0.0).census(grid, &thresholds);
                prop_assert_eq!(inside.update(grid, changes), census);
            }
            step.take(&mut map);
        }
    }
}

/// What is copied is told: a wall that comes before the first column reaches into what was there.
#[test]
fn a_wall_on_a_new_column_reaches_the_old_ones_and_no_farther() {
    let inflation =
        Inflation { inscribed_radius_m: 0.1, clear_radius_m: 0.0, inflation_radius_m: 0.2, cost_scaling_factor: 1.0 };
    let info = |width, x| GridInfo::new(width, 1, 0.1, Pose::new(x, 0.0, 0.0)).unwrap();
    let mut map = Live::new(Arc::new(OccupancyGrid::filled(info(8, 0.0), 0)));
    let mut live = LiveCostmap::new(Thresholds::default(), inflation);
    let first = live.update(map.newest(), map.changes());
    let mut next = OccupancyGrid::filled(info(10, -0.2), 0);
    next.set(Cell::new(1, 0), 100);
    map.replace(Arc::new(next));
    let second = live.update(map.newest(), map.changes());
    let since = second.changes.since_on((first.changes.version(), first.cells.info()), second.cells.info());
    let Since::Grown(growth, told) = since else { panic!("{since:?}") };
    assert_eq!((growth.corner(), told), ((2, 0), CellRect { x: 2, y: 0, width: 2, height: 1 }));
}
