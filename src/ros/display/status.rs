//! How the exploration is doing, as a message of our own and for `/diagnostics`.

use super::super::convert::header;
use super::super::log::Level;
use super::super::msg::diagnostic_msgs::{DiagnosticArray, DiagnosticStatus, KeyValue};
use super::super::msg::frontier_explorer::ExplorationStatus;
use super::super::msg::geometry_msgs::{Point32, Polygon as PolygonMessage, PolygonStamped};
use crate::explore::{Counts, End, EndReason, Phase, TimeSpent};
use crate::geometry::Polygon;

/// What a status is made of.
#[derive(Clone, Debug)]
pub struct StatusInput<'a> {
    /// ROS time, seconds.
    pub stamp_s: f64,
    /// The frame of the map.
    pub frame: &'a str,
    /// What the explorer is about.
    pub phase: Phase,
    /// Whether the user asked for a rest.
    pub paused: bool,
    /// Name of the preset.
    pub preset: &'a str,
    /// One sentence on what is going on.
    pub message: &'a str,
    /// Present at the end.
    pub end: Option<&'a End>,
    /// Since the beginning, seconds.
    pub elapsed_s: f64,
    /// Driven, metres.
    pub distance_m: f64,
    /// Known, square metres.
    pub known_area_m2: f64,
    /// Of that free, square metres.
    pub free_area_m2: f64,
    /// Frontiers of the last decision.
    pub frontiers: usize,
    /// What was done so far.
    pub counts: &'a Counts,
    /// Where the time went.
    pub time_spent: &'a TimeSpent,
    /// Age of the map, seconds; NaN while there is none.
    pub map_age_s: f64,
}

/// The status message.
#[must_use]
pub fn status(input: &StatusInput<'_>) -> ExplorationStatus {
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    ExplorationStatus {
        header: header(input.frame, input.stamp_s),
        phase: phase_number(input),
        preset: input.preset.to_owned(),
        message: input.message.to_owned(),
        end_reason: input.end.map(|end| end.reason.name().to_owned()).unwrap_or_default(),
        elapsed_s: input.elapsed_s,
        distance_m: input.distance_m,
        known_area_m2: input.known_area_m2,
        free_area_m2: input.free_area_m2,
        frontiers: count(input.frontiers),
        goals_sent: count(input.counts.goals_sent),
        goals_reached: count(input.counts.goals_reached),
        goals_failed: count(input.counts.goals_failed),
        turns: count(input.counts.turns),
        recoveries: count(input.counts.recoveries),
        map_age_s: input.map_age_s,
        driving_s: input.time_spent.driving_s,
        turning_s: input.time_spent.turning_s,
        waiting_for_map_s: input.time_spent.waiting_for_map_s,
        waiting_for_motion_s: input.time_spent.waiting_for_motion_s,
        waiting_for_navigation_s: input.time_spent.waiting_for_navigation_s,
        waiting_for_pose_s: input.time_spent.waiting_for_pose_s,
        resting_s: input.time_spent.pausing_s,
    }
}

/// The same for rqt_robot_monitor and its kind, with the gravest trouble that there is, and with
/// more names and values.
#[must_use]
pub fn diagnostics(
    node: &str,
    status: &ExplorationStatus,
    trouble: Option<Level>,
    more: Vec<(&str, String)>,
) -> DiagnosticArray {
    let waits = [
        ExplorationStatus::WAITING_FOR_MAP,
        ExplorationStatus::WAITING_FOR_POSE,
        ExplorationStatus::WAITING_FOR_NAVIGATION,
    ];
    let well = [
        "",
        EndReason::Complete.name(),
        EndReason::GoodEnough.name(),
        EndReason::OutsideRegion.name(),
        EndReason::Interrupted.name(),
    ];
    let level = match (status.phase, trouble) {
        (_, Some(Level::Error)) => DiagnosticStatus::ERROR,
        _ if !well.contains(&status.end_reason.as_str()) => DiagnosticStatus::ERROR,
        (_, Some(Level::Warn)) => DiagnosticStatus::WARN,
        (phase, _) if waits.contains(&phase) => DiagnosticStatus::WARN,
        _ => DiagnosticStatus::OK,
    };
    let value = |key: &str, value: String| KeyValue { key: key.to_owned(), value };
    let mut values = vec![
        value("preset", status.preset.clone()),
        value("elapsed [s]", format!("{:.1}", status.elapsed_s)),
        value("driving [s]", format!("{:.1}", status.driving_s)),
        value("turning [s]", format!("{:.1}", status.turning_s)),
        value("standing [s]", format!("{:.1}", (status.elapsed_s - status.driving_s - status.turning_s).max(0.0))),
        value("driven [m]", format!("{:.1}", status.distance_m)),
        value("known [m2]", format!("{:.1}", status.known_area_m2)),
        value("frontiers", status.frontiers.to_string()),
        value("goals sent", status.goals_sent.to_string()),
        value("goals reached", status.goals_reached.to_string()),
        value("goals failed", status.goals_failed.to_string()),
        value("age of the map [s]", format!("{:.1}", status.map_age_s)),
        value("end", status.end_reason.clone()),
    ];
    values.extend(more.into_iter().map(|(key, text)| value(key, text)));
    let name = format!("{}: exploration", node.trim_start_matches('/'));
    let one = DiagnosticStatus { level, name, message: status.message.clone(), values, ..DiagnosticStatus::default() };
    DiagnosticArray { header: status.header.clone(), status: vec![one] }
}

/// One line for people.
#[must_use]
pub fn status_sentence(status: &ExplorationStatus) -> String {
    format!(
        "{:.0} s, {:.1} m driven, {:.0} m2 known, {} frontiers, goals: {} sent, {} reached, {} failed",
        status.elapsed_s,
        status.distance_m,
        status.known_area_m2,
        status.frontiers,
        status.goals_sent,
        status.goals_reached,
        status.goals_failed
    )
}

/// The region to explore; without corners when everything is.
#[must_use]
pub fn region_message(region: Option<&Polygon>, frame: &str, stamp_s: f64) -> PolygonStamped {
    let corners = region.map(Polygon::corners).unwrap_or_default();
    let points = corners.iter().map(|p| Point32 { x: p.x as f32, y: p.y as f32, z: 0.0 }).collect();
    PolygonStamped { header: header(frame, stamp_s), polygon: PolygonMessage { points } }
}

const fn phase_number(input: &StatusInput<'_>) -> u8 {
    if input.paused {
        return ExplorationStatus::PAUSED;
    }
    match input.phase {
        Phase::WaitingForMap => ExplorationStatus::WAITING_FOR_MAP,
        Phase::WaitingForPose => ExplorationStatus::WAITING_FOR_POSE,
        Phase::WaitingForNavigation => ExplorationStatus::WAITING_FOR_NAVIGATION,
        Phase::Turning => ExplorationStatus::TURNING,
        Phase::Driving => ExplorationStatus::DRIVING,
        Phase::BackingOff => ExplorationStatus::BACKING_OFF,
        Phase::Pausing => ExplorationStatus::RESTING,
        Phase::Returning => ExplorationStatus::RETURNING,
        Phase::Ended => ExplorationStatus::ENDED,
    }
}
