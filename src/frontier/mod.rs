//! Frontiers and the detectors that find them (floor 1).

mod bitplane;
mod detection;
mod grouping;
mod kind;
mod papers;
mod params;
#[cfg(test)]
#[path = "random_maps_tests.rs"]
mod random_maps;
mod representative;
mod tracker;

pub use bitplane::{Bitplane, FromScratch, Repair};
pub use detection::{CellSide, DetectError, DetectionInput, Frontier, FrontierDetector};
pub(crate) use detection::{number, order};
pub use grouping::{Cells, FrontierCells};
pub use kind::DetectorKind;
pub use papers::canny::{Canny, CannyParams};
pub use papers::dbscan::{Dbscan, DbscanParams};
pub use papers::explore_lite::ExploreLiteSearch;
pub use papers::fast::{Fast, FastParams};
pub use papers::image::{ImageDetector, ImageParams};
pub use papers::wavefront::Wavefront;
pub use papers::yamauchi::Yamauchi;
pub use params::{DetectorParams, DetectorParamsError, Reachability};
pub use representative::Representative;
pub use tracker::{FrontierId, FrontierTracker};
