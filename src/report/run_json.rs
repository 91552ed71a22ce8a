//! The file `run.json`: everything about a run that a program may want to read.
//!
//! The schema is stable: keys are added, and [`SCHEMA_VERSION`] grows when one
//! changes its meaning. Of the same run all bytes are the same up to the last key,
//! `wall`, which holds what the computer took and not what the robot did.

use super::ReportError;
use super::series::{ByShare, SeriesPoint};
use crate::explore::{Counts, DecisionRecord, EndReason, LeftBehind, TimeSpent};
use crate::geometry::Pose;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter};
use std::io::{Result as IoResult, Write};

/// The version of the schema that this program writes and reads.
pub const SCHEMA_VERSION: u32 = 1;

/// A run, as `run.json` holds it. `D` is a decision: [`DecisionRecord`] when writing,
/// and when reading whatever the reader wants to know of it, such as
/// [`serde_json::Value`] or [`serde::de::IgnoredAny`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunRecord<D = DecisionRecord> {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// Name of the world, or of what stands for it.
    pub world: String,
    /// Name of the preset.
    pub preset: String,
    /// Name of the robot.
    pub robot: String,
    /// The seed of all random numbers, if there were any.
    pub seed: Option<u64>,
    /// How the simulated robot knew where it was, if that was not the perfect SLAM.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slam: Option<String>,
    /// Where the robot began, metres and radians in the map frame.
    pub start: Pose,
    /// Why the run ended.
    pub end_reason: EndReason,
    /// The same as a sentence.
    pub end_message: String,
    /// Share of the world that was covered, 0..=1.
    pub coverage: f64,
    /// Duration in the robot's own time, seconds.
    pub sim_time_s: f64,
    /// Way driven, metres.
    pub distance_m: f64,
    /// Sum of all turning, radians.
    pub turned_rad: f64,
    /// Goals the robot was sent to.
    pub goals_sent: usize,
    /// Goals that were given up.
    pub goals_failed: usize,
    /// Ticks at which the robot touched an obstacle.
    pub collisions: usize,
    /// Area of the map known to be free or occupied, square metres.
    pub known_area_m2: f64,
    /// Area of the map known to be free, square metres.
    pub free_area_m2: f64,
    /// Seconds until a share of coverage was first reached.
    pub time_to_coverage_s: ByShare,
    /// Metres driven until a share of coverage was first reached.
    pub distance_to_coverage_m: ByShare,
    /// What was done, counted.
    pub counts: Counts,
    /// Where the time went, seconds.
    #[serde(default)]
    pub time_spent: TimeSpent,
    /// What was told on the way: failed goals, stale maps, jumps.
    #[serde(default)]
    pub notices: Vec<Notice>,
    /// Frontiers that were left.
    pub left_behind: LeftBehind,
    /// All decisions in order of time.
    pub decisions: Vec<D>,
    /// Coverage and distance over time.
    pub series: Vec<SeriesPoint>,
    /// What the computer took. The last key, so that it is easily cut off.
    pub wall: Wall,
}

/// Something that was told while the run went on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Notice {
    /// When, in the robot's own time, seconds.
    pub time_s: f64,
    /// A sentence.
    pub text: String,
}

/// What a run took on the computer, in real time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// The whole run, seconds.
    pub total_s: f64,
    /// One decision, milliseconds.
    pub decision_ms: MedianMax,
}

/// The middle and the largest of some measurements.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MedianMax {
    /// The middle one; of an even number, the mean of the two in the middle.
    pub median: f64,
    /// The largest.
    pub max: f64,
}

impl MedianMax {
    /// Of some finite measurements; zeros for none.
    #[must_use]
    pub fn of(values: &[f64]) -> Self {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let at = |i: usize| sorted.get(i).copied().unwrap_or_default();
        let upper = sorted.len() / 2;
        let lower = sorted.len().saturating_sub(1) / 2;
        Self { median: f64::midpoint(at(lower), at(upper)), max: sorted.last().copied().unwrap_or_default() }
    }
}

impl<D: Serialize> RunRecord<D> {
    /// The file's bytes. Numbers are rounded to a millionth, and one decision or one
    /// point of the series is one line.
    ///
    /// # Errors
    /// [`ReportError::NotFinite`] when a number of the run is not finite, which JSON
    /// cannot hold; in decisions such a number becomes null.
    pub fn to_json(&self) -> Result<Vec<u8>, ReportError> {
        self.check_finite()?;
        Ok(to_lines(self)?)
    }

    fn check_finite(&self) -> Result<(), ReportError> {
        let named = [
            ("start", self.start.x + self.start.y + self.start.yaw),
            ("coverage", self.coverage),
            ("sim_time_s", self.sim_time_s),
            ("distance_m", self.distance_m),
            ("turned_rad", self.turned_rad),
            ("known_area_m2", self.known_area_m2),
            ("free_area_m2", self.free_area_m2),
            ("wall", self.wall.total_s + self.wall.decision_ms.median + self.wall.decision_ms.max),
            ("series", self.series.iter().map(|p| p.time_s + p.coverage + p.distance_m).sum()),
            ("time_to_coverage_s", self.time_to_coverage_s.values().flatten().sum()),
            ("distance_to_coverage_m", self.distance_to_coverage_m.values().flatten().sum()),
        ];
        match named.into_iter().find(|(_, value)| !value.is_finite()) {
            Some((field, value)) => Err(ReportError::NotFinite { field, value }),
            None => Ok(()),
        }
    }
}

impl<D: DeserializeOwned> RunRecord<D> {
    /// Reads a file's bytes. Keys that are not known are passed over.
    ///
    /// # Errors
    /// [`ReportError::Json`] when they are no run, [`ReportError::SchemaVersion`] when
    /// they are one of another version.
    pub fn from_json(bytes: &[u8]) -> Result<Self, ReportError> {
        #[derive(Deserialize)]
        struct Version {
            schema_version: u32,
        }
        let Version { schema_version } = serde_json::from_slice(bytes)?;
        if schema_version != SCHEMA_VERSION {
            return Err(ReportError::SchemaVersion { found: schema_version, expected: SCHEMA_VERSION });
        }
        Ok(serde_json::from_slice(bytes)?)
    }
}

/// JSON whose third level and what is deeper stands in one line, with numbers rounded to
/// a millionth.
pub(super) fn to_lines(value: &impl Serialize) -> serde_json::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let formatter = Lines { pretty: PrettyFormatter::new(), depth: 0 };
    value.serialize(&mut serde_json::Serializer::with_formatter(&mut bytes, formatter))?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Indents the first two levels and writes what is deeper in one line; rounds numbers.
struct Lines<'a> {
    pretty: PrettyFormatter<'a>,
    depth: usize,
}

/// The level from which on everything is in one line.
const INLINE_DEPTH: usize = 3;

/// Passes a call on to the formatter that the depth asks for.
macro_rules! by_depth {
    ($($name:ident($($arg:ident: $kind:ty),*) $grows:literal $shrinks:literal;)*) => {$(
        fn $name<W: ?Sized + Write>(&mut self, writer: &mut W, $($arg: $kind),*) -> IoResult<()> {
            self.depth += $grows;
            let result = if self.depth < INLINE_DEPTH {
                self.pretty.$name(writer, $($arg),*)
            } else {
                CompactFormatter.$name(writer, $($arg),*)
            };
            self.depth -= $shrinks;
            result
        }
    )*};
}

impl Formatter for Lines<'_> {
    by_depth! {
        begin_array() 1 0;
        end_array() 0 1;
        begin_array_value(first: bool) 0 0;
        end_array_value() 0 0;
        begin_object() 1 0;
        end_object() 0 1;
        begin_object_key(first: bool) 0 0;
        begin_object_value() 0 0;
        end_object_value() 0 0;
    }

    fn write_f64<W: ?Sized + Write>(&mut self, writer: &mut W, value: f64) -> IoResult<()> {
        let rounded = (value * 1e6).round() / 1e6;
        // Adding zero takes the sign off a negative one.
        let value = if rounded.is_finite() { rounded + 0.0 } else { value };
        self.pretty.write_f64(writer, value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::sample;

    #[test]
    fn the_schema_stays() {
        let json = String::from_utf8(sample::run().to_json().unwrap()).unwrap();
        insta::assert_snapshot!(json);
    }

    #[test]
    fn wall_is_the_last_key() {
        let json = String::from_utf8(sample::run().to_json().unwrap()).unwrap();
        let top: Vec<&str> = json.lines().filter_map(|line| line.strip_prefix("  \"")?.split('"').next()).collect();
        assert_eq!(top.first(), Some(&"schema_version"));
        assert_eq!(top.last(), Some(&"wall"));
        assert_eq!(top.len(), 26);
    }

    #[test]
    fn what_is_written_can_be_read() {
        let run = sample::run();
        let bytes = run.to_json().unwrap();
        let read = RunRecord::<serde_json::Value>::from_json(&bytes).unwrap();
        assert_eq!(read.to_json().map(|again| again.len()).unwrap(), bytes.len());
        assert_eq!((read.end_reason, read.counts, read.left_behind), (run.end_reason, run.counts, run.left_behind));
        assert_eq!(read.time_to_coverage_s, run.time_to_coverage_s);
        assert_eq!((read.decisions.len(), read.series.len()), (run.decisions.len(), run.series.len()));
        RunRecord::<serde::de::IgnoredAny>::from_json(&bytes).unwrap();
    }

    #[test]
    fn other_versions_and_impossible_numbers_are_refused() {
        let error = RunRecord::<serde_json::Value>::from_json(br#"{"schema_version": 2}"#).unwrap_err();
        assert_eq!(error.to_string(), "run.json has schema version 2: must be 1");
        let mut run = sample::run();
        run.distance_m = f64::NAN;
        assert_eq!(run.to_json().unwrap_err().to_string(), "distance_m of the run is NaN: must be finite");
    }

    #[test]
    fn medians() {
        assert_eq!(MedianMax::of(&[]), MedianMax::default());
        assert_eq!(MedianMax::of(&[3.0, 1.0, 2.0]), MedianMax { median: 2.0, max: 3.0 });
        assert_eq!(MedianMax::of(&[4.0, 1.0, 2.0, 3.0]), MedianMax { median: 2.5, max: 4.0 });
    }
}
