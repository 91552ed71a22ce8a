//! Charts of one run: coverage and way driven over time.

use super::ReportError;
use super::chart::{Chart, Curve};
use super::series::SeriesPoint;
use plotters::style::{Color, RGBColor};

/// Colour of the curves: that of paths on maps.
const CURVE: RGBColor = RGBColor(0x2b, 0x8c, 0xcf);

/// Covered share over time.
///
/// # Errors
/// [`ReportError::Plot`] when it cannot be drawn.
pub fn coverage_svg(series: &[SeriesPoint]) -> Result<String, ReportError> {
    let points: Vec<_> = series.iter().map(|p| (p.time_s, p.coverage * 100.0)).collect();
    chart(points, "coverage, %", 100.0)
}

/// Way driven over time.
///
/// # Errors
/// [`ReportError::Plot`] when it cannot be drawn.
pub fn distance_svg(series: &[SeriesPoint]) -> Result<String, ReportError> {
    let points: Vec<_> = series.iter().map(|p| (p.time_s, p.distance_m)).collect();
    let farthest = points.iter().map(|p| p.1).fold(0.0, f64::max);
    chart(points, "distance, m", farthest * 1.05)
}

fn chart(points: Vec<(f64, f64)>, label: &str, highest: f64) -> Result<String, ReportError> {
    let latest_s = points.iter().map(|p| p.0).fold(0.0, f64::max);
    let curve = Curve { points, style: CURVE.stroke_width(3) };
    Chart { latest_s, highest, label, is_large: false }.to_svg(vec![curve])
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
            assert!(!svg.contains("#010203") && !svg.contains("#FFFFFF"));
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
