//! A map from scans and odometry: scan matching on the growing map (the rim).
//!
//! Not a SLAM back end: each scan is matched against the map so far and stays where it was
//! put. There is no loop closure, so that the error of a long way round remains.

mod builder;

pub use crate::sim::MapperError;
pub use builder::BuilderConfig;
pub(crate) use builder::MapBuilder;
