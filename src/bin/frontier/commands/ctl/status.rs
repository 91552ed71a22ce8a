//! `frontier ctl status`: how an exploration is doing.

use crate::exit::Outcome;
use crate::output;
use anyhow::{Context, bail};
use frontier_explorer::ros::Node;
use frontier_explorer::ros::ctl::StatusWatch;
use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::stop;
use serde::Serialize;
use std::time::Duration;

/// A status comes once a second: an explorer that is silent for longer has gone.
const GONE_AFTER: Duration = Duration::from_secs(5);
/// From one line to the next.
const PERIOD: Duration = Duration::from_secs(1);

/// Arguments of `frontier ctl status`.
#[derive(Debug, clap::Args)]
pub struct StatusArgs {
    /// Print it each second, until Ctrl-C.
    #[arg(long)]
    watch: bool,
    /// Print JSON; with `--watch` one line each second.
    #[arg(long)]
    json: bool,
}

/// A status as JSON has it; with `--json`, these are the keys. Times are seconds, ways metres,
/// areas square metres.
#[derive(Debug, PartialEq, Serialize)]
struct Report {
    phase: &'static str,
    preset: String,
    message: String,
    /// Empty until the end.
    end_reason: String,
    elapsed_s: f64,
    distance_m: f64,
    known_area_m2: f64,
    free_area_m2: f64,
    frontiers: u32,
    goals_sent: u32,
    goals_reached: u32,
    goals_failed: u32,
    turns: u32,
    recoveries: u32,
    /// None while there is no map.
    map_age_s: Option<f64>,
    driving_s: f64,
    turning_s: f64,
    waiting_for_map_s: f64,
    waiting_for_motion_s: f64,
    waiting_for_navigation_s: f64,
    waiting_for_pose_s: f64,
    resting_s: f64,
}

impl From<ExplorationStatus> for Report {
    fn from(status: ExplorationStatus) -> Self {
        Self {
            phase: phase(status.phase),
            preset: status.preset,
            message: status.message,
            end_reason: status.end_reason,
            elapsed_s: status.elapsed_s,
            distance_m: status.distance_m,
            known_area_m2: status.known_area_m2,
            free_area_m2: status.free_area_m2,
            frontiers: status.frontiers,
            goals_sent: status.goals_sent,
            goals_reached: status.goals_reached,
            goals_failed: status.goals_failed,
            turns: status.turns,
            recoveries: status.recoveries,
            map_age_s: Some(status.map_age_s).filter(|age_s| age_s.is_finite()),
            driving_s: status.driving_s,
            turning_s: status.turning_s,
            waiting_for_map_s: status.waiting_for_map_s,
            waiting_for_motion_s: status.waiting_for_motion_s,
            waiting_for_navigation_s: status.waiting_for_navigation_s,
            waiting_for_pose_s: status.waiting_for_pose_s,
            resting_s: status.resting_s,
        }
    }
}

/// Prints the status of an explorer.
pub fn run(node: &Node, explorer: &str, args: &StatusArgs, limit: Duration) -> anyhow::Result<Outcome> {
    let watch = StatusWatch::begin(node, explorer);
    let report = Report::from(watch.newest(limit)?);
    if !args.watch {
        if args.json {
            output::json(&report)?;
        } else {
            output::line(format_args!("{}", sentence(&report)))?;
        }
        return Ok(Outcome::Done);
    }
    // Ctrl-C is how a watch ends.
    stop::settle(0);
    let mut report = report;
    while node.is_ok() {
        let text = if args.json {
            serde_json::to_string(&report).context("cannot write the status as JSON")?
        } else {
            sentence(&report)
        };
        output::line(format_args!("{text}"))?;
        node.wait_until(PERIOD, || false);
        if watch.age().is_none_or(|age| age > GONE_AFTER) {
            bail!("the status of {explorer} has stopped: it has left, or its connection is lost");
        }
        report = watch.newest(limit)?.into();
    }
    Ok(Outcome::Done)
}

fn sentence(report: &Report) -> String {
    let Report { phase, preset, message, elapsed_s, distance_m, known_area_m2, frontiers, .. } = report;
    let Report { goals_sent, goals_reached, goals_failed, end_reason, .. } = report;
    let end = if end_reason.is_empty() { String::new() } else { format!(" ({end_reason})") };
    format!(
        "{phase}{end}: {message} [{preset}: {elapsed_s:.0} s, {distance_m:.1} m driven, {known_area_m2:.0} m2 known, \
         {frontiers} frontiers, goals: {goals_sent} sent, {goals_reached} reached, {goals_failed} failed]"
    )
}

/// The names of the message's constants, in small letters.
const fn phase(number: u8) -> &'static str {
    match number {
        ExplorationStatus::WAITING_FOR_MAP => "waiting_for_map",
        ExplorationStatus::WAITING_FOR_POSE => "waiting_for_pose",
        ExplorationStatus::TURNING => "turning",
        ExplorationStatus::DRIVING => "driving",
        ExplorationStatus::RETURNING => "returning",
        ExplorationStatus::ENDED => "ended",
        ExplorationStatus::PAUSED => "paused",
        ExplorationStatus::WAITING_FOR_NAVIGATION => "waiting_for_navigation",
        ExplorationStatus::BACKING_OFF => "backing_off",
        ExplorationStatus::RESTING => "resting",
        ExplorationStatus::IDLE => "idle",
        ExplorationStatus::YIELDING => "yielding",
        _ => "unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn status() -> ExplorationStatus {
        ExplorationStatus {
            phase: ExplorationStatus::DRIVING,
            preset: "tour".to_owned(),
            message: "to the frontier 3".to_owned(),
            elapsed_s: 12.4,
            goals_sent: 2,
            map_age_s: f64::NAN,
            ..ExplorationStatus::default()
        }
    }

    #[test]
    fn a_status_is_one_line() {
        let driving = "driving: to the frontier 3 [tour: 12 s, 0.0 m driven, 0 m2 known, 0 frontiers, goals: 2 sent, \
                       0 reached, 0 failed]";
        assert_eq!(sentence(&status().into()), driving);
        let (phase, end_reason) = (ExplorationStatus::ENDED, "complete".to_owned());
        let ended = sentence(&ExplorationStatus { phase, end_reason, ..status() }.into());
        assert!(ended.starts_with("ended (complete): "), "{ended}");
    }

    #[test]
    fn json_has_no_age_where_there_is_no_map() {
        let json = serde_json::to_value(Report::from(status())).unwrap();
        assert_eq!((&json["phase"], &json["map_age_s"]), (&"driving".into(), &serde_json::Value::Null));
    }
}
