//! Line charts as SVG, to stand inside an HTML page.
//!
//! They have no background, and text and axes are drawn in the colour of the text
//! around them, so that they fit light and dark pages.

use super::ReportError;
use super::series::SeriesPoint;
use plotters::prelude::*;

/// Width of a chart in its own units; a page scales it.
pub(super) const WIDTH: u32 = 560;

/// Height of a chart in its own units.
pub(super) const HEIGHT: u32 = 300;

/// A colour that nothing else has: it stands for that of the text until the end.
pub(super) const TEXT: RGBColor = RGBColor(1, 2, 3);

/// How [`TEXT`] is written by the SVG backend.
pub(super) const TEXT_HEX: &str = "#010203";

/// Colour of the curves: that of paths on maps.
const CURVE: RGBColor = RGBColor(0x2b, 0x8c, 0xcf);

/// Covered share over time.
///
/// # Errors
/// [`ReportError::Plot`] when it cannot be drawn.
pub fn coverage_svg(series: &[SeriesPoint]) -> Result<String, ReportError> {
    let points: Vec<_> = series.iter().map(|p| (p.time_s, p.coverage * 100.0)).collect();
    chart(&points, "coverage, %", 100.0)
}

/// Way driven over time.
///
/// # Errors
/// [`ReportError::Plot`] when it cannot be drawn.
pub fn distance_svg(series: &[SeriesPoint]) -> Result<String, ReportError> {
    let points: Vec<_> = series.iter().map(|p| (p.time_s, p.distance_m)).collect();
    let farthest = points.iter().map(|p| p.1).fold(0.0, f64::max);
    chart(&points, "distance, m", farthest * 1.05)
}

/// One curve over the time in seconds.
fn chart(points: &[(f64, f64)], label: &str, highest: f64) -> Result<String, ReportError> {
    let highest = if highest > 0.0 { highest } else { 1.0 };
    let latest = points.iter().map(|p| p.0).fold(0.0, f64::max);
    let latest = if latest > 0.0 { latest } else { 1.0 };
    let mut svg = String::new();
    draw(&mut svg, points, label, (latest, highest)).map_err(|error| ReportError::Plot(error.to_string()))?;
    Ok(svg.replace(TEXT_HEX, "currentColor"))
}

/// Draws the chart into `svg`.
fn draw(
    svg: &mut String,
    points: &[(f64, f64)],
    label: &str,
    (latest, highest): (f64, f64),
) -> Result<(), Box<dyn std::error::Error>> {
    let root = SVGBackend::with_string(svg, (WIDTH, HEIGHT)).into_drawing_area();
    let mut chart = ChartBuilder::on(&root)
        .margin(8)
        .margin_right(18)
        .x_label_area_size(44)
        .y_label_area_size(60)
        .build_cartesian_2d(0.0..latest, 0.0..highest)?;
    let style = ("sans-serif", 15).into_font().color(&TEXT);
    chart
        .configure_mesh()
        .x_labels(7)
        .y_labels(6)
        .x_desc("time, s")
        .y_desc(label)
        .label_style(style.clone())
        .axis_desc_style(style)
        .axis_style(TEXT.mix(0.5))
        .bold_line_style(TEXT.mix(0.15))
        .light_line_style(TRANSPARENT)
        .x_label_formatter(&|value| tick(*value, latest))
        .y_label_formatter(&|value| tick(*value, highest))
        .draw()?;
    chart.draw_series(LineSeries::new(points.iter().copied(), CURVE.stroke_width(3)))?;
    root.present()?;
    Ok(())
}

/// A number at an axis whose largest is `largest`.
pub(super) fn tick(value: f64, largest: f64) -> String {
    let decimals = if largest > 5.0 { 0 } else { 1 };
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn charts_take_the_colour_of_the_page() {
        let point = |t: f64| SeriesPoint { time_s: t, coverage: t / 20.0, distance_m: 0.3 * t };
        let series: Vec<_> = (0..=20).map(|t| point(f64::from(t))).collect();
        for svg in [coverage_svg(&series).unwrap(), distance_svg(&series).unwrap()] {
            assert!(svg.starts_with("<svg") && svg.contains("currentColor"));
            assert!(!svg.contains(TEXT_HEX) && !svg.contains("#FFFFFF"));
            assert!(svg.contains("#2B8CCF"));
        }
        assert_eq!(coverage_svg(&series).unwrap(), coverage_svg(&series).unwrap());
    }

    #[test]
    fn a_run_of_no_time_has_charts_too() {
        coverage_svg(&[]).unwrap();
        distance_svg(&[SeriesPoint { time_s: 0.0, coverage: 0.0, distance_m: 0.0 }]).unwrap();
    }
}
