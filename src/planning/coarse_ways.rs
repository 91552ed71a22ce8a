//! How long the ways between many places are, on a coarse grid: what a tour needs to know of
//! many pairs, and not to the cell.
//!
//! A coarse cell is open where the robot gets to any of its fine cells. Steps go to all eight
//! neighbours, 5 along a side and 7 along a diagonal, so that ways are up to 8 % too long.
//! Dijkstra with a bucket queue from each place until all others are settled:
//! O(cells nearer than the farthest place).

use super::bucket_queue::BucketQueue;
use super::field::PathField;
use crate::geometry::{Point, Pose, shortest_angle};
use crate::grid::{Cell, GridInfo, NEIGHBOURS_8};

/// Edge length of a coarse cell, metres, or one fine cell where that is longer.
const EDGE_M: f64 = 0.2;
/// Cost of a step along a side, and of one along a diagonal.
const STEPS: [u32; 2] = [5, 7];
/// Cost of what was not reached.
const UNREACHED: u32 = u32::MAX;
/// A place that is not open counts as the open cell next to it, at most so many cells away.
const SNAP: i32 = 3;
/// A robot sets out for the farthest point of its way up to this distance that lies in a free
/// line, metres.
const AHEAD_M: f64 = 3.0;

/// A coarse map of where the robot gets to.
#[derive(Clone, Debug)]
pub struct CoarseWays {
    fine: GridInfo,
    /// Fine cells along an edge.
    factor: usize,
    /// Columns and rows, with a closed margin of one cell all round.
    width: usize,
    height: usize,
    open: Vec<bool>,
    cost: Vec<u32>,
    /// The cells of `cost` that are not unreached.
    reached: Vec<u32>,
    queue: BucketQueue,
    robot: Pose,
    /// The costs from the robot.
    from_robot: Vec<u32>,
}

/// What the ways from one place to everywhere cost.
#[derive(Clone, Debug)]
pub struct WaysFrom {
    cost: Vec<u32>,
}

impl CoarseWays {
    /// Of a field of ways and the robot in it.
    #[must_use]
    pub fn new(field: &PathField, robot_in_map: Pose) -> Self {
        let fine = *field.costmap().info();
        let factor = ((EDGE_M / fine.resolution_m()).round() as usize).max(1);
        let (width, height) = (fine.width().div_ceil(factor) + 2, fine.height().div_ceil(factor) + 2);
        let mut open = vec![false; width * height];
        for y in 0..fine.height() {
            let row = (y / factor + 1) * width + 1;
            for x in field.reached_in_row(y) {
                open[row + x / factor] = true;
            }
        }
        let queue = BucketQueue::new(STEPS[1]);
        let cost = vec![UNREACHED; open.len()];
        let mut this = Self {
            fine,
            factor,
            width,
            height,
            open,
            cost,
            reached: Vec::new(),
            queue,
            robot: robot_in_map,
            from_robot: Vec::new(),
        };
        this.search(robot_in_map.position(), None);
        this.from_robot = this.cost.clone();
        this
    }

    /// How long the ways from a place to others are, metres; infinite where there is none.
    pub fn lengths_m(&mut self, from: Point, to: &[Point]) -> Vec<f64> {
        let to: Vec<Option<usize>> = to.iter().map(|&point| self.open_near(point)).collect();
        self.search(from, Some(&to));
        to.into_iter().map(|index| self.length_m(index.map_or(UNREACHED, |index| self.cost[index]))).collect()
    }

    /// The ways from a place to everywhere.
    #[must_use]
    pub fn ways_from(&mut self, from: Point) -> WaysFrom {
        self.search(from, None);
        WaysFrom { cost: self.cost.clone() }
    }

    /// A shortest way from a point to the place of such ways, as centres of coarse cells that
    /// lie beside each other; none where there is no way.
    #[must_use]
    pub fn way_to(&self, place: &WaysFrom, from: Point) -> Vec<Point> {
        let start = self.open_near(from).filter(|&index| place.cost[index] < UNREACHED);
        let way = std::iter::successors(start, |&index| self.nearer(&place.cost, index));
        way.map(|index| self.center(index)).collect()
    }

    /// How long that way is, metres; infinite where there is none.
    #[must_use]
    pub fn way_m(&self, place: &WaysFrom, from: Point) -> f64 {
        self.length_m(self.open_near(from).map_or(UNREACHED, |index| place.cost[index]))
    }

    /// How long the way from the robot to a place is, metres, infinite where there is none; and
    /// how far it would have to turn to set out, radians, 0 to pi, 0 where no way is known.
    #[must_use]
    pub fn set_out(&self, to: Point) -> (f64, f64) {
        let reached = self.open_near(to).filter(|&index| self.from_robot[index] < UNREACHED);
        reached.map_or((f64::INFINITY, 0.0), |index| (self.length_m(self.from_robot[index]), self.turn_rad(index)))
    }

    /// How far the robot would have to turn to set out for a cell that it gets to, radians.
    fn turn_rad(&self, to: usize) -> f64 {
        let mut index = to;
        let robot = self.robot.position();
        let mut ahead = None;
        // From the place back: each cell of the way that lies nearer is tried until one is in sight.
        loop {
            let here = self.center(index);
            if nalgebra::distance(&robot, &here) <= AHEAD_M && self.is_free_line(robot, here) {
                ahead = Some(here);
                break;
            }
            match self.nearer(&self.from_robot, index) {
                Some(next) => index = next,
                None => break,
            }
        }
        let near_m = self.fine.resolution_m() * self.factor as f64;
        ahead
            .filter(|point| nalgebra::distance(&robot, point) > near_m)
            .map_or(0.0, |point| shortest_angle(self.robot.yaw, Pose::facing(robot, point).yaw).abs())
    }

    /// The cell beside one from which it costs the least to get on, if that is less.
    fn nearer(&self, cost: &[u32], index: usize) -> Option<usize> {
        let open = beside(self.width, index).filter(|&(_, next)| self.open[next]);
        let (_, next) = open.min_by_key(|&(_, next)| cost[next])?;
        (cost[next] < cost[index]).then_some(next)
    }

    fn length_m(&self, cost: u32) -> f64 {
        if cost == UNREACHED {
            return f64::INFINITY;
        }
        f64::from(cost) / f64::from(STEPS[0]) * self.factor as f64 * self.fine.resolution_m()
    }

    /// Searches from a place until all others are settled, or everywhere.
    fn search(&mut self, from: Point, to: Option<&[Option<usize>]>) {
        for index in self.reached.drain(..) {
            self.cost[index as usize] = UNREACHED;
        }
        self.queue.clear();
        let Some(start) = self.open_near(from) else { return };
        let mut left = to.map(|to| to.iter().flatten().copied().collect::<std::collections::HashSet<usize>>());
        self.cost[start] = 0;
        self.reached.push(start as u32);
        self.queue.push(0, start as u32);
        while let Some((cost, item)) = self.queue.pop() {
            let index = item as usize;
            if cost > self.cost[index] {
                continue;
            }
            if let Some(left) = &mut left {
                left.remove(&index);
                if left.is_empty() {
                    return;
                }
            }
            for (step, next) in beside(self.width, index) {
                let next_cost = cost + step;
                if self.open[next] && next_cost < self.cost[next] {
                    if self.cost[next] == UNREACHED {
                        self.reached.push(next as u32);
                    }
                    self.cost[next] = next_cost;
                    self.queue.push(next_cost, next as u32);
                }
            }
        }
    }

    /// The coarse cell of a point, in columns and rows of the coarse grid with its margin.
    fn coarse(&self, point: Point) -> (i32, i32) {
        let Cell { x, y } = self.fine.cell_at(point);
        let coarse = |fine: i32| fine.div_euclid(self.factor as i32) + 1;
        (coarse(x), coarse(y))
    }

    fn index(&self, (x, y): (i32, i32)) -> Option<usize> {
        let is_inside = x > 0 && y > 0 && x < self.width as i32 - 1 && y < self.height as i32 - 1;
        is_inside.then(|| y as usize * self.width + x as usize)
    }

    /// The open cell at a point, or the nearest one beside it.
    fn open_near(&self, point: Point) -> Option<usize> {
        let (x, y) = self.coarse(point);
        let around = (-SNAP..=SNAP).flat_map(|dy| (-SNAP..=SNAP).map(move |dx| (dx, dy)));
        let open = around.filter_map(|(dx, dy)| Some((dx * dx + dy * dy, self.index((x + dx, y + dy))?)));
        open.filter(|&(_, index)| self.open[index]).min().map(|(_, index)| index)
    }

    /// The centre of a coarse cell in the map frame.
    fn center(&self, index: usize) -> Point {
        let fine = |coarse: usize| ((coarse - 1) * self.factor + self.factor / 2) as i32;
        self.fine.center(Cell::new(fine(index % self.width), fine(index / self.width)))
    }

    /// Whether all coarse cells on the line between two points are open.
    pub(crate) fn is_free_line(&self, from: Point, to: Point) -> bool {
        let steps = (nalgebra::distance(&from, &to) / (0.5 * EDGE_M)).ceil().max(1.0);
        (0..=steps as usize).all(|step| {
            let point = from + (to - from) * (step as f64 / steps);
            // The robot's own cell need not be open.
            step == 0 || self.index(self.coarse(point)).is_some_and(|index| self.open[index])
        })
    }
}

/// The eight cells beside one, with what a step to each costs; the margin keeps them inside.
fn beside(width: usize, index: usize) -> impl Iterator<Item = (u32, usize)> {
    NEIGHBOURS_8.iter().map(move |&(dx, dy)| {
        let step = STEPS[usize::from(dx != 0 && dy != 0)];
        (step, (index as i64 + i64::from(dy) * width as i64 + i64::from(dx)) as usize)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::{Costmap, Inflation, OccupancyGrid, Thresholds};
    use std::sync::Arc;

    const BARE: Inflation =
        Inflation { inscribed_radius_m: 0.0, clear_radius_m: 0.0, inflation_radius_m: 0.0, cost_scaling_factor: 1.0 };

    fn ways(drawing: &str, robot: Pose) -> CoarseWays {
        let grid = OccupancyGrid::from_ascii(drawing).unwrap();
        let costmap = Arc::new(Costmap::inflate(&grid, &Thresholds::default(), &BARE));
        CoarseWays::new(&PathField::reach_only(costmap, &robot).unwrap(), robot)
    }

    #[test]
    fn lengths_go_round_walls_and_are_infinite_where_no_way_leads() {
        let mut ways = ways("....#.\n.##.#.\n....#.", Pose::new(0.5, 0.5, 0.0));
        let (from, to) = (Point::new(0.5, 0.5), [Point::new(3.5, 0.5), Point::new(0.5, 2.5), Point::new(0.5, 0.5)]);
        assert_eq!(ways.lengths_m(from, &to), [3.0, 2.0, 0.0]);
        let round = ways.lengths_m(Point::new(0.5, 2.5), &[Point::new(3.5, 0.5)]);
        assert_eq!(round, [4.4], "three along sides and one over a corner");
        assert_eq!(ways.lengths_m(from, &[Point::new(90.5, 0.5)]), [f64::INFINITY]);
        // From the robot they are known without a search.
        for point in to {
            assert_eq!(ways.lengths_m(from, &[point]), [ways.set_out(point).0]);
        }
        assert_eq!(ways.set_out(Point::new(90.5, 0.5)), (f64::INFINITY, 0.0));
    }

    #[test]
    fn a_way_leads_from_cell_to_cell_to_its_place() {
        let mut ways = ways("....#.\n.##.#.\n....#.", Pose::new(0.5, 0.5, 0.0));
        let from = ways.ways_from(Point::new(0.5, 2.5));
        let way = ways.way_to(&from, Point::new(3.4, 0.6));
        assert_eq!((way.first(), way.last()), (Some(&Point::new(3.5, 0.5)), Some(&Point::new(0.5, 2.5))));
        assert_eq!(way.len(), 5, "{way:?}");
        assert!(way.windows(2).all(|pair| nalgebra::distance(&pair[0], &pair[1]) < 1.5), "{way:?}");
        assert!(ways.way_to(&from, Point::new(90.5, 0.5)).is_empty());
    }

    #[test]
    fn a_robot_turns_to_where_its_way_begins_and_not_to_where_it_ends() {
        // The place lies to the left, and the way there begins straight ahead.
        let ways = ways("........\n.######.\n........", Pose::new(0.5, 0.5, 0.0));
        let turn = |x: f64, y: f64| ways.set_out(Point::new(x, y)).1;
        assert!(turn(6.5, 2.5) < 0.2, "{}", turn(6.5, 2.5));
        assert!((turn(0.5, 2.5) - std::f64::consts::FRAC_PI_2).abs() < 0.2);
        assert_eq!((turn(0.5, 0.5), ways.set_out(Point::new(0.5, 0.5)).0), (0.0, 0.0));
    }
}
