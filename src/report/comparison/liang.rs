//! Table 1 of Liang, Wang, Li 2020 beside our own museum.
//!
//! The paper lets a robot explore a museum hall in Gazebo with three ways of choosing
//! a frontier. Our museum is another building, so seconds cannot be compared with
//! seconds; what can hold or not is the order of the three.

use super::Comparison;
use super::measure::Measure;
use super::statistics::Spread;
use super::summary::Summary;
use serde::Serialize;

/// The world that stands for the paper's.
const WORLD: &str = "museum";

/// The paper's name of a method, our preset, and the paper's seconds; as in the paper.
const METHODS: [(&str, &str, f64); 3] = [
    ("closest frontier", "liang_closest", 431.0),
    ("maximum gain", "liang_max_gain", 515.0),
    ("proposed", "liang", 292.0),
];

/// The presets from the fastest to the slowest, as the paper has them.
const ORDER: [&str; 3] = ["liang", "liang_closest", "liang_max_gain"];

/// One method.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LiangRow {
    /// What the paper calls it.
    pub method: &'static str,
    /// Our preset.
    pub preset: &'static str,
    /// Seconds in the paper.
    pub paper_s: f64,
    /// Our seconds to the end.
    pub tend: Spread,
    /// Our seconds to 99 % of coverage.
    pub t99: Spread,
}

/// The table.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LiangTable {
    /// The methods in the paper's order.
    pub rows: Vec<LiangRow>,
    /// Whether proposed < closest < maximum gain holds for our medians of Tend.
    pub order_holds_tend: bool,
    /// Whether it holds for our medians of T99.
    pub order_holds_t99: bool,
}

impl LiangTable {
    /// The table, if the museum and all three presets are among the runs.
    #[must_use]
    pub fn of(comparison: &Comparison) -> Option<Self> {
        let summaries = comparison.summaries_by_world();
        let found = |preset: &str| {
            let here = |s: &&Summary| s.runs > 0 && s.preset == preset && s.world.as_deref() == Some(WORLD);
            summaries.iter().find(here)
        };
        let row = |(method, preset, paper_s)| {
            found(preset).map(|summary| LiangRow {
                method,
                preset,
                paper_s,
                tend: summary.measure(Measure::Tend),
                t99: summary.measure(Measure::T99),
            })
        };
        let rows: Vec<LiangRow> = METHODS.into_iter().map(row).collect::<Option<_>>()?;
        let holds = |measure: &dyn Fn(&LiangRow) -> Spread| {
            let medians = ORDER.map(|preset| {
                let median = rows.iter().find(|row| row.preset == preset).and_then(|row| measure(row).median);
                median.unwrap_or(f64::INFINITY)
            });
            medians.is_sorted_by(|faster, slower| faster < slower)
        };
        let (order_holds_tend, order_holds_t99) = (holds(&|row| row.tend), holds(&|row| row.t99));
        Some(Self { rows, order_holds_tend, order_holds_t99 })
    }

    /// Whether the order holds, in a sentence.
    #[must_use]
    pub fn verdict(&self) -> String {
        let holds = |holds: bool| if holds { "holds" } else { "does not hold" };
        let failed: usize = self.rows.iter().map(|row| row.tend.of - row.tend.reached).sum();
        let caution = if failed > 0 {
            format!(" {failed} of the runs failed and count as slower than all others.")
        } else {
            String::new()
        };
        format!(
            "The paper's order, proposed < closest frontier < maximum gain, {} for our median Tend and {} for our \
             median T99.{caution}",
            holds(self.order_holds_tend),
            holds(self.order_holds_t99)
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    fn table(presets: &[&str], world: &str, end_s: [f64; 3]) -> Option<LiangTable> {
        LiangTable::of(&sample::comparison(sample::plan(presets, &["office", world], &[1, 2]), |p| end_s[p]))
    }

    #[test]
    fn the_order_is_judged_by_medians() {
        let presets = ["liang", "liang_closest", "liang_max_gain"];
        let same = table(&presets, "museum", [300.0, 400.0, 500.0]).unwrap();
        assert!(same.order_holds_tend && same.order_holds_t99);
        let methods: Vec<_> = same.rows.iter().map(|row| (row.method, row.paper_s, row.tend.median)).collect();
        let ours = [("closest frontier", 431.0, Some(400.0)), ("maximum gain", 515.0, Some(500.0))];
        assert_eq!(methods[..2], ours);
        assert_eq!((same.rows[2].tend.of, same.rows[2].tend.median), (2, Some(300.0)));
        let other = table(&presets, "museum", [300.0, 400.0, 400.0]).unwrap();
        assert!(!other.order_holds_tend, "equal is not faster");
        assert!(other.verdict().contains("does not hold") && !other.verdict().contains("failed"));
        let failing = table(&presets, "museum", [300.0, 400.0, 500.0]).map(|mut table| {
            table.rows[1].tend = Spread::of([None, Some(1.0)]);
            table.verdict()
        });
        assert!(failing.unwrap().ends_with("1 of the runs failed and count as slower than all others."));
    }

    #[test]
    fn without_the_museum_or_a_preset_there_is_no_table() {
        assert_eq!(table(&["liang", "liang_closest", "liang_max_gain"], "maze", [1.0; 3]), None);
        assert_eq!(table(&["liang", "liang_closest", "wfd"], "museum", [1.0; 3]), None);
    }
}
