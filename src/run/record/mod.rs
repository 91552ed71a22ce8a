//! What is recorded of a run: its trail, `run.json` and the folder with all results, and bags.

mod bag_file;
mod error;
mod out_bag;
mod outcome;
mod replay_recorder;
mod run_folder;
mod sim_bag;
mod sim_recorder;
mod trail;

pub use error::RecordError;
pub use out_bag::OutBag;
pub use replay_recorder::ReplayRecorder;
pub use run_folder::RunFolder;
pub use sim_bag::SimBag;
pub use sim_recorder::SimRecorder;
pub(crate) use trail::Trail;
