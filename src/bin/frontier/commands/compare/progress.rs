//! How many runs are done: a bar in a terminal, a line for each run elsewhere.

use frontier_explorer::report::ComparedRun;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Shows progress on standard error; runs of several threads report to it.
pub struct Progress {
    shown: Shown,
    all: usize,
    done: AtomicUsize,
}

enum Shown {
    Quiet,
    Bar(ProgressBar),
    Lines,
}

impl Progress {
    /// Chooses by what standard error is.
    pub fn new(quiet: bool, all: usize) -> Self {
        let shown = if quiet {
            Shown::Quiet
        } else if std::io::stderr().is_terminal() {
            let style = ProgressStyle::with_template("{pos}/{len} runs [{bar:30}] {elapsed}, {eta} left; {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_bar())
                .progress_chars("=> ");
            let bar = ProgressBar::new(all as u64).with_style(style);
            bar.enable_steady_tick(Duration::from_millis(500));
            Shown::Bar(bar)
        } else {
            Shown::Lines
        };
        Self { shown, all, done: AtomicUsize::new(0) }
    }

    /// Takes note of a run that has been made.
    pub fn made(&self, run: &ComparedRun) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        let text = format!(
            "{} in {} from {} with seed {}: {}, {:.1} % after {:.0} s",
            run.preset,
            run.world,
            run.start_number,
            run.seed,
            run.end_name().replace('_', " "),
            100.0 * run.coverage,
            run.sim_time_s
        );
        match &self.shown {
            Shown::Quiet => {}
            Shown::Bar(bar) => {
                bar.set_position(done as u64);
                bar.set_message(text);
            }
            Shown::Lines => {
                // A closed stderr is no reason to stop.
                let _ = writeln!(std::io::stderr(), "{done}/{} {text}", self.all);
            }
        }
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}
