//! What of a robot behind ROS may change while it drives, shared by all who go by it.

use std::sync::{Arc, Mutex, PoisonError};

/// The values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tuned {
    /// How old the robot's transform may be, seconds.
    pub transform_tolerance_s: f64,
    /// How long goals of others are left to their end, seconds.
    pub yield_s: f64,
    /// Ask move_base to clear its costmaps when a goal failed.
    pub clear_costmaps: bool,
}

/// The values as they are now; clones are the same.
#[derive(Clone, Debug)]
pub struct Tuning(Arc<Mutex<Tuned>>);

impl Tuning {
    /// Begins with these values.
    #[must_use]
    pub fn new(tuned: Tuned) -> Self {
        Self(Arc::new(Mutex::new(tuned)))
    }

    /// As they are.
    #[must_use]
    pub fn now(&self) -> Tuned {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Exchanges them.
    pub fn set(&self, tuned: Tuned) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = tuned;
    }
}
