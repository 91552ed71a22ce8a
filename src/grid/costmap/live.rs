//! The costmap of a map that changes, made for the price of what changed.

use super::{Costmap, INSCRIBED_COST, Inflation, NARROW_COST};
use crate::grid::{CellRect, CellValues, Changes, Known, Live, OccupancyGrid, Since, Snapshot, Thresholds};
use std::ops::Range;
use std::sync::Arc;

/// Inflates each version of a map once.
#[derive(Clone, Debug)]
pub struct LiveCostmap {
    thresholds: Thresholds,
    inflation: Inflation,
    /// The costs, with the version of the map that they are of.
    made: Option<(u64, Live<Costmap>)>,
}

impl LiveCostmap {
    /// No costs yet.
    #[must_use]
    pub const fn new(thresholds: Thresholds, inflation: Inflation) -> Self {
        Self { thresholds, inflation, made: None }
    }

    /// The costs of a version of the map, the same as [`Costmap::inflate`] gives. O(cells that
    /// changed since the last call and around them) where `changes` knows them; where the map grew,
    /// all others are copied.
    pub fn update(&mut self, grid: &OccupancyGrid, changes: &Changes) -> Snapshot<Costmap> {
        let Self { thresholds, inflation, made } = self;
        let Some((version, live)) = made else {
            let live = Live::new(Arc::new(Costmap::inflate(grid, thresholds, inflation)));
            return made.insert((changes.version(), live)).1.snapshot();
        };
        let info = grid.info();
        let since = changes.since_on((*version, live.newest().info()), info);
        *version = changes.version();
        match (since, inflation.reach_within(info)) {
            (since, Some(_)) if since.is_nothing() => {}
            (Since::Part(changed), Some(reach)) => {
                let written = changed.grown(reach, info);
                live.change(written, |costmap| costmap.reinflate(grid, written, reach, thresholds, inflation));
            }
            (Since::Grown(growth, changed), Some(reach)) => {
                let write = |costmap: &mut Costmap, part: &CellRect| {
                    costmap.reinflate(grid, *part, reach, thresholds, inflation);
                };
                live.grow(&growth, changed.grown(reach, info), reach, write);
            }
            _ => live.replace(Arc::new(Costmap::inflate(grid, thresholds, inflation))),
        }
        live.snapshot()
    }
}

/// Costmaps for a robot that keeps to where it can turn: what is passable and narrow, as by
/// [`Inflation::clear_radius_m`], is not passable here.
#[derive(Clone, Debug, Default)]
pub struct Roomy {
    known: Known,
    /// How many narrow cells there are in each row.
    narrow: Vec<u32>,
    made: Option<Live<Costmap>>,
}

impl Roomy {
    /// The costmap without what is narrow; the same one where nothing is. O(rows that changed
    /// since the last call).
    pub fn update(&mut self, costs: &Snapshot<Costmap>) -> Snapshot<Costmap> {
        let info = costs.cells.info();
        let since = self.known.renew(&costs.changes, info);
        self.count(&costs.cells, &since);
        if self.narrow.iter().all(|&cells| cells == 0) {
            self.made = None;
            return costs.clone();
        }
        let write = |roomy: &mut Costmap, part: &CellRect| {
            roomy.copy_rect(&costs.cells, part);
            close_narrow(roomy, part);
        };
        Live::follow(&mut self.made, &since, info, write, || {
            let mut roomy = Costmap::clone(&costs.cells);
            close_narrow(&mut roomy, &CellRect::of(info));
            roomy
        });
        // Cell by cell it follows from the costs: where these did not change, it did not.
        let cells = self.made.as_ref().map_or(&costs.cells, Live::newest);
        Snapshot { cells: Arc::clone(cells), changes: costs.changes.clone() }
    }

    /// Counts what is narrow in each row that changed, and in those that grew what is new.
    fn count(&mut self, costs: &Costmap, since: &Since) {
        let info = costs.info();
        let count = |cells: &[u8]| cells.iter().filter(|&&cost| is_narrow(cost)).count() as u32;
        let (new, changed) = match since {
            Since::Part(changed) => ([CellRect::default(); 4], *changed),
            Since::Grown(growth, changed) => {
                self.narrow = growth.rows(&self.narrow, 0);
                (growth.outside(0), *changed)
            }
            Since::All => ([CellRect::default(); 4], CellRect::of(info)),
        };
        self.narrow.resize(info.height(), 0);
        let is_anew = changed.rows(info);
        for part in new {
            for (y, row) in rows(costs, part.rows(info)).filter(|(y, _)| !is_anew.contains(y)) {
                self.narrow[y] += count(&row[part.columns(info)]);
            }
        }
        for (y, row) in rows(costs, is_anew) {
            self.narrow[y] = count(row);
        }
    }
}

impl Costmap {
    /// The same costmap for a robot that keeps to where it can turn, as `Roomy` makes it of
    /// costmaps that change. `None` where nothing is narrow.
    #[must_use]
    pub fn without_narrow(&self) -> Option<Self> {
        if !self.costs.iter().any(|&cost| is_narrow(cost)) {
            return None;
        }
        let mut roomy = self.clone();
        close_narrow(&mut roomy, &CellRect::of(&self.info));
        Some(roomy)
    }
}

const fn is_narrow(cost: u8) -> bool {
    NARROW_COST <= cost && cost < INSCRIBED_COST
}

fn close_narrow(costmap: &mut Costmap, rect: &CellRect) {
    let (rows, columns) = (rect.rows(&costmap.info), rect.columns(&costmap.info));
    let width = costmap.info.width();
    for row in costmap.costs.chunks_exact_mut(width).skip(rows.start).take(rows.len()) {
        for cost in &mut row[columns.clone()] {
            *cost = if is_narrow(*cost) { INSCRIBED_COST } else { *cost };
        }
    }
}

fn rows(costmap: &Costmap, rows: Range<usize>) -> impl Iterator<Item = (usize, &[u8])> {
    rows.clone().zip(costmap.costs.chunks_exact(costmap.info.width()).skip(rows.start))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::grid::{GridInfo, GridPatch};
    use proptest::prelude::*;

    fn value() -> impl Strategy<Value = i8> {
        prop_oneof![8 => Just(0i8), 2 => Just(-1), 1 => Just(100)]
    }

    proptest! {
        #[test]
        fn what_changed_is_inflated_as_if_all_were(
            (width, first, changes) in (1usize..60, 1usize..60).prop_flat_map(|(w, h)| {
                let change = proptest::collection::vec((0..w * h, value()), 0..4);
                (Just(w), proptest::collection::vec(value(), w * h), proptest::collection::vec((change, any::<bool>()), 1..5))
            }),
            radius_m in 0.0f64..20.0,
            clear_radius_m in 0.0f64..3.0,
        ) {
            let info = GridInfo::new(width as u32, (first.len() / width) as u32, 1.0, Pose::default()).unwrap();
            let thresholds = Thresholds::default();
            let inflation =
                Inflation { inscribed_radius_m: 1.0, clear_radius_m, inflation_radius_m: radius_m, cost_scaling_factor: 1.0 };
            let mut map = Live::new(Arc::new(OccupancyGrid::new(info, first).unwrap()));
            let (mut live, mut roomy) = (LiveCostmap::new(thresholds, inflation), Roomy::default());
            let mut readers = Vec::new();
            for (change, looked_at) in changes {
                let mut next = OccupancyGrid::clone(map.newest());
                change.into_iter().for_each(|(index, value)| next.set(info.cell(index), value));
                map.replace(Arc::new(next));
                // A version may be skipped.
                if looked_at {
                    let costs = live.update(map.newest(), map.changes());
                    let all = Costmap::inflate(map.newest(), &thresholds, &inflation);
                    prop_assert_eq!(&*costs.cells, &all);
                    let made = roomy.update(&costs);
                    prop_assert_eq!(&*made.cells, &all.without_narrow().unwrap_or(all));
                    readers.push((costs, made));
                }
            }
        }
    }

    #[test]
    fn a_grown_map_is_inflated_as_if_anew() {
        let (old, new) = (OccupancyGrid::from_ascii("#..").unwrap(), OccupancyGrid::from_ascii("#....").unwrap());
        let inflation = Inflation {
            inscribed_radius_m: 1.0,
            clear_radius_m: 0.0,
            inflation_radius_m: 3.0,
            cost_scaling_factor: 1.0,
        };
        let mut map = Live::new(Arc::new(old));
        let mut live = LiveCostmap::new(Thresholds::default(), inflation);
        live.update(map.newest(), map.changes());
        map.replace(Arc::new(new));
        let costs = live.update(map.newest(), map.changes());
        assert_eq!(*costs.cells, Costmap::inflate(map.newest(), &Thresholds::default(), &inflation));
    }

    /// An update that keeps its stamp, and one that comes twice.
    #[test]
    fn costs_belong_to_the_version_of_a_map() {
        let inflation = Inflation {
            inscribed_radius_m: 1.0,
            clear_radius_m: 0.0,
            inflation_radius_m: 3.0,
            cost_scaling_factor: 1.0,
        };
        let mut map = Live::new(Arc::new(OccupancyGrid::from_ascii("......").unwrap()));
        let mut live = LiveCostmap::new(Thresholds::default(), inflation);
        let first = live.update(map.newest(), map.changes());
        map.apply(&GridPatch { corner: crate::grid::Cell::new(0, 0), width: 1, height: 1, data: vec![100] }).unwrap();
        let second = live.update(map.newest(), map.changes());
        assert_eq!((first.cells.costs()[0], second.cells.costs()[0]), (0, 254));
        let third = live.update(map.newest(), map.changes());
        assert!(Arc::ptr_eq(&second.cells, &third.cells));
    }
}
