//! The worlds of `maps/`, carried in the library so that their names work wherever it
//! runs.

use super::map_load::{load_map, map_from_bytes};
use super::settings::is_like_a_path;
use super::{MapError, file_stem};
use crate::config::hint;
use crate::grid::OccupancyGrid;
use std::path::Path;

/// Name, YAML and image of each.
macro_rules! built_in {
    ($($name:literal),*) => {
        /// The names of the built-in worlds.
        pub const BUILT_IN_WORLDS: [&str; [$($name),*].len()] = [$($name),*];

        const FILES: [(&str, &str, &[u8]); BUILT_IN_WORLDS.len()] = [$((
            $name,
            include_str!(concat!("../../maps/", $name, ".yaml")),
            include_bytes!(concat!("../../maps/", $name, ".pgm")),
        )),*];
    };
}

built_in!("office", "museum", "maze", "warehouse");

/// The ground truth of a world and its name: a built-in one, or a map_server map.
///
/// # Errors
/// [`MapError`] for a file that cannot be read as a map.
pub fn load_world(name_or_file: &str) -> Result<(OccupancyGrid, String), MapError> {
    match FILES.iter().find(|(name, ..)| *name == name_or_file) {
        Some((name, yaml, image)) => Ok((map_from_bytes(name, yaml, image)?.grid, (*name).to_owned())),
        None => {
            let path = Path::new(name_or_file);
            if !is_like_a_path(name_or_file) && !path.exists() {
                let hint = hint(name_or_file, BUILT_IN_WORLDS.into_iter());
                let (name, known) = (name_or_file.to_owned(), BUILT_IN_WORLDS.join(", "));
                return Err(MapError::NoSuchWorld { name, known, hint });
            }
            Ok((load_map(path)?.grid, file_stem(name_or_file)))
        }
    }
}
