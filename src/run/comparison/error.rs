//! Why runs cannot be compared.

use super::StartsError;
use crate::io::MapError;
use crate::report::ReportError;
use crate::run::PlanError;

/// Runs that cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum CompareError {
    /// The file of a world cannot be read.
    #[error(transparent)]
    File(#[from] MapError),
    /// There are no starts in a world.
    #[error("world {world}: {source}")]
    Starts {
        /// The world's name.
        world: String,
        /// Why there are none.
        source: StartsError,
    },
    /// Two have the same name: tables could not tell them apart.
    #[error("there are two {what}s with the name {name:?}: each must have its own")]
    NameTwice {
        /// What has a name.
        what: &'static str,
        /// The name.
        name: String,
    },
    /// A seed that would make each run twice.
    #[error("the seed {0} is given twice: each must be another one")]
    SeedTwice(u64),
    /// A preset cannot be written.
    #[error("cannot write the preset as JSON: {0}")]
    Settings(#[from] serde_json::Error),
    /// The picture of a world cannot be made.
    #[error(transparent)]
    Picture(#[from] ReportError),
    /// A run that names a preset, a world or a start that is not there.
    #[error("run {0} is not in the plan")]
    NotPlanned(usize),
    /// A run cannot begin, or not where it is to.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The system gives no threads.
    #[error("cannot start threads for the runs: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
}
