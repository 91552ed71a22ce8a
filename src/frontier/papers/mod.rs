//! The detectors as the papers and programs have them, one file for each.

pub(super) mod canny;
pub(super) mod dbscan;
pub(super) mod explore_lite;
pub(super) mod fast;
mod groups;
pub(super) mod image;
mod territory;
pub(super) mod wavefront;
pub(super) mod yamauchi;
