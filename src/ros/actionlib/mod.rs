//! The protocol of actionlib without its topics: `goal_tracker.rs` is the client's side,
//! `goal_book.rs` the server's.

mod goal_book;
mod goal_tracker;

pub(crate) use goal_book::{Entry, GoalBook, is_meant};
pub use goal_tracker::{GoalStatus, GoalTracker};
