//! Coverage over time of many runs in one chart, a colour for each preset.

use super::{ComparedRun, Comparison};
use crate::report::ReportError;
use crate::report::chart::{Chart, Curve};
use plotters::style::{BLACK, Color, RGBColor};

/// Points of a median curve.
const MEDIAN_POINTS: usize = 240;

/// Colours that can be told apart on light and dark pages, after Okabe and Ito 2008 with
/// more for many presets; then they begin anew.
const COLORS: [RGBColor; 12] = [
    RGBColor(0x2b, 0x8c, 0xcf),
    RGBColor(0xe6, 0x8a, 0x00),
    RGBColor(0x00, 0x9e, 0x73),
    RGBColor(0xd5, 0x4e, 0x3a),
    RGBColor(0xc0, 0x6a, 0xb8),
    RGBColor(0x8f, 0x8a, 0x10),
    RGBColor(0x56, 0xb4, 0xe9),
    RGBColor(0x8c, 0x5a, 0x3c),
    RGBColor(0x6f, 0xbf, 0x4b),
    RGBColor(0x7a, 0x6f, 0xe0),
    RGBColor(0xf0, 0x7f, 0xa8),
    RGBColor(0x7f, 0x8c, 0x99),
];

/// The colour of a preset by its place in the plan.
fn color(preset: usize) -> RGBColor {
    COLORS.get(preset % COLORS.len()).copied().unwrap_or(BLACK)
}

/// The same as style sheets write it.
pub fn css_color(preset: usize) -> String {
    let RGBColor(red, green, blue) = color(preset);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Coverage in one world: each run thin, the median of each preset bold.
///
/// # Errors
/// [`ReportError::Plot`] when it cannot be drawn.
pub fn coverage_curves_svg(comparison: &Comparison, world: &str) -> Result<String, ReportError> {
    let in_world = comparison.runs.iter().filter(|run| run.world == world);
    let latest = in_world.map(|run| run.sim_time_s).fold(1.0, f64::max);
    let (mut thin, mut bold) = (Vec::new(), Vec::new());
    for (i, preset) in comparison.plan.presets.iter().enumerate() {
        let runs: Vec<&ComparedRun> = comparison.runs_of(&preset.name, Some(world)).collect();
        if runs.len() > 1 {
            thin.extend(runs.iter().map(|run| Curve {
                points: run.coverage_over_time.iter().map(|&[t, share]| (t, share * 100.0)).collect(),
                style: color(i).mix(0.45).stroke_width(1),
            }));
        }
        bold.push(Curve {
            points: median_curve(&runs).into_iter().map(|(t, share)| (t, share * 100.0)).collect(),
            style: color(i).stroke_width(3),
        });
    }
    thin.append(&mut bold);
    Chart { latest_s: latest, highest: 100.0, label: "coverage, %", is_large: true }.to_svg(thin)
}

/// The median of the covered shares at each moment until the last run has ended; a run
/// that has ended keeps what it covered.
fn median_curve(runs: &[&ComparedRun]) -> Vec<(f64, f64)> {
    let latest = runs.iter().map(|run| run.sim_time_s).fold(0.0, f64::max);
    if runs.is_empty() {
        return Vec::new();
    }
    let moment = |i: usize| latest * i as f64 / (MEDIAN_POINTS - 1) as f64;
    let median = |time_s: f64| {
        let mut shares: Vec<f64> = runs.iter().map(|run| coverage_at(run, time_s)).collect();
        shares.sort_by(f64::total_cmp);
        super::statistics::quantile(&shares, 0.5)
    };
    (0..MEDIAN_POINTS).map(moment).map(|time_s| (time_s, median(time_s))).collect()
}

/// The covered share at a time: that of the latest point before it.
fn coverage_at(run: &ComparedRun, time_s: f64) -> f64 {
    let points = &run.coverage_over_time;
    let later = points.partition_point(|&[t, _]| t <= time_s);
    later.checked_sub(1).and_then(|i| points.get(i)).map_or(0.0, |&[_, share]| share)
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn a_run_that_has_ended_keeps_what_it_covered() {
        let (quick, slow) = (sample::run(0, "a", "w", 10.0), sample::run(1, "a", "w", 100.0));
        let curve = median_curve(&[&quick, &slow]);
        assert_eq!((curve.len(), curve[0], curve[MEDIAN_POINTS - 1]), (MEDIAN_POINTS, (0.0, 0.0), (100.0, 1.0)));
        assert_eq!(curve[MEDIAN_POINTS / 2].1, 0.5, "one has all, the other none yet");
        assert!(median_curve(&[]).is_empty());
    }

    #[test]
    fn a_chart_has_a_curve_for_each_preset_and_run() {
        let comparison = sample::comparison(sample::plan(&["a", "b"], &["w"], &[1, 2, 3]), |p| [10.0, 20.0][p]);
        let svg = coverage_curves_svg(&comparison, "w").unwrap();
        assert!(svg.contains("currentColor") && !svg.contains("#010203"));
        for preset in 0..2 {
            assert_eq!(svg.matches(&css_color(preset).to_uppercase()).count(), 3 + 1);
        }
        coverage_curves_svg(&Comparison { runs: Vec::new(), ..comparison }, "w").unwrap();
    }
}
