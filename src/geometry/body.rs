//! The robot's body as planners and controllers see it.

use super::{Footprint, MotionLimits};

/// What moves: an outline, and what it is able to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its outline.
    pub footprint: Footprint,
    /// What it is able to do.
    pub limits: MotionLimits,
}
