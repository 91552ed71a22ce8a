//! Simulated, recorded and compared runs (the rim): what puts one together, drives it and
//! records it, for the command line and the nodes.

#[cfg(feature = "report")]
pub mod comparison;
mod error;
#[cfg(feature = "report")]
mod map_detection;
mod named_world;
#[cfg(feature = "report")]
pub mod oracle;
mod pace;
mod plan;
#[cfg(feature = "report")]
pub mod record;

pub use error::PlanError;
#[cfg(feature = "report")]
pub use map_detection::MapDetection;
pub use named_world::NamedWorld;
pub use pace::Pace;
pub use plan::Plan;
