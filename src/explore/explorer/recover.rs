//! What is done when nothing works: get away from here, look round, rest, try again; and
//! when that is over.

use super::super::decided::Decided;
use super::super::record::{CandidateStatus, DecisionRecord, End, EndReason};
use super::super::state::{AfterTurn, State};
use super::Explorer;
use crate::geometry::{Point, Pose};
use std::f64::consts::TAU;

/// Backing off has worked when the robot came this far, metres.
const GOT_AWAY_M: f64 = 0.08;
/// Goals that failed from within this distance of a place where the robot was wedged are
/// not to blame, metres.
const WEDGED_M: f64 = 0.4;
/// Whatever is left: after so many times the time allowed for failing, the run ends.
const LAST_FACTOR: f64 = 3.0;

impl Explorer {
    /// Gets away from what stands too near.
    pub(super) fn back_off(&mut self, pose: Pose, now_s: f64) -> State {
        self.counts.back_offs += 1;
        State::BackingOff { id: self.next_id(), from: pose.position(), since_s: now_s }
    }

    /// A robot that got away was wedged, and what failed there is not to blame.
    pub(super) fn end_of_back_off(&mut self, pose: Pose, from: Point) {
        if pose.distance_to(from) >= GOT_AWAY_M && self.trouble.has_got_away() {
            self.blacklist.forgive_from(from, WEDGED_M);
        }
    }

    /// Ends a run in which everything has failed for too long, whatever is left to try.
    pub(super) fn gives_up(&mut self, now_s: f64) -> bool {
        let (lasts_s, limit_s) = (self.trouble.lasts_s(now_s), self.settings.patience.failing_s);
        let is_wedged = self.trouble.is_wedged();
        if !(is_wedged && lasts_s >= limit_s || lasts_s >= LAST_FACTOR * limit_s && limit_s > 0.0) {
            return false;
        }
        let (reason, what) = if is_wedged {
            (EndReason::Stuck, "the robot does not get away from where it is")
        } else {
            (EndReason::AllUnreachable, "no goal has been reached")
        };
        let message = format!(
            "{what}: every attempt failed for {lasts_s:.0} s, and {} frontiers are left",
            self.left_behind.frontiers
        );
        self.finish(reason, now_s, &message);
        true
    }

    /// Ends a run that goes on and on and sees nothing new: goals are reached or exchanged,
    /// and no frontier gives way.
    pub(super) fn end_without_news(&mut self, now_s: f64) {
        let no_news_s = self.trouble.no_news_for_s(now_s);
        let is_over = matches!(self.state, State::Ended(_) | State::Returning { .. });
        if no_news_s >= self.settings.patience.no_news_s && !is_over {
            let message = format!(
                "nothing new was seen for {no_news_s:.0} s, and {} frontiers are left",
                self.left_behind.frontiers
            );
            self.finish(EndReason::AllUnreachable, now_s, &message);
        }
    }

    /// Frontiers are left, and nothing leads to any of them: a recovery, or the end.
    pub(super) fn recover(&mut self, decided: &Decided, pose: Pose, now_s: f64, record: &mut DecisionRecord) {
        let left = &decided.left_behind;
        let audit = decided.audit.as_ref();
        let in_pocket = audit.is_some_and(|audit| audit.in_pocket);
        // Ways that are too tight stay so, and failures may be final: a look round is all
        // that can help there.
        let may_help_to_wait = left.failed > 0 && !self.settings.taboo.is_final;
        let in_time = self.trouble.lasts_s(now_s) < self.settings.patience.failing_s;
        let rest_s = self.trouble.next_round_s(&pose, now_s);
        // A planner that knows how the robot turns may find no way from here to anywhere.
        let no_way_out = decided.record.candidates.iter().any(|c| c.status == CandidateStatus::NoPath);
        if no_way_out && self.recoveries_in_a_row > 0 && self.trouble.may_back_off() {
            self.blacklist.forgive_failures();
            "frontiers remain and the planner finds no way out of here: back off".clone_into(&mut record.why);
            self.state = self.back_off(pose, now_s);
            return;
        }
        if self.recoveries_in_a_row < self.settings.turns.recoveries {
            self.recoveries_in_a_row += 1;
            self.counts.recoveries += 1;
            self.blacklist.forgive_failures();
            if in_pocket && self.trouble.may_back_off() {
                "frontiers remain and the robot stands in a pocket: back off".clone_into(&mut record.why);
                self.state = self.back_off(pose, now_s);
            } else {
                "frontiers remain and no way leads to them: recovery turn".clone_into(&mut record.why);
                self.turn(now_s, TAU, AfterTurn::Settle);
            }
            return;
        }
        if may_help_to_wait && in_time {
            self.blacklist.forgive_failures();
            record.why = format!("frontiers remain and each attempt has failed: trying again in {rest_s:.0} s");
            self.state = State::Pausing { until_s: now_s + rest_s };
            return;
        }
        let (reason, message) = decided.why_nothing_is_left(self.trouble.is_wedged());
        self.finish(reason, now_s, &message);
    }

    /// The run is over but for the way back, if that is wanted.
    pub(super) fn finish(&mut self, reason: EndReason, now_s: f64, message: &str) {
        let end = End { reason, time_s: now_s, left_behind: self.left_behind, message: message.to_owned() };
        self.state = match self.start_pose {
            // Not even home is driven to in a no-go area.
            Some(goal) if self.settings.return_to_start && !self.areas().is_in_no_go(goal.position()) => {
                return self.drive_home(goal, end, now_s, 0);
            }
            _ => State::Ended(end),
        };
    }
}
