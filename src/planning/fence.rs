//! Costmaps for a robot that keeps to a region and out of no-go areas.
//!
//! A cell that the areas forbid is no place for the robot's centre; the robot's body keeps out
//! of no-go areas. Nothing is seen as an obstacle there: from a place inside, the robot may look
//! across. A robot that stands where it may not be leaves by the shortest way, which is opened
//! for it, and where no way into its region is known yet it may look for one outside.

use super::endpoints::ESCAPE_RADIUS_M;
use crate::geometry::{Areas, Path, Point, Pose};
use crate::grid::{
    AreaCells, Cell, CellRect, CellValues, Changes, Costmap, GridInfo, INSCRIBED_COST, LETHAL_COST, Live,
    Neighbourhood, Since, Snapshot, UNKNOWN_COST,
};
use std::collections::{HashSet, VecDeque};
use std::sync::Arc;

/// A place inside that is smaller than this is only gone to where there is no larger one, square
/// metres.
const POCKET_M2: f64 = 1.0;

/// So far beside its way in a robot may drive, so that a planner that knows how it turns finds one,
/// metres; and so far beside its way out of a no-go area.
const BESIDE_M: f64 = 0.75;
const BESIDE_OUT_M: f64 = 0.4;

/// Where a robot stands, by its areas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Whereabouts {
    /// Inside: in the region, and away from no-go areas.
    #[default]
    Inside,
    /// Outside, and a way of so many metres leads in.
    Leaving {
        /// Whether it stands in a no-go area, or too near to one.
        no_go: bool,
        /// How long the way is, metres.
        way_m: f64,
    },
    /// Outside, and no way in is known.
    LockedOut {
        /// Whether it stands in a no-go area, or too near to one, and cannot leave that.
        no_go: bool,
    },
}

/// The cells of a grid that a robot may be in, as it stands.
#[derive(Clone, Debug)]
pub struct Fenced {
    info: GridInfo,
    cells: Arc<AreaCells>,
    /// Whether it is kept in its region: no longer where no way into it is known.
    keeps_region: bool,
    /// The cells of its way in, which are open to it.
    way_in: HashSet<Cell>,
}

impl Fenced {
    /// Whether a robot that is inside may be at a point.
    #[must_use]
    pub fn allows(&self, point: Point) -> bool {
        !self.forbids(self.info.cell_at(point))
    }

    /// Whether a path stays inside once it is there.
    #[must_use]
    pub fn keeps(&self, path: &Path) -> bool {
        let step_m = 0.5 * self.info.resolution_m();
        let between = |pair: &[Pose]| {
            let (from, to) = (pair[0].position(), pair[1].position());
            let steps = (nalgebra::distance(&from, &to) / step_m).ceil().clamp(1.0, 1e5) as u32;
            (1..=steps).map(move |step| from + (to - from) * (f64::from(step) / f64::from(steps)))
        };
        let mut points = path.poses.windows(2).flat_map(between).map(|point| self.allows(point));
        let leaves_again = points.by_ref().skip_while(|is_inside| !is_inside).any(|is_inside| !is_inside);
        !leaves_again && path.poses.last().is_none_or(|last| self.allows(last.position()))
    }

    fn forbids(&self, cell: Cell) -> bool {
        self.cells.is_near_no_go(cell) || self.keeps_region && self.cells.is_outside_region(cell)
    }

    /// Where closed costs may differ from those that were closed for another place of the robot, before
    /// the costs changed.
    fn since(&self, last: &Self, since: Since) -> Since {
        let way_in: HashSet<Cell> = last.way_in.iter().map(|cell| cell.offset(since.offset())).collect();
        let other = way_in.symmetric_difference(&self.way_in).filter_map(|&cell| CellRect::of_cell(cell));
        let areas = match &since {
            Since::Grown(growth, _) => self.cells.changed_since(&last.cells, growth),
            Since::Part(_) | Since::All => CellRect::default(),
        };
        since.and(other.chain([areas]))
    }

    /// Closes what is forbidden in a rectangle of a costmap.
    fn close(&self, costmap: &mut Costmap, rect: &CellRect) {
        let (rows, columns) = (rect.rows(&self.info), rect.columns(&self.info));
        let width = self.info.width();
        for y in rows {
            let row = &mut costmap.costs_mut()[y * width..][columns.clone()];
            for (x, cost) in columns.clone().zip(row) {
                let cell = Cell::new(x as i32, y as i32);
                if *cost < INSCRIBED_COST && self.forbids(cell) && !self.way_in.contains(&cell) {
                    *cost = INSCRIBED_COST;
                }
            }
        }
    }
}

/// Areas, laid over costmaps that change.
#[derive(Debug, Default)]
pub struct Fence {
    areas: Areas,
    /// How far the robot's centre keeps from no-go areas, metres.
    margin_m: f64,
    fenced: Option<Fenced>,
    whereabouts: Whereabouts,
    /// The version of the costs that are known.
    version: Option<u64>,
    made: Option<Live<Costmap>>,
    changes: Changes,
}

impl Fence {
    /// A fence for a robot whose centre keeps so many metres from no-go areas.
    #[must_use]
    pub fn new(areas: Areas, margin_m: f64) -> Self {
        Self { areas, margin_m, ..Self::default() }
    }

    /// Where the robot stood at the last update.
    #[must_use]
    pub const fn whereabouts(&self) -> Whereabouts {
        self.whereabouts
    }

    /// The cells that the robot may be in, by the last update; `None` where it may be everywhere.
    #[must_use]
    pub const fn fenced(&self) -> Option<&Fenced> {
        self.fenced.as_ref()
    }

    /// The cells of a grid by the areas that they lie in; `None` where there are no areas.
    pub fn cells_of(&mut self, info: &GridInfo) -> Option<Arc<AreaCells>> {
        if self.areas.are_everywhere() {
            return None;
        }
        let known = self.fenced.as_ref().filter(|fenced| fenced.info == *info);
        let cells = known.map(|fenced| Arc::clone(&fenced.cells));
        Some(cells.unwrap_or_else(|| Arc::new(AreaCells::of(info, &self.areas, self.margin_m))))
    }

    /// The costmap with what is forbidden closed, for a robot that stands at a pose; the same
    /// one where nothing is. O(cells that changed since the last call) while the robot is inside.
    pub fn update(&mut self, costs: &Snapshot<Costmap>, robot: &Pose) -> Snapshot<Costmap> {
        let last = self.fenced.take();
        let Some(cells) = self.stand(last.as_ref(), &costs.cells, robot) else { return costs.clone() };
        let since = match (last, self.version) {
            (Some(last), Some(version)) if last.keeps_region == cells.keeps_region => {
                cells.since(&last, costs.changes.since_on((version, &last.info), &cells.info))
            }
            _ => Since::All,
        };
        self.version = Some(costs.changes.version());
        if !since.is_nothing() {
            self.changes = self.changes.then_since(&since);
        }
        let write = |fenced: &mut Costmap, part: &CellRect| {
            fenced.copy_rect(&costs.cells, part);
            cells.close(fenced, part);
        };
        Live::follow(&mut self.made, &since, &cells.info, write, || {
            let mut fenced = Costmap::clone(&costs.cells);
            cells.close(&mut fenced, &CellRect::of(&cells.info));
            fenced
        });
        self.fenced = Some(cells);
        let cells = self.made.as_ref().map_or(&costs.cells, Live::newest);
        Snapshot { cells: Arc::clone(cells), changes: self.changes.clone() }
    }

    /// The same of a costmap of which nothing is kept.
    pub fn close(&mut self, costmap: &Arc<Costmap>, robot: &Pose) -> Arc<Costmap> {
        let last = self.fenced.take();
        let whereabouts = self.whereabouts;
        let Some(cells) = self.stand(last.as_ref(), costmap, robot) else { return Arc::clone(costmap) };
        if self.version.is_some() {
            self.whereabouts = whereabouts;
        }
        let mut closed = Costmap::clone(costmap);
        cells.close(&mut closed, &CellRect::of(costmap.info()));
        // What is kept is as of the last update.
        self.fenced = last.or(Some(cells));
        Arc::new(closed)
    }

    /// Finds out where the robot stands, and which cells are open to it for that.
    fn stand(&mut self, last: Option<&Fenced>, costmap: &Costmap, robot: &Pose) -> Option<Fenced> {
        if self.areas.are_everywhere() {
            return None;
        }
        let info = *costmap.info();
        let known = last.filter(|fenced| fenced.info == info).map(|fenced| Arc::clone(&fenced.cells));
        let cells = known.unwrap_or_else(|| Arc::new(AreaCells::of(&info, &self.areas, self.margin_m)));
        let mut fenced = Fenced { info, cells, keeps_region: true, way_in: HashSet::new() };
        let own = info.cell_at(robot.position());
        self.whereabouts =
            if !info.contains(own) || !fenced.forbids(own) { Whereabouts::Inside } else { fenced.let_in(costmap, own) };
        Some(fenced)
    }
}

impl Fenced {
    /// Opens the shortest way in for a robot in a cell outside.
    fn let_in(&mut self, costmap: &Costmap, own: Cell) -> Whereabouts {
        let reach = (self.info.cells(ESCAPE_RADIUS_M).ceil() as i64).pow(2);
        // A robot that stands too near to an obstacle gets away from it.
        let is_open = |cell: Cell| match costmap.cost(cell) {
            LETHAL_COST | UNKNOWN_COST => false,
            INSCRIBED_COST => cell.distance_squared(own) <= reach,
            _ => true,
        };
        let cells = Arc::clone(&self.cells);
        let no_go = cells.is_near_no_go(own);
        let out = if no_go {
            self.route(own, is_open, |cell| costmap.is_passable(cell) && !cells.is_near_no_go(cell))
        } else {
            Some(vec![own])
        };
        let Some(mut way) = out else { return Whereabouts::LockedOut { no_go: true } };
        let out_cells = if no_go { way.len() } else { 0 };
        let gate = way.first().copied().unwrap_or(own);
        let is_inside = |cell: Cell| costmap.is_passable(cell) && cells.is_inside(cell) && !cells.is_near_no_go(cell);
        let enough = (POCKET_M2 / self.info.cell_area_m2()).ceil().clamp(4.0, 1e5) as usize;
        let mut tried: HashSet<Cell> = HashSet::new();
        let mut is_place = |cell: Cell| {
            if !is_inside(cell) || tried.contains(&cell) {
                return false;
            }
            let place: Vec<Cell> = self.info.flood(cell, Neighbourhood::Four, is_inside).take(enough).collect();
            let is_enough = place.len() >= enough;
            tried.extend(place);
            is_enough
        };
        let beside_no_go = |cell: Cell| is_open(cell) && !cells.is_near_no_go(cell);
        let mut rest = self.route(gate, beside_no_go, &mut is_place);
        if rest.is_none() {
            rest = self.route(gate, beside_no_go, is_inside);
        }
        let is_locked_out = rest.is_none();
        way.extend(rest.unwrap_or_default());
        // Both parts begin or end with a cell that is there already.
        let way_m = way.len().saturating_sub(2) as f64 * self.info.resolution_m();
        let beside = self.around(&way, BESIDE_M).filter(|&cell| !cells.is_near_no_go(cell));
        self.way_in = self.around(&way[..out_cells], BESIDE_OUT_M).chain(way.iter().copied()).chain(beside).collect();
        self.keeps_region = !is_locked_out;
        if is_locked_out { Whereabouts::LockedOut { no_go: false } } else { Whereabouts::Leaving { no_go, way_m } }
    }

    /// The cells within a distance of those of a way.
    fn around<'a>(&self, way: &'a [Cell], distance_m: f64) -> impl Iterator<Item = Cell> + use<'a> {
        let cells = self.info.cells(distance_m);
        let side = cells.floor() as i32;
        let square = (-side..=side).flat_map(move |y| (-side..=side).map(move |x| (x, y)));
        let disc: Vec<(i32, i32)> = square.filter(|&(x, y)| f64::from(x).hypot(f64::from(y)) <= cells).collect();
        way.iter().flat_map(move |&cell| disc.clone().into_iter().map(move |offset| cell.offset(offset)))
    }

    /// The cells of the shortest way over open cells from one to the nearest that will do, the last first.
    fn route(
        &self,
        from: Cell,
        is_open: impl Fn(Cell) -> bool,
        mut will_do: impl FnMut(Cell) -> bool,
    ) -> Option<Vec<Cell>> {
        let mut came_by: Vec<Option<Cell>> = vec![None; self.info.len()];
        *came_by.get_mut(self.info.index(from)?)? = Some(from);
        let mut queue = VecDeque::from([from]);
        while let Some(cell) = queue.pop_front() {
            let before = |cell: &Cell| came_by[self.info.index(*cell)?].filter(|before| before != cell);
            if will_do(cell) {
                return Some(std::iter::successors(Some(cell), before).collect());
            }
            for beside in self.info.neighbours(cell, Neighbourhood::Four) {
                let met = self.info.index(beside).and_then(|index| came_by.get_mut(index));
                if let Some(met) = met.filter(|met| met.is_none())
                    && is_open(beside)
                {
                    *met = Some(cell);
                    queue.push_back(beside);
                }
            }
        }
        None
    }
}

#[cfg(test)]
#[path = "fence_tests.rs"]
mod tests;
