//! Occupancy grids, costmaps and what is computed on them cell by cell (floor 0).
//!
//! Row order is ROS's: cell (0, 0) is the lowest x and y of the grid's own frame and
//! index `y * width + x`; images, whose first row is the highest y, are turned over
//! where they are read or written and nowhere else.

mod area_cells;
mod cell;
mod cell_values;
mod census;
mod changes;
mod costmap;
mod distance;
mod flood;
#[cfg(test)]
pub(crate) mod growing_tests;
mod growth;
mod info;
mod live;
mod memory;
mod near;
mod occupancy;
mod patch;
mod raytrace;
mod rect;
mod state;
mod vertical;

pub use area_cells::{AreaCells, AreaCensus};
pub use cell::Cell;
pub use cell_values::CellValues;
pub(crate) use cell_values::changed_rect;
pub use census::Census;
pub(crate) use census::LiveCensus;
pub use changes::Changes;
pub(crate) use changes::Known;
pub use costmap::{
    BelievedCosts, Costmap, FREE_COST, HIGHEST_COST, INSCRIBED_COST, Inflation, LETHAL_COST, NARROW_COST, UNKNOWN_COST,
    unknown_share_hidden_by,
};
pub(crate) use costmap::{LiveCostmap, Roomy};
pub use distance::squared_distance_cells;
pub use growth::{Growth, Since};
pub use info::{GridInfo, GridInfoError, MAX_CELLS, NEIGHBOURS_4, NEIGHBOURS_8, Neighbourhood};
pub use live::{Live, Snapshot};
pub use memory::MapMemory;
pub use occupancy::{GridError, OccupancyGrid};
pub use patch::{GridPatch, GridPatchError};
pub use raytrace::{Traversal, traverse};
pub use rect::CellRect;
pub use state::{CellState, ThresholdError, Thresholds};
