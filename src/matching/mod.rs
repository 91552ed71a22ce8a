//! Where a scan fits on a map (floor 1): scan matching, for the maps that are made of
//! recordings and for the simulator's SLAM.

mod field;
mod matcher;

pub use field::LikelihoodField;
pub use matcher::{Match, Prior, match_scan, thinned_hits};
