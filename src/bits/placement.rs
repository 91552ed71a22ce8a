//! Where a map lies in planes that are kept while it grows: as many cells before it as it takes to
//! move what was there by whole tiles.

use crate::bits::WORD_CELLS;
use crate::bits::connectivity::tiling::{TILE_ROWS, TILE_WORDS};
use crate::grid::{CellRect, GridInfo};
use std::ops::Range;

/// Where planes grow, they grow by as many tiles more as are nearest to this share of the map, so
/// that they need not as often.
const SPARE: usize = 16;

/// Planes that grow are larger than the map by so many columns or rows of tiles more at most.
const MOST_EMPTY: usize = 4;

/// A map and where its first cell lies in the planes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    info: GridInfo,
    corner: (usize, usize),
}

/// From the placement of one map to that of the next.
pub(crate) struct Step {
    /// Where the next map lies.
    pub placement: Placement,
    /// By how many columns and rows cells of the last map lie further on in the next.
    pub moved: (i32, i32),
    /// How the planes must grow, if they do not hold the next map as they are.
    pub growth: Option<Growth>,
    /// What one of the two maps alone has, as rectangles of the planes.
    pub strips: [CellRect; 4],
}

/// A larger size for planes, in columns and rows.
pub(crate) struct Growth {
    pub size: (usize, usize),
    /// The columns of tiles that come in front, and the rows of them that come below.
    pub tiles: (usize, usize),
}

impl Placement {
    /// A first map, which begins where the planes do.
    pub const fn first(info: &GridInfo) -> Self {
        Self { info: *info, corner: (0, 0) }
    }

    /// The first cell's column and row in the planes.
    pub const fn corner(&self) -> (usize, usize) {
        self.corner
    }

    /// By how much cells of the map lie further on in the planes.
    pub const fn offset(&self) -> (i32, i32) {
        (self.corner.0 as i32, self.corner.1 as i32)
    }

    /// By how much cells of the planes lie further on in the map.
    pub const fn offset_in_map(&self) -> (i32, i32) {
        (-self.offset().0, -self.offset().1)
    }

    /// A rectangle of the map, as far as it is one, in the planes.
    pub fn rect(&self, in_map: &CellRect) -> CellRect {
        let (columns, rows) = (in_map.columns(&self.info), in_map.rows(&self.info));
        let (x, y) = (columns.start + self.corner.0, rows.start + self.corner.1);
        CellRect { x, y, width: columns.len(), height: rows.len() }
    }

    /// The cells of a word of a row of the planes that are cells of the map.
    pub fn mask(&self, y: usize, word: usize) -> u64 {
        let (x, low) = self.corner;
        let bits_from = |column: usize| match column.saturating_sub(word * WORD_CELLS) {
            bit @ ..WORD_CELLS => u64::MAX << bit,
            _ => 0,
        };
        let is_row = (low..low + self.info.height()).contains(&y);
        if is_row { bits_from(x) & !bits_from(x + self.info.width()) } else { 0 }
    }

    /// The next map in planes of this size: cells that lie at the same place keep what is known of
    /// them. Grids of one size that share no lattice go cell by cell. `None` if nothing is kept.
    pub fn follow(&self, info: &GridInfo, (columns, rows): (usize, usize)) -> Option<Step> {
        let moved = moved(&self.info, info)?;
        let (width, height) = ([self.info.width(), info.width()], [self.info.height(), info.height()]);
        let x = Axis::new(self.corner.0, moved.0, width, columns, TILE_WORDS * WORD_CELLS)?;
        let y = Axis::new(self.corner.1, moved.1, height, rows, TILE_ROWS)?;
        let growth = Growth { size: (x.length, y.length), tiles: (x.tiles, y.tiles) };
        let [left, right] = x.outside.clone().map(|columns| rect(&columns, &y.all));
        let [low, high] = y.outside.clone().map(|rows| rect(&x.both, &rows));
        Some(Step {
            placement: Self { info: *info, corner: (x.start, y.start) },
            moved,
            growth: (growth.size != (columns, rows)).then_some(growth),
            strips: [left, right, low, high],
        })
    }
}

/// By how many columns and rows cells of one map lie further on in the next; `None` if the two
/// have no cell in common.
pub(crate) fn moved(last: &GridInfo, next: &GridInfo) -> Option<(i32, i32)> {
    let Some((x, y)) = next.offset_of(last) else {
        let is_same_size = (last.width(), last.height()) == (next.width(), next.height());
        return is_same_size.then_some((0, 0));
    };
    let overlap = |moved: i32, last: usize, next: usize| {
        let moved = i64::from(moved);
        moved < next as i64 && -moved < last as i64
    };
    (overlap(x, last.width(), next.width()) && overlap(y, last.height(), next.height())).then_some((x, y))
}

/// The columns or the rows of two maps, in the planes as they will be.
struct Axis {
    /// How many columns or rows the planes will have.
    length: usize,
    /// The columns or rows of tiles that come before all others.
    tiles: usize,
    /// The first of the next map.
    start: usize,
    /// From the first to the last of either map.
    all: Range<usize>,
    /// Those of both maps.
    both: Range<usize>,
    /// Those before and behind that are of one alone.
    outside: [Range<usize>; 2],
}

impl Axis {
    /// For a map of some length at `corner`, the next one, by which it has moved, and planes that
    /// have some length. `None` where these would be far larger than the next map.
    fn new(corner: usize, moved: i32, [last, next]: [usize; 2], have: usize, tile: usize) -> Option<Self> {
        let start = corner as isize - moved as isize;
        let spare = (next / SPARE + tile / 2) / tile;
        let tiles = if start < 0 { start.unsigned_abs().div_ceil(tile) + spare } else { 0 };
        let (old, new) = (corner + tiles * tile, start.checked_add_unsigned(tiles * tile)?.unsigned_abs());
        let (old, new) = (old..old + last, new..new + next);
        let all = old.start.min(new.start)..old.end.max(new.end);
        let both = old.start.max(new.start)..old.end.min(new.end);
        let outside = [all.start..both.start, both.end..all.end];
        let held = have + tiles * tile;
        let is_beyond = new.end > held;
        let needed = if is_beyond { new.end + spare * tile } else { held };
        let length = if is_beyond || tiles > 0 { needed.next_multiple_of(tile) } else { have };
        let is_kept = length == have || length <= next + (2 * spare + MOST_EMPTY) * tile;
        is_kept.then_some(Self { length, tiles, start: new.start, all, both, outside })
    }
}

fn rect(columns: &Range<usize>, rows: &Range<usize>) -> CellRect {
    CellRect { x: columns.start, y: rows.start, width: columns.len(), height: rows.len() }
}
