//! Mapping with known poses on a grid that grows as gmapping's does.
//!
//! *Probabilistic Robotics* (Thrun, Burgard, Fox 2005), chapter 9: a cell holds the
//! log odds of being occupied; a ray adds to the cell it ends in and takes from the
//! cells it passes. Each scan counts once for a cell, and a hit wins over a pass.
//! O(cells passed) a scan.
//!
//! A range measures the way to the near side of an obstacle, which in a world of
//! cells is a border between two. Within the precision of a range (`f32`), a ray that
//! ends on a border hits the cell beyond; one that ends so near to a corner that it
//! cannot be told which cell is beyond marks none. Noise-free scans therefore never
//! mark a cell wrongly where the map's lattice is the world's.

mod publish;

use super::MapperConfig;
use super::map_window::MapWindow;
use super::ray::{Ray, Walk};
use crate::geometry::{Point, Pose};
use crate::grid::{CellRect, GridInfoError, Live, OccupancyGrid};
use crate::range::OutOfRange;
use crate::scan::{LaserScan, Reading};

/// A beam that ends farther away than this, in cells, is held there: no window reaches so far.
const FARTHEST_CELLS: f64 = 1e12;

/// Why a scan cannot be put into the map.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MapperError {
    /// A parameter out of its range.
    #[error(transparent)]
    Config(#[from] OutOfRange),
    /// The map would become too large.
    #[error("the map cannot grow: {0}")]
    TooLarge(#[from] GridInfoError),
    /// The scan was taken nowhere.
    #[error("the lidar's pose ({x}, {y}, {yaw}): must be finite metres and radians")]
    PoseNotFinite {
        /// Metres.
        x: f64,
        /// Metres.
        y: f64,
        /// Radians.
        yaw: f64,
    },
}

/// What the map knows of a cell.
#[derive(Clone, Copy, Debug)]
struct MapCell {
    log_odds: f32,
    /// Mark of the newest scan that touched it; 0 of a cell never seen.
    mark: u32,
}

const UNSEEN: MapCell = MapCell { log_odds: 0.0, mark: 0 };

/// A ray on the lattice and where it ends, in cells.
struct Beam {
    ray: Ray,
    length: f64,
    hit: bool,
}

/// A growing occupancy grid in log odds.
#[derive(Debug)]
pub struct Mapper {
    config: MapperConfig,
    window: MapWindow,
    cells: Vec<MapCell>,
    known_cells: usize,
    /// Even; a scan marks what it passes with this and what it hits with this + 1.
    mark: u32,
    /// The map last published, and where it may differ from what is known now.
    published: Option<Live<OccupancyGrid>>,
    touched: CellRect,
}

impl Mapper {
    /// An empty map around a start, on the lattice with a cell corner at `anchor`
    /// (the world's origin, for a map whose cells are the world's), axis-aligned in
    /// the map frame.
    ///
    /// # Errors
    /// [`MapperError`] for a parameter out of its range or a first map too large.
    pub fn new(config: MapperConfig, start: Point, anchor: Point) -> Result<Self, MapperError> {
        config.validate()?;
        let window = MapWindow::around(start, config.initial_reach_m, anchor, config.resolution_m)?;
        let cells = vec![UNSEEN; window.len()];
        Ok(Self { config, window, cells, known_cells: 0, mark: 0, published: None, touched: CellRect::default() })
    }

    /// Takes a scan into the map, taken with the lidar at `lidar_pose`.
    ///
    /// # Errors
    /// [`MapperError`] for a pose that is not finite or a map that would become too
    /// large; the map is then as before.
    pub fn integrate(&mut self, lidar_pose: &Pose, scan: &LaserScan) -> Result<(), MapperError> {
        if !lidar_pose.is_finite() {
            let Pose { x, y, yaw } = *lidar_pose;
            return Err(MapperError::PoseNotFinite { x, y, yaw });
        }
        let mut beams = self.beams(lidar_pose, scan);
        self.make_room(&beams)?;
        // Of a ray along a border nobody can tell which cells it passes and hits.
        for beam in &mut beams {
            beam.take_if(|beam| beam.ray.follows_border(beam.length, ROUNDING));
        }
        self.mark += 2;
        for beam in beams.iter().flatten().filter(|beam| beam.hit) {
            self.hit(beam);
        }
        for (index, beam) in beams.iter().enumerate() {
            if let Some(beam) = beam {
                self.pass(beam, covered_by_neighbours(&beams, index, scan.angle_increment_rad));
            }
        }
        Ok(())
    }

    /// Number of cells seen so far.
    #[must_use]
    pub const fn known_cells(&self) -> usize {
        self.known_cells
    }

    /// Area of the cells seen so far, square metres.
    #[must_use]
    pub fn known_area_m2(&self) -> f64 {
        self.known_cells as f64 * self.window.resolution_m() * self.window.resolution_m()
    }

    fn beams(&self, lidar_pose: &Pose, scan: &LaserScan) -> Vec<Option<Beam>> {
        let start = self.window.to_lattice(lidar_pose.position());
        let resolution_m = self.window.resolution_m();
        let beam = |(angle_rad, reading): (f64, Reading)| {
            let (range_m, hit) = match reading {
                Reading::Hit(range_m) => (range_m, true),
                Reading::Clear(range_m) => (range_m, false),
                Reading::None => return None,
            };
            let (sin, cos) = (lidar_pose.yaw + angle_rad).sin_cos();
            Some(Beam { ray: Ray::new(start, (cos, sin)), length: range_m / resolution_m, hit })
        };
        scan.readings().map(beam).collect()
    }

    /// Grows the window so that every beam ends inside it.
    fn make_room(&mut self, beams: &[Option<Beam>]) -> Result<(), MapperError> {
        let Some(first) = beams.iter().flatten().next() else { return Ok(()) };
        let (mut low, mut high) = (first.ray.point(0.0), first.ray.point(0.0));
        for beam in beams.iter().flatten() {
            let (x, y) = beam.ray.point(beam.length);
            low = (low.0.min(x), low.1.min(y));
            high = (high.0.max(x), high.1.max(y));
        }
        // The cell that is hit may be the one beyond the end.
        let held = |value: f64| value.floor().clamp(-FARTHEST_CELLS, FARTHEST_CELLS) as i64;
        let cell = |(x, y): (f64, f64), by: f64| (held(x + by), held(y + by));
        let chunk = (self.config.growth_m / self.config.resolution_m).ceil() as i64;
        let (low, high) = (cell(low, -1.0), cell(high, 1.0));
        let grown = self.window.grown_to(low, high, chunk)?;
        if grown != self.window {
            self.cells = self.window.copy_into(&self.cells, &grown, UNSEEN);
            self.touched = self.window.moved_to(self.touched, &grown);
            self.window = grown;
        }
        self.touched = self.touched.union(self.window.rect(low, high));
        Ok(())
    }

    /// Adds to the cell that a beam hits, if it can be told.
    fn hit(&mut self, beam: &Beam) {
        let Beam { ray, length, .. } = beam;
        let (mut x, mut y, mut walk) = ray.at((length - 1.0).max(0.0));
        let (step_x, step_y) = ray.steps();
        let mut go_on = |walk: &mut Walk| {
            if ray.advance(walk) { x += step_x as i64 } else { y += step_y as i64 }
        };
        let slack = beam.slack();
        while walk.left() < length - slack {
            go_on(&mut walk);
        }
        if walk.left() <= length + slack {
            go_on(&mut walk);
        }
        if walk.left() <= length + slack {
            return;
        }
        let index = self.window.index(x, y);
        if let Some(cell) = index.and_then(|i| self.cells.get_mut(i))
            && cell.mark <= self.mark
        {
            self.known_cells += usize::from(cell.mark == 0);
            cell.mark = self.mark + 1;
            cell.log_odds = (cell.log_odds + self.config.hit_log_odds).min(self.config.max_log_odds);
        }
    }

    /// Takes from the cells that a beam passes from a distance on, unless this scan has
    /// seen them: those left before its end, and the one left there or in which it
    /// ends unseen.
    fn pass(&mut self, beam: &Beam, from: f64) {
        let Beam { ray, length, hit } = beam;
        let (mut x, mut y, mut walk) = ray.at(from);
        let (step_x, step_y) = ray.steps();
        // Of a ray along a border, rounding can name the cell on the other side.
        while walk.left() <= from {
            if ray.advance(&mut walk) { x += step_x as i64 } else { y += step_y as i64 }
        }
        let Some(mut index) = self.window.index(x, y) else { return };
        let row = step_y * self.window.width() as isize;
        let slack = beam.slack();
        let end = length - slack;
        let MapperConfig { pass_log_odds, min_log_odds, .. } = self.config;
        let (mark, cells, known_cells) = (self.mark, self.cells.as_mut_slice(), &mut self.known_cells);
        let mut pass = |index: usize| {
            if let Some(cell) = cells.get_mut(index)
                && cell.mark < mark
            {
                *known_cells += usize::from(cell.mark == 0);
                cell.mark = mark;
                cell.log_odds = (cell.log_odds + pass_log_odds).max(min_log_odds);
            }
        };
        while walk.left() < end {
            pass(index);
            index = index.wrapping_add_signed(if ray.advance(&mut walk) { step_x } else { row });
        }
        if !hit || walk.left() <= length + slack {
            pass(index);
        }
    }
}

/// Distance in cells up to which all cells of a beam are passed by others too.
///
/// A cell whose centre is `r` cells away is seen under an angle of at least `1 / r`.
/// Of the beams by twos, fours, eights and so on, the next one to each side of a beam
/// passes with the other all cells that are seen under more than the angle between
/// them. So an odd beam need only be followed from where its even neighbours leave
/// gaps, and they in turn from where theirs do.
fn covered_by_neighbours(beams: &[Option<Beam>], index: usize, increment_rad: f64) -> f64 {
    if index == 0 {
        return 0.0;
    }
    let step = 1 << index.trailing_zeros();
    let neighbour = |index: usize| beams.get(index).and_then(Option::as_ref).map_or(0.0, |beam| beam.length);
    let reach = neighbour(index - step).min(neighbour(index + step));
    let without_gap = 1.0 / (2.0 * step as f64 * increment_rad.abs());
    // A cell reaches beyond its centre; and what is covered must be so beyond doubt.
    let covered = reach.min(without_gap) - 2.0;
    if covered > 0.0 { covered } else { 0.0 }
}

impl Beam {
    /// How far its end may be from where the range says, cells.
    fn slack(&self) -> f64 {
        self.length * RANGE_PRECISION + ROUNDING
    }
}

/// Relative error of a range that was rounded to `f32`, with room to spare.
const RANGE_PRECISION: f64 = 2.0 * f32::EPSILON as f64;
/// Error of a crossing computed in `f64`, cells.
const ROUNDING: f64 = 1e-9;

#[cfg(test)]
mod tests;
