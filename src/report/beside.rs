//! What a recording decided beside what we would have: for the page of a replay.

use serde::Serialize;

/// The recording's decisions beside ours.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Beside {
    /// Goals of the recording.
    pub recorded_goals: usize,
    /// Of those, the ones near a frontier that we saw.
    pub at_frontiers: usize,
    /// Our decisions that could be compared.
    pub decisions: usize,
    /// Of those, the ones that agree with the recording.
    pub agreeing: usize,
    /// Why the others do not, and how many for each cause.
    pub causes: Vec<(String, usize)>,
    /// The others, in their order.
    pub partings: Vec<BesideRow>,
}

/// A decision of ours that is not the recording's.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BesideRow {
    /// When, seconds since the recording's begin.
    pub time_s: f64,
    /// Where we would have gone: metres of the map frame.
    pub ours: Option<[f64; 2]>,
    /// Where the recording went: metres of the map frame.
    pub recorded: Option<[f64; 2]>,
    /// Why it was not ours, as far as can be told.
    pub cause: String,
}
