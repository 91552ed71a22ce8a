//! docs/reliability.md names tests: each of them is there.

#![allow(clippy::unwrap_used)]

use std::path::Path;

/// The text of all Rust files below a folder.
fn code_below(folder: &Path) -> String {
    let mut text = String::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            text += &code_below(&path);
        } else if path.extension().is_some_and(|end| end == "rs") {
            text += &std::fs::read_to_string(&path).unwrap();
        }
    }
    text
}

/// The names in backticks of a table's last column, but for those of files in parentheses.
fn tests_of(row: &str) -> Vec<&str> {
    let last = row.trim_end_matches('|').rsplit('|').next().unwrap();
    let parts: Vec<&str> = last.split('`').collect();
    parts.windows(2).step_by(2).filter(|pair| !pair[0].ends_with('(')).map(|pair| pair[1]).collect()
}

#[test]
fn every_row_names_tests_that_are_there() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(root.join("docs/reliability.md")).unwrap();
    let code = code_below(&root.join("tests")) + &code_below(&root.join("src"));
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| ") && !line.contains("| test |")).collect();
    assert!(rows.len() >= 40, "{} rows", rows.len());
    for row in rows {
        assert_eq!(row.matches(" | ").count(), 2, "three columns: {row}");
        let tests = tests_of(row);
        assert!(!tests.is_empty() || row.ends_with("| the same |"), "no test: {row}");
        for name in tests {
            assert!(code.contains(&format!("(\"{name}\"")) || code.contains(&format!("fn {name}(")), "{name}");
        }
    }
}

#[test]
fn names_are_those_of_the_last_column() {
    assert_eq!(tests_of("| `a_name_that_is_long` | x | `another_name_that_is` (`file`) |"), ["another_name_that_is"]);
}
