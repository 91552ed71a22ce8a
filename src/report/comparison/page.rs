//! The report of a comparison as one HTML file that needs nothing beside it.

use super::curves::{coverage_curves_svg, css_color};
use super::liang::LiangTable;
use super::measure::Measure;
use super::statistics::Spread;
use super::summary::Summary;
use super::{ComparedRun, ComparedWorld, Comparison};
use crate::geometry::Point;
use crate::report::ReportError;
use minijinja::Environment;
use minijinja::value::Serde;
use serde::Serialize;

/// The page; `.html` in its name has the template engine escape all strings.
const TEMPLATE_NAME: &str = "comparison.html.j2";
const TEMPLATE: &str = include_str!("comparison.html.j2");

/// What the template fills in.
#[derive(Serialize)]
struct Page<'a> {
    lead: String,
    missing: usize,
    titles: Vec<&'static str>,
    has_oracle: bool,
    legend: Vec<Preset<'a>>,
    summaries: Vec<SummaryRow>,
    liang: Option<Liang>,
    worlds: Vec<World<'a>>,
    runs: Vec<RunRow<'a>>,
}

/// A preset and its colour.
#[derive(Serialize)]
struct Preset<'a> {
    name: &'a str,
    color: String,
}

/// A row of a table of summaries.
#[derive(Serialize)]
struct SummaryRow {
    preset: String,
    color: String,
    runs: usize,
    failed: usize,
    measures: Vec<SpreadCell>,
    to_oracle: Option<SpreadCell>,
    coverage: String,
    goals: String,
    goals_failed: usize,
    collisions: usize,
    /// The median and the largest.
    decision_ms: [String; 2],
}

/// A spread in words.
#[derive(Serialize)]
struct SpreadCell {
    median: String,
    range: String,
    interval: String,
    reached: String,
    all: bool,
}

#[derive(Serialize)]
struct Liang {
    rows: Vec<LiangCells>,
    verdict: String,
}

#[derive(Serialize)]
struct LiangCells {
    method: &'static str,
    preset: &'static str,
    paper: String,
    tend: SpreadCell,
    t99: SpreadCell,
}

/// The part of the page about one world.
#[derive(Serialize)]
struct World<'a> {
    name: &'a str,
    id: String,
    picture: &'a super::WorldPicture,
    coverage_svg: String,
    summaries: Vec<SummaryRow>,
    trajectories: Vec<Trajectory<'a>>,
}

/// The way of one run on the picture of its world.
#[derive(Serialize)]
struct Trajectory<'a> {
    preset: &'a str,
    color: String,
    points: String,
    start: [String; 2],
    caption: String,
}

/// A row of the table of all runs.
#[derive(Serialize)]
struct RunRow<'a> {
    preset: &'a str,
    world: &'a str,
    start_number: usize,
    seed: u64,
    succeeded: bool,
    end: String,
    figures: Vec<String>,
}

impl Comparison {
    /// The page.
    ///
    /// # Errors
    /// [`ReportError::Template`] when it cannot be filled in, [`ReportError::Plot`] when
    /// a chart cannot be drawn.
    pub fn to_html(&self) -> Result<String, ReportError> {
        let mut environment = Environment::new();
        environment.add_template(TEMPLATE_NAME, TEMPLATE)?;
        let presets = self.plan.presets.iter().enumerate();
        let by_world = self.summaries_by_world();
        let worlds = self.plan.worlds.iter().enumerate();
        let page = Page {
            lead: self.lead(),
            missing: self.missing(),
            titles: Measure::ALL.map(Measure::title).to_vec(),
            has_oracle: self.plan.oracle().is_some(),
            legend: presets.map(|(i, preset)| Preset { name: &preset.name, color: css_color(i) }).collect(),
            summaries: summary_rows(&self.summaries()),
            liang: LiangTable::of(self).map(|table| liang(&table)),
            worlds: worlds.map(|(i, world)| self.world(i, world, &by_world)).collect::<Result<_, _>>()?,
            runs: self.runs.iter().map(run_row).collect(),
        };
        Ok(environment.get_template(TEMPLATE_NAME)?.render(Serde(&page))?)
    }

    /// What was compared, in a sentence.
    fn lead(&self) -> String {
        let plan = &self.plan;
        let starts: usize = plan.worlds.iter().map(|world| world.starts.len()).sum();
        let limit = plan.time_limit_s.map_or_else(String::new, |s| format!(" Time limit {s:.0} s."));
        format!(
            "{} of {} runs: presets {}, worlds {}, starts {starts} in all, seeds {}; robot {}.{limit}",
            self.runs.len(),
            plan.runs().len(),
            plan.presets.len(),
            plan.worlds.len(),
            plan.seeds.len(),
            plan.robot,
        )
    }

    fn world<'a>(
        &'a self,
        place: usize,
        world: &'a ComparedWorld,
        summaries: &[Summary],
    ) -> Result<World<'a>, ReportError> {
        let here: Vec<Summary> =
            summaries.iter().filter(|summary| summary.world.as_ref() == Some(&world.name)).cloned().collect();
        let trajectories = self.plan.presets.iter().enumerate().filter_map(|(i, preset)| {
            let run = self.runs_of(&preset.name, Some(&world.name)).next()?;
            Some(trajectory(run, world, css_color(i)))
        });
        Ok(World {
            name: &world.name,
            id: format!("world-{place}"),
            picture: &world.picture,
            coverage_svg: coverage_curves_svg(self, &world.name)?,
            summaries: summary_rows(&here),
            trajectories: trajectories.collect(),
        })
    }
}

/// The way of a run in pixels of its world's picture.
fn trajectory<'a>(run: &'a ComparedRun, world: &ComparedWorld, color: String) -> Trajectory<'a> {
    let in_px = |x: f64, y: f64| {
        let (x, y) = world.picture.to_px(Point::new(x, y));
        [format!("{x:.1}"), format!("{y:.1}")]
    };
    let points: Vec<String> = run.trajectory.iter().map(|&[x, y]| in_px(x, y).join(",")).collect();
    Trajectory {
        preset: &run.preset,
        color,
        points: points.join(" "),
        start: in_px(run.start.x, run.start.y),
        caption: format!(
            "start {}, seed {}: {:.1} %, {:.0} s, {:.0} m{}",
            run.start_number,
            run.seed,
            run.coverage * 100.0,
            run.sim_time_s,
            run.distance_m,
            if run.succeeded() { String::new() } else { format!(", {}", run.end_name().replace('_', " ")) }
        ),
    }
}

/// Rows in the order of the presets, which gives them their colours.
fn summary_rows(summaries: &[Summary]) -> Vec<SummaryRow> {
    let number = |value: Option<f64>, decimals: usize| value.map_or_else(dash, |v| format!("{v:.decimals$}"));
    let row = |(i, summary): (usize, &Summary)| SummaryRow {
        preset: summary.preset.clone(),
        color: css_color(i),
        runs: summary.runs,
        failed: summary.failed,
        measures: Measure::ALL.map(|measure| spread_cell(&summary.measure(measure), 0)).into(),
        to_oracle: summary.t99_to_oracle.map(|ratio| spread_cell(&ratio, 2)),
        coverage: summary.coverage.map_or_else(dash, |share| format!("{:.1} %", share * 100.0)),
        goals: number(summary.goals_sent, 0),
        goals_failed: summary.goals_failed,
        collisions: summary.collisions,
        decision_ms: [number(summary.decision_median_ms, 1), number(summary.decision_max_ms, 1)],
    };
    summaries.iter().enumerate().map(row).collect()
}

fn spread_cell(spread: &Spread, decimals: usize) -> SpreadCell {
    let number = |value: Option<f64>| value.map_or_else(|| "∞".to_owned(), |value| format!("{value:.decimals$}"));
    let shown = spread.reached > 0;
    let words = |text: String| if shown { text } else { String::new() };
    SpreadCell {
        median: if shown { number(spread.median) } else { dash() },
        range: words(format!("{}–{}", number(spread.q25), number(spread.q75))),
        interval: words(format!("[{}, {}]", number(spread.ci_low), number(spread.ci_high))),
        reached: format!("{}/{}", spread.reached, spread.of),
        all: spread.reached == spread.of,
    }
}

fn liang(table: &LiangTable) -> Liang {
    let cells = table.rows.iter().map(|row| LiangCells {
        method: row.method,
        preset: row.preset,
        paper: format!("{:.0}", row.paper_s),
        tend: spread_cell(&row.tend, 0),
        t99: spread_cell(&row.t99, 0),
    });
    Liang { rows: cells.collect(), verdict: table.verdict() }
}

fn run_row(run: &ComparedRun) -> RunRow<'_> {
    let times = [Measure::T50, Measure::T90, Measure::T95, Measure::T99].map(|measure| measure.of(run));
    let mut figures = vec![
        format!("{:.2}", run.coverage * 100.0),
        format!("{:.0}", run.sim_time_s),
        format!("{:.1}", run.distance_m),
    ];
    figures.extend(times.map(|time_s| time_s.map_or_else(dash, |s| format!("{s:.0}"))));
    figures.extend([run.goals_sent, run.goals_failed, run.collisions].map(|count| count.to_string()));
    figures.extend([run.wall.decision_ms.median, run.wall.decision_ms.max].map(|ms| format!("{ms:.2}")));
    RunRow {
        preset: &run.preset,
        world: &run.world,
        start_number: run.start_number,
        seed: run.seed,
        succeeded: run.succeeded(),
        end: run.end_name().replace('_', " "),
        figures,
    }
}

fn dash() -> String {
    "–".to_owned()
}

#[cfg(test)]
#[path = "page_tests.rs"]
mod tests;
