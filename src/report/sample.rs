//! A made-up run for the tests of this module.

use super::run_json::{MedianMax, Notice, RunRecord, SCHEMA_VERSION, Wall};
use super::series::Series;
use crate::explore::{
    CandidateRecord, CandidateStatus, Counts, DecisionRecord, EndReason, LeftBehind, Position, TimeSpent,
};
use crate::geometry::Pose;
use std::collections::BTreeMap;

/// One decision with a chosen, an eligible and an unreachable candidate.
fn decision(time_s: f64) -> DecisionRecord {
    let goal = Pose::new(3.25, 1.0 + 0.1 + 0.2, 0.5);
    let candidate = |id: u64, distance_m: f64, status, goal: Option<Pose>| CandidateRecord {
        id,
        target: Position { x: 3.5 + id as f64, y: 1.25 },
        goal,
        size_cells: 40 - 10 * id as usize,
        size_m: (40 - 10 * id) as f64 * 0.05,
        distance_m,
        path_m: goal.map(|_| distance_m * 1.1),
        scores: match goal {
            Some(_) => BTreeMap::from([("distance", distance_m), ("size", -0.5), ("total", distance_m - 0.5)]),
            None => BTreeMap::new(),
        },
        status,
    };
    DecisionRecord {
        time_s,
        pose: Pose::new(1.0, 1.0, 0.0),
        candidates: vec![
            candidate(0, 2.5, CandidateStatus::Chosen, Some(goal)),
            candidate(1, 3.5, CandidateStatus::Eligible, Some(goal)),
            candidate(2, 4.5, CandidateStatus::Unreachable, None),
        ],
        goal: Some(goal),
        why: "the nearest of 2 <frontiers> & \"more\"".to_owned(),
    }
}

/// A run of 100 s that covers 97 % of its world.
pub(super) fn run() -> RunRecord {
    let mut series = Series::new();
    for t in 0..=4 {
        let t = f64::from(t) * 25.0;
        series.push(t, 0.97 * (1.0 - (-t / 20.0).exp()) / (1.0 - (-5.0_f64).exp()), 0.31 * t);
    }
    RunRecord {
        schema_version: SCHEMA_VERSION,
        world: "rooms <b>&</b>".to_owned(),
        preset: "ours".to_owned(),
        robot: "turtlebot3_waffle".to_owned(),
        seed: Some(7),
        slam: None,
        start: Pose::new(1.0, 1.0, 0.0),
        end_reason: EndReason::Complete,
        end_message: "No frontier is left that the robot could get to.".to_owned(),
        coverage: 0.97,
        sim_time_s: 100.0,
        distance_m: 31.0,
        turned_rad: 0.1 + 0.2,
        goals_sent: 9,
        goals_failed: 1,
        collisions: 0,
        known_area_m2: 180.5,
        free_area_m2: 160.25,
        time_to_coverage_s: series.time_to_coverage_s(),
        distance_to_coverage_m: series.distance_to_coverage_m(),
        counts: Counts {
            goals_sent: 9,
            goals_reached: 8,
            goals_failed: 1,
            turns: 1,
            recoveries: 0,
            back_offs: 0,
            detections: 40,
        },
        time_spent: TimeSpent { driving_s: 20.0, turning_s: 6.5, waiting_for_map_s: 2.0, ..TimeSpent::default() },
        notices: vec![Notice { time_s: 12.0, text: "the goal at (1.00, 2.00) m failed: no path".to_owned() }],
        left_behind: LeftBehind { frontiers: 1, unreachable: 1, ..LeftBehind::default() },
        decisions: vec![decision(0.0), decision(31.7)],
        series: series.points(),
        wall: Wall { total_s: 1.5, decision_ms: MedianMax { median: 0.8, max: 2.5 } },
    }
}
