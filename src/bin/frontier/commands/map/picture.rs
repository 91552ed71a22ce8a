//! The picture of `frontier map diff`: one pixel a cell of the common raster.

use anyhow::{Context, ensure};
use frontier_explorer::grid::{CellState, GridInfo};
use frontier_explorer::io::write_atomic;
use image::{ExtendedColorType, ImageFormat};
use std::io::Cursor;
use std::path::Path;

/// Writes the picture; `states` gives what A and B say of a cell by its index.
pub fn write(path: &Path, raster: &GridInfo, states: impl Fn(usize) -> (CellState, CellState)) -> anyhow::Result<()> {
    let is_png = path.extension().is_some_and(|end| end.eq_ignore_ascii_case("png"));
    ensure!(is_png, "the picture {}: must end in .png", path.display());
    let mut colours = Vec::with_capacity(3 * raster.len());
    for y in (0..raster.height()).rev() {
        for x in 0..raster.width() {
            let (a, b) = states(y * raster.width() + x);
            colours.extend(colour(a, b));
        }
    }
    let mut bytes = Vec::new();
    let (out, kind) = (&mut Cursor::new(&mut bytes), ExtendedColorType::Rgb8);
    let (width, height) = (raster.width() as u32, raster.height() as u32);
    image::write_buffer_with_format(out, &colours, width, height, kind, ImageFormat::Png)
        .with_context(|| format!("cannot make {}", path.display()))?;
    write_atomic(path, &bytes).with_context(|| format!("cannot write {}", path.display()))
}

/// The greys of map_saver where the maps agree, a colour where they do not.
const fn colour(a: CellState, b: CellState) -> [u8; 3] {
    use CellState::{Free, Occupied, Unknown, Unsettled};
    match (a, b) {
        (Free, Free) => [254, 254, 254],
        (Occupied, Occupied) => [0, 0, 0],
        (Unknown | Unsettled, Unknown | Unsettled) => [205, 205, 205],
        (Free, Occupied) => [215, 48, 39],
        (Occupied, Free) => [69, 117, 180],
        (_, Unknown | Unsettled) => [253, 174, 97],
        (Unknown | Unsettled, _) => [102, 189, 99],
    }
}
