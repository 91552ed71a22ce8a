//! The runs of a comparison: where they begin, and how they are made several at a time.

mod error;
mod runner;
mod starts;
mod worlds;

pub use error::CompareError;
pub use runner::Runner;
pub use starts::{Starts, StartsError};
