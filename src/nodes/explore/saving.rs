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
    /// The version of the map that was saved last; held while one is being saved.
    saved: Mutex<Option<u64>>,
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

    /// Saves the newest map, unless it is saved already; whether nothing is lost.
    pub fn save(&self) -> bool {
        if self.file.is_empty() {
            return true;
        }
        let mut saved = self.saved.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(map) = self.maps.newest() else {
            return self.fail(&format!("no map has come that could be saved as {}", self.file));
        };
        if *saved == Some(map.changes.version()) {
            return true;
        }
        match save_as(&self.file, &map) {
            Ok(paths) => {
                *saved = Some(map.changes.version());
                self.troubles.clear(Trouble::MapFile);
                self.log.info(format_args!("saved {} and {}", paths.yaml.display(), paths.image.display()));
                true
            }
            Err(error) => self.fail(&format!("the map is not saved: {error}")),
        }
    }

    fn fail(&self, why: &str) -> bool {
        self.troubles.report(Trouble::MapFile, Level::Error, why);
        false
    }
}

/// Saves a map in map_server's format, as the node and the command line do.
///
/// # Errors
/// [`MapError`] with the file.
pub fn save_as(path: &str, map: &ReceivedMap) -> Result<SavedPaths, MapError> {
    save_map(Path::new(path), &map.grid, &SaveOptions::default())
}
