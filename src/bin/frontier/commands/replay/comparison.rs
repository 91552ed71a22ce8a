//! Our decisions beside those of the recording.

use crate::output;
use frontier_explorer::geometry::{Point, Pose};
use serde::Serialize;

/// Goals nearer than this to each other, or to a frontier, agree, metres.
const SAME_M: f64 = 1.0;
/// So many partings are printed.
const PRINTED: usize = 8;

/// A goal of the recording, and what we had to say then.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Since the bag's begin, seconds.
    pub time_s: f64,
    /// Where the recording was sent.
    pub recorded_goal: Pose,
    /// From there to the nearest frontier that our detector saw on the newest map, metres.
    pub frontier_m: Option<f64>,
    /// What we had decided last.
    pub our_goal: Option<Pose>,
    /// From one goal to the other, metres.
    pub apart_m: Option<f64>,
    /// Why we decided so.
    pub why: String,
}

/// All of them.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Comparison {
    /// One for each goal of the recording.
    pub rows: Vec<Row>,
}

impl Comparison {
    /// Adds a goal of the recording.
    pub fn add(&mut self, time_s: f64, recorded_goal: Pose, frontiers: &[Point], ours: Option<(Pose, String)>) {
        let distance_m = |point: &Point| recorded_goal.distance_to(*point);
        let frontier_m = frontiers.iter().map(distance_m).min_by(f64::total_cmp);
        let (our_goal, why) = ours.map_or((None, String::new()), |(goal, why)| (Some(goal), why));
        let apart_m = our_goal.map(|goal| recorded_goal.distance_to(goal.position()));
        self.rows.push(Row { time_s, recorded_goal, frontier_m, our_goal, apart_m, why });
    }

    /// Writes the figures, and where it parted.
    pub fn print(&self) -> anyhow::Result<()> {
        if self.rows.is_empty() {
            return output::line(format_args!("the bag holds no goals to compare with"));
        }
        let is_near = |distance_m: Option<f64>| distance_m.is_some_and(|distance_m| distance_m <= SAME_M);
        let seen = self.rows.iter().filter(|row| is_near(row.frontier_m)).count();
        let same = self.rows.iter().filter(|row| is_near(row.apart_m)).count();
        let all = self.rows.len();
        output::line(format_args!(
            "of {all} recorded goals, {seen} lay within {SAME_M} m of a frontier that we saw, and {same} within \
             {SAME_M} m of the goal that we had chosen"
        ))?;
        let parted: Vec<&Row> = self.rows.iter().filter(|row| !is_near(row.apart_m)).collect();
        for row in parted.iter().take(PRINTED) {
            let goal = row.recorded_goal;
            let ours = match (row.our_goal, row.apart_m) {
                (Some(ours), Some(apart_m)) => {
                    format!("we ({:.1}, {:.1}), {apart_m:.1} m apart: {}", ours.x, ours.y, row.why)
                }
                _ => "we had no goal".to_owned(),
            };
            output::line(format_args!("  at {:.1} s it went to ({:.1}, {:.1}), {ours}", row.time_s, goal.x, goal.y))?;
        }
        if parted.len() > PRINTED {
            output::line(format_args!("  and {} more in comparison.json", parted.len() - PRINTED))?;
        }
        Ok(())
    }
}
