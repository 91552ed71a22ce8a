//! Files that this program wrote once: results of runs and comparisons, and sessions.

use super::engine::{Answer, Target, none};
use super::exploring::{a_while, room};
use frontier_explorer::config::{Preset, builtin_robot};
use frontier_explorer::explore::Explorer;
use frontier_explorer::geometry::Pose;
use frontier_explorer::nodes::Session;
use frontier_explorer::report::{Comparison, RunRecord};

#[test]
fn comparisons() {
    let memory = (64 << 20, 2000);
    Target { name: "comparisons", run: comparison, seeds: none, memory, least_taken_percent: 5.0 }.fuzz();
}

/// Two parts of a comparison, with a line of their own between them.
fn comparison(input: &[u8]) -> Answer {
    let at = input.windows(3).position(|bytes| bytes == b"\n-\n").unwrap_or(input.len());
    let (first, second) = input.split_at(at);
    let mut whole = Comparison::from_json(first).map_err(|error| error.to_string())?;
    let part = Comparison::from_json(second.get(3..).unwrap_or_default()).map_err(|error| error.to_string());
    let merged = part.and_then(|part| whole.merge(part).map_err(|error| error.to_string()));
    let _ = (whole.missing(), whole.summaries(), whole.summaries_by_world());
    let bytes = whole.to_json().map_err(|error| error.to_string())?;
    Comparison::from_json(&bytes).unwrap_or_else(|error| panic!("what was written is not read: {error}"));
    Ok(merged.err().unwrap_or_default())
}

#[test]
fn runs() {
    Target { name: "runs", run, seeds: none, memory: (16 << 20, 500), least_taken_percent: 5.0 }.fuzz();
}

fn run(input: &[u8]) -> Answer {
    let record = RunRecord::<serde_json::Value>::from_json(input).map_err(|error| error.to_string())?;
    record.to_json().map_err(|error| error.to_string())?;
    Ok(String::new())
}

#[test]
fn sessions() {
    Target {
        name: "sessions",
        run: session,
        seeds: sessions_after_a_while,
        memory: (64 << 20, 500),
        least_taken_percent: 5.0,
    }
    .fuzz();
}

/// An explorer that goes on with a session.
fn session(input: &[u8]) -> Answer {
    let text = std::str::from_utf8(input).map_err(|error| error.to_string())?;
    let session = Session::parse(text)?;
    let preset = Preset::built_in("tour").unwrap();
    let mut explorer = Explorer::new(preset.explorer, &builtin_robot("turtlebot2").unwrap().traits()).unwrap();
    explorer.recall(&session.memory);
    explorer.set_areas(session.areas);
    let said = a_while(&mut explorer, room(), Pose::new(1.0, 1.0, 0.3), None);
    let kept = explorer.memory();
    serde_json::to_string(&kept).map_err(|error| error.to_string())?;
    explorer.return_home(100.0, "the session");
    Ok(said)
}

fn sessions_after_a_while() -> Vec<(String, Vec<u8>)> {
    let preset = Preset::built_in("tour").unwrap();
    let mut explorer = Explorer::new(preset.explorer, &builtin_robot("turtlebot2").unwrap().traits()).unwrap();
    a_while(&mut explorer, room(), Pose::new(1.0, 1.0, 0.3), None);
    let corners = [[-1.0, -1.0], [4.0, -1.0], [4.0, 3.0], [-1.0, 3.0]];
    let session = serde_json::json!({
        "format": "frontier_explorer session 1",
        "activity": "exploring",
        "preset": "tour",
        "map_frame": "map",
        "elapsed_s": 12.5,
        "distance_m": 3.25,
        "memory": explorer.memory(),
        "areas": {"region": corners, "no_go": [[[2.0, 2.0], [3.0, 2.0], [3.0, 3.0]]]},
    });
    vec![("tour.json".to_owned(), serde_json::to_vec_pretty(&session).unwrap())]
}
