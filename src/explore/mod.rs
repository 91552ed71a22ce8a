//! The explorer: a pure state machine from observations to decisions (floor 2).

mod assess;
mod audit;
mod behind;
mod blacklist;
mod decided;
mod explorer;
mod ledger;
mod lookout;
mod map_watch;
mod opening;
mod progress_monitor;
mod record;
mod run;
mod settings;
mod sight;
mod stages;
mod standing;
mod state;
mod traits;
mod trouble;

pub use crate::geometry::Areas;
pub use blacklist::{Blacklist, Blacklisted, Failure, Forgiven, Taboo, TabooConfig};
pub use explorer::{Explorer, Memory};
pub use ledger::TimeSpent;
pub use record::{
    CandidateRecord, CandidateStatus, Counts, DecisionRecord, End, EndReason, LeftBehind, Position, SeenFrontiers,
};
pub use run::{STOPPED, Watcher, run};
pub use settings::{
    DetectorSettings, ExplorerSettings, FinishSettings, GoalSettings, PatienceSettings, SettingsError, TurnSettings,
};
pub use standing::GoalHeading;
pub use state::{Decision, Phase};
pub use traits::RobotTraits;
