//! Keeps which cells of a plane that changes are connected to a seed, tile by tile.

use super::label_cache::LabelCache;
use super::nodes::{Nodes, Tiles};
use crate::bits::connectivity::joins::Joins;
use crate::bits::connectivity::tiling::{TILE_ROWS, TILE_WORDS, Tile, Tiling};
use crate::bits::word_spans::WordSpans;
use crate::bits::{BitPlane, prefetch};
use crate::grid::{Cell, Neighbourhood};
use std::ops::Range;

/// The connections of a plane and what of it is reached.
#[derive(Clone, Debug)]
pub(crate) struct TileGraph {
    neighbourhood: Neighbourhood,
    tiling: Tiling,
    tiles: Vec<Tile>,
    /// Number of nodes of each tile.
    node_counts: Vec<u16>,
    /// Of each tile the nodes that touch those of the tile to the right, and above.
    joins: Joins,
    /// Tiles whose cells changed since they were labelled.
    dirty: Vec<bool>,
    /// Of each tile whether its reached cells include a component within its rim.
    has_inner: Vec<bool>,
    nodes: Nodes,
    /// Of all nodes, whether they are reached: now, and when last written.
    reached: Vec<bool>,
    written: Vec<bool>,
    plane: BitPlane,
    /// Words in which other cells are reached than before.
    changed: WordSpans,
    labelled: LabelCache,
    /// Tiles that are written.
    stale: Vec<usize>,
    /// Components within a rim that hold a seed.
    inner: Vec<(usize, u32)>,
}

impl TileGraph {
    /// Of no plane yet.
    pub fn new(neighbourhood: Neighbourhood) -> Self {
        Self {
            neighbourhood,
            tiling: Tiling::default(),
            tiles: Vec::new(),
            node_counts: Vec::new(),
            joins: Joins::default(),
            dirty: Vec::new(),
            has_inner: Vec::new(),
            nodes: Nodes::default(),
            reached: Vec::new(),
            written: Vec::new(),
            plane: BitPlane::default(),
            changed: WordSpans::default(),
            labelled: LabelCache::default(),
            stale: Vec::new(),
            inner: Vec::new(),
        }
    }

    /// The cells that are reached.
    pub const fn plane(&self) -> &BitPlane {
        &self.plane
    }

    /// The words in which other cells were reached after the last update than before.
    pub const fn changed(&self) -> &WordSpans {
        &self.changed
    }

    /// What connects cells.
    pub const fn neighbourhood(&self) -> Neighbourhood {
        self.neighbourhood
    }

    /// Starts over with planes of this size.
    pub fn reset(&mut self, width: usize, height: usize) {
        self.plane.resize(width, height);
        self.tiling = Tiling::new(self.plane.row_words(), height);
        self.changed.reset(self.plane.row_words(), height);
        let count = self.tiling.len();
        self.tiles.resize_with(count, Tile::default);
        self.labelled.reset(&self.tiling);
        self.node_counts.resize(count, 0);
        self.joins.reset(2 * count);
        self.dirty.clear();
        self.dirty.resize(count, true);
        self.has_inner.clear();
        self.has_inner.resize(count, false);
        self.nodes.reset(count);
        self.written.clear();
    }

    /// Goes on with planes that have grown by so many columns and rows of tiles in front and below,
    /// and in all to a size; see [`BitPlane::grow`].
    pub fn grow(&mut self, width: usize, height: usize, (columns, rows): (usize, usize)) {
        self.plane.grow(width, height, (columns * TILE_WORDS, rows * TILE_ROWS));
        let tiling = Tiling::new(self.plane.row_words(), height);
        let before = std::mem::replace(&mut self.tiling, tiling);
        let origins: Vec<Option<usize>> = tiling.origins(before, (columns, rows)).collect();
        self.changed.reset(self.plane.row_words(), height);
        self.labelled.reset(&tiling);
        self.joins.rearrange(origins.iter().flat_map(|o| [o.map(|tile| 2 * tile), o.map(|tile| 2 * tile + 1)]));
        let nodes_of = |origin: &Option<usize>| origin.map_or(0..0, |tile| self.nodes.of(&(tile..tile + 1)));
        self.written = origins.iter().flat_map(nodes_of).map(|node| self.written[node]).collect();
        self.node_counts = origins.iter().map(|origin| nodes_of(origin).len() as u16).collect();
        self.nodes.rearrange(&self.node_counts);
        let mut tiles = std::mem::take(&mut self.tiles);
        let tile_of = |origin: &Option<usize>| origin.map(|tile| std::mem::take(&mut tiles[tile])).unwrap_or_default();
        self.tiles = origins.iter().map(tile_of).collect();
        self.dirty = origins.iter().map(|origin| origin.is_none_or(|tile| self.dirty[tile])).collect();
        self.has_inner = origins.iter().map(|origin| origin.is_some_and(|tile| self.has_inner[tile])).collect();
    }

    /// Finds what is connected to a seed in a plane of which nothing is known. Only the buffers
    /// are kept.
    pub fn find(&mut self, plane: &BitPlane, seed: Cell, reached: &mut BitPlane) {
        std::mem::swap(&mut self.plane, reached);
        self.reset(plane.width(), plane.height());
        self.update(plane, &[seed]);
        std::mem::swap(&mut self.plane, reached);
    }

    /// Tells that a word of the plane changed.
    pub fn mark_dirty(&mut self, y: usize, word: usize) {
        self.dirty[self.tiling.at(y, word)] = true;
    }

    /// Finds again what is connected to any of the seeds in the plane, which must be as it
    /// was but for the words touched.
    pub fn update(&mut self, plane: &BitPlane, seeds: &[Cell]) {
        self.changed.clear();
        self.labelled.forget(&self.dirty);
        self.label_rims(plane);
        self.join_tiles(plane);
        let Self { tiling, tiles, joins, neighbourhood, .. } = self;
        self.nodes.connect(
            &self.node_counts,
            Tiles { tiling, tiles, joins, neighbourhood: *neighbourhood },
            &self.dirty,
        );
        self.mark_reached(plane, seeds);
        self.list_stale();
        for plane in [plane, &self.plane] {
            prefetch_tiles(plane, &self.tiling, self.stale.iter().copied());
        }
        for index in 0..self.stale.len() {
            self.write(plane, self.stale[index]);
        }
        self.dirty.fill(false);
        std::mem::swap(&mut self.reached, &mut self.written);
    }

    /// Lists the tiles whose reached cells may be others than before.
    fn list_stale(&mut self) {
        let Self { tiling, dirty, has_inner, nodes, reached, written, stale, inner, .. } = self;
        // Those with a seed within their rims now, and those that had one.
        inner.iter().for_each(|&(tile, _)| has_inner[tile] = true);
        let is_stale = |tiles: &Range<usize>| {
            dirty[tiles.clone()].contains(&true)
                || has_inner[tiles.clone()].contains(&true)
                || reached[nodes.of(tiles)] != written[nodes.before(tiles)]
        };
        stale.clear();
        for block in tiling.blocks().filter(is_stale) {
            stale.extend(block.filter(|&tile| is_stale(&(tile..tile + 1))));
        }
        has_inner.fill(false);
        inner.iter().for_each(|&(tile, _)| has_inner[tile] = true);
    }

    fn label_rims(&mut self, plane: &BitPlane) {
        prefetch_tiles(plane, &self.tiling, (0..self.tiles.len()).filter(|&tile| self.dirty[tile]));
        for tile in 0..self.tiles.len() {
            if self.dirty[tile] {
                self.labelled.of((tile, &mut self.tiles[tile]), plane, &self.tiling, self.neighbourhood);
                self.node_counts[tile] = self.tiles[tile].nodes;
            }
        }
    }

    /// Finds again what joins the tiles that changed to those beside them.
    fn join_tiles(&mut self, plane: &BitPlane) {
        let Self { tiling, tiles, dirty, neighbourhood, joins, .. } = self;
        if !dirty.contains(&true) {
            return;
        }
        let columns = tiling.columns();
        // At the end of a row that may be one too many.
        let is_stale = |list: usize| {
            let beside = list / 2 + if list % 2 == 1 { columns } else { 1 };
            dirty[list / 2] || dirty.get(beside) == Some(&true)
        };
        joins.rebuild(is_stale, |list, pairs| {
            let (tile, is_above) = (list / 2, list % 2 == 1);
            let Some(other) = tiling.beside(tile, if is_above { (0, 1) } else { (1, 0) }) else { return };
            if is_above {
                let windows = [&tiling.window(tile), &tiling.window(other)];
                tiles[tile].join_above(&tiles[other], plane, windows, *neighbourhood, pairs);
            } else {
                tiles[tile].join_right(&tiles[other], *neighbourhood, pairs);
            }
        });
    }

    /// Marks the nodes that are connected to a seed, and notes the seeds within rims.
    fn mark_reached(&mut self, plane: &BitPlane, seeds: &[Cell]) {
        self.inner.clear();
        self.reached.clear();
        self.reached.resize(self.nodes.len(), false);
        for &seed in seeds.iter().filter(|&&seed| plane.contains(seed)) {
            let tile = self.tiling.at(seed.y as usize, seed.x as usize / crate::bits::WORD_CELLS);
            let labelled = self.labelled.of((tile, &mut self.tiles[tile]), plane, &self.tiling, self.neighbourhood);
            let component = labelled.labels.component_at(plane, &self.tiling.window(tile), seed);
            let Some(component) = component else { continue };
            match labelled.node_of(component) {
                None => self.inner.push((tile, component)),
                Some(node) => {
                    let root = self.nodes.root(tile, node);
                    self.reached[root] = true;
                }
            }
        }
        self.nodes.spread(&mut self.reached);
    }

    /// Writes the reached cells of a tile.
    fn write(&mut self, plane: &BitPlane, tile: usize) {
        let window = self.tiling.window(tile);
        let reached = &self.reached[self.nodes.of(&(tile..tile + 1))];
        self.changed.expect(&window.rows);
        let mut write = |y: usize, i: usize, word: u64| {
            let target = &mut self.plane.row_mut(y)[i];
            self.changed.add_if(y, i, *target != word);
            *target = word;
        };
        let is_mixed = reached.contains(&true) && reached.contains(&false);
        if !(self.tiles[tile].has_islands || is_mixed) {
            // All or nothing: no need to know which cell is whose.
            let all = if reached.contains(&true) { u64::MAX } else { 0 };
            for y in window.rows.clone() {
                for (i, &word) in window.words.clone().zip(window.row(plane, y)) {
                    write(y, i, word & all);
                }
            }
            return;
        }
        let labelled = self.labelled.of((tile, &mut self.tiles[tile]), plane, &self.tiling, self.neighbourhood);
        let is_kept = |component: u32| match labelled.node_of(component) {
            Some(node) => reached[usize::from(node)],
            None => self.inner.contains(&(tile, component)),
        };
        labelled.labels.select(plane, &window, is_kept, write);
    }

    /// What all this takes in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        let flags = self.dirty.capacity() + self.has_inner.capacity();
        self.plane.memory_bytes()
            + self.changed.memory_bytes()
            + self.labelled.memory_bytes()
            + self.tiles.capacity() * size_of::<Tile>()
            + self.tiles.iter().map(Tile::memory_bytes).sum::<usize>()
            + self.node_counts.capacity() * size_of::<u16>()
            + self.joins.memory_bytes()
            + self.nodes.memory_bytes()
            + flags
            + self.reached.capacity()
            + self.written.capacity()
            + self.stale.capacity() * size_of::<usize>()
            + self.inner.capacity() * size_of::<(usize, u32)>()
    }
}

/// Has the words of tiles at hand.
fn prefetch_tiles(plane: &BitPlane, tiling: &Tiling, tiles: impl Iterator<Item = usize>) {
    let windows = tiles.map(|tile| tiling.window(tile));
    prefetch(windows.flat_map(|window| window.rows.clone().map(move |y| &plane.row(y)[window.words.clone()])));
}

#[cfg(test)]
#[path = "tile_graph_tests.rs"]
mod tests;
