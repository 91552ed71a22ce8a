//! Union-find over the rim components of all tiles, kept up to date block by block.
//!
//! A change concerns few tiles. So the nodes of blocks of tiles are connected first, of each
//! block within itself, which stays as it was where nothing changed; then those of blocks that
//! lie beside each other.

use crate::bits::connectivity::joins::{Joins, Pair};
use crate::bits::connectivity::tiling::{Tile, Tiling};
use crate::bits::union_find::{root_of, unite};
use crate::grid::Neighbourhood;
use std::ops::Range;

/// The connections of all nodes, with the buffers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Nodes {
    /// The index of each tile's first node among all, and of the end; at the last update too.
    first: Vec<u32>,
    first_before: Vec<u32>,
    /// Of each node one of the same block that it is connected to within the block, counted
    /// within the block, and not after it; at the last update too.
    within: Vec<u32>,
    within_before: Vec<u32>,
    /// Of each node one that it is connected to and that is not after it.
    parents: Vec<u32>,
    /// The blocks are others than at the last update.
    has_other_blocks: bool,
}

/// The tiles as far as their nodes are concerned.
#[derive(Clone, Copy)]
pub(crate) struct Tiles<'a> {
    pub tiling: &'a Tiling,
    pub tiles: &'a [Tile],
    /// The nodes that touch those of the tile to the right, and above.
    pub joins: &'a Joins,
    pub neighbourhood: Neighbourhood,
}

impl Tiles<'_> {
    /// Visits the nodes of a tile that touch such of a later one.
    fn for_each_join(&self, tile: usize, mut visit: impl FnMut(usize, Pair)) {
        let beside = self.tiling.later_neighbours(tile);
        if let Some(right) = beside.right {
            self.joins.list(2 * tile).iter().for_each(|&nodes| visit(right, nodes));
        }
        if let Some(above) = beside.above {
            self.joins.list(2 * tile + 1).iter().for_each(|&nodes| visit(above, nodes));
        }
        if self.neighbourhood == Neighbourhood::Eight {
            let this = &self.tiles[tile];
            let right = beside.above_right.and_then(|c| Some((c, this.joined_at_right_corner(&self.tiles[c])?)));
            let left = beside.above_left.and_then(|c| Some((c, this.joined_at_left_corner(&self.tiles[c])?)));
            right.into_iter().chain(left).for_each(|(corner, nodes)| visit(corner, nodes));
        }
    }
}

impl Nodes {
    /// Forgets all.
    pub fn reset(&mut self, tiles: usize) {
        self.first.clear();
        self.first.resize(tiles + 1, 0);
    }

    /// Puts the tiles in another order, in which they have so many nodes.
    pub fn rearrange(&mut self, counts: &[u16]) {
        self.count(counts);
        self.has_other_blocks = true;
    }

    /// Finds again which nodes are connected. The tiles that changed since the last time have
    /// other nodes, or other tiles beside them.
    pub fn connect(&mut self, counts: &[u16], tiles: Tiles<'_>, changed: &[bool]) {
        self.count(counts);
        let has_other_blocks = std::mem::take(&mut self.has_other_blocks);
        let Self { first, first_before, within, within_before, parents, .. } = self;
        std::mem::swap(within, within_before);
        within.clear();
        for block in tiles.tiling.blocks() {
            let (base, end) = (first[block.start], first[block.end]);
            if has_other_blocks || changed[block.clone()].contains(&true) {
                within.extend(0..end - base);
                let within = &mut within[base as usize..];
                for tile in block.clone() {
                    tiles.for_each_join(tile, |other, [a, b]| {
                        if other < block.end {
                            let (a, b) = (first[tile] + u32::from(a), first[other] + u32::from(b));
                            unite(within, a - base, b - base);
                        }
                    });
                }
            } else {
                let before = first_before[block.start] as usize..first_before[block.end] as usize;
                within.extend_from_slice(&within_before[before]);
            }
        }
        parents.clear();
        for block in tiles.tiling.blocks() {
            let base = first[block.start];
            parents.extend(within[base as usize..first[block.end] as usize].iter().map(|parent| parent + base));
        }
        for block in tiles.tiling.blocks() {
            for tile in tiles.tiling.last_row(&block) {
                tiles.for_each_join(tile, |other, [a, b]| {
                    if other >= block.end {
                        unite(parents, first[tile] + u32::from(a), first[other] + u32::from(b));
                    }
                });
            }
        }
    }

    /// Finds the first node of each tile.
    fn count(&mut self, counts: &[u16]) {
        std::mem::swap(&mut self.first, &mut self.first_before);
        self.first.clear();
        self.first.push(0);
        let mut count = 0;
        for &nodes in counts {
            count += u32::from(nodes);
            self.first.push(count);
        }
    }

    /// Number of nodes.
    pub const fn len(&self) -> usize {
        self.parents.len()
    }

    /// The nodes of tiles.
    pub fn of(&self, tiles: &Range<usize>) -> Range<usize> {
        self.first[tiles.start] as usize..self.first[tiles.end] as usize
    }

    /// The nodes of tiles as they were counted at the last update.
    pub fn before(&self, tiles: &Range<usize>) -> Range<usize> {
        self.first_before[tiles.start] as usize..self.first_before[tiles.end] as usize
    }

    /// The node that stands for all that a node of a tile is connected to.
    pub fn root(&mut self, tile: usize, node: u16) -> usize {
        root_of(&mut self.parents, self.first[tile] + u32::from(node)) as usize
    }

    /// Gives all nodes the answers of their roots.
    pub fn spread(&self, answers: &mut [bool]) {
        // A parent comes before its children, and so knows its root's answer already.
        for (node, &parent) in self.parents.iter().enumerate() {
            answers[node] = answers[parent as usize];
        }
    }

    /// What the buffers take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        let buffers = [&self.first, &self.first_before, &self.within, &self.within_before, &self.parents];
        buffers.map(Vec::capacity).iter().sum::<usize>() * size_of::<u32>()
    }
}
