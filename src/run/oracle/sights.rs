//! What the lidar sees of the area that coverage is counted on, from anywhere.

use super::seen::Seen;
use crate::config::LidarConfig;
use crate::geometry::{Point, Pose};
use crate::grid::{Cell, GridInfo, traverse};
use crate::sim::{Coverage, TargetArea, World};
use std::f64::consts::TAU;
use std::sync::Arc;

/// The most samples that stand for the area, more or less: in larger ones one cell of each square
/// of so many.
const MOST_SAMPLES: usize = 8192;
/// As the robot drives, its rays fall between those that it has cast before: so many times as many
/// stand for all of them.
const FINER: f64 = 2.0;
/// Headings of a robot that does not see all round are told apart by so many.
pub(super) const HEADINGS: usize = 8;

/// Casts rays, and knows the samples that they pass.
pub(super) struct Sights {
    world: Arc<World>,
    lidar: LidarConfig,
    rays: usize,
    /// For each cell of the world the number of its sample, from 1.
    sample_of: Vec<u32>,
    count: usize,
}

impl Sights {
    /// What a lidar sees of a target area.
    pub fn new(world: Arc<World>, lidar: LidarConfig, target: &TargetArea) -> Self {
        let info = *world.info();
        let stride = (target.cells().len() as f64 / MOST_SAMPLES as f64).sqrt().ceil().max(1.0) as usize;
        let mut sample_of = vec![0; info.len()];
        let mut count = 0;
        for &cell in target.cells() {
            let cell = cell as usize;
            let (x, y) = (cell % info.width(), cell / info.width());
            if picked(x / stride, y / stride, stride) == (x % stride, y % stride) {
                count += 1;
                sample_of[cell] = count;
            }
        }
        // More than one for each cell of the farthest circle show no more.
        let enough = (lidar.field_of_view_rad * info.cells(lidar.range_max_m)).ceil().max(2.0);
        let rays = (FINER * f64::from(lidar.rays)).min(enough) as usize;
        Self { world, lidar, rays, sample_of, count: count as usize }
    }

    /// How many samples there are.
    pub const fn samples(&self) -> usize {
        self.count
    }

    /// How many a share of them is, rounded up.
    pub fn samples_of(&self, share: f64) -> usize {
        (share * self.count as f64).ceil() as usize
    }

    /// Whether it makes no difference where the robot looks.
    pub fn is_all_round(&self) -> bool {
        self.lidar.field_of_view_rad > TAU - 1e-3
    }

    /// What is seen from a point when the robot turns round there once.
    pub fn around(&self, from: Point) -> Seen {
        let rays = (self.rays as f64 * TAU / self.lidar.field_of_view_rad).ceil();
        let headings = (0..rays as usize).map(|ray| ray as f64 * TAU / rays);
        self.cast(from, headings)
    }

    /// What is seen from a pose of the robot.
    pub fn ahead(&self, base: &Pose) -> Seen {
        if self.is_all_round() {
            return self.around(base.position());
        }
        let lidar = base.compose(&self.lidar.mount);
        let field = self.lidar.field_of_view_rad;
        let step = field / self.rays.saturating_sub(1).max(1) as f64;
        self.cast(lidar.position(), (0..self.rays).map(|ray| lidar.yaw - 0.5 * field + ray as f64 * step))
    }

    fn cast(&self, from: Point, headings: impl Iterator<Item = f64>) -> Seen {
        let mut seen = Seen::none(self.count);
        let info: &GridInfo = self.world.info();
        for heading in headings {
            for (cell, _) in traverse(info, from, heading, self.lidar.range_max_m) {
                if self.world.is_solid(cell) {
                    break;
                }
                self.insert(&mut seen, cell);
            }
        }
        seen
    }

    fn insert(&self, seen: &mut Seen, cell: Cell) {
        let sample = self.world.info().index(cell).map_or(0, |index| self.sample_of[index]);
        if sample > 0 {
            seen.insert(sample as usize - 1);
        }
    }

    /// What a map that is counted on shows.
    pub fn known(&self, coverage: &Coverage) -> Seen {
        let mut seen = Seen::none(self.count);
        (0..self.count).for_each(|sample| seen.insert(sample));
        for &cell in coverage.remaining() {
            let sample = self.sample_of[cell as usize];
            if sample > 0 {
                seen.remove(sample as usize - 1);
            }
        }
        seen
    }
}

/// The column and the row of the cell that stands for a square: another one in each, as walls stand
/// at regular distances too.
const fn picked(column: usize, row: usize, stride: usize) -> (usize, usize) {
    let mixed = (column as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (row as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    let mixed = (mixed ^ mixed >> 29).wrapping_mul(0xbf58_476d_1ce4_e5b9) >> 32;
    (mixed as usize % stride, mixed as usize / stride % stride)
}
