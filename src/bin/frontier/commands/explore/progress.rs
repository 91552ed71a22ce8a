//! The progress of a run: a bar in a terminal, plain lines elsewhere.

use frontier_explorer::explore::{Decision, Explorer, Watcher};
use frontier_explorer::robot::Observation;
use frontier_explorer::sim::{SimRobot, SimStats};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::{IsTerminal, Write};
use std::time::{Duration, Instant};

/// Parts of the bar: coverage is shown to a tenth of a percent.
const STEPS: u64 = 1000;

/// From one plain line to the next, seconds of real time.
const LINE_PERIOD: Duration = Duration::from_secs(2);

/// Shows how far a run is, on standard error.
pub enum Progress {
    /// Nothing is shown.
    Quiet,
    /// A bar that is redrawn in place.
    Bar(ProgressBar),
    /// A line now and then.
    Lines {
        /// When the last one was written.
        last: Option<Instant>,
    },
}

impl Progress {
    /// Chooses by what standard error is.
    pub fn new(quiet: bool, world: &str, preset: &str) -> Self {
        if quiet {
            return Self::Quiet;
        }
        if !std::io::stderr().is_terminal() {
            return Self::Lines { last: None };
        }
        let style = ProgressStyle::with_template("{prefix} [{bar:30}] {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar())
            .progress_chars("=> ");
        let bar = ProgressBar::new(STEPS).with_style(style).with_prefix(format!("{world}, {preset}"));
        Self::Bar(bar)
    }

    /// Shows the state of the run.
    fn show(&mut self, stats: &SimStats) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                bar.set_position((stats.coverage * STEPS as f64) as u64);
                bar.set_message(line(stats));
            }
            Self::Lines { last } => {
                if last.is_none_or(|at| at.elapsed() >= LINE_PERIOD) {
                    *last = Some(Instant::now());
                    // A closed stderr is no reason to stop exploring.
                    let _ = writeln!(std::io::stderr(), "{}", line(stats));
                }
            }
        }
    }

    /// Tells what happened, above the bar.
    fn tell(&self, time_s: f64, text: &str) {
        let line = format!("at {time_s:.0} s: {text}");
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.println(line),
            Self::Lines { .. } => {
                let _ = writeln!(std::io::stderr(), "{line}");
            }
        }
    }

    /// Takes the bar away, or writes the last line.
    pub fn finish(&mut self, stats: &SimStats) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.finish_and_clear(),
            Self::Lines { last } => {
                *last = None;
                self.show(stats);
            }
        }
    }
}

impl Watcher<SimRobot> for Progress {
    fn after_step(&mut self, sim: &SimRobot, _: &Explorer, observation: &Observation, decision: &Decision) {
        if let Some(text) = &decision.notice {
            self.tell(observation.stamp_s, text);
        }
        self.show(&sim.stats());
    }
}

fn line(stats: &SimStats) -> String {
    format!(
        "{:5.1} % explored, {:.0} m2 known, {:.1} m driven, {:.0} s simulated",
        100.0 * stats.coverage,
        stats.known_area_m2,
        stats.distance_m,
        stats.sim_time_s
    )
}
