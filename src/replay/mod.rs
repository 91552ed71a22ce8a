//! A recording behind the port that the explorer knows: the very pipeline of the node, at
//! the time of a bag (the rim).

mod inputs;
mod player;
mod robot;

pub use inputs::{InputError, Inputs, Wanted};
pub use player::{Player, RecordedGoal, Tap};
pub use robot::BagRobot;
