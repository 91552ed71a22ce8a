//! Why a decision is not that of the recording.

use crate::explore::{CandidateRecord, CandidateStatus, DecisionRecord};
use crate::geometry::{Point, Pose};

/// A goal of the recording within this distance of a frontier was sent there, metres.
pub const AT_FRONTIER_M: f64 = 1.0;

/// Why we did not choose the goal of the recording, and the figures.
pub fn cause(record: &DecisionRecord, theirs: &Pose) -> (&'static str, String) {
    let distance_m = |candidate: &CandidateRecord| {
        let target = theirs.distance_to(Point::new(candidate.target.x, candidate.target.y));
        candidate.goal.map_or(target, |goal| target.min(theirs.distance_to(goal.position())))
    };
    let ranked = record.candidates.iter().zip(1..);
    let nearest = ranked.min_by(|(a, _), (b, _)| distance_m(a).total_cmp(&distance_m(b)));
    let Some((candidate, rank)) = nearest.filter(|(candidate, _)| distance_m(candidate) <= AT_FRONTIER_M) else {
        return ("no frontier of ours lies near its goal", String::new());
    };
    let total = |candidate: &CandidateRecord| candidate.scores.get("total").copied().unwrap_or(f64::NAN);
    let best = record.candidates.iter().find(|candidate| candidate.status == CandidateStatus::Chosen);
    let detail = match best {
        Some(best) if candidate.status == CandidateStatus::Eligible => {
            format!("our no. {rank}: {:.2} against {:.2}", total(candidate), total(best))
        }
        _ => String::new(),
    };
    let cause = match candidate.status {
        CandidateStatus::Chosen => "we go to the same frontier, but stand elsewhere",
        CandidateStatus::Eligible if record.goal.is_none() => "we looked round first",
        CandidateStatus::Eligible => "its frontier was not our best",
        CandidateStatus::NoPath => "we found no way to its frontier",
        CandidateStatus::Unreachable => "its frontier was unreachable to us",
        CandidateStatus::Taboo => "its frontier was taboo to us",
        CandidateStatus::OutsideRegion => "its frontier lies outside of our region",
        CandidateStatus::TooNarrow => "its frontier is too narrow for the robot",
        CandidateStatus::AlreadyThere => "its frontier lies where the robot stands",
    };
    (cause, detail)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::explore::Position;
    use std::collections::BTreeMap;

    fn candidate(x: f64, total: f64, status: CandidateStatus) -> CandidateRecord {
        CandidateRecord {
            id: 1,
            target: Position { x, y: 0.0 },
            goal: None,
            size_cells: 10,
            size_m: 0.5,
            distance_m: x,
            path_m: None,
            scores: BTreeMap::from([("total", total)]),
            status,
        }
    }

    #[test]
    fn the_nearest_candidate_tells_why() {
        let record = DecisionRecord {
            time_s: 1.0,
            pose: Pose::default(),
            candidates: vec![
                candidate(3.0, 0.25, CandidateStatus::Chosen),
                candidate(6.0, 0.5, CandidateStatus::Eligible),
                candidate(9.0, 0.75, CandidateStatus::Taboo),
            ],
            goal: Some(Pose::new(3.0, 0.0, 0.0)),
            why: String::new(),
        };
        let why = |x| cause(&record, &Pose::new(x, 0.0, 0.0));
        assert_eq!(why(3.8).0, "we go to the same frontier, but stand elsewhere");
        assert_eq!(why(6.1), ("its frontier was not our best", "our no. 2: 0.50 against 0.25".to_owned()));
        assert_eq!(why(9.1).0, "its frontier was taboo to us");
        assert_eq!(why(20.0).0, "no frontier of ours lies near its goal");
    }
}
