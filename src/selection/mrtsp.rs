//! An order over all frontiers: the travelling salesman whose every leg is weighed by
//! what waits at its end.
//!
//! After the minimum-ratio travelling salesman of Scientific Reports 2025
//! (s41598-025-97231-9): a leg costs its length divided by the gain at its end, and the
//! open tour from the robot with the least sum is driven from its beginning. A leg from
//! the robot is as long as the planner's way; between frontiers the straight line
//! serves. Up to ten frontiers the best order is found by dynamic
//! programming (Held and Karp 1962), beyond that by the nearest neighbour improved by
//! moving single frontiers (or-opt) until nothing improves. O(n^2 2^n) and O(n^3).

use super::open_tour::{EXACT_UP_TO, OpenTour};
use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};

/// More frontiers than this are cut off: the least attractive legs from the robot.
const MOST: usize = 80;

/// The smallest gain, metres: a ratio needs one.
const LEAST_GAIN_M: f64 = 0.05;

/// The strategy.
///
/// The first place of the tour need not be the best single leg: from the robot the large frontier
/// has the better ratio, 2.5 / 4, but the long leg between the two had better lead to it.
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{Candidate, GoalSelector, Mrtsp, SelectionContext, StraightWays};
///
/// let robot_in_map = Pose::default();
/// let at = |x: f64, cells| Candidate {
///     way_m: Some(x.abs()),
///     ..Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), cells, 0.5, &robot_in_map)
/// };
/// let mut ways = StraightWays { robot_in_map };
/// let scores = Mrtsp.score(&[at(-2.5, 8), at(2.0, 1)], &mut SelectionContext::straight(&mut ways));
/// assert_eq!((scores[0].parts["ratio"], scores[1].parts["ratio"]), (0.625, 4.0));
/// assert_eq!((scores[0].total, scores[1].total), (1.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Mrtsp;

impl GoalSelector for Mrtsp {
    fn name(&self) -> &'static str {
        "mrtsp"
    }

    fn needs(&self) -> Needs {
        Needs { way: true, ..Needs::default() }
    }

    fn score(&mut self, candidates: &[Candidate], _: &mut SelectionContext<'_>) -> Vec<Score> {
        let first: Vec<f64> = candidates.iter().map(|c| c.way_m.unwrap_or(c.distance_m) / gain_m(c)).collect();
        let mut nearest_first: Vec<usize> = (0..candidates.len()).collect();
        nearest_first.sort_by(|&a, &b| first[a].total_cmp(&first[b]).then(a.cmp(&b)));
        let (kept, cut_off) = nearest_first.split_at(nearest_first.len().min(MOST));
        let legs = legs(kept.iter().map(|&index| (&candidates[index], first[index])));
        let tour = if kept.len() <= EXACT_UP_TO { legs.best_order() } else { legs.good_order() };
        let order = tour.iter().map(|&node| kept[node]).chain(cut_off.iter().copied());
        let mut scores = vec![Score::default(); candidates.len()];
        for (place, index) in order.enumerate() {
            let parts = [("place", place as f64), ("ratio", first[index])];
            scores[index] = Score { total: place as f64, parts: parts.into() };
        }
        scores
    }
}

fn gain_m(candidate: &Candidate) -> f64 {
    candidate.size_m.max(LEAST_GAIN_M)
}

/// The ratios of all legs, of candidates with those of their legs from the robot.
fn legs<'a>(nodes: impl Iterator<Item = (&'a Candidate, f64)>) -> OpenTour {
    let (nodes, first): (Vec<&Candidate>, Vec<f64>) = nodes.unzip();
    let between = nodes.iter().flat_map(|a| {
        let from = a.goal.position();
        nodes.iter().map(move |b| b.goal.distance_to(from) / gain_m(b))
    });
    OpenTour { between: between.collect(), first }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Pose};

    fn candidates(places: &[(f64, f64, f64)]) -> Vec<Candidate> {
        let at = |&(x, y, size_m): &(f64, f64, f64)| {
            let (target, goal) = (Point::new(x, y), Pose::new(x, y, 0.0));
            Candidate { way_m: Some(x.hypot(y)), ..Candidate::new(target, goal, 1, size_m, &Pose::default()) }
        };
        places.iter().map(at).collect()
    }

    #[test]
    fn long_legs_lead_to_what_is_large() {
        // 2 / 0.5 + 4.5 / 4 = 5.1 against 2.5 / 4 + 4.5 / 0.5 = 9.6
        let nodes = candidates(&[(2.0, 0.0, 0.5), (-2.5, 0.0, 4.0)]);
        let legs = legs(nodes.iter().map(|c| (c, c.distance_m / gain_m(c))));
        assert_eq!(legs.best_order(), [0, 1]);
        assert!((legs.cost(&[0, 1]) - 5.125).abs() < 1e-9 && (legs.cost(&[1, 0]) - 9.625).abs() < 1e-9);
    }
}
