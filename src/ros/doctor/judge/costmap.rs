//! The global costmap of move_base: is it published, and does it know what is unknown.

use super::super::facts::{CostmapFacts, ServerFacts, Wanted};
use super::super::finding::{Finding, FindingLevel};

const CHECK: &str = "costmap";

/// What is to be said of the global costmap. It is an error only where it takes the place of our
/// own costs.
pub fn judge(wanted: &Wanted, server: &ServerFacts, costmap: &CostmapFacts) -> Finding {
    let topic = &costmap.topic.topic;
    let name = server.name.trim_start_matches('/');
    let level = if wanted.plans_on_costmap { FindingLevel::Error } else { FindingLevel::Warning };
    let bad = |what: String, remedy: String| Finding { level, ..Finding::warning(CHECK, what, remedy) };
    let publish =
        || format!("set `global_costmap/publish_frequency: 1.0` in the parameters of {name} and start it again");
    let unseen = "goals are not kept away from what move_base calls an obstacle";
    if costmap.topic.publishers.is_empty() {
        return bad(format!("nobody publishes {topic}: {unseen}"), publish());
    }
    let switch = costmap.params.unknown_is_off();
    let remedy = || {
        let switch = switch.as_deref().unwrap_or("track_unknown_space");
        format!(
            "set `global_costmap/{switch}: true` in the parameters of {name} (costmap_2d's default is false; an \
             obstacle layer of its own may say so too) and start it again"
        )
    };
    if let Some(share) = costmap.hidden_unknown {
        let percent = 100.0 * share;
        let said = switch.as_deref().map_or_else(String::new, |switch| format!(" ({switch} is false)"));
        return bad(
            format!(
                "{topic} has no unknown cell, and {percent:.0} % of the map below it is unknown{said}: move_base \
                 drives through what nobody has seen"
            ),
            remedy(),
        );
    }
    if let Some(switch) = &switch {
        let what = format!("{}/global_costmap/{switch} is false: move_base takes the unknown for free", server.name);
        return bad(what, remedy());
    }
    if !costmap.has_come {
        let listened_s = costmap.topic.listened_s;
        return bad(format!("no costmap has come on {topic} for {listened_s:.0} s: {unseen}"), publish());
    }
    Finding::ok(CHECK, format!("{topic} comes, and knows what is unknown"))
}

#[cfg(test)]
mod tests {
    use super::super::super::costmap_params::CostmapParams;
    use super::super::super::facts::TopicFacts;
    use super::super::super::finding::FindingLevel::{Error, Ok, Warning};
    use super::super::testing::{nodes, server, wanted};
    use super::*;

    fn facts() -> CostmapFacts {
        let topic = "/move_base/global_costmap/costmap".to_owned();
        let topic = TopicFacts { topic, publishers: nodes(&["/move_base"]), listened_s: 10.0, ..TopicFacts::default() };
        CostmapFacts { topic, has_come: true, ..CostmapFacts::default() }
    }

    #[test]
    fn a_costmap_with_unknown_cells_is_well() {
        assert_eq!(judge(&wanted(), &server(), &facts()).level, Ok);
    }

    #[test]
    fn a_costmap_without_unknown_cells_is_named_with_its_switch() {
        let hidden = CostmapFacts { hidden_unknown: Some(0.4), ..facts() };
        let finding = judge(&wanted(), &server(), &hidden);
        assert_eq!(finding.level, Warning);
        assert!(finding.what.contains("has no unknown cell, and 40 % of the map below it is unknown:"), "{finding:?}");
        assert!(finding.remedy.unwrap().starts_with("set `global_costmap/track_unknown_space: true` in"));
        let layers = vec![("obstacles".to_owned(), false)];
        let params = CostmapParams { track_unknown_space: Some(true), layers, ..CostmapParams::default() };
        let finding = judge(&wanted(), &server(), &CostmapFacts { params: params.clone(), ..hidden.clone() });
        assert!(finding.what.contains("(obstacles/track_unknown_space is false)"), "{finding:?}");
        let finding = judge(&wanted(), &server(), &CostmapFacts { params, ..facts() });
        assert!(finding.what.starts_with("/move_base/global_costmap/obstacles/track_unknown_space is false"));
        let planned_on = super::Wanted { plans_on_costmap: true, ..wanted() };
        assert_eq!(judge(&planned_on, &server(), &hidden).level, Error);
    }

    #[test]
    fn a_costmap_that_does_not_come_is_named() {
        let silent = judge(&wanted(), &server(), &CostmapFacts { has_come: false, ..facts() });
        assert!(silent.level == Warning && silent.what.contains("no costmap has come"), "{silent:?}");
        let topic = TopicFacts { publishers: nodes(&[]), ..facts().topic };
        let absent = judge(&wanted(), &server(), &CostmapFacts { topic, has_come: false, ..facts() });
        assert!(absent.what.starts_with("nobody publishes /move_base/global_costmap/costmap"), "{absent:?}");
        assert!(absent.remedy.unwrap().contains("publish_frequency"));
    }
}
