//! The worlds by name.

use crate::{maze, museum, office, warehouse};
use frontier_explorer::grid::{GridInfoError, OccupancyGrid};

/// How a world is drawn.
pub type Draw = fn() -> Result<OccupancyGrid, GridInfoError>;

/// Every world: its name and its drawing.
pub const ALL: [(&str, Draw); 4] =
    [("office", office::draw), ("museum", museum::draw), ("maze", maze::draw), ("warehouse", warehouse::draw)];
