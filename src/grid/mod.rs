//! Occupancy grids, costmaps and what is computed on them cell by cell (floor 0).
//!
//! Row order is ROS's: cell (0, 0) is the lowest x and y of the grid's own frame and
//! index `y * width + x`; images, whose first row is the highest y, are turned over
//! where they are read or written and nowhere else.

mod bitplane;
mod bitplanes;
mod classify;
mod costmap;
mod distance;
mod info;
mod near;
mod occupancy;
mod pack;
mod patch;
mod published;
mod raytrace;
mod rect;
#[cfg(target_arch = "x86_64")]
mod simd;
mod state;
mod touch;
mod vertical;

pub use bitplane::{BitPlane, BitWork, WORD_CELLS, with_bit_instructions};
pub use bitplanes::BitPlanes;
pub use classify::Classifier;
pub use costmap::{
    Costmap, FREE_COST, HIGHEST_COST, INSCRIBED_COST, Inflation, LETHAL_COST, NARROW_COST, UNKNOWN_COST,
};
pub use distance::squared_distance_cells;
pub use info::{Cell, GridInfo, GridInfoError, MAX_CELLS, NEIGHBOURS_4, NEIGHBOURS_8, Neighbourhood};
pub use occupancy::{Census, GridError, OccupancyGrid};
pub use patch::{GridPatch, GridPatchError};
pub use raytrace::{Traversal, traverse};
pub use rect::CellRect;
pub use state::{CellState, ThresholdError, Thresholds};
pub use touch::touch;
