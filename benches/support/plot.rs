//! Cost against size, both on scales of powers of ten.

use super::Row;
use plotters::prelude::*;
use std::error::Error;
use std::path::Path;

/// A line of the plot: what it shows, its colour, and the time it takes from a row.
type Line = (&'static str, RGBColor, fn(&Row) -> f64);

const LINES: [Line; 5] = [
    ("textbook", RGBColor(150, 60, 160), |row| row.textbook_ms),
    ("bitplane, from scratch", RGBColor(20, 90, 190), |row| row.bitplane_ms),
    ("one pass that sums the bytes", RGBColor(120, 120, 120), |row| row.byte_sum_ms),
    ("repaired, grid sent again", RGBColor(30, 140, 90), |row| row.resent_ms),
    ("repaired, 200 x 200 cells told", RGBColor(220, 110, 20), |row| row.patch_ms),
];

/// Draws the office scene's rows.
pub fn draw(path: &Path, rows: &[Row]) -> Result<(), Box<dyn Error>> {
    let rows: Vec<&Row> = rows.iter().filter(|row| row.scene == "office").collect();
    let times = || rows.iter().flat_map(|row| LINES.iter().map(|line| line.2(row)));
    let (least, most) = (times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max));
    let sizes = || rows.iter().map(|row| f64::from(row.size));
    let (small, large) = (sizes().fold(f64::INFINITY, f64::min), sizes().fold(0.0, f64::max));
    let root = SVGBackend::new(path, (820, 520)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption("One detection in the tiled office", ("sans-serif", 20))
        .margin(12)
        .x_label_area_size(46)
        .y_label_area_size(70)
        .build_cartesian_2d((small * 0.9..large * 1.1).log_scale(), (least * 0.6..most * 1.6).log_scale())?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("edge of the grid, cells")
        .y_desc("time, ms")
        .x_label_formatter(&|x| format!("{x:.0}"))
        .y_label_formatter(&|y| format!("{y}"))
        .draw()?;
    for (name, color, time) in LINES {
        let points = || rows.iter().map(|row| (f64::from(row.size), time(row)));
        chart
            .draw_series(LineSeries::new(points(), color.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], color.stroke_width(2)));
        chart.draw_series(points().map(|point| Circle::new(point, 3, color.filled())))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperLeft)
        .background_style(WHITE.mix(0.85))
        .border_style(BLACK.mix(0.3))
        .draw()?;
    root.present()?;
    Ok(())
}
