//! Our decisions beside those of the recording, in words.

use crate::output;
use frontier_explorer::geometry::Pose;
use frontier_explorer::replay::{Agreement, Parting};

/// So many partings are printed.
const PRINTED: usize = 5;

/// Prints how far the two agree, and where they part.
pub fn print(agreement: &Agreement) -> anyhow::Result<()> {
    let Some(share) = agreement.share() else {
        return output::line(format_args!("the bag holds no goals to compare with"));
    };
    output::line(format_args!(
        "of {} recorded goals, {} lay within 1 m of a frontier that we saw",
        agreement.recorded_goals.len(),
        agreement.at_frontiers(),
    ))?;
    output::line(format_args!(
        "of {} decisions, {} agree with the recording ({:.1} %)",
        agreement.decisions,
        agreement.agreeing,
        100.0 * share
    ))?;
    for (cause, count) in &agreement.causes {
        output::line(format_args!("  {count} not: {cause}"))?;
    }
    for parting in agreement.partings.iter().take(PRINTED) {
        let Parting { time_s, our_goal, recorded_goal, .. } = parting;
        let cause = parting.full_cause();
        output::line(format_args!(
            "  at {:.1} s we {}, it {}: {cause}",
            time_s,
            place(our_goal.as_ref()),
            place(recorded_goal.as_ref())
        ))?;
    }
    if agreement.partings.len() > PRINTED {
        let more = agreement.partings.len() - PRINTED;
        output::line(format_args!("  and {more} more in comparison.json"))?;
    }
    Ok(())
}

fn place(goal: Option<&Pose>) -> String {
    goal.map_or_else(|| "had no goal".to_owned(), |goal| format!("({:.1}, {:.1})", goal.x, goal.y))
}
