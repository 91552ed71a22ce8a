//! The one place that turns outcomes into exit codes.

use frontier_explorer::text::printable;
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
            let line = format!("frontier: {}\n", printable(&told_once(&error)));
            let _ = std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes());
            ExitCode::FAILURE
        }
    }
}

/// An error with its causes in one line: what a message says already of its own cause is not
/// said again.
fn told_once(error: &anyhow::Error) -> String {
    let mut told = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if told.is_empty() {
            told = cause;
        } else if !told.contains(&cause) {
            told = format!("{told}: {cause}");
        }
    }
    told
}

#[cfg(test)]
mod tests {
    use super::*;
    use anyhow::Context;

    #[test]
    fn a_cause_is_told_once() {
        let cause = std::io::Error::other("no such file");
        let error = anyhow::Error::new(cause).context("cannot read offce: no such file").context("a world");
        assert_eq!(told_once(&error), "a world: cannot read offce: no such file");
        let other: anyhow::Result<()> = Err(anyhow::anyhow!("disk full")).context("cannot write map.pgm");
        assert_eq!(told_once(&other.unwrap_err()), "cannot write map.pgm: disk full");
    }
}
