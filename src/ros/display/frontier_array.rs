//! A decision as `frontier_explorer/FrontierArray`.

use super::super::convert::{header, point_message, pose_message};
use super::super::msg::frontier_explorer::{Frontier, FrontierArray};
use crate::explore::{CandidateRecord, CandidateStatus, DecisionRecord};

/// The message of a decision.
#[must_use]
pub fn frontier_array(record: &DecisionRecord, frame: &str, stamp_s: f64) -> FrontierArray {
    let mut rank = 0;
    let frontiers = record.candidates.iter().map(|candidate| frontier(candidate, &mut rank)).collect();
    FrontierArray {
        header: header(frame, stamp_s),
        robot: pose_message(&record.pose),
        why: record.why.clone(),
        frontiers,
    }
}

fn frontier(candidate: &CandidateRecord, rank: &mut u32) -> Frontier {
    let is_ranked = matches!(candidate.status, CandidateStatus::Chosen | CandidateStatus::Eligible);
    if is_ranked {
        *rank += 1;
    }
    Frontier {
        id: candidate.id,
        status: number(candidate.status),
        rank: if is_ranked { *rank } else { 0 },
        target: point_message(candidate.target.x, candidate.target.y),
        has_goal: candidate.goal.is_some(),
        goal: pose_message(&candidate.goal.unwrap_or_default()),
        size_cells: u32::try_from(candidate.size_cells).unwrap_or(u32::MAX),
        size_m: candidate.size_m,
        distance_m: candidate.distance_m,
        path_m: candidate.path_m.unwrap_or(f64::NAN),
        score_names: candidate.scores.keys().map(|name| (*name).to_owned()).collect(),
        score_values: candidate.scores.values().copied().collect(),
    }
}

const fn number(status: CandidateStatus) -> u8 {
    match status {
        CandidateStatus::Chosen => Frontier::CHOSEN,
        CandidateStatus::Eligible => Frontier::ELIGIBLE,
        CandidateStatus::NoPath => Frontier::NO_PATH,
        CandidateStatus::Unreachable => Frontier::UNREACHABLE,
        CandidateStatus::Taboo => Frontier::TABOO,
        CandidateStatus::OutsideRegion => Frontier::OUTSIDE_REGION,
        CandidateStatus::TooNarrow => Frontier::TOO_NARROW,
        CandidateStatus::AlreadyThere => Frontier::ALREADY_THERE,
    }
}
