//! A plane cut into tiles, each of which remembers how its rim is connected within it.
//!
//! What a change in one tile does to the connections of all is found from the rims alone,
//! as in the clusters of Botea, Müller and Schaeffer, "Near Optimal Hierarchical
//! Path-Finding" (Journal of Game Development 2004): components that touch a tile's rim
//! are nodes, those of two tiles that touch are joined, and what is connected to the seed
//! is a union-find over the nodes. Only tiles that changed are labelled again.

use crate::bits::BitPlane;
use crate::bits::connectivity::joins::Pair;
use crate::bits::contacts::for_each_contact;
use crate::bits::labels::Labels;
use crate::bits::window::Window;
use crate::grid::Neighbourhood;
use std::ops::Range;

/// Words in a row of a tile.
pub(crate) const TILE_WORDS: usize = 4;
/// Rows of a tile.
pub(crate) const TILE_ROWS: usize = 64;
/// Rows of tiles in a block; the planes of the tests are small.
const BLOCK_ROWS: usize = if cfg!(test) { 2 } else { 4 };
/// No node: the cell is not set, or its component does not touch the rim.
pub(crate) const NONE: u16 = u16::MAX;

/// How a plane is cut.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tiling {
    row_words: usize,
    height: usize,
    columns: usize,
    rows: usize,
}

impl Tiling {
    /// The tiles of planes of this size.
    pub const fn new(row_words: usize, height: usize) -> Self {
        Self { row_words, height, columns: row_words.div_ceil(TILE_WORDS), rows: height.div_ceil(TILE_ROWS) }
    }

    /// Number of tiles.
    pub const fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Number of tiles in a row of them.
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// The tile of a word of a row.
    pub const fn at(&self, y: usize, word: usize) -> usize {
        y / TILE_ROWS * self.columns + word / TILE_WORDS
    }

    /// The words of a tile.
    pub fn window(&self, tile: usize) -> Window {
        let (row, column) = (tile / self.columns * TILE_ROWS, tile % self.columns * TILE_WORDS);
        Window {
            rows: row..(row + TILE_ROWS).min(self.height),
            words: column..(column + TILE_WORDS).min(self.row_words),
        }
    }

    /// The tiles beside one that come later in the order of rows.
    pub const fn later_neighbours(&self, tile: usize) -> LaterNeighbours {
        let (column, above) = (tile % self.columns, tile + self.columns);
        let (has_left, has_right, has_above) = (column > 0, column + 1 < self.columns, above < self.len());
        LaterNeighbours {
            right: if has_right { Some(tile + 1) } else { None },
            above: if has_above { Some(above) } else { None },
            above_left: if has_above && has_left { Some(above - 1) } else { None },
            above_right: if has_above && has_right { Some(above + 1) } else { None },
        }
    }

    /// The tiles in blocks of some rows of them each.
    pub fn blocks(self) -> impl Iterator<Item = Range<usize>> {
        let tiles = BLOCK_ROWS * self.columns;
        (0..self.len()).step_by(tiles.max(1)).map(move |start| start..(start + tiles).min(self.len()))
    }

    /// Of each tile the one of an earlier tiling that it is, now so many columns and rows of tiles
    /// further on; none where there was none, or one that the end of the plane cut shorter.
    pub fn origins(self, before: Self, (columns, rows): (usize, usize)) -> impl Iterator<Item = Option<usize>> {
        let size = |window: Window| (window.rows.len(), window.words.len());
        (0..self.len()).map(move |tile| {
            let column = (tile % self.columns).checked_sub(columns).filter(|&column| column < before.columns)?;
            let row = (tile / self.columns).checked_sub(rows).filter(|&row| row < before.rows)?;
            let origin = row * before.columns + column;
            (size(before.window(origin)) == size(self.window(tile))).then_some(origin)
        })
    }

    /// The tiles of a block that lie beside the next.
    pub const fn last_row(&self, block: &Range<usize>) -> Range<usize> {
        block.end - self.columns..block.end
    }

    /// The tile a number of columns and rows on, if there is one.
    pub fn beside(&self, tile: usize, (columns, rows): (isize, isize)) -> Option<usize> {
        let column = (tile % self.columns).checked_add_signed(columns).filter(|&c| c < self.columns)?;
        let row = (tile / self.columns).checked_add_signed(rows).filter(|&r| r < self.rows)?;
        Some(row * self.columns + column)
    }
}

/// The tiles beside one that come later in the order of rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaterNeighbours {
    /// The one after it.
    pub right: Option<usize>,
    /// The one above it.
    pub above: Option<usize>,
    /// The one at its corner above to the left.
    pub above_left: Option<usize>,
    /// The one at its corner above to the right.
    pub above_right: Option<usize>,
}

/// The rim of a tile: which of its cells belong to which node.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tile {
    /// Number of nodes.
    pub nodes: u16,
    /// Whether there are components that do not touch the rim.
    pub has_islands: bool,
    /// The node of each run of the lowest row.
    lowest: Vec<u16>,
    /// The node of each run of the highest row.
    highest: Vec<u16>,
    /// The node of the first cell of each row.
    left: Vec<u16>,
    /// The node of the last cell of each row.
    right: Vec<u16>,
}

impl Tile {
    /// Takes in a labelled tile. `node_of` becomes the node of each component.
    pub fn read_rim(&mut self, plane: &BitPlane, window: &Window, labels: &Labels, node_of: &mut Vec<u16>) {
        node_of.clear();
        node_of.resize(labels.components(), NONE);
        self.nodes = 0;
        let mut node = |component: u32| {
            let node = &mut node_of[component as usize];
            if *node == NONE {
                *node = self.nodes;
                self.nodes += 1;
            }
            *node
        };
        let rows = window.rows.len();
        self.lowest.clear();
        self.lowest.extend(labels.row(0).iter().map(|&component| node(component)));
        self.highest.clear();
        self.highest.extend(labels.row(rows - 1).iter().map(|&component| node(component)));
        self.left.clear();
        self.right.clear();
        for (row, y) in window.rows.clone().enumerate() {
            let (words, components) = (window.row(plane, y), labels.row(row));
            let first = components.first().filter(|_| words.first().is_some_and(|word| word & 1 != 0));
            let last = components.last().filter(|_| words.last().is_some_and(|word| word >> 63 != 0));
            self.left.push(first.map_or(NONE, |&component| node(component)));
            self.right.push(last.map_or(NONE, |&component| node(component)));
        }
        self.has_islands = labels.components() > usize::from(self.nodes);
    }

    /// Appends which nodes touch those of the tile to the right.
    pub fn join_right(&self, other: &Self, neighbourhood: Neighbourhood, pairs: &mut Vec<Pair>) {
        let reach = usize::from(neighbourhood == Neighbourhood::Eight);
        let begin = pairs.len();
        for (row, &node) in self.right.iter().enumerate().filter(|&(_, &node)| node != NONE) {
            let touching = row.saturating_sub(reach)..(row + reach + 1).min(other.left.len());
            for &next in other.left[touching].iter().filter(|&&next| next != NONE) {
                push_new(pairs, begin, [node, next]);
            }
        }
    }

    /// Appends which nodes touch those of the tile above; the windows are those of the two.
    pub fn join_above(
        &self,
        other: &Self,
        plane: &BitPlane,
        [here, there]: [&Window; 2],
        neighbourhood: Neighbourhood,
        pairs: &mut Vec<Pair>,
    ) {
        let (row, above) = (here.row(plane, here.rows.end - 1), there.row(plane, there.rows.start));
        let begin = pairs.len();
        for_each_contact(row, above, neighbourhood == Neighbourhood::Eight, |run, above_run| {
            push_new(pairs, begin, [self.highest[run as usize], other.lowest[above_run as usize]]);
        });
    }

    /// The pair of nodes that touch at the corner above to the right, if one does.
    pub fn joined_at_right_corner(&self, other: &Self) -> Option<Pair> {
        joined(self.right.last(), other.left.first())
    }

    /// The pair of nodes that touch at the corner above to the left, if one does.
    pub fn joined_at_left_corner(&self, other: &Self) -> Option<Pair> {
        joined(self.left.last(), other.right.first())
    }

    /// What the rim takes in memory beside the type itself, bytes.
    pub fn memory_bytes(&self) -> usize {
        let nodes = [&self.lowest, &self.highest, &self.left, &self.right].map(Vec::capacity).iter().sum::<usize>();
        nodes * size_of::<u16>()
    }
}

/// Appends a pair, unless it is the last of those since `begin`.
fn push_new(pairs: &mut Vec<Pair>, begin: usize, pair: Pair) {
    if pairs[begin..].last() != Some(&pair) {
        pairs.push(pair);
    }
}

fn joined(a: Option<&u16>, b: Option<&u16>) -> Option<Pair> {
    let (&a, &b) = (a?, b?);
    (a != NONE && b != NONE).then_some([a, b])
}
