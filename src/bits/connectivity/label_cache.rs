//! Keeps the component labels of the few tiles that were looked at last.
//!
//! A tile that changed is labelled to join it to others, and again to write what of it is
//! reached. As long as few change, the labels are kept from one to the other.

use crate::bits::BitPlane;
use crate::bits::connectivity::tiling::{NONE, Tile, Tiling};
use crate::bits::labels::Labels;
use crate::grid::Neighbourhood;

/// The labels of one tile.
#[derive(Clone, Debug, Default)]
pub(crate) struct Labelled {
    /// The tile.
    tile: Option<usize>,
    /// The components of its runs.
    pub labels: Labels,
    /// The node of each component.
    nodes: Vec<u16>,
}

impl Labelled {
    /// The node of a component that touches the rim.
    pub fn node_of(&self, component: u32) -> Option<u16> {
        self.nodes.get(component as usize).copied().filter(|&node| node != NONE)
    }
}

/// The tiles labelled last.
#[derive(Clone, Debug, Default)]
pub(crate) struct LabelCache {
    tiles: Vec<Labelled>,
    next: usize,
}

/// One in so many tiles is kept, so that the labels take little beside the planes. The planes
/// of the tests are small.
const TILES_FOR_EACH: usize = if cfg!(test) { 2 } else { 32 };

impl LabelCache {
    /// Forgets all, and makes room for those of a plane.
    pub fn reset(&mut self, tiling: &Tiling) {
        self.tiles.iter_mut().for_each(|labelled| labelled.tile = None);
        self.tiles.resize_with((tiling.len() / TILES_FOR_EACH).max(1), Labelled::default);
        self.next = 0;
    }

    /// Forgets the tiles that changed.
    pub fn forget(&mut self, changed: &[bool]) {
        for labelled in &mut self.tiles {
            labelled.tile = labelled.tile.filter(|&tile| !changed[tile]);
        }
    }

    /// The labels of a tile of a plane, with the tile's rim read in if it had none.
    pub fn of(
        &mut self,
        (index, tile): (usize, &mut Tile),
        plane: &BitPlane,
        tiling: &Tiling,
        neighbourhood: Neighbourhood,
    ) -> &Labelled {
        let place_of = |this: &Self, tile| this.tiles.iter().position(|labelled| labelled.tile == tile);
        let place = place_of(self, Some(index)).unwrap_or_else(|| {
            let place = place_of(self, None).unwrap_or(self.next);
            self.next = (place + 1) % self.tiles.len();
            let Labelled { tile: known, labels, nodes } = &mut self.tiles[place];
            let window = tiling.window(index);
            labels.label(plane, &window, neighbourhood);
            tile.read_rim(plane, &window, labels, nodes);
            *known = Some(index);
            place
        });
        &self.tiles[place]
    }

    /// What the labels take in memory, bytes.
    pub fn memory_bytes(&self) -> usize {
        let of_tile =
            |labelled: &Labelled| labelled.labels.memory_bytes() + labelled.nodes.capacity() * size_of::<u16>();
        self.tiles.capacity() * size_of::<Labelled>() + self.tiles.iter().map(of_tile).sum::<usize>()
    }
}
