//! Writing a map as map_saver does.
//!
//! 254 where 0 <= value <= free, 0 where value >= occupied, 205 everywhere else, which
//! map_server's own thresholds read back as free, occupied and unknown. The keys of
//! the YAML file and their order are map_saver's, its six decimals too where they hold
//! the number exactly; elsewhere as many digits as the number needs. The image is
//! named without its directory, so that the two files can be moved together.

use super::atomic::check_writable;
use super::{MapError, write_atomic};
use crate::grid::{CellState, GridInfo, OccupancyGrid, Thresholds};
use image::{ExtendedColorType, ImageFormat};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// Kinds of image that a map can be saved with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MapImage {
    /// A binary greymap, as map_saver writes it.
    #[default]
    Pgm,
    /// A grey PNG, for tools that know no greymaps.
    Png,
}

impl MapImage {
    /// The ending of the file's name.
    #[must_use]
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Pgm => "pgm",
            Self::Png => "png",
        }
    }
}

/// How to save a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SaveOptions {
    /// map_saver's `--free` and `--occ`, 25 and 65 when nothing is said.
    pub thresholds: Thresholds,
    /// What to save the cells as.
    pub image: MapImage,
}

impl Default for SaveOptions {
    fn default() -> Self {
        Self { thresholds: Thresholds { free_max: 25, occupied_min: 65 }, image: MapImage::default() }
    }
}

/// The two files of a saved map.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SavedPaths {
    /// The YAML file.
    pub yaml: PathBuf,
    /// The image beside it.
    pub image: PathBuf,
}

/// Saves a map as `PATH.yaml` with its image beside it; a `PATH` that ends in `.yaml`
/// or `.yml` is taken as it is. Each file appears whole, the image first.
///
/// # Errors
/// [`MapError`] for thresholds out of order, a path that is no file name, and what the
/// file system refuses.
pub fn save_map(path: &Path, grid: &OccupancyGrid, options: &SaveOptions) -> Result<SavedPaths, MapError> {
    options.thresholds.validate()?;
    let (paths, image_name) = saved_paths(path, options.image)?;
    let pixels = pixels(grid, &options.thresholds);
    let image = match options.image {
        MapImage::Pgm => pgm(grid.info(), &pixels),
        MapImage::Png => png(grid.info(), &pixels)
            .map_err(|error| MapError::Encode { path: paths.image.clone(), reason: error.to_string() })?,
    };
    let write = |path: &Path, bytes: &[u8]| {
        write_atomic(path, bytes).map_err(|source| MapError::Write { path: path.to_path_buf(), source })
    };
    write(&paths.image, &image)?;
    write(&paths.yaml, yaml(grid.info(), &image_name).as_bytes())?;
    Ok(paths)
}

/// Tries whether [`save_map`] could write there now, and leaves nothing behind.
///
/// # Errors
/// [`MapError`] for a path that is no file name, and what the file system refuses.
pub fn check_map_path(path: &Path, image: MapImage) -> Result<SavedPaths, MapError> {
    let (paths, _) = saved_paths(path, image)?;
    for path in [&paths.image, &paths.yaml] {
        check_writable(path).map_err(|source| MapError::Write { path: path.clone(), source })?;
    }
    Ok(paths)
}

/// The two files of a map, and the image's name in the YAML file. A device or a pipe is
/// not one of them: it cannot hold both.
fn saved_paths(path: &Path, image: MapImage) -> Result<(SavedPaths, String), MapError> {
    let nameless = || MapError::SaveName { path: path.to_path_buf() };
    let name = path.file_name().and_then(|name| name.to_str()).ok_or_else(nameless)?;
    let stem = [".yaml", ".yml"].iter().find_map(|end| name.strip_suffix(end)).unwrap_or(name);
    if stem.is_empty() || path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(nameless());
    }
    let yaml_name = if stem == name { format!("{stem}.yaml") } else { name.to_owned() };
    let image_name = format!("{stem}.{}", image.extension());
    let paths = SavedPaths { yaml: path.with_file_name(yaml_name), image: path.with_file_name(&image_name) };
    // A pipe without a reader would keep its writer waiting for ever.
    let is_special = |path: &Path| std::fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir());
    if let Some(special) = [path, &paths.image, &paths.yaml].into_iter().find(|path| is_special(path)) {
        let (found, expected) = ("a device or a pipe", "a name for the two files of a map");
        return Err(MapError::NotAFile { path: special.to_path_buf(), found, expected });
    }
    Ok((paths, image_name))
}

/// One grey a cell, top row first.
fn pixels(grid: &OccupancyGrid, thresholds: &Thresholds) -> Vec<u8> {
    let grey = |&value: &i8| match thresholds.classify(value) {
        CellState::Free => 254,
        CellState::Occupied => 0,
        CellState::Unknown | CellState::Unsettled => 205,
    };
    grid.data().chunks_exact(grid.info().width()).rev().flatten().map(grey).collect()
}

fn pgm(info: &GridInfo, pixels: &[u8]) -> Vec<u8> {
    let header = format!(
        "P5\n# CREATOR: frontier_explorer {:.3} m/pix\n{} {}\n255\n",
        info.resolution_m(),
        info.width(),
        info.height()
    );
    [header.as_bytes(), pixels].concat()
}

fn png(info: &GridInfo, pixels: &[u8]) -> image::ImageResult<Vec<u8>> {
    let mut bytes = Vec::new();
    let (width, height) = (info.width() as u32, info.height() as u32);
    let out = &mut Cursor::new(&mut bytes);
    image::write_buffer_with_format(out, pixels, width, height, ExtendedColorType::L8, ImageFormat::Png)?;
    Ok(bytes)
}

fn yaml(info: &GridInfo, image_name: &str) -> String {
    let origin = info.origin_in_map();
    format!(
        "image: {}\nresolution: {}\norigin: [{}, {}, {}]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n\n",
        scalar(image_name),
        number(info.resolution_m()),
        number(origin.x),
        number(origin.y),
        number(origin.yaw)
    )
}

/// Six decimals, or as many as it takes to read the same number back.
fn number(value: f64) -> String {
    let six = format!("{value:.6}");
    if six.parse() == Ok(value) { six } else { value.to_string() }
}

/// A file name as YAML: bare when nothing in it could mean anything, else quoted.
fn scalar(name: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '-');
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(is_plain) {
        name.to_owned()
    } else {
        // A JSON string is a YAML string.
        serde_json::Value::from(name).to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Pose;
    use crate::io::load_map;
    use proptest::prelude::*;

    fn grid(width: u32, resolution_m: f64, origin: Pose, values: &[i8]) -> OccupancyGrid {
        let info = GridInfo::new(width, values.len() as u32 / width, resolution_m, origin).unwrap();
        OccupancyGrid::new(info, values.to_vec()).unwrap()
    }

    #[test]
    fn the_files_are_map_savers() {
        let dir = tempfile::tempdir().unwrap();
        let grid = grid(3, 0.05, Pose::new(-1.0, 2.5, 0.0), &[0, 25, 26, 64, 65, 100, -1, -1, 0]);
        let paths = save_map(&dir.path().join("lab"), &grid, &SaveOptions::default()).unwrap();
        assert_eq!(paths.yaml, dir.path().join("lab.yaml"));
        assert_eq!(
            std::fs::read(&paths.image).unwrap(),
            b"P5\n# CREATOR: frontier_explorer 0.050 m/pix\n3 3\n255\n\xcd\xcd\xfe\xcd\x00\x00\xfe\xfe\xcd"
        );
        assert_eq!(
            std::fs::read_to_string(&paths.yaml).unwrap(),
            "image: lab.pgm\nresolution: 0.050000\norigin: [-1.000000, 2.500000, 0.000000]\nnegate: 0\n\
             occupied_thresh: 0.65\nfree_thresh: 0.196\n\n"
        );
    }

    #[test]
    fn thresholds_are_map_savers_options() {
        let dir = tempfile::tempdir().unwrap();
        let thresholds = Thresholds { free_max: 49, occupied_min: 50 };
        let grid = grid(3, 1.0, Pose::default(), &[49, 50, -1]);
        let options = SaveOptions { thresholds, ..SaveOptions::default() };
        let paths = save_map(&dir.path().join("a.v2.yaml"), &grid, &options).unwrap();
        assert_eq!(paths.image, dir.path().join("a.v2.pgm"));
        assert_eq!(load_map(&paths.yaml).unwrap().grid.data(), &[0, 100, -1]);
        let thresholds = Thresholds { free_max: 50, occupied_min: 50 };
        let options = SaveOptions { thresholds, ..SaveOptions::default() };
        let message = save_map(&dir.path().join("b"), &grid, &options).unwrap_err().to_string();
        assert!(message.contains("free_max 50 and occupied_min 50"), "{message}");
    }

    #[test]
    fn odd_names_and_png_are_read_back() {
        let dir = tempfile::tempdir().unwrap();
        let grid = grid(2, 1.0, Pose::default(), &[0, 100]);
        let options = SaveOptions { image: MapImage::Png, ..SaveOptions::default() };
        for name in ["my map: #1", "12", "\"quoted\"", "karte-ö", "- x", "null"] {
            let paths = save_map(&dir.path().join(name), &grid, &options).unwrap();
            assert_eq!(load_map(&paths.yaml).unwrap().grid, grid, "{name}");
        }
    }

    #[test]
    fn paths_that_are_no_names_are_refused() {
        let grid = grid(2, 1.0, Pose::default(), &[0, 100]);
        for path in ["", "/", "..", "a/.yaml", "a/"] {
            let message = save_map(Path::new(path), &grid, &SaveOptions::default()).unwrap_err().to_string();
            assert!(message.contains("must end in a file name"), "{path}: {message}");
        }
        let message = save_map(Path::new("/nowhere/x/map"), &grid, &SaveOptions::default()).unwrap_err().to_string();
        assert!(message.contains("cannot write /nowhere/x/map.pgm"), "{message}");
        let message = save_map(Path::new("/dev/null"), &grid, &SaveOptions::default()).unwrap_err().to_string();
        assert_eq!(message, "/dev/null is a device or a pipe: must be a name for the two files of a map");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_in_the_place_of_an_image_is_refused_and_not_waited_for() {
        let dir = tempfile::tempdir().unwrap();
        let pipe = dir.path().join("lab.pgm");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let grid = grid(2, 1.0, Pose::default(), &[0, 100]);
        let saved = save_map(&dir.path().join("lab"), &grid, &SaveOptions::default()).unwrap_err().to_string();
        assert!(saved.contains("lab.pgm is a device or a pipe"), "{saved}");
        assert!(check_map_path(&dir.path().join("lab"), MapImage::Pgm).is_err());
    }

    #[test]
    fn where_a_map_cannot_be_saved_is_known_before() {
        let dir = tempfile::tempdir().unwrap();
        let tried = check_map_path(&dir.path().join("lab"), MapImage::Pgm).unwrap();
        assert_eq!(tried.image, dir.path().join("lab.pgm"));
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0, "nothing is left behind");
        let message = check_map_path(Path::new("/nowhere/x/map"), MapImage::Pgm).unwrap_err().to_string();
        assert!(message.starts_with("cannot write /nowhere/x/map.pgm"), "{message}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn what_was_written_is_read(
            (width, values) in (1u32..20, 1u32..20).prop_flat_map(|(w, h)| {
                let value = prop_oneof![Just(-1_i8), Just(0), Just(100)];
                (Just(w), proptest::collection::vec(value, (w * h) as usize))
            }),
            resolution_m in prop_oneof![Just(0.05), 1e-4f64..10.0],
            x in prop_oneof![Just(-12.2), -1e6f64..1e6],
            y in -1e-6f64..1e-6,
            yaw in -4.0f64..4.0,
            image in prop_oneof![Just(MapImage::Pgm), Just(MapImage::Png)],
        ) {
            let dir = tempfile::tempdir().unwrap();
            let written = grid(width, resolution_m, Pose::new(x, y, yaw), &values);
            let options = SaveOptions { image, ..SaveOptions::default() };
            let paths = save_map(&dir.path().join("map"), &written, &options).unwrap();
            prop_assert_eq!(load_map(&paths.yaml).unwrap().grid, written);
        }
    }
}
