//! A recording behind the port that the explorer knows: the very pipeline of the node, at
//! the time of a bag (the rim).

mod agreement;
mod cause;
mod clock;
mod faults;
mod frames;
mod goals;
mod guess;
mod inputs;
mod missing;
mod player;
mod robot;
mod scans;
mod told;
mod verdict;

pub use agreement::{Agreement, Parting, RecordedSight};
pub use clock::Clock;
pub use faults::{Fault, Faults};
pub use goals::{GoalEnd, RecordedGoal, RecordedGoals};
pub use inputs::{InputError, Inputs, Wanted};
pub use player::{PlayError, Player, Tap};
pub use robot::BagRobot;
pub use scans::{LeftOut, ScanMapping};
pub use verdict::Verdict;
