//! `frontier doctor`: what keeps an exploration from running on this ROS graph, and how to mend it.

use crate::exit::Outcome;
use crate::{output, ros_node};
use anyhow::{Context, anyhow};
use frontier_explorer::nodes::{DoctorOptions, Finding, FindingLevel, examine};
use std::time::Duration;

/// Beside the time to listen: for the master, the parameters and `make_plan`.
const MARGIN: Duration = Duration::from_secs(20);

/// Arguments of `frontier doctor`.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The node that is to explore: its parameters are read, whether it runs or not.
    #[arg(long, value_name = "NAME", default_value = "/explore")]
    node: String,
    /// The topic of the map, instead of the node's parameter `map_topic`.
    #[arg(long, value_name = "TOPIC")]
    map_topic: Option<String>,
    /// The robot's frame, instead of the node's parameter `base_frame`.
    #[arg(long, value_name = "FRAME")]
    base_frame: Option<String>,
    /// The action server, instead of the node's parameter `move_base`.
    #[arg(long, value_name = "NAME")]
    move_base: Option<String>,
    /// The topic of the scans; `scan` in the node's namespace when not given.
    #[arg(long, value_name = "TOPIC")]
    scan_topic: Option<String>,
    /// How long to wait for what does not come, seconds.
    #[arg(long, value_name = "S", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..=3600))]
    timeout: u64,
    /// Print JSON: a list of {check, level, what, remedy}.
    #[arg(long)]
    json: bool,
}

/// Runs `frontier doctor`: incomplete where something is wrong.
pub fn run(args: &Args) -> anyhow::Result<Outcome> {
    let options = DoctorOptions {
        node: args.node.clone(),
        map_topic: args.map_topic.clone(),
        base_frame: args.base_frame.clone(),
        move_base: args.move_base.clone(),
        scan_topic: args.scan_topic.clone(),
        limit: Duration::from_secs(args.timeout),
    };
    let limit = options.limit + MARGIN;
    let findings = ros_node::with("frontier_doctor", |node| {
        let node = node.clone();
        let findings = ros_node::within(limit, move || examine(&node, &options));
        findings.context("the ROS master does not answer")?.map_err(|why| anyhow!(why))
    })?;
    if args.json {
        output::json(&findings)?;
    } else {
        for finding in &findings {
            output::line(format_args!("{}", line(finding)))?;
        }
        output::line(format_args!("{}", summary(&findings)))?;
    }
    let has_errors = findings.iter().any(|finding| finding.level == FindingLevel::Error);
    Ok(if has_errors { Outcome::Incomplete } else { Outcome::Done })
}

fn line(finding: &Finding) -> String {
    let Finding { check, level, what, remedy } = finding;
    let remedy = remedy.as_ref().map_or_else(String::new, |remedy| format!(". To mend it: {remedy}"));
    format!("{:<8} {check}: {what}{remedy}", level.name())
}

fn summary(findings: &[Finding]) -> String {
    let count = |level| findings.iter().filter(|finding| finding.level == level).count();
    let counted = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    match (count(FindingLevel::Error), count(FindingLevel::Warning)) {
        (0, 0) => "all is well".to_owned(),
        (0, warnings) => format!("all is well but for {}", counted(warnings, "warning")),
        (errors, 0) => counted(errors, "error"),
        (errors, warnings) => format!("{}, {}", counted(errors, "error"), counted(warnings, "warning")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_is_one_line() {
        let well = Finding::ok("clock", "it goes");
        let wrong = Finding::error("map", "no map comes", "start a SLAM");
        assert_eq!(line(&well), "ok       clock: it goes");
        assert_eq!(line(&wrong), "error    map: no map comes. To mend it: start a SLAM");
    }

    #[test]
    fn the_last_line_sums_up() {
        let (well, so_so, wrong) =
            (Finding::ok("a", "b"), Finding::warning("c", "d", "e"), Finding::error("f", "g", "h"));
        assert_eq!(summary(std::slice::from_ref(&well)), "all is well");
        assert_eq!(summary(&[well, so_so.clone()]), "all is well but for 1 warning");
        assert_eq!(summary(std::slice::from_ref(&wrong)), "1 error");
        assert_eq!(summary(&[wrong.clone(), wrong, so_so]), "2 errors, 1 warning");
    }
}
