//! Reading a map as map_server does.
//!
//! A pixel's lightness v (0..=255, mean of its channels) gives the occupancy
//! probability p = (255 - v) / 255, or v / 255 with `negate`. Then p > occupied_thresh
//! is 100 and p < free_thresh is 0, both strict, as `image_loader.cpp` compares them;
//! what lies between is unknown in trinary mode and 1 + 98 (p - free) / (occupied -
//! free), cut to an integer, in scale mode. Trinary mode averages the alpha channel in
//! with the colours; the others leave it out, and scale mode takes a wholly transparent
//! pixel between the thresholds for unknown. Raw mode takes v (or 255 - v) for the
//! value itself, as a signed byte: 205 is -51, which is unknown as every negative is.
//!
//! One thing is not copied: map_server reads the blue of an image without alpha as its
//! transparency in scale mode.

use super::image_file::{Channels, MapPixels, decode_image, read_image};
use super::{MapError, MapMode, MapYaml};
use crate::grid::{GridInfo, OccupancyGrid};
use std::path::{Path, PathBuf};

/// A map and where it came from.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadedMap {
    /// The map.
    pub grid: OccupancyGrid,
    /// The image file that was read.
    pub image_path: PathBuf,
    /// What the YAML file said.
    pub yaml: MapYaml,
}

/// Reads a map by its YAML file; the image's name is relative to that file.
///
/// # Errors
/// [`MapError`], one sentence that names the file and what is wrong with it. Sizes are
/// checked before memory is asked for.
pub fn load_map(path: &Path) -> Result<LoadedMap, MapError> {
    let yaml = MapYaml::read(path)?;
    let image_path = path.parent().unwrap_or(Path::new("")).join(&yaml.image);
    let pixels = read_image(&image_path)?;
    assemble(yaml, &pixels, path, image_path)
}

/// A map from the bytes of its two files, as they were built into a program; `name`
/// stands for the path in messages.
///
/// # Errors
/// As [`load_map`].
pub(super) fn map_from_bytes(name: &str, yaml: &str, image: &[u8]) -> Result<LoadedMap, MapError> {
    let path = Path::new(name);
    let yaml = MapYaml::parse(yaml, path)?;
    let image_path = yaml.image.clone();
    let pixels = decode_image(image, &image_path)?;
    assemble(yaml, &pixels, path, image_path)
}

/// The grid that pixels stand for under the rules of a map's YAML file.
fn assemble(yaml: MapYaml, pixels: &MapPixels, path: &Path, image_path: PathBuf) -> Result<LoadedMap, MapError> {
    let info = GridInfo::new(pixels.width, pixels.height, yaml.resolution_m, yaml.origin_in_map)
        .map_err(|source| MapError::Grid { path: path.to_path_buf(), source })?;
    let rule = Rule { yaml: &yaml };
    let width = info.width();
    let data = match &pixels.channels {
        Channels::Grey(greys) => {
            let mut table = [0_i8; 256];
            for (grey, value) in (0_u8..=255).zip(&mut table) {
                *value = rule.value(f64::from(grey), false);
            }
            bottom_row_first(greys, width, |&grey| table[usize::from(grey)])
        }
        Channels::Rgb(colours) => bottom_row_first(colours, width, |rgb| rule.value(mean(rgb), false)),
        Channels::Rgba(colours) => bottom_row_first(colours, width, |rgba| {
            let [red, green, blue, alpha] = *rgba;
            let averaged = yaml.mode == MapMode::Trinary;
            rule.value(if averaged { mean(rgba) } else { mean(&[red, green, blue]) }, alpha == 0)
        }),
    };
    let grid = OccupancyGrid::new(info, data)
        .map_err(|error| MapError::Image { path: image_path.clone(), reason: error.to_string() })?;
    Ok(LoadedMap { grid, image_path, yaml })
}

/// Turns the rows over and each pixel into its value.
fn bottom_row_first<P>(pixels: &[P], width: usize, value: impl Fn(&P) -> i8) -> Vec<i8> {
    pixels.chunks_exact(width).rev().flatten().map(value).collect()
}

fn mean(samples: &[u8]) -> f64 {
    samples.iter().map(|&sample| f64::from(sample)).sum::<f64>() / samples.len() as f64
}

/// How this map's pixels become values.
struct Rule<'a> {
    yaml: &'a MapYaml,
}

impl Rule<'_> {
    fn value(&self, lightness: f64, is_transparent: bool) -> i8 {
        let MapYaml { occupied_thresh, free_thresh, mode, negate, .. } = *self.yaml;
        let lightness = if negate { 255.0 - lightness } else { lightness };
        if mode == MapMode::Raw {
            return (lightness as u8).cast_signed();
        }
        let occupancy = (255.0 - lightness) / 255.0;
        if occupancy > occupied_thresh {
            OccupancyGrid::OCCUPIED
        } else if occupancy < free_thresh {
            OccupancyGrid::FREE
        } else if mode == MapMode::Trinary || is_transparent {
            OccupancyGrid::UNKNOWN
        } else {
            (1.0 + 98.0 * (occupancy - free_thresh) / (occupied_thresh - free_thresh)) as i8
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Cell;
    use image::{ExtendedColorType, ImageFormat};
    use proptest::prelude::*;

    const YAML: &str = "image: a.img\nresolution: 0.5\norigin: [-1.0, 2.0, 0.5]\nnegate: 0\n\
                        occupied_thresh: 0.65\nfree_thresh: 0.196\n";

    fn load(yaml: &str, image: &[u8]) -> Result<LoadedMap, MapError> {
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("a.yaml"), yaml).unwrap();
        std::fs::write(dir.path().join("a.img"), image).unwrap();
        load_map(&dir.path().join("a.yaml"))
    }

    fn values(extra: &str, image: &[u8]) -> Vec<i8> {
        load(&format!("{YAML}{extra}"), image).unwrap().grid.data().to_vec()
    }

    fn png(samples: &[u8], width: u32, colour: ExtendedColorType) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut out = std::io::Cursor::new(&mut bytes);
        image::write_buffer_with_format(&mut out, samples, width, 1, colour, ImageFormat::Png).unwrap();
        bytes
    }

    /// Makes the checksum of a PNG's first chunk right again.
    fn sign_header(png: &mut [u8]) {
        let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
        let crc = png[12..29].iter().fold(!0_u32, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc)));
        png[29..33].copy_from_slice(&(!crc).to_be_bytes());
    }

    #[test]
    fn the_top_row_of_the_image_is_the_last_of_the_grid() {
        let map = load(YAML, b"P5 3 2 255\n\x00\xfe\xcd\xfe\xfe\x00").unwrap();
        assert_eq!(map.grid.data(), &[0, 0, 100, 100, 0, -1]);
        assert_eq!(map.grid.get(Cell::new(0, 1)), Some(100));
        let info = map.grid.info();
        assert_eq!((info.width(), info.height(), info.resolution_m()), (3, 2, 0.5));
        assert_eq!(info.origin_in_map(), crate::geometry::Pose::new(-1.0, 2.0, 0.5));
    }

    #[test]
    fn thresholds_are_strict() {
        // p = 0.6 and 0.2 exactly: neither occupied above 0.6 nor free below 0.2.
        let yaml = YAML.replace("0.65", "0.6").replace("0.196", "0.2");
        assert_eq!(load(&yaml, b"P5 4 1 255\n\x65\x66\xcc\xcd").unwrap().grid.data(), &[100, -1, -1, 0]);
    }

    #[test]
    fn negate_turns_light_and_dark_round() {
        let yaml = YAML.replace("negate: 0", "negate: true");
        assert_eq!(load(&yaml, b"P5 3 1 255\n\x00\xff\x80").unwrap().grid.data(), &[0, 100, -1]);
    }

    #[test]
    fn scale_grades_what_lies_between() {
        // p of 128 is 0.498: 1 + 98 * (0.498 - 0.196) / 0.454 = 66.2.
        assert_eq!(values("mode: scale\n", b"P5 4 1 255\n\x00\xfe\xcd\x80"), [100, 0, 1, 66]);
    }

    #[test]
    fn raw_is_the_byte() {
        assert_eq!(values("mode: raw\n", b"P5 5 1 255\n\x00\x32\x64\xff\xcd"), [0, 50, 100, -1, -51]);
    }

    #[test]
    fn colours_are_averaged_and_alpha_by_the_mode() {
        let rgb = png(&[0, 0, 30, 255, 255, 240, 255, 128, 0], 3, ExtendedColorType::Rgb8);
        assert_eq!(values("", &rgb), [100, 0, -1]);
        assert_eq!(values("mode: scale\n", &rgb), [100, 0, 66]);
        // Black and opaque: the mean of 0, 0, 0, 255 is 63.75, p = 0.75. White and
        // transparent: 191.25, p = 0.25. Grey and transparent: 96, p = 0.62.
        let rgba = png(&[0, 0, 0, 255, 255, 255, 255, 0, 128, 128, 128, 0], 3, ExtendedColorType::Rgba8);
        assert_eq!(values("", &rgba), [100, -1, -1]);
        assert_eq!(values("mode: scale\n", &rgba), [100, 0, -1]);
        assert_eq!(values("mode: raw\n", &rgba), [0, -1, -128]);
        let grey_alpha = png(&[0, 255, 255, 0, 128, 0], 3, ExtendedColorType::La8);
        assert_eq!(values("", &grey_alpha), values("", &rgba));
    }

    #[test]
    fn two_byte_samples_keep_their_high_byte() {
        let samples: Vec<u8> = [0x00ff_u16, 0xfe00, 0xcd80].iter().flat_map(|s| s.to_ne_bytes()).collect();
        assert_eq!(values("mode: raw\n", &png(&samples, 3, ExtendedColorType::L16)), [0, -2, -51]);
    }

    #[test]
    fn bad_images_are_answered_in_one_sentence() {
        let mut giant = png(&[0], 1, ExtendedColorType::L8);
        giant[16..24].copy_from_slice(&[0x7f, 0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff]);
        sign_header(&mut giant);
        let mut hollow = png(&[0], 1, ExtendedColorType::L8);
        hollow[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
        sign_header(&mut hollow);
        // As many pixels of one bit could be in it, and none of these with 32.
        let mut vast = png(&[0; 4], 1, ExtendedColorType::Rgba8);
        vast[16..24].copy_from_slice(&[0, 0, 1, 0xf4, 0, 0, 3, 0xe8]);
        sign_header(&mut vast);
        let mut cut = png(&[7; 300], 100, ExtendedColorType::Rgb8);
        cut.truncate(50);
        for (image, expected) in [
            (b"".as_slice(), "a.img is empty"),
            (b"P5 2147483648 2147483648 255\n", "claims 2147483648 x 2147483648 pixels: must be at least 1"),
            (b"P5 2 2 255\nabc", "is truncated: it has data for at most 3 of 2 x 2 pixels"),
            (b"P5 2", "is a damaged image: its header ends before the height"),
            (b"P6 1 1 255\nabc", "another kind of PNM image: must be a PGM"),
            (b"\xff\xd8\xff", "a JPEG image: must be a PGM (P2 or P5) or PNG image"),
            (b"hello", "of no kind that is known here"),
            (b"\x89PNG", "is a damaged image: "),
            (&cut, "is a damaged image: "),
            (&giant, "a.img claims 2147483647 x 2147483647 pixels: must be at least 1"),
            (&hollow, "a.img is truncated: it has data for at most "),
            (&vast, "of 500 x 1000 pixels"),
        ] {
            let message = load(YAML, image).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
            assert!(message.contains("a.img") && !message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn bad_paths_are_answered_in_one_sentence() {
        let dir = tempfile::tempdir().unwrap();
        let file = |name: &str, bytes: &[u8]| {
            std::fs::write(dir.path().join(name), bytes).unwrap();
            load_map(&dir.path().join(name)).unwrap_err().to_string()
        };
        assert!(file("a.yaml", YAML.as_bytes()).contains("a.img: No such file"));
        assert!(file("b.yaml", YAML.replace("a.img", ".").as_bytes()).contains("is a directory: must be the image"));
        assert!(file("c.yaml", b"").contains("c.yaml is empty"));
        assert!(file("d.yaml", b"image: \xff\xfe").contains("byte 7 is not UTF-8"));
        assert!(file("e.pgm", b"P5 1 1 255\n0").contains("it is an image: give the .yaml file"));
        assert!(load_map(dir.path()).unwrap_err().to_string().contains("is a directory: must be the .yaml file"));
        let missing = load_map(&dir.path().join("no.yaml")).unwrap_err().to_string();
        assert!(missing.contains("cannot read") && missing.contains("no.yaml: No such file"), "{missing}");
    }

    #[test]
    fn windows_line_ends_and_document_marks_are_taken() {
        let yaml = format!("---\n{YAML}").replace('\n', "\r\n");
        assert_eq!(load(&yaml, b"P5 1 1 255\n\x00").unwrap().grid.data(), &[100]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(128))]
        #[test]
        fn noise_is_an_error_and_never_a_panic(
            noise in proptest::collection::vec(any::<u8>(), 0..60),
            at in 0usize..90,
            start in prop_oneof![Just(b"P5 ".to_vec()), Just(b"P2 9 9 ".to_vec()), Just(Vec::new())],
            yaml in "\\PC{0,60}",
        ) {
            let _ = load(YAML, &[start, noise.clone()].concat());
            let mut damaged = png(&[7; 300], 100, ExtendedColorType::Rgb8);
            for (byte, noise) in damaged.iter_mut().skip(at).zip(&noise) {
                *byte ^= noise;
            }
            let _ = load(YAML, &damaged);
            prop_assert!(load(&yaml, b"P5 1 1 255\n0").is_err());
            let _ = load(&format!("{YAML}{yaml}"), b"P5 1 1 255\n0");
        }
    }
}
