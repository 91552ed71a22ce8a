//! From a plane of frontier cells to frontiers: connected cells grouped, listed and, where a few
//! words changed, grouped again.

pub(super) mod cell_groups;
pub(super) mod cell_lists;
pub(super) mod clusters;
pub(super) mod repair;
pub(super) mod shared_cells;

pub use cell_lists::FrontierCells;
pub use shared_cells::Cells;
