//! Where the robot can stand in the true world, and the ways between such stands.

use crate::config::RobotConfig;
use crate::geometry::{Point, Pose};
use crate::grid::{Cell, Costmap, GridInfo, OccupancyGrid, Thresholds};
use crate::planning::{CoarseWays, PathField, WaysFrom};
use crate::sim::World;
use std::sync::Arc;

/// Edge length of a block, metres: what is seen is computed once for each, and a route is made of
/// them.
const BLOCK_M: f64 = 0.4;

/// A block is looked for at most so many blocks away from a point.
const SNAP: i64 = 3;

/// The world as the robot can drive in it, in blocks of cells.
///
/// In each block that the robot can get to, it stands where it has the most room.
pub(super) struct Ground {
    info: GridInfo,
    ways: CoarseWays,
    /// Cells along the edge of a block.
    edge: usize,
    columns: usize,
    stands: Vec<Option<Point>>,
}

impl Ground {
    /// What a robot can get to from a start; `None` where it cannot move at all.
    pub fn new(world: &World, robot: &RobotConfig, start: &Pose) -> Option<Self> {
        let costmap = Arc::new(true_costmap(world, robot));
        let field = PathField::reach_only(Arc::clone(&costmap), start).ok()?;
        let info = *world.info();
        let edge = info.cells(BLOCK_M).round().max(1.0) as usize;
        let (columns, rows) = (info.width().div_ceil(edge), info.height().div_ceil(edge));
        let stands = (0..columns * rows).map(|block| {
            let (left, low) = ((block % columns * edge) as i32, (block / columns * edge) as i32);
            let center = Cell::new(left + edge as i32 / 2, low + edge as i32 / 2);
            let cells = (0..edge * edge).map(|i| Cell::new(left + (i % edge) as i32, low + (i / edge) as i32));
            let reached = cells.filter(|&cell| field.reaches(cell));
            let best = reached.min_by_key(|&cell| (costmap.cost(cell), cell.distance_squared(center), cell.y, cell.x));
            best.map(|cell| info.center(cell))
        });
        Some(Self { info, edge, columns, stands: stands.collect(), ways: CoarseWays::new(&field, *start) })
    }

    /// The blocks that the robot can get to.
    pub fn blocks(&self) -> impl Iterator<Item = usize> {
        self.stands.iter().enumerate().filter(|(_, stand)| stand.is_some()).map(|(block, _)| block)
    }

    /// Column and row of a block.
    pub const fn place(&self, block: usize) -> (usize, usize) {
        (block % self.columns, block / self.columns)
    }

    /// Where the robot stands in a block.
    pub fn stand(&self, block: usize) -> Point {
        self.stands.get(block).copied().flatten().unwrap_or_default()
    }

    /// The block that holds a point, or the one whose stand is the nearest.
    pub fn block_at(&self, point: Point) -> Option<usize> {
        let Cell { x, y } = self.info.cell_at(point);
        let (column, row) = (i64::from(x).div_euclid(self.edge as i64), i64::from(y).div_euclid(self.edge as i64));
        let block = |dx: i64, dy: i64| {
            let (column, row) = (column + dx, row + dy);
            let inside = (0..self.columns as i64).contains(&column) && row >= 0;
            let block = row * self.columns as i64 + column;
            (inside && self.stands.get(block as usize).copied().flatten().is_some()).then_some(block as usize)
        };
        let near = || {
            let around = (-SNAP..=SNAP).flat_map(|dy| (-SNAP..=SNAP).map(move |dx| (dx, dy)));
            let away_m = |&block: &usize| nalgebra::distance(&self.stand(block), &point);
            around.filter_map(|(dx, dy)| block(dx, dy)).min_by(|a, b| away_m(a).total_cmp(&away_m(b)))
        };
        block(0, 0).or_else(near)
    }

    /// The ways from a block to everywhere.
    pub fn ways_from(&mut self, block: usize) -> WaysFrom {
        let stand = self.stand(block);
        self.ways.ways_from(stand)
    }

    /// A shortest way from a point to where such ways begin, a point each 0.2 m or so; none
    /// where there is no way.
    pub fn way(&self, to: &WaysFrom, from: Point) -> Vec<Point> {
        self.ways.way_to(to, from)
    }

    /// How long that way is, metres.
    pub fn way_m(&self, to: &WaysFrom, from: Point) -> f64 {
        self.ways.way_m(to, from)
    }

    /// The corners of a way when it is pulled tight: its ends and where it must bend.
    pub fn corners(&self, way: &[Point]) -> Vec<usize> {
        let mut corners = vec![0];
        let mut at = 0;
        while at + 1 < way.len() {
            let mut next = at + 1;
            while next + 1 < way.len() && self.ways.is_free_line(way[at], way[(next + 2).min(way.len() - 1)]) {
                next = (next + 2).min(way.len() - 1);
            }
            corners.push(next);
            at = next;
        }
        corners
    }
}

/// The costmap that the robot would have of a map that shows all.
fn true_costmap(world: &World, robot: &RobotConfig) -> Costmap {
    let mut truth = OccupancyGrid::filled(*world.info(), OccupancyGrid::FREE);
    for index in 0..world.info().len() {
        let cell = world.info().cell(index);
        if world.is_solid(cell) {
            truth.set(cell, OccupancyGrid::OCCUPIED);
        }
    }
    Costmap::inflate(&truth, &Thresholds::default(), &robot.inflation())
}
