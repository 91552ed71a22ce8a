//! What is connected to a seed in a plane that changes here and there.

mod labelled;

use super::joins::Joins;
use super::spans::{Span, Spans};
use super::tiles::{Tile, Tiling};
use super::union_find::{root_of, unite};
use crate::grid::{BitPlane, Cell, Neighbourhood};
use labelled::LabelledTiles;

/// The connections of a plane and what of it is reached.
#[derive(Clone, Debug)]
pub(super) struct Reach {
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
    /// The index of each tile's first node among all.
    first_node: Vec<u32>,
    parents: Vec<u32>,
    /// Of all nodes, whether they are reached: now, and when last written.
    reached: Vec<bool>,
    written: Vec<bool>,
    /// The index of each tile's first node in `written`.
    first_written: Vec<u32>,
    plane: BitPlane,
    labelled: LabelledTiles,
    /// Components within a rim that hold a seed.
    inner: Vec<(usize, u32)>,
}

impl Reach {
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
            first_node: Vec::new(),
            parents: Vec::new(),
            reached: Vec::new(),
            written: Vec::new(),
            first_written: Vec::new(),
            plane: BitPlane::default(),
            labelled: LabelledTiles::default(),
            inner: Vec::new(),
        }
    }

    /// The cells that are reached.
    pub const fn plane(&self) -> &BitPlane {
        &self.plane
    }

    /// Starts over with planes of this size.
    pub fn reset(&mut self, width: usize, height: usize) {
        self.plane.resize(width, height);
        self.tiling = Tiling::new(self.plane.row_words(), height);
        let count = self.tiling.len();
        self.tiles.resize_with(count, Tile::default);
        self.labelled.reset(&self.tiling);
        self.node_counts.resize(count, 0);
        self.joins.reset(2 * count);
        self.dirty.clear();
        self.dirty.resize(count, true);
        self.has_inner.clear();
        self.has_inner.resize(count, false);
        self.first_written.clear();
        self.first_written.resize(count + 1, 0);
        self.written.clear();
    }

    /// Tells that a word of the plane changed.
    pub fn touch(&mut self, y: usize, word: usize) {
        self.dirty[self.tiling.at(y, word)] = true;
    }

    /// Finds again what is connected to any of the seeds in the plane, which must be as it
    /// was but for the words touched. Adds the words in which other cells are reached than
    /// before.
    pub fn update(&mut self, plane: &BitPlane, seeds: &[Cell], changed: &mut Spans) {
        self.labelled.forget(&self.dirty);
        self.label_rims(plane);
        self.join_tiles(plane);
        self.connect();
        self.mark_reached(plane, seeds);
        for tile in 0..self.tiles.len() {
            let inner = self.inner.iter().any(|&(of, _)| of == tile);
            let nodes = self.first_node[tile] as usize..self.first_node[tile + 1] as usize;
            let written = self.first_written[tile] as usize..self.first_written[tile + 1] as usize;
            let same = self.reached[nodes] == self.written[written];
            if !same || self.dirty[tile] || inner || self.has_inner[tile] {
                self.write(plane, tile, inner, changed);
            }
            self.has_inner[tile] = inner;
        }
        self.dirty.fill(false);
        std::mem::swap(&mut self.reached, &mut self.written);
        std::mem::swap(&mut self.first_node, &mut self.first_written);
    }

    fn label_rims(&mut self, plane: &BitPlane) {
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

    /// Unites all nodes that touch.
    fn connect(&mut self) {
        let Self { tiles, tiling, node_counts, joins, first_node, parents, .. } = self;
        first_node.clear();
        first_node.push(0);
        let mut count = 0;
        for &nodes in &*node_counts {
            count += u32::from(nodes);
            first_node.push(count);
        }
        parents.clear();
        parents.extend(0..count);
        for beside in tiling.later_neighbours() {
            let mut join = |other: usize, [a, b]: [u16; 2]| {
                unite(parents, first_node[beside.tile] + u32::from(a), first_node[other] + u32::from(b));
            };
            if let Some(right) = beside.right {
                joins.list(2 * beside.tile).iter().for_each(|&nodes| join(right, nodes));
            }
            if let Some(above) = beside.above {
                joins.list(2 * beside.tile + 1).iter().for_each(|&nodes| join(above, nodes));
            }
            if self.neighbourhood == Neighbourhood::Eight {
                for (corner, joined) in [
                    (beside.above_right, Tile::joined_at_right_corner as fn(&Tile, &Tile) -> _),
                    (beside.above_left, Tile::joined_at_left_corner),
                ] {
                    let tile = &tiles[beside.tile];
                    if let Some((corner, nodes)) = corner.and_then(|c| joined(tile, &tiles[c]).map(|nodes| (c, nodes)))
                    {
                        join(corner, nodes);
                    }
                }
            }
        }
    }

    /// Marks the nodes that are connected to a seed, and notes the seeds within rims.
    fn mark_reached(&mut self, plane: &BitPlane, seeds: &[Cell]) {
        self.inner.clear();
        self.reached.clear();
        self.reached.resize(self.parents.len(), false);
        for &seed in seeds.iter().filter(|&&seed| plane.contains(seed)) {
            let tile = self.tiling.at(seed.y as usize, seed.x as usize / crate::grid::WORD_CELLS);
            let labelled = self.labelled.of((tile, &mut self.tiles[tile]), plane, &self.tiling, self.neighbourhood);
            let component = labelled.labels.component_at(plane, &self.tiling.window(tile), seed);
            let Some(component) = component else { continue };
            match labelled.node_of(component) {
                None => self.inner.push((tile, component)),
                Some(node) => {
                    let root = root_of(&mut self.parents, self.first_node[tile] + u32::from(node));
                    self.reached[root as usize] = true;
                }
            }
        }
        // A parent comes before its children, and so knows its root's answer already.
        for node in 0..self.parents.len() {
            self.reached[node] = self.reached[self.parents[node] as usize];
        }
    }

    /// Writes the reached cells of a tile, which has a seed within its rim or not.
    fn write(&mut self, plane: &BitPlane, tile: usize, is_seeded: bool, changed: &mut Spans) {
        let window = self.tiling.window(tile);
        let reached = &self.reached[self.first_node[tile] as usize..self.first_node[tile + 1] as usize];
        let mut write = |y: usize, i: usize, word: u64| {
            let target = &mut self.plane.row_mut(y)[i];
            if *target != word {
                *target = word;
                changed.add(y, Span::of(&(i..i + 1)));
            }
        };
        let is_mixed = reached.contains(&true) && reached.contains(&false);
        if !(self.tiles[tile].has_islands || is_seeded || is_mixed) {
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
        let nodes = (self.parents.capacity() + self.first_node.capacity() + self.first_written.capacity()) * 4;
        let flags = self.dirty.capacity() + self.has_inner.capacity();
        self.plane.memory_bytes()
            + self.labelled.memory_bytes()
            + self.tiles.capacity() * size_of::<Tile>()
            + self.tiles.iter().map(Tile::memory_bytes).sum::<usize>()
            + self.node_counts.capacity() * size_of::<u16>()
            + self.joins.memory_bytes()
            + nodes
            + flags
            + self.reached.capacity()
            + self.written.capacity()
            + self.inner.capacity() * size_of::<(usize, u32)>()
    }
}

#[cfg(test)]
#[path = "reach_tests.rs"]
mod tests;
