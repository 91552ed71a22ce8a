//! The robot is where it is: what a costmap must leave open for it to get away.
//!
//! A map closes in on a robot as it becomes known: a leg of a table seen late narrows the
//! gap that the robot has just come through, and by the costmap it stands in a pocket of a
//! few cells from which no way leads anywhere. But it came there, so that a way leads back.
//! What was driven through stays passable unless an obstacle is seen in it, at the highest
//! cost; and from a pocket that is too small to be a place of its own, a way is opened to
//! the nearest place that is not, through all that is no obstacle itself.
//!
//! O(places driven through) where nothing has closed in, and a copy of the costs where
//! something has.

use super::endpoints::ESCAPE_RADIUS_M;
use crate::geometry::{Point, Pose};
use crate::grid::{
    Cell, CellRect, CellValues, Changes, Costmap, INSCRIBED_COST, Known, LETHAL_COST, Live, NARROW_COST, Neighbourhood,
    Snapshot, UNKNOWN_COST, traverse,
};
use std::collections::{HashMap, HashSet, VecDeque};
use std::sync::Arc;

/// From one place that is remembered to the next, metres.
const SPACING_M: f64 = 0.1;
/// A step longer than this was a jump of the map, not a drive, metres.
const JUMP_M: f64 = 0.6;
/// A place smaller than this is a pocket, square metres.
const POCKET_M2: f64 = 1.0;

/// Where the robot has driven, in metres of the map frame.
#[derive(Clone, Debug, Default)]
pub struct Driven {
    /// Each place with the one before it, where it was driven to from there.
    legs: Vec<(Point, Point)>,
    known: HashSet<(i32, i32, i32, i32)>,
    last: Option<Point>,
}

impl Driven {
    /// The robot is at a pose now.
    pub fn note(&mut self, pose: &Pose) {
        let here = pose.position();
        let Some(last) = self.last else {
            self.last = Some(here);
            return;
        };
        let step_m = nalgebra::distance(&last, &here);
        if step_m < SPACING_M {
            return;
        }
        self.last = Some(here);
        let coarse = |point: Point| ((point.x / SPACING_M).round() as i32, (point.y / SPACING_M).round() as i32);
        let (a, b) = (coarse(last), coarse(here));
        if step_m <= JUMP_M && self.known.insert((a.0, a.1, b.0, b.1)) {
            self.legs.push((last, here));
        }
    }

    /// The costmap as it is for this robot, which stands at a pose: the same one where
    /// nothing has closed in on it.
    #[must_use]
    pub fn open(&self, costmap: &Arc<Costmap>, robot: &Pose) -> Arc<Costmap> {
        let opened = self.opened(costmap, robot);
        if opened.is_empty() { Arc::clone(costmap) } else { Arc::new(costmap.with_costs(&opened)) }
    }

    /// The cells that have other costs for this robot, which stands at a pose, and these costs.
    fn opened(&self, costmap: &Costmap, robot: &Pose) -> HashMap<Cell, u8> {
        let mut opened: HashMap<Cell, u8> = HashMap::new();
        for (from, to) in &self.legs {
            // Most legs lie in the open.
            if costmap.is_passable(costmap.info().cell_at(*from)) && costmap.is_passable(costmap.info().cell_at(*to)) {
                continue;
            }
            let line = to - from;
            for (cell, _) in traverse(costmap.info(), *from, line.y.atan2(line.x), line.norm()) {
                if costmap.cost(cell) == INSCRIBED_COST {
                    opened.insert(cell, NARROW_COST);
                }
            }
        }
        let own = costmap.info().cell_at(robot.position());
        let cost = |cell: Cell| opened.get(&cell).copied().unwrap_or_else(|| costmap.cost(cell));
        let out = way_out(costmap, own, cost);
        opened.extend(out.into_iter().map(|cell| (cell, NARROW_COST)));
        opened
    }
}

/// Costmaps as they are for a robot that came from where it came, kept from one version to the
/// next.
#[derive(Clone, Debug, Default)]
pub struct Opened {
    known: Known,
    opened: HashMap<Cell, u8>,
    made: Option<Live<Costmap>>,
    /// Its versions: a cell that was opened may be closed again where the costs stay the same.
    changes: Changes,
}

impl Opened {
    /// The costmap as [`Driven::open`] gives it. O(places driven through, cells that changed).
    pub fn update(&mut self, driven: &Driven, costs: &Snapshot<Costmap>, robot: &Pose) -> Snapshot<Costmap> {
        let info = costs.cells.info();
        let opened = driven.opened(&costs.cells, robot);
        let since = self.known.renew(&costs.changes, info);
        let last = std::mem::replace(&mut self.opened, opened);
        let last = last.into_iter().map(|(cell, cost)| (cell.offset(since.offset()), cost)).collect();
        let other = |a: &HashMap<Cell, u8>, b: &HashMap<Cell, u8>| {
            let differ = a.iter().filter(|(cell, cost)| b.get(cell) != Some(cost));
            differ.filter_map(|(&cell, _)| CellRect::of_cell(cell)).fold(CellRect::default(), CellRect::union)
        };
        let since = since.and([other(&last, &self.opened), other(&self.opened, &last)]);
        if !since.is_nothing() {
            self.changes = self.changes.then_since(&since);
        }
        if self.opened.is_empty() {
            self.made = None;
            return Snapshot { cells: Arc::clone(&costs.cells), changes: self.changes.clone() };
        }
        let opened = &self.opened;
        let write = |cells: &mut Costmap, part: &CellRect| {
            cells.copy_rect(&costs.cells, part);
            cells.set_costs(opened);
        };
        Live::follow(&mut self.made, &since, info, write, || costs.cells.with_costs(opened));
        let cells = self.made.as_ref().map_or(&costs.cells, Live::newest);
        Snapshot { cells: Arc::clone(cells), changes: self.changes.clone() }
    }
}

/// The cells of a way out of a pocket, the robot's own among them; none where the robot is
/// in no pocket, or where no way leads out.
fn way_out(costmap: &Costmap, own: Cell, cost: impl Fn(Cell) -> u8) -> Vec<Cell> {
    let info = costmap.info();
    let enough = (POCKET_M2 / info.cell_area_m2()).ceil().clamp(4.0, 1e5) as usize;
    let passable = |cell: Cell| info.contains(cell) && cost(cell) < INSCRIBED_COST;
    let place_of = |seed: Cell| info.flood(seed, Neighbourhood::Four, passable).take(enough).collect::<HashSet<Cell>>();
    if !info.contains(own) {
        return Vec::new();
    }
    let pocket = if passable(own) { place_of(own) } else { HashSet::from([own]) };
    if pocket.len() >= enough {
        return Vec::new();
    }
    let reach = (info.cells(ESCAPE_RADIUS_M).ceil() as i64).pow(2);
    let mut came_by: HashMap<Cell, Cell> = HashMap::from([(own, own)]);
    let mut queue = VecDeque::from([own]);
    let mut largest = (pocket.len(), None);
    let mut tried: HashSet<Cell> = pocket.clone();
    while let Some(cell) = queue.pop_front() {
        if passable(cell) && !tried.contains(&cell) {
            let place = place_of(cell);
            if place.len() > largest.0 {
                largest = (place.len(), Some(cell));
            }
            if place.len() >= enough {
                break;
            }
            tried.extend(place);
        }
        // Sides before corners, so that no way squeezes between two obstacles.
        for beside in info.neighbours(cell, Neighbourhood::Four) {
            let is_open = !matches!(cost(beside), LETHAL_COST | UNKNOWN_COST);
            if is_open && beside.distance_squared(own) <= reach && !came_by.contains_key(&beside) {
                came_by.insert(beside, cell);
                queue.push_back(beside);
            }
        }
    }
    let mut way: Vec<Cell> =
        std::iter::successors(largest.1, |cell| came_by.get(cell).copied().filter(|c| c != cell)).collect();
    way.retain(|&cell| !passable(cell));
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Inflation, OccupancyGrid, Thresholds};

    /// Cells of 0.1 m, a robot of radius 0.15 m.
    fn costmap(drawing: &str) -> Arc<Costmap> {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let info = grid.info();
        let info = crate::grid::GridInfo::new(info.width() as u32, info.height() as u32, 0.1, Pose::default()).unwrap();
        let grid = OccupancyGrid::new(info, grid.data().to_vec()).unwrap();
        let inflation = Inflation {
            inscribed_radius_m: 0.15,
            clear_radius_m: 0.0,
            inflation_radius_m: 0.15,
            cost_scaling_factor: 1.0,
        };
        Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &inflation))
    }

    fn reached(costmap: &Arc<Costmap>, robot: Pose) -> usize {
        let field = super::super::PathField::reach_only(Arc::clone(costmap), &robot).unwrap();
        (0..costmap.info().len()).filter(|&i| field.reaches(costmap.info().cell(i))).count()
    }

    /// Two legs of a table behind the robot, and a hall beyond.
    const LEGS: &str = "
        ################
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        #..............#
        ######..########
        #####....#######
        #####....#######
        ################";

    #[test]
    fn what_was_driven_through_stays_passable() {
        let closed = costmap(LEGS);
        let robot = Pose::new(0.7, 0.25, 0.0);
        assert!(reached(&closed, Pose::new(0.7, 1.0, 0.0)) > 60);
        let mut driven = Driven::default();
        for step in 0..20 {
            driven.note(&Pose::new(0.72, 1.0 - 0.04 * f64::from(step), 0.0));
        }
        let open = driven.open(&closed, &robot);
        assert!(reached(&open, robot) > 60, "the way back is open");
        assert!(
            open.costs()
                .iter()
                .zip(closed.costs())
                .all(|(new, old)| new == old || (*new, *old) == (NARROW_COST, INSCRIBED_COST))
        );
    }

    #[test]
    fn a_robot_that_began_in_a_pocket_gets_out() {
        let closed = costmap(LEGS);
        let robot = Pose::new(0.7, 0.25, 0.0);
        let open = Driven::default().open(&closed, &robot);
        assert!(reached(&open, robot) > 60);
        let free = Pose::new(0.7, 0.8, 0.0);
        assert!(Arc::ptr_eq(&Driven::default().open(&closed, &free), &closed), "nothing is opened for a free robot");
    }

    /// Costs change, the robot moves, what was opened closes again: as if opened anew each time.
    #[test]
    fn what_is_kept_open_is_as_if_opened_anew() {
        let shut = LEGS.replace("######..########", "################");
        let drawn = [LEGS, LEGS, &shut, LEGS, &LEGS.replace('#', "."), LEGS].map(costmap);
        let mut costs = Live::new(Arc::clone(&drawn[0]));
        let (mut driven, mut opened, mut readers) = (Driven::default(), Opened::default(), Vec::new());
        for (step, next) in drawn.iter().enumerate() {
            costs.replace(Arc::clone(next));
            let robot = Pose::new(0.72, 1.0 - 0.15 * step as f64, 0.0);
            driven.note(&robot);
            let known = opened.update(&driven, &costs.snapshot(), &robot);
            assert_eq!(known.cells, driven.open(costs.newest(), &robot), "step {step}");
            readers.push(known);
            for pair in readers.windows(2) {
                let told = pair[1].changes.since(pair[0].changes.version()).unwrap();
                let differs = crate::grid::changed_rect(&*pair[0].cells, &*pair[1].cells).unwrap_or_default();
                assert_eq!(told.union(differs), told);
            }
        }
        assert!(!opened.opened.is_empty(), "the legs were opened");
    }

    #[test]
    fn an_obstacle_in_the_way_driven_closes_it() {
        let shut = costmap(&LEGS.replace("######..########", "################"));
        let mut driven = Driven::default();
        for step in 0..20 {
            driven.note(&Pose::new(0.72, 1.0 - 0.04 * f64::from(step), 0.0));
        }
        let robot = Pose::new(0.7, 0.25, 0.0);
        let open = driven.open(&shut, &robot);
        assert_eq!(open.cost_at(Point::new(0.72, 0.35)), LETHAL_COST);
        let field = super::super::PathField::reach_only(open, &robot);
        assert!(field.is_err() || field.is_ok_and(|field| !field.reaches(Cell::new(7, 9))));
    }
}
