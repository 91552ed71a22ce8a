//! What the runs of a preset come to.

use super::measure::Measure;
use super::paired::t99_ratios;
use super::statistics::Spread;
use super::{ComparedRun, Comparison};
use serde::Serialize;
use std::collections::BTreeMap;

/// The runs of a preset, in one world or in all.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Summary {
    /// The preset's name.
    pub preset: String,
    /// The world's name, `None` for all worlds.
    pub world: Option<String>,
    /// How many runs.
    pub runs: usize,
    /// Of those, runs that did not end complete or covered less than 99 %.
    pub failed: usize,
    /// The median of the covered share at the end.
    pub coverage: Option<f64>,
    /// The median of the goals sent.
    pub goals_sent: Option<f64>,
    /// Goals given up, of all runs together.
    pub goals_failed: usize,
    /// Ticks at which a robot touched an obstacle, of all runs together.
    pub collisions: usize,
    /// What was measured.
    pub measures: BTreeMap<Measure, Spread>,
    /// Its T99 as a multiple of the oracle's in the same world, from the same start, with the
    /// same seed, where the oracle took part and reached it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub t99_to_oracle: Option<Spread>,
    /// The median over the runs of the median time of a decision, milliseconds.
    #[serde(skip)]
    pub decision_median_ms: Option<f64>,
    /// The longest decision, milliseconds.
    #[serde(skip)]
    pub decision_max_ms: Option<f64>,
}

impl Summary {
    fn of(comparison: &Comparison, preset: &str, world: Option<&str>) -> Self {
        let runs: Vec<&ComparedRun> = comparison.runs_of(preset, world).collect();
        let median = |value: &dyn Fn(&ComparedRun) -> f64| Spread::of(runs.iter().map(|run| Some(value(run)))).median;
        let measure = |measure: Measure| (measure, Spread::of(runs.iter().map(|run| measure.of(run))));
        Self {
            preset: preset.to_owned(),
            world: world.map(str::to_owned),
            runs: runs.len(),
            failed: runs.iter().filter(|run| !run.succeeded()).count(),
            coverage: median(&|run| run.coverage),
            goals_sent: median(&|run| run.goals_sent as f64),
            goals_failed: runs.iter().map(|run| run.goals_failed).sum(),
            collisions: runs.iter().map(|run| run.collisions).sum(),
            measures: Measure::ALL.into_iter().map(measure).collect(),
            t99_to_oracle: comparison.t99_to_oracle(&runs),
            decision_median_ms: median(&|run| run.wall.decision_ms.median),
            decision_max_ms: runs.iter().map(|run| run.wall.decision_ms.max).reduce(f64::max),
        }
    }

    /// One measure.
    #[must_use]
    pub fn measure(&self, measure: Measure) -> Spread {
        self.measures.get(&measure).copied().unwrap_or_default()
    }
}

impl Comparison {
    /// How many times as long as the oracle's some runs took to 99 %; `None` without an oracle.
    fn t99_to_oracle(&self, runs: &[&ComparedRun]) -> Option<Spread> {
        let oracle = self.plan.oracle()?;
        Some(t99_ratios(&self.beside(&oracle.name, runs.iter().copied())))
    }

    /// One summary for each preset, over all worlds.
    #[must_use]
    pub fn summaries(&self) -> Vec<Summary> {
        self.plan.presets.iter().map(|preset| Summary::of(self, &preset.name, None)).collect()
    }

    /// One summary for each preset in each world, world by world.
    #[must_use]
    pub fn summaries_by_world(&self) -> Vec<Summary> {
        let of_world = |world| self.plan.presets.iter().map(move |preset| Summary::of(self, &preset.name, Some(world)));
        self.plan.worlds.iter().flat_map(|world| of_world(world.name.as_str())).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn failures_are_counted_and_count_as_not_reached() {
        let mut comparison = sample::comparison(sample::plan(&["a", "b"], &["w"], &[1, 2, 3]), |p| [100.0, 200.0][p]);
        comparison.runs[0].coverage = 0.97;
        comparison.runs[0].time_to_coverage_s.insert("0.99".to_owned(), None);
        let [a, b]: [Summary; 2] = comparison.summaries().try_into().unwrap();
        assert_eq!((a.runs, a.failed, b.runs, b.failed), (3, 1, 3, 0));
        let tend = a.measure(Measure::Tend);
        assert_eq!((tend.reached, tend.of, tend.median, tend.q75), (2, 3, Some(100.0), None));
        assert_eq!(a.measure(Measure::T99).reached, 2);
        assert_eq!(a.measure(Measure::T50).reached, 3);
        assert_eq!(b.measure(Measure::T50).median, Some(100.0));
        assert_eq!(b.measure(Measure::Distance).median, Some(100.0));
    }

    #[test]
    fn a_time_is_a_multiple_of_the_oracles_in_the_same_place() {
        let plan = sample::plan(&["a", "oracle"], &["v", "w"], &[1, 2]);
        let mut comparison = sample::comparison(plan, |p| [150.0, 100.0][p]);
        // The oracle of one run is slower, of one it is missing, and one run never gets there.
        comparison.runs[1].time_to_coverage_s.insert("0.99".to_owned(), Some(148.5));
        comparison.runs[2].time_to_coverage_s.insert("0.99".to_owned(), None);
        comparison.runs.remove(7);
        let [a, oracle]: [Summary; 2] = comparison.summaries().try_into().unwrap();
        let ratio = a.t99_to_oracle.unwrap();
        assert_eq!((ratio.reached, ratio.of, ratio.median, ratio.q25), (2, 3, Some(1.5), Some(1.25)));
        assert_eq!(oracle.t99_to_oracle.unwrap().median, Some(1.0));
        assert_eq!(comparison.summaries_by_world()[2].t99_to_oracle.unwrap().of, 1);
        let without = sample::comparison(sample::plan(&["a"], &["w"], &[1]), |_| 100.0);
        assert_eq!(without.summaries()[0].t99_to_oracle, None);
    }

    #[test]
    fn a_preset_without_runs_keeps_its_row() {
        let comparison = Comparison { plan: sample::plan(&["a"], &["w"], &[1]), runs: Vec::new() };
        let summaries = comparison.summaries();
        assert_eq!((summaries.len(), summaries[0].runs, comparison.missing()), (1, 0, 1));
        assert_eq!(summaries[0].decision_max_ms, None);
    }
}
