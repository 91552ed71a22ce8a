//! The numbers of a run as its page says them: headline, figures, milestones, where the time
//! went.

use super::beside::Beside;
use super::run_json::RunRecord;
use super::series::COVERAGE_SHARES;
use crate::explore::Counts;
use serde::Serialize;

/// A figure on the page.
#[derive(Serialize)]
pub(super) struct Figure {
    /// What it is.
    name: &'static str,
    /// How much, with its unit.
    value: String,
}

/// Why it ended and what it came to, in a sentence or two.
pub(super) fn headline<D>(run: &RunRecord<D>) -> String {
    // A recording has no seed, and nobody knows how large its world was.
    if is_recording(run) {
        let (area_m2, time) = (run.known_area_m2, clock(run.sim_time_s));
        return format!("{}; {area_m2:.1} m² were mapped in {time} and {:.1} m.", run.end_message, run.distance_m);
    }
    format!(
        "{}; {:.1} % of the world was covered in {} and {:.1} m.",
        run.end_message,
        run.coverage * 100.0,
        clock(run.sim_time_s),
        run.distance_m
    )
}

/// Whether the run is a replay of a recording: nobody drew its random numbers.
pub(super) const fn is_recording<D>(run: &RunRecord<D>) -> bool {
    run.seed.is_none()
}

/// The figures at the top of the page of a recording: what it shows, and how far we agree.
pub(super) fn recorded_figures<D>(run: &RunRecord<D>, beside: Option<&Beside>) -> Vec<Figure> {
    let figure = |name, value| Figure { name, value };
    let mut figures = vec![
        figure("time", clock(run.sim_time_s)),
        figure("distance", format!("{:.1} m", run.distance_m)),
        figure("turned", format!("{:.1} turns", run.turned_rad / std::f64::consts::TAU)),
        figure("area mapped", format!("{:.1} m²", run.known_area_m2)),
        figure("our decisions", run.decisions.len().to_string()),
        figure("frontiers left", run.left_behind.frontiers.to_string()),
    ];
    if let Some(beside) = beside {
        figures.push(figure("recorded goals", beside.recorded_goals.to_string()));
        figures
            .push(figure("at frontiers that we saw", format!("{} of {}", beside.at_frontiers, beside.recorded_goals)));
        figures.push(figure("agreement", format!("{} of {}", beside.agreeing, beside.decisions)));
    }
    figures
}

/// The figures at the top of the page.
pub(super) fn figures<D>(run: &RunRecord<D>) -> Vec<Figure> {
    let figure = |name, value| Figure { name, value };
    vec![
        figure("coverage", format!("{:.1} %", run.coverage * 100.0)),
        figure("time", clock(run.sim_time_s)),
        figure("distance", format!("{:.1} m", run.distance_m)),
        figure("turned", format!("{:.1} turns", run.turned_rad / std::f64::consts::TAU)),
        figure("goals reached", format!("{} of {}", run.counts.goals_reached, run.goals_sent)),
        figure("seen or replaced on the way", on_the_way(&run.counts).to_string()),
        figure("goals failed", run.goals_failed.to_string()),
        figure("area mapped", format!("{:.1} m²", run.known_area_m2)),
        figure("frontiers left", run.left_behind.frontiers.to_string()),
        figure("collisions", run.collisions.to_string()),
    ]
}

/// Goals that were neither reached nor failed: their frontiers were seen before the robot was
/// there, or another goal was better by then.
const fn on_the_way(counts: &Counts) -> usize {
    counts.goals_sent.saturating_sub(counts.goals_reached + counts.goals_failed)
}

/// Where the time went: what for, how long, and its share.
pub(super) fn time_spent<D>(run: &RunRecord<D>) -> Vec<[String; 3]> {
    let spent = &run.time_spent;
    let total_s = spent.total_s().max(f64::MIN_POSITIVE);
    [
        ("driving", spent.driving_s),
        ("turning on the spot", spent.turning_s),
        ("standing until a map came", spent.waiting_for_map_s),
        ("standing though a goal was under way", spent.waiting_for_motion_s),
        ("standing for want of navigation", spent.waiting_for_navigation_s),
        ("standing for want of a pose", spent.waiting_for_pose_s),
        ("resting before another attempt", spent.pausing_s),
    ]
    .into_iter()
    .filter(|(_, seconds)| *seconds > 0.0)
    .map(|(name, seconds)| [name.to_owned(), clock(seconds), format!("{:.1} %", 100.0 * seconds / total_s)])
    .collect()
}

/// When each share of coverage was reached: share, time, distance.
pub(super) fn milestones<D>(run: &RunRecord<D>) -> Vec<[String; 3]> {
    let row = |(name, share): (&str, f64)| {
        let time_s = run.time_to_coverage_s.get(name).copied().flatten();
        let distance_m = run.distance_to_coverage_m.get(name).copied().flatten();
        [
            format!("{:.0} %", share * 100.0),
            time_s.map_or_else(|| "not reached".to_owned(), clock),
            distance_m.map_or_else(|| "–".to_owned(), |distance_m| format!("{distance_m:.1} m")),
        ]
    };
    COVERAGE_SHARES.into_iter().map(row).collect()
}

/// Seconds as a person says them.
pub(super) fn clock(time_s: f64) -> String {
    if time_s < 59.95 {
        return format!("{time_s:.1} s");
    }
    let whole = time_s.round() as u64;
    let (hours, minutes, seconds) = (whole / 3600, whole / 60 % 60, whole % 60);
    if hours > 0 { format!("{hours} h {minutes} min {seconds} s") } else { format!("{minutes} min {seconds} s") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clocks() {
        for (time_s, expected) in
            [(0.0, "0.0 s"), (59.94, "59.9 s"), (59.96, "1 min 0 s"), (312.4, "5 min 12 s"), (3661.0, "1 h 1 min 1 s")]
        {
            assert_eq!(clock(time_s), expected);
        }
    }
}
