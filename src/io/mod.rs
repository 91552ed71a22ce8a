//! Files: map_server maps, and writing that is never seen half done (the rim).
//!
//! A map is a YAML file that names an image. The image's first row is the top of the
//! map and the grid's first row its bottom: the rows are turned over here, on the way
//! in and on the way out, and nowhere else.

mod atomic;
mod atomic_file;
mod destination;
mod error;
mod image_file;
mod map_load;
mod map_save;
mod map_yaml;
mod pgm;
mod process_use;
mod settings;
mod text_file;
mod worlds;

pub use atomic::{clear_stale, create_folder, write_atomic};
pub use atomic_file::AtomicFile;
pub use error::MapError;
pub use map_load::{LoadedMap, load_map};
pub use map_save::{MapImage, SaveOptions, SavedPaths, check_map_path, save_map};
pub use map_yaml::{MapMode, MapYaml};
pub use process_use::{ProcessUse, ProcessUseError};
pub use settings::{SettingsFileError, file_stem, load_preset, load_robot};
pub use text_file::{read_bytes, read_if_there, read_text};
pub use worlds::{BUILT_IN_WORLDS, load_world};
