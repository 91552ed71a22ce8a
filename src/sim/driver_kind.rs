//! The names of those who can drive the simulated robot to its goals.

use super::SlamKind;
use serde::{Deserialize, Serialize};

/// Which of the two drives.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DriverKind {
    /// Our own navigator, which knows no refusal but where there is no way: kind.
    #[default]
    Navigator,
    /// A stand-in for move_base that fails as the real one does.
    MoveBase,
}

impl DriverKind {
    /// Who drives where only the SLAM is chosen: a SLAM that errs goes with a move_base that
    /// fails.
    #[must_use]
    pub const fn beside(slam: SlamKind) -> Self {
        match slam {
            SlamKind::Perfect => Self::Navigator,
            SlamKind::Matched => Self::MoveBase,
        }
    }

    /// Its name in settings.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Navigator => "navigator",
            Self::MoveBase => "move_base",
        }
    }
}
