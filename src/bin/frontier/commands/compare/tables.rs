//! The results as tables on standard output.

use crate::output;
use comfy_table::{CellAlignment, Table};
use frontier_explorer::report::{Comparison, LiangTable, Measure, PAIRED, Paired, Spread, Summary};

/// How to read the cells.
const LEGEND: &str = "\
Cells: median (25-75 %), below it [bootstrap 95 % interval of the median] and the runs that
reached it. A run that does not reach a share counts as later than all that do (inf). Tend
and distance are those of runs that ended complete with at least 99 %; all others failed.";

/// The head of the column of [`Summary::t99_to_oracle`], and what it says.
const TO_ORACLE: &str = "T99/oracle's";
const ORACLE_LEGEND: &str = "\
T99/oracle's: T99 as a multiple of that of the oracle, which knows the world, in the same world,
from the same start, with the same seed. The oracle stops at 99 %.";

/// How to read the table of presets measured by one of them.
const PAIRED_LEGEND: &str = "\
Ratios of the medians, and the median (25-75 %) [95 % interval] of the ratios of T99 in the same
world from the same start with the same seed; in how many of these it came earlier.";

/// Prints all tables; also one of all presets measured by the one with a name.
pub fn print(comparison: &Comparison, against: Option<&str>) -> anyhow::Result<()> {
    output::line(format_args!("{}", summaries(&comparison.summaries())))?;
    output::line(format_args!("{LEGEND}"))?;
    if comparison.plan.oracle().is_some() {
        output::line(format_args!("{ORACLE_LEGEND}"))?;
    }
    if let Some((name, paired)) = against.and_then(|name| Some((name, comparison.paired_with(name)?))) {
        output::line(format_args!("\nMeasured by {name}:\n{}", measured(&paired)))?;
        output::line(format_args!("{PAIRED_LEGEND}"))?;
    }
    if comparison.plan.worlds.len() > 1 {
        output::line(format_args!("\n{}", by_world(&comparison.summaries_by_world())))?;
    }
    if let Some(table) = LiangTable::of(comparison) {
        output::line(format_args!("\nTable 1 of Liang, Wang, Li 2020 beside our museum, which is another building:"))?;
        output::line(format_args!("{}", liang(&table)))?;
        output::line(format_args!("{}", table.verdict()))?;
    }
    Ok(())
}

/// A row for each preset, over all worlds.
fn summaries(summaries: &[Summary]) -> Table {
    let head = ["preset", "runs", "failed"].into_iter().chain(Measure::ALL.map(Measure::title));
    let mut table = table(head.chain(to_oracle_head(summaries)).chain(["collisions", "ms/decision"]));
    for summary in summaries {
        let mut row = vec![summary.preset.clone(), summary.runs.to_string(), summary.failed.to_string()];
        row.extend(Measure::ALL.map(|measure| cell(&summary.measure(measure), 0)));
        row.extend(summary.t99_to_oracle.map(|ratio| cell(&ratio, 2)));
        let milliseconds = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |ms| format!("{ms:.1}"));
        row.push(summary.collisions.to_string());
        row.push(format!(
            "{}\nmax {}",
            milliseconds(summary.decision_median_ms),
            milliseconds(summary.decision_max_ms)
        ));
        table.add_row(row);
    }
    table
}

/// A row for each preset, measured by one of them.
fn measured(paired: &[Paired]) -> Table {
    let head = ["preset"].into_iter().chain(PAIRED.map(|measure| measure.title().split(' ').next().unwrap_or("")));
    let mut table = table(head.chain(["T99, place by place", "faster"]));
    for preset in paired {
        let mut row = vec![preset.preset.clone()];
        row.extend(preset.ratios.map(|ratio| number(ratio, 2)));
        row.push(cell(&preset.t99, 2));
        row.push(format!("{}/{}", preset.faster, preset.places));
        table.add_row(row);
    }
    table
}

/// A row for each preset in each world: medians alone.
fn by_world(summaries: &[Summary]) -> Table {
    let head = ["world", "preset", "runs", "failed"].into_iter().chain(Measure::ALL.map(Measure::title));
    let mut table = table(head.chain(to_oracle_head(summaries)).chain(["coverage (%)"]));
    for summary in summaries {
        let world = summary.world.clone().unwrap_or_default();
        let mut row = vec![world, summary.preset.clone(), summary.runs.to_string(), summary.failed.to_string()];
        row.extend(Measure::ALL.map(|measure| median(&summary.measure(measure), 0)));
        row.extend(summary.t99_to_oracle.map(|ratio| median(&ratio, 2)));
        row.push(summary.coverage.map_or_else(|| "-".to_owned(), |share| format!("{:.1}", share * 100.0)));
        table.add_row(row);
    }
    table
}

fn liang(liang: &LiangTable) -> Table {
    let mut table = table(["method", "preset", "paper (s)", "our Tend (s)", "our T99 (s)"]);
    for row in &liang.rows {
        let paper = format!("{:.0}", row.paper_s);
        table.add_row([row.method.to_owned(), row.preset.to_owned(), paper, median(&row.tend, 0), median(&row.t99, 0)]);
    }
    table
}

fn table(head: impl IntoIterator<Item = &'static str>) -> Table {
    let mut table = Table::new();
    table.load_style(comfy_table::presets::NOTHING);
    table.set_header(head);
    for (i, column) in table.column_iter_mut().enumerate() {
        column.set_cell_alignment(if i == 0 { CellAlignment::Left } else { CellAlignment::Right });
    }
    table
}

/// The head of the column that is there where an oracle takes part.
fn to_oracle_head(summaries: &[Summary]) -> Option<&'static str> {
    summaries.iter().any(|summary| summary.t99_to_oracle.is_some()).then_some(TO_ORACLE)
}

/// A spread in two lines.
fn cell(spread: &Spread, decimals: usize) -> String {
    if spread.reached == 0 {
        return format!("-\n0/{}", spread.of);
    }
    format!(
        "{} ({}-{})\n[{}, {}] {}/{}",
        number(spread.median, decimals),
        number(spread.q25, decimals),
        number(spread.q75, decimals),
        number(spread.ci_low, decimals),
        number(spread.ci_high, decimals),
        spread.reached,
        spread.of
    )
}

/// The median alone, and how many reached it if not all did.
fn median(spread: &Spread, decimals: usize) -> String {
    match (spread.reached, spread.of) {
        (0, of) => format!("- 0/{of}"),
        (reached, of) if reached < of => format!("{} {reached}/{of}", number(spread.median, decimals)),
        _ => number(spread.median, decimals),
    }
}

fn number(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "inf".to_owned(), |value| format!("{value:.decimals$}"))
}
