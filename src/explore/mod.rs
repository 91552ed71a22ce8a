//! The explorer: a pure state machine from observations to decisions (floor 2).

mod record;

pub use record::{CandidateRecord, CandidateStatus, Counts, DecisionRecord, End, EndReason, LeftBehind, Position};
