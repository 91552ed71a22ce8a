//! Words that several judgements need.

use super::super::facts::TopicFacts;
use crate::ros::directory::list;

/// A name is near to another from this similarity on, 0 to 1.
const NEAR: f64 = 0.6;

/// The name that is most like the wanted one, where one is near.
pub fn nearest<'a>(wanted: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let likeness = |name: &str| strsim::normalized_damerau_levenshtein(wanted, name);
    let best = names.into_iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b)))?;
    (likeness(best) >= NEAR).then_some(best)
}

/// Names and who is behind them: `/map (of /sim), ...`; "none" without any.
pub fn offers(topic: &TopicFacts) -> String {
    let offers: Vec<String> = topic.others.iter().map(|(name, nodes)| format!("{name} (of {})", list(nodes))).collect();
    list(&offers)
}

/// How to give a node another parameter.
pub fn set_param(node: &str, parameter: &str, value: &str) -> String {
    format!("`rosparam set {node}/{parameter} {value}`, or in its launch file, and start the node again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_meant_where_one_is_near() {
        assert_eq!(nearest("base_lnk", ["map", "odom", "base_link"]), Some("base_link"));
        assert_eq!(nearest("tool", ["map", "odom", "base_link"]), None);
        assert_eq!(nearest("base_link", ["odom"]), None);
        assert_eq!(nearest("/x", []), None);
    }
}
