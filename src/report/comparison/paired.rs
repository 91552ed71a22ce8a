//! Presets measured by one of them, place by place: a world, a start and a seed.

use super::measure::Measure;
use super::statistics::{Spread, quantile};
use super::{ComparedRun, Comparison};
use std::collections::BTreeMap;

/// The measures that are compared, in the order of [`Paired::ratios`].
pub const PAIRED: [Measure; 4] = [Measure::T90, Measure::T95, Measure::T99, Measure::Tend];

/// A run, and one of another preset in the same place.
pub(super) type Pair<'a> = (&'a ComparedRun, &'a ComparedRun);

/// The T99 of each run by the other's, where the other reached it.
pub(super) fn t99_ratios(pairs: &[Pair<'_>]) -> Spread {
    let ratio = |run: &ComparedRun, other_s: f64| match Measure::T99.of(run)? {
        // Where a first look is enough, nobody is slower.
        time_s if time_s <= other_s && other_s == 0.0 => Some(1.0),
        time_s => Some(time_s / other_s).filter(|ratio| ratio.is_finite()),
    };
    Spread::of(pairs.iter().filter_map(|(run, other)| Some(ratio(run, Measure::T99.of(other)?))))
}

/// A preset measured by another one.
#[derive(Clone, Debug, PartialEq)]
pub struct Paired {
    /// The preset's name.
    pub preset: String,
    /// Its median by the other's median for each of [`PAIRED`], over the places where both ran;
    /// `None` where either is not reached.
    pub ratios: [Option<f64>; 4],
    /// Its T99 by the other's in the same place. A preset that does not reach it counts as later
    /// than all that do.
    pub t99: Spread,
    /// In how many places its T99 came earlier.
    pub faster: usize,
    /// In how many places both ran.
    pub places: usize,
}

impl Comparison {
    /// All presets measured by the one with a name; `None` when there is no such preset.
    #[must_use]
    pub fn paired_with(&self, name: &str) -> Option<Vec<Paired>> {
        let presets = &self.plan.presets;
        presets.iter().any(|preset| preset.name == name).then(|| {
            let paired = |preset: &str| Paired::of(preset, &self.beside(name, self.runs_of(preset, None)));
            presets.iter().map(|preset| paired(&preset.name)).collect()
        })
    }

    /// Runs with those of the preset with a name in the same places, where there are such.
    pub(super) fn beside<'a>(&'a self, name: &'a str, runs: impl Iterator<Item = &'a ComparedRun>) -> Vec<Pair<'a>> {
        let place = |run: &ComparedRun| (run.world.clone(), run.start_number, run.seed);
        let others: BTreeMap<_, &ComparedRun> = self.runs_of(name, None).map(|run| (place(run), run)).collect();
        runs.filter_map(|run| Some((run, *others.get(&place(run))?))).collect()
    }
}

impl Paired {
    fn of(preset: &str, pairs: &[Pair<'_>]) -> Self {
        let late = |measure: Measure, run: &ComparedRun| measure.of(run).unwrap_or(f64::INFINITY);
        let ratio = |measure: Measure| {
            let ours = median(pairs.iter().map(|(run, _)| late(measure, run)));
            let ratio = ours / median(pairs.iter().map(|(_, other)| late(measure, other)));
            (ours.is_finite() && ratio.is_finite() && ratio > 0.0).then_some(ratio)
        };
        let is_faster = |(run, other): &&Pair<'_>| late(Measure::T99, run) < late(Measure::T99, other);
        Self {
            preset: preset.to_owned(),
            ratios: PAIRED.map(ratio),
            t99: t99_ratios(pairs),
            faster: pairs.iter().filter(is_faster).count(),
            places: pairs.len(),
        }
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    quantile(&sorted, 0.5)
}

#[cfg(test)]
mod tests {
    use super::super::sample;
    use super::*;

    #[test]
    fn ratios_are_of_the_same_places_alone() {
        let plan = sample::plan(&["a", "b"], &["v", "w"], &[1, 2]);
        let mut comparison = sample::comparison(plan, |p| [80.0, 100.0][p]);
        // One run never gets to 99 %, one of the other preset's was not made.
        comparison.runs[0].time_to_coverage_s.insert("0.99".to_owned(), None);
        comparison.runs.remove(7);
        let [a, b]: [Paired; 2] = comparison.paired_with("b").unwrap().try_into().unwrap();
        assert_eq!((a.places, a.faster, b.faster), (3, 2, 0));
        assert_eq!((a.t99.reached, a.t99.of, a.t99.median), (2, 3, Some(0.8)));
        assert_eq!((a.ratios[2], b.ratios), (Some(0.8), [Some(1.0); 4]));
        assert_eq!(comparison.paired_with("c"), None);
    }

    #[test]
    fn what_most_runs_do_not_reach_has_no_ratio() {
        let mut comparison = sample::comparison(sample::plan(&["a", "b"], &["w"], &[1, 2, 3]), |_| 100.0);
        for run in comparison.runs.iter_mut().filter(|run| run.preset == "a" && run.seed < 3) {
            run.time_to_coverage_s.insert("0.99".to_owned(), None);
        }
        let paired = comparison.paired_with("b").unwrap();
        assert_eq!((paired[0].ratios[2], paired[0].t99.median, paired[0].faster), (None, None, 0));
        assert_eq!(paired[0].ratios[0], Some(1.0));
    }
}
