//! The explorer: a pure state machine from observations to decisions (floor 2).

mod assess;
mod blacklist;
mod decide;
mod explorer;
mod progress;
mod record;
mod run;
mod settings;
mod stages;
mod standing;
mod state;

pub use blacklist::{Blacklist, Taboo, TabooConfig};
pub use explorer::Explorer;
pub use record::{
    CandidateRecord, CandidateStatus, Counts, DecisionRecord, End, EndReason, LeftBehind, Position, SeenFrontier,
};
pub use run::{Watcher, run};
pub use settings::{DetectorSettings, ExplorerSettings, GoalSettings, PatienceSettings, SettingsError, TurnSettings};
pub use standing::GoalHeading;
pub use state::{Decision, Phase};
