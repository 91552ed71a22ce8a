//! What a decision found: a goal, what is left behind and why, and what that means for the end.

use super::assess::Assessed;
use super::blacklist::Taboo;
use super::record::{CandidateRecord, CandidateStatus, DecisionRecord, EndReason, LeftBehind, SeenFrontiers};
use crate::geometry::{Point, Pose};
use crate::selection::TOUR_M;

/// Where to go, when there is somewhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choice {
    /// Where the robot shall stand.
    pub goal: Pose,
    /// The frontier's representative point, or the cell to be seen.
    pub target: Point,
    /// Whether the goal is only a place on the way there.
    pub is_stage: bool,
    /// Whether it lies beside the way to a better one and comes first for that.
    pub is_beside: bool,
}

/// What one decision found.
#[derive(Clone, Debug)]
pub struct Decided {
    /// For the log.
    pub record: DecisionRecord,
    /// The goal, if there is one.
    pub choice: Option<Choice>,
    /// The target that is seen from where the robot stands, when only such are left.
    pub here: Option<Point>,
    /// What is left, by the reason for leaving it.
    pub left_behind: LeftBehind,
    /// What the audit found besides, where there was nothing to choose.
    pub audit: Option<Audited>,
}

/// What the check before an end found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Audited {
    /// Frontiers that the robot could be sent to, and the preset's rules forbid it.
    pub forbidden: usize,
    /// Their length in all, metres.
    pub forbidden_m: f64,
    /// Frontiers that the bare body could get to, and with its padding and room to turn it
    /// cannot.
    pub barred: usize,
    /// Whether the robot stands in a pocket: a place too small to be one of its own.
    pub in_pocket: bool,
    /// Frontiers to which ways lead that the areas forbid, and no others.
    pub fenced_off: usize,
    /// Whether there are no-go areas.
    pub has_no_go: bool,
    /// Whether the robot stands outside of its areas and no known way leads in; and then whether it
    /// stands in a no-go area, or beside one.
    pub locked_out: Option<bool>,
}

impl Audited {
    /// What the areas forbid, to be added to a sentence.
    pub fn forbidden_by_areas(&self) -> Option<String> {
        let fenced_off = || (self.fenced_off > 0).then(|| format!("{} beyond what the areas forbid", self.fenced_off));
        let parts = [self.locked_out.map(|no_go| no_way(no_go).to_owned()), fenced_off()];
        let parts: Vec<String> = parts.into_iter().flatten().collect();
        (!parts.is_empty()).then(|| format!("; {}", parts.join("; ")))
    }
}

const fn no_way(no_go: bool) -> &'static str {
    if no_go {
        "the robot stands in a no-go area, or beside one, and no known way leads out"
    } else {
        "the robot stands outside of its region, and no known way leads in"
    }
}

impl Decided {
    /// Whether the robot could still be sent to a frontier near a point.
    pub fn is_open_near(&self, target: Point, radius_m: f64) -> bool {
        let is_open = |status| matches!(status, CandidateStatus::Chosen | CandidateStatus::Eligible);
        self.near(target, radius_m).any(|(_, c)| is_open(c.status))
    }

    /// The target and the place of a frontier near a point that is best seen from where the
    /// robot stands.
    pub fn seen_from_here(&self, target: Point, radius_m: f64) -> Option<(Point, Point)> {
        let mut here = self.near(target, radius_m).filter(|(_, c)| c.status == CandidateStatus::AlreadyThere);
        here.find_map(|(seen, c)| Some((seen, c.goal?.position())))
    }

    /// Whether a frontier with its target or a cell near a point is one to which no way leads:
    /// where the way closes, another cell may stand for it at once.
    pub fn is_barred_near(&self, point: Point, radius_m: f64, seen: &SeenFrontiers) -> bool {
        let is_near = |other: Point| nalgebra::distance(&point, &other) <= radius_m;
        let is_barred =
            |c: &&CandidateRecord| matches!(c.status, CandidateStatus::NoPath | CandidateStatus::Unreachable);
        self.record
            .candidates
            .iter()
            .filter(is_barred)
            .any(|c| is_near(Point::new(c.target.x, c.target.y)) || seen.cells_of(c.id).any(is_near))
    }

    /// The candidates near a point, with their targets.
    fn near(&self, point: Point, radius_m: f64) -> impl Iterator<Item = (Point, &CandidateRecord)> {
        let with_target = self.record.candidates.iter().map(|c| (Point::new(c.target.x, c.target.y), c));
        with_target.filter(move |(target, _)| nalgebra::distance(&point, target) <= radius_m)
    }

    /// Why a run ends for which nothing is left to choose. `is_wedged`: the robot has not
    /// got away from where it is for long.
    pub fn why_nothing_is_left(&self, is_wedged: bool) -> (EndReason, String) {
        let left = &self.left_behind;
        let audit = self.audit.unwrap_or_default();
        let behind = format!("{:.1} m of frontier, {:.1} m2 or more behind it", left.length_m, left.area_m2);
        let blocked = left.failed + audit.barred;
        if (left.unreachable > 0 && audit.in_pocket) || (left.failed > 0 && is_wedged) {
            let message = format!(
                "the robot does not get away from where it is, and {} frontiers are left: {behind}",
                left.frontiers
            );
            (EndReason::Stuck, message)
        } else if blocked > 0 {
            let message = format!(
                "{blocked} of {} frontiers cannot be reached ({} where driving failed, {} by ways too tight for the \
                 robot): {behind}",
                left.frontiers, left.failed, audit.barred
            );
            (EndReason::AllUnreachable, message)
        } else if audit.forbidden > 0 {
            let message = format!(
                "the preset sees no more, and the map has {} frontiers of {:.1} m that can be reached",
                audit.forbidden, audit.forbidden_m
            );
            (EndReason::PresetSeesNoMore, message)
        } else if let Some(no_go) = audit.locked_out {
            (EndReason::AllUnreachable, format!("{}: {behind}", no_way(no_go)))
        } else if audit.fenced_off > 0 {
            let message = format!(
                "all frontiers left lie outside the region or in no-go areas ({}), or beyond what these forbid ({}): \
                 {behind}",
                left.outside_region, audit.fenced_off
            );
            (EndReason::OutsideRegion, message)
        } else if left.outside_region > 0 {
            let no_go = if audit.has_no_go { " or in no-go areas" } else { "" };
            let message = format!("all {} frontiers left lie outside the region{no_go}", left.outside_region);
            (EndReason::OutsideRegion, message)
        } else if left.frontiers == 0 {
            (EndReason::Complete, "no frontier is left".to_owned())
        } else {
            let message = format!(
                "no frontier is left that the robot could get to and see more of ({} seen in vain, {} behind openings \
                 too narrow for the robot or hidden from as near as it gets: {behind})",
                left.exhausted,
                left.too_narrow + left.unreachable
            );
            (EndReason::Complete, message)
        }
    }
}

/// What is left, by the reason for leaving it.
pub fn count(assessed: &[Assessed]) -> LeftBehind {
    let mut left = LeftBehind { frontiers: assessed.len(), ..LeftBehind::default() };
    for a in assessed {
        if a.record.status != CandidateStatus::OutsideRegion {
            left.length_m += a.record.size_m;
        }
        match (a.record.status, a.taboo) {
            (CandidateStatus::OutsideRegion, _) => left.outside_region += 1,
            (CandidateStatus::TooNarrow, _) => left.too_narrow += 1,
            (CandidateStatus::Unreachable, _) => left.unreachable += 1,
            (CandidateStatus::Taboo, Some(Taboo::Exhausted)) => left.exhausted += 1,
            (CandidateStatus::Taboo | CandidateStatus::NoPath, _) => left.failed += 1,
            (CandidateStatus::Chosen | CandidateStatus::Eligible | CandidateStatus::AlreadyThere, _) => {}
        }
    }
    left
}

/// How the chosen one compares with the next best beginning, where the strategy plans tours.
fn runner_up(assessed: &[Assessed]) -> Option<String> {
    let tour_m = |a: &Assessed| a.record.scores.get(TOUR_M).copied();
    let (chosen, others): (Vec<&Assessed>, Vec<&Assessed>) =
        assessed.iter().partition(|a| a.record.status == CandidateStatus::Chosen);
    let length_m = tour_m(chosen.first()?)?;
    let others = others.into_iter().filter_map(|a| Some((tour_m(a)?, a.target)));
    let Some((other_m, begin)) = others.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return Some(format!(", a way of {length_m:.1} m"));
    };
    let (by_m, word) = ((other_m - length_m).abs(), if other_m < length_m { "more" } else { "less" });
    let begin = format!("to begin at ({:.2}, {:.2}) m", begin.x, begin.y);
    Some(format!(", a tour of {length_m:.1} m, {by_m:.1} m {word} than {begin}"))
}

/// One sentence about the decision.
pub fn explain(assessed: &[Assessed], choice: Option<&Choice>, strategy: &str, left: &LeftBehind) -> String {
    let skipped = assessed.iter().filter(|a| a.record.status == CandidateStatus::NoPath).count();
    match choice {
        Some(choice) if choice.is_beside => format!(
            "at ({:.2}, {:.2}) m, beside the way to the best of {} frontiers by {strategy}",
            choice.target.x, choice.target.y, left.frontiers
        ),
        Some(choice) => {
            let passed_over = if skipped > 0 { format!(", {skipped} before it had no path") } else { String::new() };
            let part = if choice.is_stage { ": the planner gave up, part of the way" } else { "" };
            let tours = runner_up(assessed).unwrap_or_default();
            format!(
                "{strategy}: best of {} frontiers, at ({:.2}, {:.2}) m{tours}{passed_over}{part}",
                left.frontiers, choice.target.x, choice.target.y
            )
        }
        None => format!(
            "no goal among {} frontiers: {} unreachable, {} failed, {} seen in vain, {} too narrow, {} outside the region",
            left.frontiers, left.unreachable, left.failed, left.exhausted, left.too_narrow, left.outside_region
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assessed(status: CandidateStatus, x: f64, tour_m: Option<f64>) -> Assessed {
        let target = Point::new(x, 0.0);
        let record = CandidateRecord {
            id: x as u64,
            target: target.into(),
            goal: None,
            size_cells: 1,
            size_m: 1.0,
            distance_m: x,
            path_m: None,
            scores: tour_m.map(|tour_m| (TOUR_M, tour_m)).into_iter().collect(),
            status,
        };
        Assessed { record, target, candidate: None, taboo: None, spent_m: None, total: 0.0 }
    }

    #[test]
    fn a_tour_is_told_beside_its_runner_up() {
        let (chosen, other) = (CandidateStatus::Chosen, CandidateStatus::Eligible);
        let told = |all: &[Assessed]| runner_up(all).unwrap_or_default();
        let mut all = vec![assessed(chosen, 1.0, Some(20.0)), assessed(other, 2.0, Some(26.0))];
        assert_eq!(told(&all), ", a tour of 20.0 m, 6.0 m less than to begin at (2.00, 0.00) m");
        // The one under way stays though another tour is a little shorter.
        all.push(assessed(other, 3.0, Some(18.5)));
        assert_eq!(told(&all), ", a tour of 20.0 m, 1.5 m more than to begin at (3.00, 0.00) m");
        assert_eq!(told(&all[..1]), ", a way of 20.0 m");
        assert_eq!(told(&[assessed(chosen, 1.0, None), assessed(other, 2.0, None)]), "");
    }
}
