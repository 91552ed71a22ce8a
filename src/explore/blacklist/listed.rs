//! What is said of the places that are left alone.

use crate::geometry::Point;
use std::fmt;

/// When what failed is tried again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Forgiven {
    /// When nothing else is left to try, or the map opens there.
    AfterRound,
    /// Never: failures are final.
    Never,
}

impl fmt::Display for Forgiven {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::AfterRound => "until nothing else is left to try, or the map opens there",
            Self::Never => "for good",
        })
    }
}

/// A target that failed, for those who want to know.
#[derive(Clone, Debug, PartialEq)]
pub struct Blacklisted {
    /// What was to be seen, in the map frame.
    pub target: Point,
    /// Where the robot was sent last for it.
    pub place: Point,
    /// How far around the target other targets are left with it, metres.
    pub radius_m: f64,
    /// How often it failed in this round.
    pub failures: u32,
    /// Whether the target is left alone; else only places to stand are.
    pub is_left_alone: bool,
    /// Why it failed last.
    pub why: String,
    /// When it is tried again.
    pub forgiven: Forgiven,
}
