//! From facts to findings; pure, one file for each part of the stack.

mod clock;
mod costmap;
mod drivers;
mod frames;
mod map;
mod outline;
mod scan;
mod server;
#[cfg(test)]
mod testing;
mod words;

use super::facts::{Facts, Wanted};
use super::finding::Finding;

/// The findings of all checks, in the order in which they are best mended.
#[must_use]
pub fn judge(wanted: &Wanted, facts: &Facts) -> Vec<Finding> {
    let mut findings = vec![
        clock::judge(&facts.clock),
        map::judge(wanted, &facts.map),
        frames::judge(wanted, &facts.frames, facts.clock.goes()),
    ];
    match (&facts.server, &facts.costmap) {
        (Some(server), Some(costmap)) => {
            findings.push(server::judge(wanted, server));
            if !server.whole().is_empty() {
                findings.push(server::judge_make_plan(server));
                findings.push(server::judge_goals(wanted, server));
                findings.push(costmap::judge(wanted, server, costmap));
                findings.push(outline::judge(&wanted.outline, server, &costmap.params));
            }
        }
        _ => findings.push(Finding::ok("move_base", "not needed: our own controller drives")),
    }
    findings.push(drivers::judge(wanted, &facts.drivers));
    findings.extend(facts.scans.as_ref().map(|scans| scan::judge(wanted, scans)));
    findings
}
