//! The YAML and the picture of a map.

use super::engine::{Answer, Target, none};
use frontier_explorer::io::{MapYaml, load_map};
use std::cell::RefCell;
use std::path::Path;

#[test]
fn map_yaml() {
    // A YAML of many anchors or brackets is refused before it unfolds.
    Target { name: "map_yaml", run: yaml, seeds: none, memory: (8 << 20, 200), least_taken_percent: 5.0 }.fuzz();
}

fn yaml(input: &[u8]) -> Answer {
    let text = std::str::from_utf8(input).map_err(|error| error.to_string())?;
    let yaml = MapYaml::parse(text, Path::new("map.yaml")).map_err(|error| error.to_string())?;
    Ok(format!("{} {}", yaml.mode, yaml.negate))
}

#[test]
fn map_image() {
    let memory = (32 << 20, 12 * 1032);
    Target { name: "map_image", run: image, seeds: images, memory, least_taken_percent: 5.0 }.fuzz();
}

thread_local! {
    /// Where the picture lies, with YAML files beside it.
    static FOLDER: RefCell<Option<tempfile::TempDir>> = const { RefCell::new(None) };
}

const MODES: [&str; 3] = ["trinary", "scale", "raw"];

/// Loads the picture as a map of one of the three modes.
fn image(input: &[u8]) -> Answer {
    FOLDER.with_borrow_mut(|folder| {
        let folder = folder.get_or_insert_with(|| {
            let folder = tempfile::tempdir().unwrap();
            for mode in MODES {
                let yaml = format!(
                    "image: image\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n\
                     free_thresh: 0.196\nmode: {mode}\n"
                );
                std::fs::write(folder.path().join(format!("{mode}.yaml")), yaml).unwrap();
            }
            folder
        });
        std::fs::write(folder.path().join("image"), with_sums(input)).unwrap();
        let mode = MODES[input.len() % MODES.len()];
        let map = load_map(&folder.path().join(format!("{mode}.yaml"))).map_err(|error| error.to_string())?;
        let info = map.grid.info();
        assert_eq!(map.grid.data().len(), info.len());
        Ok(format!("{mode} {} {}", info.width() == info.height(), map.grid.data()[0]))
    })
}

/// A PNG with the check sums that its chunks must have, so that what is in them is looked at.
fn with_sums(input: &[u8]) -> Vec<u8> {
    let mut bytes = input.to_vec();
    let mut at = 8;
    while bytes.starts_with(b"\x89PNG")
        && let Some(length) = bytes.get(at..at + 4)
    {
        let length = u32::from_be_bytes([length[0], length[1], length[2], length[3]]) as usize;
        let Some(end) = at.checked_add(8 + length).filter(|end| end + 4 <= bytes.len()) else { break };
        let sum = crc(&bytes[at + 4..end]);
        bytes[end..end + 4].copy_from_slice(&sum.to_be_bytes());
        at = end + 4;
    }
    bytes
}

/// The sum of PNG's chunks: a CRC with the polynomial edb88320.
fn crc(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg()))
    })
}

/// Small pictures of each kind of pixels.
fn images() -> Vec<(String, Vec<u8>)> {
    use image::{DynamicImage, ImageFormat};
    let greys: Vec<u8> = (0..12 * 9).map(|i| [0, 254, 205, 130][i % 4]).collect();
    let grey = DynamicImage::ImageLuma8(image::GrayImage::from_raw(12, 9, greys.clone()).unwrap());
    let all = [
        ("grey.png", grey.clone()),
        ("grey16.png", grey.to_luma16().into()),
        ("grey_alpha.png", grey.to_luma_alpha8().into()),
        ("rgb.png", grey.to_rgb8().into()),
        ("rgba.png", grey.to_rgba8().into()),
        ("rgba16.png", grey.to_rgba16().into()),
    ];
    let png = |(name, image): (&str, DynamicImage)| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        (name.to_owned(), bytes.into_inner())
    };
    let binary = [b"P5\n# CREATOR: a test\n12 9\n255\n".as_slice(), &greys].concat();
    let plain = greys.iter().map(u8::to_string).collect::<Vec<_>>().join(" ");
    let plain = format!("P2\n12 9\n255\n{plain}\n").into_bytes();
    let wide: Vec<u8> = greys.iter().flat_map(|&grey| [grey, 0]).collect();
    let wide = [b"P5 12 9 65535\n".as_slice(), &wide].concat();
    let pgms = [("binary.pgm", binary), ("plain.pgm", plain), ("wide.pgm", wide)];
    all.map(png).into_iter().chain(pgms.map(|(name, bytes)| (name.to_owned(), bytes))).collect()
}

#[test]
fn check_sums_are_those_of_png() {
    assert_eq!(crc(b"IEND"), 0xae42_6082);
    for (name, bytes) in images() {
        assert_eq!(with_sums(&bytes), bytes, "{name}");
    }
}
