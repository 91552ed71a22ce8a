//! One text on what the exploration sees, chose and rejected, and why.

use crate::explore::{CandidateRecord, CandidateStatus, DecisionRecord};
use crate::ros::display::status_sentence;
use crate::ros::msg::frontier_explorer::ExplorationStatus;
use std::fmt::Write;

/// So many of the candidates that were not chosen are told one by one.
const TOLD: usize = 3;

/// Explains the last decision of an exploration, with what is wrong now.
#[must_use]
pub fn explain(status: &ExplorationStatus, last: Option<&DecisionRecord>, wrong: &[String]) -> String {
    let mut text = format!("preset {}: {}\n{}", status.preset, status.message, status_sentence(status));
    // Writing to a string does not fail.
    for trouble in wrong.iter().filter(|trouble| **trouble != status.message) {
        let _ = write!(text, "\nwrong now: {trouble}");
    }
    let Some(record) = last else {
        text.push_str("\nnothing has been decided so far");
        return text;
    };
    let _ = write!(text, "\nlast decision: {}", record.why);
    if let Some(goal) = &record.goal {
        let _ = write!(text, "\ngoal: ({:.2}, {:.2}) m", goal.x, goal.y);
    }
    let of = |status: CandidateStatus| record.candidates.iter().filter(move |c| c.status == status);
    for chosen in of(CandidateStatus::Chosen) {
        let _ = write!(text, "\nchosen: {}", candidate(chosen));
    }
    let others: Vec<_> = of(CandidateStatus::Eligible).collect();
    for other in others.iter().take(TOLD) {
        let _ = write!(text, "\npossible, and comes later: {}", candidate(other));
    }
    if others.len() > TOLD {
        let _ = write!(text, "\nand {} more that come later", others.len() - TOLD);
    }
    for (status, why) in [
        (CandidateStatus::Taboo, "failed or seen in vain, left alone for now"),
        (CandidateStatus::NoPath, "no path to it"),
        (CandidateStatus::Unreachable, "no place to stand near it that the robot can get to"),
        (CandidateStatus::TooNarrow, "too narrow for the robot"),
        (CandidateStatus::OutsideRegion, "outside the region"),
        (CandidateStatus::AlreadyThere, "the robot stands where it is seen from"),
    ] {
        let rejected: Vec<_> = of(status).collect();
        for one in rejected.iter().take(TOLD) {
            let _ = write!(text, "\nrejected: {}: {why}", candidate(one));
        }
        if rejected.len() > TOLD {
            let _ = write!(text, "\nand {} more: {why}", rejected.len() - TOLD);
        }
    }
    text
}

/// A frontier in a few words.
fn candidate(one: &CandidateRecord) -> String {
    let mut text = format!(
        "frontier {} at ({:.2}, {:.2}) m, {:.1} m long, {:.1} m away",
        one.id, one.target.x, one.target.y, one.size_m, one.distance_m
    );
    if let Some(path_m) = one.path_m {
        let _ = write!(text, " ({path_m:.1} m by way)");
    }
    let parts: Vec<String> = one.scores.iter().map(|(name, value)| format!("{name} {value:.2}")).collect();
    if !parts.is_empty() {
        let _ = write!(text, ", {}", parts.join(", "));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explore::Position;
    use crate::geometry::Pose;

    fn frontier(id: u64, status: CandidateStatus) -> CandidateRecord {
        CandidateRecord {
            id,
            target: Position { x: id as f64, y: 0.5 },
            goal: None,
            size_cells: 20,
            size_m: 1.0,
            distance_m: 2.0,
            path_m: (status == CandidateStatus::Chosen).then_some(2.5),
            scores: [("total", 4.0)].into_iter().collect(),
            status,
        }
    }

    #[test]
    fn what_was_chosen_and_rejected_is_told_with_reasons() {
        let status = ExplorationStatus { preset: "tour".to_owned(), ..ExplorationStatus::default() };
        let nothing = explain(&status, None, &["no map".to_owned()]);
        assert!(nothing.ends_with("wrong now: no map\nnothing has been decided so far"), "{nothing}");
        let mut candidates = vec![frontier(1, CandidateStatus::Chosen)];
        candidates.extend((2..7).map(|id| frontier(id, CandidateStatus::Eligible)));
        candidates.push(frontier(9, CandidateStatus::TooNarrow));
        let record = DecisionRecord {
            time_s: 1.0,
            pose: Pose::new(0.0, 0.0, 0.0),
            goal: Some(Pose::new(0.8, 0.5, 0.0)),
            candidates,
            why: "tour: best of 7".to_owned(),
        };
        let text = explain(&status, Some(&record), &[]);
        for line in [
            "last decision: tour: best of 7",
            "chosen: frontier 1 at (1.00, 0.50) m, 1.0 m long, 2.0 m away (2.5 m by way), total 4.00",
            "possible, and comes later: frontier 4 at",
            "and 2 more that come later",
            "rejected: frontier 9 at (9.00, 0.50) m, 1.0 m long, 2.0 m away, total 4.00: too narrow for the robot",
        ] {
            assert!(text.contains(line), "{line:?} is not in:\n{text}");
        }
    }
}
