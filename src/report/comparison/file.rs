//! The JSON file of a comparison, and how files of its parts become one.
//!
//! Of the same comparison all bytes are the same up to the last key, `wall`, whether
//! it was made at once or merged from parts.

use super::liang::LiangTable;
use super::summary::Summary;
use super::{ComparedRun, Comparison, ComparisonPlan};
use crate::report::run_json::{Wall, to_lines};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// The version of the schema that this program writes and reads.
pub const COMPARISON_SCHEMA_VERSION: u32 = 1;

/// A comparison that cannot be read, written or merged.
#[derive(Debug, thiserror::Error)]
pub enum ComparisonError {
    /// Not the JSON of a comparison.
    #[error("not the results of a comparison: {0}")]
    Json(#[from] serde_json::Error),
    /// A file of another time.
    #[error("the results have schema version {found}: must be {COMPARISON_SCHEMA_VERSION}")]
    SchemaVersion {
        /// The version that the file names.
        found: u32,
    },
    /// A run that the plan does not have.
    #[error("run {index} of preset {preset:?} in world {world:?} is not in the plan")]
    NotPlanned {
        /// Its place.
        index: usize,
        /// Its preset.
        preset: String,
        /// Its world.
        world: String,
    },
    /// A run that is there twice.
    #[error("run {index} is there twice: parts must not overlap")]
    Twice {
        /// Its place.
        index: usize,
    },
    /// A covered share that is none.
    #[error("coverage of run {index} is {coverage}: must be >= 0 and <= 1")]
    Coverage {
        /// Its place.
        index: usize,
        /// Its coverage.
        coverage: f64,
    },
    /// Not one entry of `wall` for each run.
    #[error("wall has {found} entries: must be {expected}, one for each run")]
    Wall {
        /// How many there are.
        found: usize,
        /// How many runs there are.
        expected: usize,
    },
    /// Parts of different comparisons.
    #[error("its {what} are not those of the first part: parts must come from one comparison")]
    OtherPlan {
        /// What differs.
        what: &'static str,
    },
}

/// The file when written.
#[derive(Serialize)]
struct Written<'a> {
    schema_version: u32,
    plan: &'a ComparisonPlan,
    summaries: Vec<Summary>,
    summaries_by_world: Vec<Summary>,
    liang_table_1: Option<LiangTable>,
    runs: &'a [ComparedRun],
    wall: Vec<Wall>,
}

/// The file when read: what can be computed again is not looked at.
#[derive(Deserialize)]
struct Read {
    plan: ComparisonPlan,
    runs: Vec<ComparedRun>,
    wall: Vec<Wall>,
}

#[derive(Deserialize)]
struct Version {
    schema_version: u32,
}

impl Comparison {
    /// The file's bytes; one run is one line.
    ///
    /// # Errors
    /// [`ComparisonError::Json`] when it cannot be written.
    pub fn to_json(&self) -> Result<Vec<u8>, ComparisonError> {
        Ok(to_lines(&Written {
            schema_version: COMPARISON_SCHEMA_VERSION,
            plan: &self.plan,
            summaries: self.summaries(),
            summaries_by_world: self.summaries_by_world(),
            liang_table_1: LiangTable::of(self),
            runs: &self.runs,
            wall: self.runs.iter().map(|run| run.wall).collect(),
        })?)
    }

    /// Reads and validates a file's bytes.
    ///
    /// # Errors
    /// [`ComparisonError`] that says what is wrong.
    pub fn from_json(bytes: &[u8]) -> Result<Self, ComparisonError> {
        let Version { schema_version } = serde_json::from_slice(bytes)?;
        if schema_version != COMPARISON_SCHEMA_VERSION {
            return Err(ComparisonError::SchemaVersion { found: schema_version });
        }
        let Read { plan, mut runs, wall } = serde_json::from_slice(bytes)?;
        if wall.len() != runs.len() {
            return Err(ComparisonError::Wall { found: wall.len(), expected: runs.len() });
        }
        for (run, wall) in runs.iter_mut().zip(wall) {
            run.wall = wall;
        }
        let mut comparison = Self { plan, runs: Vec::new() };
        comparison.add(runs)?;
        Ok(comparison)
    }

    /// Takes in another part of the same comparison.
    ///
    /// # Errors
    /// [`ComparisonError`] when the parts have different plans or a run in common.
    pub fn merge(&mut self, part: Self) -> Result<(), ComparisonError> {
        let (ours, theirs) = (&self.plan, &part.plan);
        let same = [
            ("robot and time limit", (&ours.robot, ours.time_limit_s) == (&theirs.robot, theirs.time_limit_s)),
            ("SLAM", ours.slam == theirs.slam),
            ("presets", ours.presets == theirs.presets),
            ("worlds", ours.worlds == theirs.worlds),
            ("seeds", ours.seeds == theirs.seeds),
        ];
        if let Some((what, _)) = same.into_iter().find(|(_, same)| !same) {
            return Err(ComparisonError::OtherPlan { what });
        }
        self.add(part.runs)
    }

    /// Puts runs in their places.
    fn add(&mut self, added: Vec<ComparedRun>) -> Result<(), ComparisonError> {
        let planned = self.plan.runs();
        let mut runs: BTreeMap<usize, ComparedRun> =
            std::mem::take(&mut self.runs).into_iter().map(|run| (run.index, run)).collect();
        for run in added {
            let index = run.index;
            let fits = planned.get(index).is_some_and(|place| {
                let preset = self.plan.presets.get(place.preset).map(|preset| preset.name.as_str());
                let world = self.plan.worlds.get(place.world).map(|world| world.name.as_str());
                (preset, world) == (Some(&run.preset), Some(&run.world))
                    && (place.start + 1, place.seed) == (run.start_number, run.seed)
            });
            if !fits {
                return Err(ComparisonError::NotPlanned { index, preset: run.preset, world: run.world });
            }
            if !(0.0..=1.0).contains(&run.coverage) {
                return Err(ComparisonError::Coverage { index, coverage: run.coverage });
            }
            match runs.entry(index) {
                Entry::Occupied(_) => return Err(ComparisonError::Twice { index }),
                Entry::Vacant(place) => place.insert(run),
            };
        }
        self.runs = runs.into_values().collect();
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    fn whole() -> Comparison {
        sample::comparison(sample::plan(&["a", "b"], &["one", "two"], &[1, 2]), |p| [100.0, 200.0][p])
    }

    fn part(number: usize, of: usize) -> Comparison {
        let Comparison { plan, runs } = whole();
        Comparison { plan, runs: runs.into_iter().filter(|run| run.index % of == number).collect() }
    }

    #[test]
    fn what_is_written_can_be_read_and_parts_make_the_whole() {
        let bytes = whole().to_json().unwrap();
        assert_eq!(Comparison::from_json(&bytes).unwrap(), whole());
        let mut merged = part(2, 3);
        merged.merge(part(0, 3)).unwrap();
        assert_eq!(merged.missing(), 3);
        merged.merge(Comparison::from_json(&part(1, 3).to_json().unwrap()).unwrap()).unwrap();
        assert_eq!(merged.to_json().unwrap(), bytes);
    }

    #[test]
    fn wall_is_the_last_key() {
        let json = String::from_utf8(whole().to_json().unwrap()).unwrap();
        let top: Vec<&str> = json.lines().filter_map(|line| line.strip_prefix("  \"")?.split('"').next()).collect();
        assert_eq!((top.first(), top.last()), (Some(&"schema_version"), Some(&"wall")));
        assert!(!json.split_once("\n  \"wall\"").unwrap().0.contains("decision"));
    }

    #[test]
    fn parts_that_do_not_fit_are_refused() {
        let error = |part: Comparison| whole().merge(part).unwrap_err().to_string();
        assert_eq!(error(part(0, 8)), "run 0 is there twice: parts must not overlap");
        let mut other = part(0, 2);
        other.plan.seeds = vec![1, 3];
        assert_eq!(error(other), "its seeds are not those of the first part: parts must come from one comparison");
    }

    #[test]
    fn files_are_validated() {
        let error = |change: &dyn Fn(&mut serde_json::Value)| {
            let mut value = serde_json::from_slice(&whole().to_json().unwrap()).unwrap();
            change(&mut value);
            Comparison::from_json(value.to_string().as_bytes()).unwrap_err().to_string()
        };
        assert_eq!(error(&|v| v["schema_version"] = 2.into()), "the results have schema version 2: must be 1");
        assert_eq!(error(&|v| v["wall"] = serde_json::json!([])), "wall has 0 entries: must be 8, one for each run");
        let unplanned = error(&|v| v["runs"][0]["preset"] = "c".into());
        assert_eq!(unplanned, "run 0 of preset \"c\" in world \"one\" is not in the plan");
        assert_eq!(
            error(&|v| v["runs"][3]["coverage"] = 1.5.into()),
            "coverage of run 3 is 1.5: must be >= 0 and <= 1"
        );
        assert!(error(&|v| v["runs"] = 1.into()).starts_with("not the results of a comparison"));
    }
}
