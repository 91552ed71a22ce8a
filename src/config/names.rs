//! What is said of a misspelt name: the nearest valid one, and errors of YAML in one line.

/// A name is near to another from this similarity on, 0 to 1.
const NEAR: f64 = 0.6;

/// ` (did you mean wfd?)` where one of the names is near, else nothing.
#[must_use]
pub fn hint<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> String {
    let likeness = |name: &&str| strsim::normalized_damerau_levenshtein(wanted, name);
    match names.max_by(|a, b| likeness(a).total_cmp(&likeness(b))) {
        Some(name) if likeness(&name) >= NEAR => format!(" (did you mean {name}?)"),
        _ => String::new(),
    }
}

/// An error of a YAML reader or of serde in one line, without the picture of the source text,
/// and with the nearest name where a field or a variant is unknown.
#[must_use]
pub fn one_line(message: &str) -> String {
    let lines = message.lines().map(str::trim);
    let plain = lines.filter(|line| !(line.is_empty() || line.starts_with("-->") || line.contains('|')));
    let told = plain.collect::<Vec<_>>().join(" ");
    let told = told.strip_prefix("error: ").unwrap_or(&told);
    let hint = unknown(told).map_or_else(String::new, |(wanted, names)| hint(wanted, names.into_iter()));
    format!("{told}{hint}")
}

/// The unknown name of an error by serde, and those that it expects.
pub(super) fn unknown(message: &str) -> Option<(&str, Vec<&str>)> {
    let (_, rest) = message.split_once("unknown field `").or_else(|| message.split_once("unknown variant `"))?;
    let (wanted, rest) = rest.split_once('`')?;
    let (_, names) = rest.split_once("expected ")?;
    let names = names.trim_start_matches("one of ").split(", ").flat_map(|part| part.split(" or "));
    Some((wanted, names.map(|name| name.trim_matches('`')).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_told_where_one_is_near() {
        let names = || ["wfd", "liang", "northwestern"].into_iter();
        assert_eq!(hint("lian", names()), " (did you mean liang?)");
        assert_eq!(hint("wdf", names()), " (did you mean wfd?)");
        assert_eq!(hint("rrt", names()), "");
    }

    #[test]
    fn drawings_are_left_out_and_names_found() {
        let drawn = "error: line 3 column 5: unknown field `commit_radius`, expected one of heading, \
                     commit_radius_m\n --> <input>:3:5\n  |\n3 |     commit_radius: 3\n  |     ^ unknown field";
        let told = "line 3 column 5: unknown field `commit_radius`, expected one of heading, commit_radius_m \
                    (did you mean commit_radius_m?)";
        assert_eq!(one_line(drawn), told);
        let variant = "unknown variant `dijkstar`, expected one of `astar`, `dijkstra`";
        assert_eq!(one_line(variant), format!("{variant} (did you mean dijkstra?)"));
        assert_eq!(one_line("invalid type"), "invalid type");
    }
}
