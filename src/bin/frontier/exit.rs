//! The one place that turns outcomes into exit codes.

use std::process::ExitCode;

/// How a command ended when it did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// All that was asked for was done: exit code 0.
    Done,
    /// Ended early with what there was saved: exit code 3.
    Incomplete,
    /// A comparison found differences: exit code 1, as `diff` has it.
    Differs,
}

/// 0 done, 1 failed or different, 2 usage (clap's own), 3 finished but incomplete.
pub fn code(result: anyhow::Result<Outcome>) -> ExitCode {
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Differs) => ExitCode::from(1),
        Ok(Outcome::Incomplete) => ExitCode::from(3),
        Err(error) => {
            // A closed stderr is no reason to panic while reporting.
            let _ = std::io::Write::write_all(&mut std::io::stderr(), format!("frontier: {error:#}\n").as_bytes());
            ExitCode::FAILURE
        }
    }
}
