//! The report of a run as one HTML file that needs nothing beside it.
//!
//! The page is made from what `run.json` holds, so it can be made again from that
//! file. What the computer took is left out: the same run gives the same page.

use super::ReportError;
use super::beside::Beside;
use super::figures::{Figure, clock, figures, headline, is_recording, milestones, recorded_figures, time_spent};
use super::plots;
use super::run_json::RunRecord;
use super::theme::{Ink, Rgb, Theme};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use minijinja::Environment;
use minijinja::value::Serde;
use serde::Serialize;

/// The page; `.html` in its name has the template engine escape all strings.
const TEMPLATE_NAME: &str = "report.html.j2";
const TEMPLATE: &str = include_str!("report.html.j2");

/// Candidates of a decision that the page shows; the rest is counted.
const SHOWN_CANDIDATES: usize = 15;
/// Decisions that are not the recording's that the page shows; the rest is counted.
const SHOWN_PARTINGS: usize = 50;

/// What a page is made of.
#[derive(Clone, Copy, Debug)]
pub struct HtmlReport<'a, D> {
    /// The run.
    pub run: &'a RunRecord<D>,
    /// The final map as a PNG file.
    pub map_png: &'a [u8],
    /// The animation as a GIF file, if there is one.
    pub animation_gif: Option<&'a [u8]>,
    /// The colours of both, for the legend.
    pub theme: Theme,
    /// What the recording decided, if the run is one.
    pub beside: Option<&'a Beside>,
}

/// What the template fills in.
#[derive(Serialize)]
struct Page<'a, D> {
    run: &'a RunRecord<D>,
    beside: Option<&'a Beside>,
    shown_partings: usize,
    headline: String,
    figures: Vec<Figure>,
    milestones: Vec<[String; 3]>,
    time_spent: Vec<[String; 3]>,
    legend: Vec<LegendEntry>,
    gradient: String,
    shown_candidates: usize,
    coverage_svg: String,
    distance_svg: String,
    map_png: String,
    animation_gif: Option<String>,
}

/// An entry of the legend.
#[derive(Serialize)]
struct LegendEntry {
    name: &'static str,
    color: String,
}

impl<D: Serialize> HtmlReport<'_, D> {
    /// The page.
    ///
    /// # Errors
    /// [`ReportError::Template`] when it cannot be filled in, [`ReportError::Plot`]
    /// when a chart cannot be drawn.
    pub fn to_html(&self) -> Result<String, ReportError> {
        let mut environment = Environment::new();
        environment.add_filter("fixed", |value: Option<f64>, decimals: usize| fixed(value, decimals));
        environment.add_filter("clock", |value: f64| clock(value));
        environment.add_filter("words", |value: String| value.replace('_', " "));
        environment.add_template(TEMPLATE_NAME, TEMPLATE)?;
        let page = Page {
            run: self.run,
            beside: self.beside,
            shown_partings: SHOWN_PARTINGS,
            headline: headline(self.run),
            figures: if is_recording(self.run) { recorded_figures(self.run, self.beside) } else { figures(self.run) },
            milestones: milestones(self.run),
            time_spent: time_spent(self.run),
            legend: legend(self.theme),
            gradient: self.theme.gradient_stops().map(css).join(", "),
            shown_candidates: SHOWN_CANDIDATES,
            coverage_svg: plots::coverage_svg(&self.run.series)?,
            distance_svg: plots::distance_svg(&self.run.series)?,
            map_png: STANDARD.encode(self.map_png),
            animation_gif: self.animation_gif.map(|gif| STANDARD.encode(gif)),
        };
        Ok(environment.get_template(TEMPLATE_NAME)?.render(Serde(&page))?)
    }
}

/// What the colours of the pictures mean.
fn legend(theme: Theme) -> Vec<LegendEntry> {
    let entries = [
        ("free", Ink::Free),
        ("unknown", Ink::Unknown),
        ("obstacle", Ink::Occupied),
        ("frontier", Ink::Frontier),
        ("robot", Ink::Robot),
        ("goal", Ink::Goal),
        ("goal given up", Ink::Taboo),
    ];
    entries.into_iter().map(|(name, ink)| LegendEntry { name, color: css(theme.color(ink)) }).collect()
}

/// A colour as style sheets write it.
fn css([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// A number with some decimals, a dash for none.
fn fixed(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{BesideRow, sample};

    fn page(gif: Option<&[u8]>) -> String {
        let run = sample::run();
        let report = HtmlReport { run: &run, map_png: b"png", animation_gif: gif, theme: Theme::Clear, beside: None };
        report.to_html().unwrap()
    }

    #[test]
    fn the_page_stands_alone_and_is_always_the_same() {
        let page = page(Some(b"gif"));
        assert!(page.contains("data:image/png;base64,cG5n") && page.contains("data:image/gif;base64,Z2lm"));
        assert_eq!(page.matches("<svg").count(), 2);
        for elsewhere in ["href=\"http", "src=\"http", "<script", "@import"] {
            assert!(!page.contains(elsewhere), "{elsewhere}");
        }
        assert_eq!(page, self::page(Some(b"gif")));
        assert!(!self::page(None).contains("image/gif"));
    }

    /// What nobody can know of a recording is not on its page, and what it decided is.
    #[test]
    fn the_page_of_a_recording_has_its_decisions_beside_ours() {
        let run = RunRecord { seed: None, ..sample::run() };
        let beside = Beside {
            recorded_goals: 7,
            at_frontiers: 5,
            decisions: 6,
            agreeing: 4,
            causes: vec![("the recording's goal was <taboo>".to_owned(), 2)],
            partings: vec![BesideRow {
                time_s: 12.34,
                ours: Some([1.0, -2.0]),
                recorded: None,
                cause: "why".to_owned(),
            }],
        };
        let (map_png, theme) = (&b""[..], Theme::Clear);
        let page =
            HtmlReport { run: &run, map_png, animation_gif: None, theme, beside: Some(&beside) }.to_html().unwrap();
        for there in ["4 of 6", "5 of 7", "goal was &lt;taboo&gt;", "12.3 s", "(1.00, -2.00)", "Distance over time"] {
            assert!(page.contains(there), "{there}");
        }
        for unknown in ["collisions", "goals reached", "Coverage over time", "When coverage was reached"] {
            assert!(!page.contains(unknown), "{unknown}");
        }
        let simulated = self::page(None);
        assert!(simulated.contains("collisions") && !simulated.contains("The recording beside us"));
    }

    #[test]
    fn strings_are_escaped() {
        let page = page(None);
        assert!(page.contains("rooms &lt;b&gt;&amp;&lt;&#x2f;b&gt;"));
        assert!(page.contains("2 &lt;frontiers&gt; &amp;"));
        assert!(!page.contains("<frontiers>"));
    }

    #[test]
    fn a_page_from_the_file_is_the_page_from_the_run() {
        let mut run = sample::run();
        for point in &mut run.series {
            point.coverage = (point.coverage * 1e6).round() / 1e6;
        }
        let read = RunRecord::<serde_json::Value>::from_json(&run.to_json().unwrap()).unwrap();
        let (map_png, animation_gif, theme) = (&b""[..], None, Theme::Clear);
        let from_run = HtmlReport { run: &run, map_png, animation_gif, theme, beside: None };
        let from_file = HtmlReport { run: &read, map_png, animation_gif, theme, beside: None };
        assert_eq!(from_run.to_html().unwrap(), from_file.to_html().unwrap());
    }
}
