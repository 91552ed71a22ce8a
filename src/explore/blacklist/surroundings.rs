//! What the map shows around a place that failed, and whether it has opened since.

use crate::geometry::Point;
use crate::grid::{CellRect, GridInfo, Thresholds};
use crate::robot::MapSnapshot;

/// So far around a place the map is looked at, metres along both axes.
const AROUND_M: f64 = 1.0;
/// A map that shows so much more free area, or so much less of obstacles, has opened, square
/// metres: about what a door takes.
const OPENED_M2: f64 = 0.05;
/// Twice as much is asked for after each opening, so many times at most.
const MOST_DOUBLINGS: u32 = 8;

/// Free and occupied cells around a place; `None` where no map was there.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surroundings {
    counts: Option<(usize, usize)>,
}

impl Surroundings {
    /// Those of a point on a map.
    pub fn of(map: Option<&MapSnapshot>, point: Point, thresholds: &Thresholds) -> Self {
        Self { counts: map.map(|map| count(map, point, thresholds)) }
    }

    /// Whether a map shows more open ground there; `changed` is where it differs from one that did
    /// not, if that is known, and the ground has opened so many times before.
    pub fn has_opened(
        &self,
        map: &MapSnapshot,
        point: Point,
        changed: Option<&CellRect>,
        thresholds: &Thresholds,
        openings: u32,
    ) -> bool {
        let info = map.grid.info();
        let is_elsewhere = |changed: &CellRect| square(info, point).is_none_or(|square| !meet(&square, changed));
        let Some((free, occupied)) = self.counts.filter(|_| !changed.is_some_and(is_elsewhere)) else { return false };
        let doubled = 2_f64.powi(openings.min(MOST_DOUBLINGS) as i32);
        let enough = (OPENED_M2 * doubled / info.cell_area_m2()).ceil().max(1.0) as usize;
        let (free_now, occupied_now) = count(map, point, thresholds);
        free_now >= free + enough || occupied_now + enough <= occupied
    }
}

fn count(map: &MapSnapshot, point: Point, thresholds: &Thresholds) -> (usize, usize) {
    let square = square(map.grid.info(), point).unwrap_or_default();
    let census = map.grid.census_of(&square, thresholds);
    (census.free, census.occupied)
}

/// The cells around a point of the map; `None` off the map.
fn square(info: &GridInfo, point: Point) -> Option<CellRect> {
    let cell = info.cell_at(point);
    let own = CellRect::of_cell(cell).filter(|_| info.contains(cell))?;
    Some(own.grown(info.cells(AROUND_M).ceil() as usize, info))
}

const fn meet(a: &CellRect, b: &CellRect) -> bool {
    a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height
}
