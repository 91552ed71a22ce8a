//! The map's file: tried at the start, written at the end, and what is wrong with it is
//! known all the while.

use crate::io::{MapError, MapImage, SaveOptions, SavedPaths, check_map_path, save_map};
use crate::ros::log::{Level, Log};
use crate::ros::map_feed::{MapReader, ReceivedMap};
use crate::ros::troubles::{Trouble, Troubles};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// Saves the newest map where the parameters want it. It asks no master, and may be used
/// by any thread.
pub struct MapSaver {
    file: String,
    maps: MapReader,
    log: Log,
    troubles: Troubles,
    /// The version of the map that was saved last, and its file; held while one is being saved.
    saved: Mutex<Option<(u64, String)>>,
}

impl MapSaver {
    /// A saver for `~map_file`; without a name it saves nothing.
    pub fn new(file: &str, maps: MapReader, log: &Log, troubles: &Troubles) -> Self {
        Self { file: file.to_owned(), maps, log: log.clone(), troubles: troubles.clone(), saved: Mutex::new(None) }
    }

    /// Tries whether the map could be saved now, and says so when it could not. The node
    /// goes on: the folder may still come, and the map is tried again at the end.
    pub fn check(&self) {
        if self.file.is_empty() {
            return;
        }
        match check_map_path(Path::new(&self.file), MapImage::default()) {
            Ok(_) => {
                self.troubles.clear(Trouble::MapFile);
            }
            Err(error) => {
                let text = format_args!(
                    "the map could not be saved as ~map_file says: {error}; let this user write there, or set \
                     ~map_file elsewhere"
                );
                self.troubles.report(Trouble::MapFile, Level::Error, text);
            }
        }
    }

    /// Looks again at a file that could not be written, as folders come and go.
    pub fn check_again(&self) {
        if self.troubles.text(Trouble::MapFile).is_some() {
            self.check();
        }
    }

    /// Saves the newest map, unless it is saved already. Returns the YAML file, if one is
    /// wanted.
    ///
    /// # Errors
    /// A sentence when the map is lost.
    pub fn save(&self) -> Result<Option<String>, String> {
        if self.file.is_empty() {
            return Ok(None);
        }
        let mut saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        let (Some((version, file)), Some(map)) = (&*saved, self.maps.newest()) else {
            return self.write(&mut saved);
        };
        if *version == map.changes.version() { Ok(Some(file.clone())) } else { self.write(&mut saved) }
    }

    /// Saves the newest map in another place, as an order wants it; returns the YAML file.
    ///
    /// # Errors
    /// A sentence when it cannot be saved.
    pub fn save_elsewhere(&self, file: &str) -> Result<String, String> {
        let map = self.maps.newest().ok_or_else(|| format!("no map has come that could be saved as {file}"))?;
        let paths = save_as(file, &map).map_err(|error| format!("the map is not saved: {error}"))?;
        self.log.info(format_args!("saved {} and {}", paths.yaml.display(), paths.image.display()));
        Ok(paths.yaml.display().to_string())
    }

    fn write(&self, saved: &mut Option<(u64, String)>) -> Result<Option<String>, String> {
        let version = self.maps.newest().map(|map| map.changes.version());
        let written = self.save_elsewhere(&self.file);
        match &written {
            Ok(file) => {
                *saved = version.map(|version| (version, file.clone()));
                self.troubles.clear(Trouble::MapFile);
            }
            Err(why) => self.troubles.report(Trouble::MapFile, Level::Error, why),
        }
        written.map(Some)
    }
}

/// Saves a map in map_server's format, as the node and the command line do.
///
/// # Errors
/// [`MapError`] with the file.
pub fn save_as(path: &str, map: &ReceivedMap) -> Result<SavedPaths, MapError> {
    save_map(Path::new(path), &map.grid, &SaveOptions::default())
}
