//! What the node shows: markers for RViz, the candidates with their scores, its status.

mod areas;
mod frontier_array;
mod markers;
mod status;

pub use areas::{AreaMarkers, ShownAreas};
pub use frontier_array::frontier_array;
pub use markers::{FrontierMarkers, no_markers};
pub use status::{StatusInput, diagnostics, region_message, status, status_sentence};
