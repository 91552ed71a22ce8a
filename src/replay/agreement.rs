//! Whether our decisions are those of the recording, and where not, why.
//!
//! Each decision is made from where the recording was: when the two part, the explorer goes
//! on from the recording's goal as if it had chosen that ([`Explorer::adopt`]), so that one
//! parting is counted once and does not make all that follows another story.

use super::cause::{AT_FRONTIER_M, cause};
use super::goals::{RecordedGoal, RecordedGoals};
use super::robot::{LAG_S, SAME_M};
use crate::explore::{Decision, DecisionRecord, Explorer};
use crate::geometry::{Point, Pose};
use crate::robot::Observation;
use serde::Serialize;
use std::collections::BTreeMap;

/// A decision that the recording did not make, or one of the recording that we did not.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Parting {
    /// When, seconds since the bag's begin.
    pub time_s: f64,
    /// Where we would have gone.
    pub our_goal: Option<Pose>,
    /// Where the recording went.
    pub recorded_goal: Option<Pose>,
    /// When it was sent there, seconds since the bag's begin.
    pub recorded_at_s: Option<f64>,
    /// Why we decided so.
    pub why: String,
    /// Why the recording's goal was not ours, as far as can be told.
    pub cause: String,
    /// The figures behind the cause; empty where there are none.
    pub detail: String,
}

impl Parting {
    /// The cause with the figures behind it.
    #[must_use]
    pub fn full_cause(&self) -> String {
        let Self { cause, detail, .. } = self;
        if detail.is_empty() { cause.clone() } else { format!("{cause} ({detail})") }
    }
}

/// A goal of the recording, and what we saw there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RecordedSight {
    /// The goal.
    #[serde(flatten)]
    pub goal: RecordedGoal,
    /// From there to the nearest frontier of our last detection, metres.
    pub frontier_m: Option<f64>,
}

/// A decision of ours whose fellow is waited for.
#[derive(Clone, Debug)]
struct Pending {
    record: DecisionRecord,
    /// The recording was on its way there when it was decided, or on no way.
    recorded: Option<RecordedGoal>,
}

/// The comparison under way.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Agreement {
    /// Decisions that could be compared.
    pub decisions: usize,
    /// Of those, the ones that agree.
    pub agreeing: usize,
    /// The others.
    pub partings: Vec<Parting>,
    /// How many there are of each cause.
    pub causes: BTreeMap<String, usize>,
    /// The goals of the recording.
    pub recorded_goals: Vec<RecordedSight>,
    #[serde(skip)]
    pending: Option<Pending>,
    /// Since when our goal is none of the recording's, seconds.
    #[serde(skip)]
    apart_since_s: Option<f64>,
    #[serde(skip)]
    last: Option<DecisionRecord>,
    /// When maps came, and their stamps.
    #[serde(skip)]
    maps: Vec<(f64, f64)>,
}

impl Agreement {
    /// To be called before a step: lets the explorer follow the recording where the two
    /// have parted.
    pub fn before_step(&mut self, goals: &RecordedGoals, explorer: &mut Explorer, observation: &Observation) {
        let now_s = observation.stamp_s;
        if let Some(map) = &observation.map
            && self.maps.last().is_none_or(|&(_, stamp_s)| stamp_s != map.stamp_s)
        {
            self.maps.push((now_s, map.stamp_s));
        }
        self.see(goals, explorer);
        self.settle(goals, now_s);
        let theirs = goals.in_force();
        let is_apart = theirs.is_some_and(|theirs| !explorer.goal().is_some_and(|ours| is_same(&ours, theirs)));
        if !is_apart {
            self.apart_since_s = None;
            return;
        }
        let since_s = *self.apart_since_s.get_or_insert(now_s);
        if let (Some(theirs), true) = (theirs, now_s - since_s > LAG_S) {
            if let Some(pending) = self.pending.take() {
                self.judge(&pending, goals, now_s);
            }
            // Unless a decision of ours was weighed against it, it decided without us.
            let is_known = self.partings.last().is_some_and(|parting| parting.time_s >= theirs.time_s - LAG_S);
            if !is_known {
                let (ours, last) = (explorer.goal(), self.last.take());
                self.part(theirs.time_s, ours, Some(theirs), last.as_ref(), "it decided anew, and we did not");
                self.last = last;
            }
            explorer.adopt(theirs.goal_in_map, observation);
            self.apart_since_s = None;
        }
    }

    /// To be called after a step: takes a decision down.
    pub fn after_step(&mut self, goals: &RecordedGoals, decision: &Decision, now_s: f64) {
        let Some(record) = &decision.record else { return };
        if goals.all().is_empty() {
            return;
        }
        if let Some(pending) = self.pending.take() {
            self.judge(&pending, goals, now_s);
        }
        let recorded = goals.in_force().cloned();
        self.pending = Some(Pending { record: record.clone(), recorded });
        self.last = Some(record.clone());
    }

    /// To be called at the end: judges the last decision, and takes down how the recording's
    /// goals ended.
    pub fn finish(&mut self, goals: &RecordedGoals, now_s: f64) {
        if let Some(pending) = self.pending.take() {
            self.judge(&pending, goals, now_s);
        }
        let driven = goals.all().iter().filter(|goal| !goal.is_turn);
        self.recorded_goals.iter_mut().zip(driven).for_each(|(sight, goal)| sight.goal = goal.clone());
    }

    /// The share of decisions that agree.
    #[must_use]
    pub fn share(&self) -> Option<f64> {
        (self.decisions > 0).then(|| self.agreeing as f64 / self.decisions as f64)
    }

    /// How many of the recording's goals lay near a frontier that we saw.
    #[must_use]
    pub fn at_frontiers(&self) -> usize {
        let is_near = |sight: &&RecordedSight| sight.frontier_m.is_some_and(|distance_m| distance_m <= AT_FRONTIER_M);
        self.recorded_goals.iter().filter(is_near).count()
    }

    /// Takes the recording's new goals down.
    fn see(&mut self, goals: &RecordedGoals, explorer: &Explorer) {
        let driven = goals.all().iter().filter(|goal| !goal.is_turn);
        for goal in driven.skip(self.recorded_goals.len()) {
            let distance_m = |point: Point| goal.goal_in_map.distance_to(point);
            let frontier_m = explorer.frontiers().cells().map(distance_m).min_by(f64::total_cmp);
            self.recorded_goals.push(RecordedSight { goal: goal.clone(), frontier_m });
        }
    }

    /// Judges the decision that waits as soon as its fellow came, or did not in time.
    fn settle(&mut self, goals: &RecordedGoals, now_s: f64) {
        let Some(pending) = self.pending.take() else { return };
        let is_due = now_s - pending.record.time_s > LAG_S;
        if is_due || agrees(&pending, goals, now_s) {
            self.judge(&pending, goals, now_s);
        } else {
            self.pending = Some(pending);
        }
    }

    fn judge(&mut self, pending: &Pending, goals: &RecordedGoals, now_s: f64) {
        if agrees(pending, goals, now_s) {
            self.decisions += 1;
            self.agreeing += 1;
            return;
        }
        let theirs = goals.in_force().or(pending.recorded.as_ref());
        let record = &pending.record;
        self.part(record.time_s, record.goal, theirs, Some(record), "it had no goal");
    }

    /// Whether a map came between our decision and the recording's, made about then.
    fn is_another_map(&self, ours_s: f64, theirs_s: Option<f64>) -> bool {
        let about_then = |theirs_s: &f64| (theirs_s - ours_s).abs() <= LAG_S && *theirs_s != ours_s;
        let Some(theirs_s) = theirs_s.filter(about_then) else { return false };
        // We decide in the moment in which a map comes: that one is ours.
        let between = ours_s.min(theirs_s)..=ours_s.max(theirs_s);
        self.maps.iter().any(|(came_s, _)| between.contains(came_s))
    }

    fn part(
        &mut self,
        time_s: f64,
        our_goal: Option<Pose>,
        theirs: Option<&RecordedGoal>,
        record: Option<&DecisionRecord>,
        otherwise: &str,
    ) {
        let (recorded_goal, recorded_at_s) = (theirs.map(|goal| goal.goal_in_map), theirs.map(|goal| goal.time_s));
        let (cause, detail) = match (record, &recorded_goal) {
            (Some(_), Some(_)) if self.is_another_map(time_s, recorded_at_s) => {
                let by_s = recorded_at_s.unwrap_or(time_s) - time_s;
                let when = if by_s < 0.0 { "before" } else { "after" };
                ("it decided on another map", format!("{:.1} s {when}", by_s.abs()))
            }
            (Some(record), Some(theirs)) => cause(record, theirs),
            _ => (otherwise, String::new()),
        };
        self.decisions += 1;
        *self.causes.entry(cause.to_owned()).or_default() += 1;
        let why = record.map(|record| record.why.clone()).unwrap_or_default();
        self.partings.push(Parting {
            time_s,
            our_goal,
            recorded_goal,
            recorded_at_s,
            why,
            cause: cause.to_owned(),
            detail,
        });
    }
}

fn is_same(ours: &Pose, theirs: &RecordedGoal) -> bool {
    ours.distance_to(theirs.goal_in_map.position()) <= SAME_M
}

/// Whether the recording was on its way to the same place, or like us to none, about when
/// it was decided.
fn agrees(pending: &Pending, goals: &RecordedGoals, now_s: f64) -> bool {
    let decided_s = pending.record.time_s;
    match &pending.record.goal {
        Some(ours) => {
            let about_then = |goal: &&RecordedGoal| !goal.is_turn && goal.is_in_force(decided_s - LAG_S, now_s);
            goals.all().iter().rev().filter(about_then).any(|theirs| is_same(ours, theirs))
        }
        None => pending.recorded.is_none() || goals.in_force().is_none(),
    }
}
