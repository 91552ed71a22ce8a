//! The YAML half of a map: the keys that map_server reads.
//!
//! The keys and their meaning are those of <http://wiki.ros.org/map_server#YAML_format>.
//! map_saver's successors add keys of their own, so that unknown ones are passed over;
//! a key given twice is an error.

use super::MapError;
use super::error::read_file;
use crate::geometry::Pose;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::fmt;
use std::path::{Path, PathBuf};

/// The largest YAML file that is looked at, bytes; real ones have about 150.
const MAX_YAML_BYTES: u64 = 1 << 20;

/// How a map's pixels become occupancy values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MapMode {
    /// Occupied, free or unknown, by the two thresholds.
    #[default]
    Trinary,
    /// As trinary, and what lies between the thresholds becomes 1 to 99.
    Scale,
    /// The pixel is the value.
    Raw,
}

impl MapMode {
    /// Every mode.
    pub const ALL: [Self; 3] = [Self::Trinary, Self::Scale, Self::Raw];

    /// The name in map files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trinary => "trinary",
            Self::Scale => "scale",
            Self::Raw => "raw",
        }
    }
}

impl fmt::Display for MapMode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What the YAML file of a map says.
#[derive(Clone, Debug, PartialEq)]
pub struct MapYaml {
    /// The image, as written: relative to the YAML file, or absolute.
    pub image: PathBuf,
    /// Edge length of a pixel, metres.
    pub resolution_m: f64,
    /// The lower left corner of the image in the map frame.
    pub origin_in_map: Pose,
    /// Whether white is occupied and black is free.
    pub negate: bool,
    /// A pixel whose occupancy probability is above this is occupied.
    pub occupied_thresh: f64,
    /// A pixel whose occupancy probability is below this is free.
    pub free_thresh: f64,
    /// How pixels become values.
    pub mode: MapMode,
}

impl MapYaml {
    /// Reads a map's YAML file.
    ///
    /// # Errors
    /// [`MapError`], which names the file, the key, its value and what is allowed.
    pub fn read(path: &Path) -> Result<Self, MapError> {
        let bytes = read_file(path, "the .yaml file of a map", MAX_YAML_BYTES)?;
        if bytes.starts_with(b"\x89PNG") || bytes.starts_with(b"P2") || bytes.starts_with(b"P5") {
            let reason = "it is an image: give the .yaml file that names it".to_owned();
            return Err(MapError::NotYaml { path: path.to_path_buf(), reason });
        }
        let text = std::str::from_utf8(&bytes).map_err(|error| MapError::NotYaml {
            path: path.to_path_buf(),
            reason: format!("byte {} is not UTF-8", error.valid_up_to()),
        })?;
        Self::parse(text, path)
    }

    /// Reads the text of a map's YAML file; `path` is for messages alone.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(text: &str, path: &Path) -> Result<Self, MapError> {
        let keys = Keys { path, map: mapping(text, path)? };
        let (free, occupied) = (keys.number("free_thresh")?, keys.number("occupied_thresh")?);
        if !(0.0 <= free && free < occupied && occupied <= 1.0) {
            return Err(MapError::ThresholdOrder { path: path.to_path_buf(), free, occupied });
        }
        let resolution_m = keys.number("resolution")?;
        if resolution_m <= 0.0 {
            return Err(keys.wrong("resolution", &resolution_m.into(), "a finite number of metres > 0"));
        }
        Ok(Self {
            image: keys.image()?,
            resolution_m,
            origin_in_map: keys.origin()?,
            negate: keys.negate()?,
            occupied_thresh: occupied,
            free_thresh: free,
            mode: keys.mode()?,
        })
    }
}

/// The document as a mapping, or why it is none.
fn mapping(text: &str, path: &Path) -> Result<Map<String, Value>, MapError> {
    let not_yaml = |reason: String| MapError::NotYaml { path: path.to_path_buf(), reason };
    let options = serde_saphyr::options! {
        with_snippet: false,
        non_finite_float_policy: serde_saphyr::options::NonFiniteFloatPolicy::AsString,
    };
    let value: Value = serde_saphyr::from_str_with_options(text, options)
        .map_err(|error| not_yaml(error.to_string().lines().collect::<Vec<_>>().join(" ")))?;
    match value {
        Value::Object(map) => Ok(map),
        other => Err(not_yaml(format!("it holds {}, no keys", shown(&other)))),
    }
}

/// The keys of one file.
struct Keys<'a> {
    path: &'a Path,
    map: Map<String, Value>,
}

impl Keys<'_> {
    fn get(&self, key: &'static str, allowed: &'static str) -> Result<&Value, MapError> {
        self.map.get(key).ok_or_else(|| MapError::MissingKey { path: self.path.to_path_buf(), key, allowed })
    }

    fn wrong(&self, key: &'static str, value: &Value, allowed: &'static str) -> MapError {
        MapError::Value { path: self.path.to_path_buf(), key, value: shown(value), allowed }
    }

    fn number(&self, key: &'static str) -> Result<f64, MapError> {
        const ALLOWED: &str = "a finite number";
        let value = self.get(key, ALLOWED)?;
        finite(value).ok_or_else(|| self.wrong(key, value, ALLOWED))
    }

    fn image(&self) -> Result<PathBuf, MapError> {
        const ALLOWED: &str = "the name of an image file";
        let value = self.get("image", ALLOWED)?;
        let name = value.as_str().filter(|name| !name.is_empty());
        name.map(PathBuf::from).ok_or_else(|| self.wrong("image", value, ALLOWED))
    }

    fn origin(&self) -> Result<Pose, MapError> {
        const ALLOWED: &str = "[x, y, yaw] in finite metres and radians";
        let value = self.get("origin", ALLOWED)?;
        let numbers = value.as_array().map(|list| list.iter().map(finite).collect::<Vec<_>>());
        match numbers.as_deref() {
            Some([Some(x), Some(y), Some(yaw)]) => Ok(Pose::new(*x, *y, *yaw)),
            _ => Err(self.wrong("origin", value, ALLOWED)),
        }
    }

    fn negate(&self) -> Result<bool, MapError> {
        const ALLOWED: &str = "0, 1, false or true";
        let value = self.get("negate", ALLOWED)?;
        match (value.as_bool(), finite(value)) {
            (Some(negate), _) => Ok(negate),
            (None, Some(number)) if number == 0.0 || (number - 1.0).abs() < f64::EPSILON => Ok(number != 0.0),
            _ => Err(self.wrong("negate", value, ALLOWED)),
        }
    }

    fn mode(&self) -> Result<MapMode, MapError> {
        let Some(value) = self.map.get("mode") else { return Ok(MapMode::default()) };
        let mode = MapMode::ALL.into_iter().find(|mode| value.as_str() == Some(mode.name()));
        mode.ok_or_else(|| self.wrong("mode", value, "trinary, scale or raw"))
    }
}

/// A finite number; quoted numbers count, since yaml-cpp takes them too.
fn finite(value: &Value) -> Option<f64> {
    let number = match value {
        Value::String(text) => text.trim().parse().ok(),
        other => other.as_f64(),
    };
    number.filter(|number| number.is_finite())
}

/// A value for a message, cut short.
fn shown(value: &Value) -> String {
    let text = match value {
        Value::Null => "nothing".to_owned(),
        Value::String(text) => format!("'{}'", text.escape_debug()),
        other => other.to_string(),
    };
    if text.chars().count() > 60 { text.chars().take(60).chain("...".chars()).collect() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "image: a.pgm\nresolution: 0.050000\norigin: [-1.5, 2, 0.25]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    fn parse(text: &str) -> Result<MapYaml, MapError> {
        MapYaml::parse(text, Path::new("a.yaml"))
    }

    #[test]
    fn the_keys_of_map_saver_are_read() {
        let yaml = parse(GOOD).unwrap();
        assert_eq!(yaml.image, Path::new("a.pgm"));
        assert_eq!((yaml.resolution_m, yaml.origin_in_map), (0.05, Pose::new(-1.5, 2.0, 0.25)));
        assert_eq!((yaml.occupied_thresh, yaml.free_thresh), (0.65, 0.196));
        assert_eq!((yaml.negate, yaml.mode), (false, MapMode::Trinary));
    }

    #[test]
    fn other_spellings_and_unknown_keys_are_taken() {
        for (from, to) in [("negate: 0", "negate: true"), ("negate: 0", "negate: 1"), ("negate: 0", "negate: '1'")] {
            assert!(parse(&GOOD.replace(from, to)).unwrap().negate, "{to}");
        }
        let yaml = parse(&format!("{GOOD}mode: scale\nbuilding: [1, {{a: b}}]\n")).unwrap();
        assert_eq!(yaml.mode, MapMode::Scale);
        assert_eq!(parse(&GOOD.replace("0.050000", "\"0.05\"")).unwrap().resolution_m, 0.05);
    }

    #[test]
    fn bad_yaml_is_answered_in_one_sentence() {
        for (from, to, expected) in [
            ("image: a.pgm\n", "", "a.yaml has no key 'image': must be the name of an image file"),
            ("a.pgm", "''", "image is '': must be the name of an image file"),
            ("a.pgm", "[1]", "image is [1]: must be"),
            ("resolution: 0.050000\n", "", "no key 'resolution'"),
            ("0.050000", "fine", "resolution is 'fine': must be a finite number"),
            ("0.050000", "0", "resolution is 0.0: must be a finite number of metres > 0"),
            ("0.050000", "-0.05", "resolution is -0.05: must be a finite number of metres > 0"),
            ("0.050000", ".nan", "resolution is '"),
            ("0.050000", ".inf", "must be a finite number"),
            ("0.050000", "", "resolution is nothing: must be a finite number"),
            ("[-1.5, 2, 0.25]", "[1, 2]", "origin is [1,2]: must be [x, y, yaw]"),
            ("[-1.5, 2, 0.25]", "[1, 2, x]", "must be [x, y, yaw]"),
            ("[-1.5, 2, 0.25]", "5", "origin is 5: must be [x, y, yaw]"),
            ("[-1.5, 2, 0.25]", "[1, 2, .inf]", "must be [x, y, yaw] in finite metres and radians"),
            ("negate: 0", "negate: 2", "negate is 2: must be 0, 1, false or true"),
            ("0.65", "0.1", "free_thresh 0.196 and occupied_thresh 0.1: must satisfy"),
            ("0.65", "65", "occupied_thresh 65: must satisfy"),
            ("0.65", "high", "occupied_thresh is 'high'"),
            ("negate: 0", "negate: 0\nmode: binary", "mode is 'binary': must be trinary, scale or raw"),
            ("negate: 0", "negate: 0\nnegate: 0", "a.yaml is not the YAML of a map: "),
            ("negate: 0", "negate: [", "a.yaml is not the YAML of a map: "),
            (GOOD, "just words", "it holds 'just words', no keys"),
            (GOOD, "", "it holds nothing, no keys"),
        ] {
            let message = parse(&GOOD.replacen(from, to, 1)).unwrap_err().to_string();
            assert!(message.contains(expected), "{to:?}: {message}");
            assert!(message.contains("a.yaml") && !message.contains('\n'), "{message}");
        }
    }
}
