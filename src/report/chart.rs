//! One chart of curves over time as SVG, to stand inside an HTML page.
//!
//! It has no background, and text and axes are drawn in the colour of the text around them,
//! so that it fits light and dark pages.

use super::ReportError;
use plotters::prelude::*;

/// Width of a chart in its own units; a page scales it.
const WIDTH: u32 = 560;

/// Height of a chart in its own units.
const HEIGHT: u32 = 300;

/// A colour that nothing else has: it stands for that of the text until the end.
const TEXT: RGBColor = RGBColor(1, 2, 3);

/// How [`TEXT`] is written by the SVG backend.
const TEXT_HEX: &str = "#010203";

/// A curve: seconds and values, and how it is drawn.
pub struct Curve {
    /// Its points, in the order of time.
    pub points: Vec<(f64, f64)>,
    /// Its colour and width.
    pub style: ShapeStyle,
}

/// The frame that curves are drawn in.
pub struct Chart<'a> {
    /// The end of the axis of time, seconds; 1 when it is not positive.
    pub latest_s: f64,
    /// The end of the other axis; 1 when it is not positive.
    pub highest: f64,
    /// What the other axis shows, with its unit.
    pub label: &'a str,
    /// Whether it is half as high again and twice as wide, for many curves.
    pub is_large: bool,
}

impl Chart<'_> {
    /// The chart with its curves, the last on top.
    ///
    /// # Errors
    /// [`ReportError::Plot`] when it cannot be drawn.
    pub fn to_svg(&self, curves: Vec<Curve>) -> Result<String, ReportError> {
        let mut svg = String::new();
        self.draw(&mut svg, curves).map_err(|error| ReportError::Plot(error.to_string()))?;
        Ok(svg.replace(TEXT_HEX, "currentColor"))
    }

    fn draw(&self, svg: &mut String, curves: Vec<Curve>) -> Result<(), Box<dyn std::error::Error>> {
        let or_one = |value: f64| if value > 0.0 { value } else { 1.0 };
        let (latest, highest) = (or_one(self.latest_s), or_one(self.highest));
        let (size, time_labels) = if self.is_large { ((WIDTH * 2, HEIGHT * 3 / 2), 10) } else { ((WIDTH, HEIGHT), 7) };
        let root = SVGBackend::with_string(svg, size).into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .margin(8)
            .margin_right(18)
            .x_label_area_size(44)
            .y_label_area_size(60)
            .build_cartesian_2d(0.0..latest, 0.0..highest)?;
        let style = ("sans-serif", 15).into_font().color(&TEXT);
        chart
            .configure_mesh()
            .x_labels(time_labels)
            .y_labels(6)
            .x_desc("time, s")
            .y_desc(self.label)
            .label_style(style.clone())
            .axis_desc_style(style)
            .axis_style(TEXT.mix(0.5))
            .bold_line_style(TEXT.mix(0.15))
            .light_line_style(TRANSPARENT)
            .x_label_formatter(&|value| tick(*value, latest))
            .y_label_formatter(&|value| tick(*value, highest))
            .draw()?;
        for Curve { points, style } in curves {
            chart.draw_series(LineSeries::new(points, style))?;
        }
        root.present()?;
        Ok(())
    }
}

/// A number at an axis whose largest is `largest`.
fn tick(value: f64, largest: f64) -> String {
    let decimals = if largest > 5.0 { 0 } else { 1 };
    format!("{value:.decimals$}")
}
