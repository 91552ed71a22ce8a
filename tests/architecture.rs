//! The invariants of ARCHITECTURE.md, checked on the source: which room may use which, and
//! what may not appear where.

#![allow(clippy::unwrap_used)]

#[path = "architecture/circles.rs"]
mod circles;

use circles::circles;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Each room with the rooms that it may use.
const ROOMS: &[(&str, &[&[&str]])] = &[
    // Floor 0: data.
    ("range", &[]),
    ("text", &[]),
    ("geometry", &[&["range"]]),
    ("scan", &[&["geometry"]]),
    ("tf", &[&["geometry"]]),
    ("grid", &[&["geometry"]]),
    ("bits", &[&["geometry", "grid"]]),
    // Floor 1: algorithms, which do not know each other.
    ("frontier", &[FLOOR_0]),
    ("selection", &[FLOOR_0]),
    ("planning", &[FLOOR_0]),
    ("control", &[FLOOR_0]),
    ("matching", &[FLOOR_0]),
    // Floor 2: the pipeline.
    ("robot", &[FLOOR_0]),
    ("navigation", &[FLOOR_0, &["planning", "control", "robot"]]),
    ("explore", &[FLOOR_0, FLOOR_1, &["robot"]]),
    ("config", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    // Floor 3: the rim, whose rooms do not use each other.
    ("io", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    ("sim", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    ("report", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    ("bag", &[FLOOR_0, FLOOR_1, FLOOR_2]),
    // Scans become a map by the simulator's mapper.
    ("mapping", &[FLOOR_0, FLOOR_1, FLOOR_2, &["sim"]]),
    // A recording behind the port; where it lacks a map, one is made of its scans.
    ("replay", &[FLOOR_0, FLOOR_1, FLOOR_2, &["bag", "mapping"]]),
    // The adapter is told what the configuration says.
    ("ros", &[FLOOR_0, FLOOR_1, &["robot", "navigation", "explore"]]),
    // What assembles, drives and records runs stands above all that runs are made of.
    ("run", &[FLOOR_0, FLOOR_1, FLOOR_2, &["io", "sim", "report", "bag", "mapping", "replay"]]),
    // The nodes: sim_node is the simulator behind ROS.
    ("nodes", &[FLOOR_0, FLOOR_1, FLOOR_2, &["io", "sim", "ros", "run"]]),
];

const FLOOR_0: &[&str] = &["range", "text", "geometry", "scan", "grid", "bits", "tf"];
const FLOOR_1: &[&str] = &["frontier", "selection", "planning", "control", "matching"];
const FLOOR_2: &[&str] = &["robot", "navigation", "explore", "config"];

/// Words that belong to some rooms alone.
const PLACES: &[(&str, &[&str])] = &[
    ("rosrust", &["ros"]),
    ("clap", &["bin"]),
    ("anyhow", &["bin"]),
    ("std::fs", &["io", "bin"]),
    ("File::", &["io", "bin"]),
];

/// Rooms of floors 0 to 2, in which no clock is read.
const PURE: &[&[&str]] = &[FLOOR_0, FLOOR_1, FLOOR_2];
/// What would make the same inputs give other outputs, or wait.
const IMPURE: &[&str] = &[
    "Instant",
    "SystemTime",
    "thread::spawn",
    "thread::Builder",
    "thread::scope",
    "rayon",
    "sleep(",
    "rand::",
    "rand_pcg",
    "std::env",
    "println!",
];

/// A source file without its comments and tests.
struct Source {
    /// From `src` on.
    path: PathBuf,
    text: String,
}

impl Source {
    fn new(path: &Path, text: &str) -> Self {
        Self { path: path.to_owned(), text: code(text) }
    }

    /// The first part of its path.
    fn room(&self) -> String {
        let first = self.path.iter().next().unwrap().to_string_lossy();
        first.trim_end_matches(".rs").to_owned()
    }

    /// How many `super::` lead from it to the root of the crate.
    fn depth(&self) -> usize {
        let is_folder_itself = self.path.file_name().is_some_and(|name| name == "mod.rs");
        self.path.iter().count() - usize::from(is_folder_itself)
    }

    /// Whether a word begins somewhere in it: `AtomicFile::` does not say `File::`.
    fn says(&self, word: &str) -> bool {
        let is_part = |before: &str| before.ends_with(|c: char| c.is_alphanumeric() || c == '_');
        self.text.match_indices(word).any(|(at, _)| !is_part(&self.text[..at]))
    }

    /// The rooms that it names by paths from the root.
    fn used(&self) -> Vec<String> {
        let to_root = "super::".repeat(self.depth());
        let from_root = self.text.split("crate::").skip(1).chain(self.text.split(to_root.as_str()).skip(1));
        let name = |rest: &str| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
        // What is imported in braces after the root would need a parser: nobody does so.
        from_root.map(name).collect()
    }
}

/// All files of `src`, but for tests in files of their own.
fn sources() -> Vec<Source> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    let mut folders = vec![src.clone()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let is_test = path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("tests"));
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "rs") && !is_test {
                let text = std::fs::read_to_string(&path).unwrap();
                found.push(Source::new(path.strip_prefix(&src).unwrap(), &text));
            }
        }
    }
    found
}

/// What is left of a file without comments and without the items that are compiled for tests
/// alone, wherever they stand.
fn code(text: &str) -> String {
    let mut kept = Vec::new();
    let mut lines = text.lines().map(|line| line.split("//").next().unwrap_or_default());
    while let Some(line) = lines.next() {
        if line.trim() != "#[cfg(test)]" {
            kept.push(line);
            continue;
        }
        let mut open = 0;
        for line in lines.by_ref() {
            let count = |c: char| line.matches(c).count();
            let was_open = open > 0;
            open += count('{');
            let is_over = was_open || open > 0 || line.trim_end().ends_with(';');
            open = open.saturating_sub(count('}'));
            if is_over && open == 0 {
                break;
            }
        }
    }
    kept.join("\n")
}

/// Uses of rooms that the table does not allow.
fn climbers(sources: &[Source]) -> Vec<String> {
    let allowed: BTreeMap<&str, Vec<&str>> = ROOMS.iter().map(|(room, may)| (*room, may.concat())).collect();
    let mut wrong = Vec::new();
    for source in sources {
        let (room, path) = (source.room(), source.path.display());
        if room == "lib" || room == "bin" {
            continue;
        }
        let Some(allowed) = allowed.get(room.as_str()) else {
            wrong.push(format!("the room {room} is not in the table"));
            continue;
        };
        let used = source.used().into_iter();
        let others = used.filter(|used| *used != room && !allowed.contains(&used.as_str()));
        wrong.extend(others.map(|used| format!("{path} uses {used}")));
    }
    wrong
}

/// Words outside the rooms that they belong to.
fn strays(sources: &[Source]) -> Vec<String> {
    let strays = |source: &Source| {
        let room = source.room();
        let words = PLACES.iter().filter(|(word, places)| source.says(word) && !places.contains(&room.as_str()));
        words.map(|(word, _)| format!("{} contains {word}", source.path.display())).collect::<Vec<_>>()
    };
    sources.iter().flat_map(strays).collect()
}

/// Clocks, threads and chance in rooms that have none.
fn impurities(sources: &[Source]) -> Vec<String> {
    let pure = PURE.concat();
    let found = |source: &Source| {
        let words = IMPURE.iter().filter(|&&word| source.text.contains(word));
        words.map(|word| format!("{} contains {word}", source.path.display())).collect::<Vec<_>>()
    };
    sources.iter().filter(|source| pure.contains(&source.room().as_str())).flat_map(found).collect()
}

#[test]
fn rooms_use_lower_floors_only() {
    assert_eq!(climbers(&sources()), Vec::<String>::new());
}

#[test]
fn what_belongs_to_one_place_appears_there_alone() {
    assert_eq!(strays(&sources()), Vec::<String>::new());
}

#[test]
fn the_pipeline_reads_no_clock_and_draws_no_random_number() {
    assert_eq!(impurities(&sources()), Vec::<String>::new());
}

#[test]
fn no_two_files_need_each_other() {
    assert_eq!(circles(&sources()), BTreeSet::new());
}

#[test]
fn a_circle_is_found_however_it_is_closed() {
    let check = |files: &[(&str, &str)], expected: &[&str]| {
        let sources: Vec<Source> = files.iter().map(|(path, text)| Source::new(Path::new(path), text)).collect();
        let found: Vec<String> = circles(&sources).into_iter().flatten().collect();
        assert_eq!(found, expected, "{files:?}");
    };
    let room = ("sim/mod.rs", "pub use plant::Plant;\npub use world::{\n    World as Place,\n};");
    let world = ("sim/world.rs", "pub struct World;");
    // By the room's re-exports, by a path in the code, by an imported module, from outside.
    for line in ["use super::Place;", "fn f() { super::world::g() }", "use super::world;\nfn f() { world::g() }"] {
        check(&[room, world, ("sim/plant.rs", line)], &[]);
        let back = ("sim/world.rs", "use crate::sim::{\n    Plant,\n};");
        check(&[room, back, ("sim/plant.rs", line)], &["sim/plant.rs", "sim/world.rs"]);
    }
    let by_way_of = ("sim/world.rs", "use crate::grid::Grid;");
    let grid = ("grid.rs", "use crate::sim::Plant;");
    let all = ["grid.rs", "sim/plant.rs", "sim/world.rs"];
    check(&[room, by_way_of, grid, ("sim/plant.rs", "use super::Place;")], &all);
    // A parent and its child: the child may implement what the parent has, and not else.
    let parent = ("plan.rs", "mod way;\nuse way::Way;\ntrait Planner {}\nstruct Ask;");
    check(&[parent, ("plan/way.rs", "use super::Planner;\nimpl<T> Planner for Way<T> {}")], &[]);
    check(&[parent, ("plan/way.rs", "use super::Ask;\nimpl From<Ask> for Way {}")], &["plan/way.rs", "plan.rs"]);
    // A program's own modules.
    let (main, args) = (("bin/x/main.rs", "use args::Args;\nfn f() {}"), ("bin/x/args.rs", "use crate::f;"));
    check(&[main, args], &["bin/x/args.rs", "bin/x/main.rs"]);
}

#[test]
fn each_rule_finds_the_line_that_breaks_it() {
    let source = |path: &str, text: &str| [Source::new(Path::new(path), text)];
    for (path, line) in [
        ("grid/info.rs", "use crate::frontier::Frontier;"),
        ("frontier/canny.rs", "use super::super::planning::Astar;"),
        ("frontier/mod.rs", "use super::planning::Astar;"),
        ("frontier/reach/nodes.rs", "use super::super::super::planning::Astar;"),
        ("sim/plant.rs", "let x = crate::report::page();"),
        ("attic/box.rs", "use crate::grid::Cell;"),
    ] {
        assert_eq!(climbers(&source(path, line)).len(), 1, "{path}: {line}");
    }
    assert_eq!(climbers(&source("frontier/reach/nodes.rs", "use super::super::flood::Flood;")), Vec::<String>::new());
    assert_eq!(climbers(&source("lib.rs", "use crate::ros;")), Vec::<String>::new());
    for (word, places) in PLACES {
        assert_eq!(strays(&source("explore/run.rs", &format!("use {word}x;"))).len(), 1, "{word}");
        assert!(strays(&source(&format!("{}/x.rs", places[0]), &format!("use {word}x;"))).is_empty(), "{word}");
        assert!(strays(&source("explore/run.rs", &format!("use a_{word}x;"))).is_empty(), "{word}");
    }
    for word in IMPURE {
        assert_eq!(impurities(&source("explore/run.rs", &format!("let x = {word};"))).len(), 1, "{word}");
        assert!(impurities(&source("sim/robot.rs", &format!("let x = {word};"))).is_empty(), "{word}");
    }
}

#[test]
fn only_tests_and_comments_are_left_out() {
    let text = "a // b\n#[cfg(test)]\nmod one;\nc\n#[cfg(test)]\n#[path = \"x_tests.rs\"]\nmod two;\nd\n\
                #[cfg(test)]\nmod three {\n fn f() { g(); }\n}\ne\n#[cfg(test)]\nfn h() {}\nf";
    assert_eq!(code(text).lines().map(str::trim).collect::<Vec<_>>(), ["a", "c", "d", "e", "f"]);
}
