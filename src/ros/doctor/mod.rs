//! A look at a running ROS graph before an exploration: what is wrong, and how to mend it.
//!
//! `gather.rs` listens for some seconds and makes facts (`facts.rs`) of what it hears; `judge/`
//! makes findings of facts and is pure, one file for each part of the stack. What the node's own
//! parameters are worth is judged above this room, which knows no configuration.

mod costmap_params;
mod ears;
mod facts;
mod finding;
mod gather;
mod judge;

pub use facts::{OwnOutline, Wanted};
pub use finding::{Finding, FindingLevel};
pub use gather::gather;
pub use judge::judge;
