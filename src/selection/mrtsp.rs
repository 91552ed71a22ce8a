//! An order over all frontiers: the travelling salesman whose every leg is weighed by
//! what waits at its end.
//!
//! After the minimum-ratio travelling salesman of Scientific Reports 2025
//! (s41598-025-97231-9): a leg costs its length divided by the gain at its end, and the
//! open tour from the robot with the least sum is driven from its beginning. A leg from
//! the robot is as long as the planner's way; between frontiers the straight line
//! serves. Up to [`EXACT_UP_TO`] frontiers the best order is found by dynamic
//! programming (Held and Karp 1962), beyond that by the nearest neighbour improved by
//! moving single frontiers (or-opt) until nothing improves. O(n^2 2^n) and O(n^3).

use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};

/// The most frontiers that are ordered exactly.
pub const EXACT_UP_TO: usize = 10;

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
/// use frontier_explorer::selection::{Candidate, GoalSelector, Mrtsp, SelectionContext};
///
/// let robot_in_map = Pose::default();
/// let at = |x: f64, cells| Candidate {
///     way_m: Some(x.abs()),
///     ..Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), cells, 0.5, &robot_in_map)
/// };
/// let scores = Mrtsp.score(&[at(-2.5, 8), at(2.0, 1)], &SelectionContext { robot_in_map });
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

    fn score(&mut self, candidates: &[Candidate], _: &SelectionContext) -> Vec<Score> {
        let first: Vec<f64> = candidates.iter().map(|c| c.way_m.unwrap_or(c.distance_m) / gain_m(c)).collect();
        let mut nearest_first: Vec<usize> = (0..candidates.len()).collect();
        nearest_first.sort_by(|&a, &b| first[a].total_cmp(&first[b]).then(a.cmp(&b)));
        let (kept, cut_off) = nearest_first.split_at(nearest_first.len().min(MOST));
        let legs = Legs::new(kept.iter().map(|&index| (&candidates[index], first[index])));
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

/// The ratios of all legs of a tour.
struct Legs {
    /// From the robot.
    first: Vec<f64>,
    /// From one frontier (row) to another (column).
    between: Vec<f64>,
}

impl Legs {
    /// Of candidates with the ratios of their legs from the robot.
    fn new<'a>(nodes: impl Iterator<Item = (&'a Candidate, f64)>) -> Self {
        let (nodes, first): (Vec<&Candidate>, Vec<f64>) = nodes.unzip();
        let between = nodes
            .iter()
            .flat_map(|a| {
                let from = a.goal.position();
                nodes.iter().map(move |b| b.goal.distance_to(from) / gain_m(b))
            })
            .collect();
        Self { first, between }
    }

    fn between(&self, a: usize, b: usize) -> f64 {
        self.between[a * self.first.len() + b]
    }

    /// The leg to a frontier from the one before it, or from the robot.
    fn leg(&self, before: Option<usize>, node: usize) -> f64 {
        before.map_or(self.first[node], |before| self.between(before, node))
    }

    /// The order of least cost, by dynamic programming over sets.
    fn best_order(&self) -> Vec<usize> {
        let count = self.first.len();
        if count == 0 {
            return Vec::new();
        }
        // least[set * count + last]: cost of the best way through `set` that ends at `last`.
        let mut least = vec![f64::INFINITY; count << count];
        let mut before = vec![usize::MAX; count << count];
        for (last, &cost) in self.first.iter().enumerate() {
            least[(1 << last) * count + last] = cost;
        }
        for set in 1..1_usize << count {
            for last in (0..count).filter(|last| set & (1 << last) != 0) {
                let here = least[set * count + last];
                for next in (0..count).filter(|next| set & (1 << next) == 0) {
                    let slot = (set | 1 << next) * count + next;
                    let cost = here + self.between(last, next);
                    if cost < least[slot] {
                        least[slot] = cost;
                        before[slot] = last;
                    }
                }
            }
        }
        let mut set = (1 << count) - 1;
        let mut last =
            (0..count).min_by(|&a, &b| least[set * count + a].total_cmp(&least[set * count + b])).unwrap_or_default();
        let mut order = vec![last];
        while before[set * count + last] != usize::MAX {
            let previous = before[set * count + last];
            set &= !(1 << last);
            last = previous;
            order.push(last);
        }
        order.reverse();
        order
    }

    /// A good order: nearest neighbour, then single moves while they help.
    fn good_order(&self) -> Vec<usize> {
        let mut left: Vec<usize> = (0..self.first.len()).collect();
        let mut tour: Vec<usize> = Vec::with_capacity(left.len());
        while !left.is_empty() {
            let leg = |&node: &usize| self.leg(tour.last().copied(), node);
            let next = (0..left.len()).min_by(|&a, &b| leg(&left[a]).total_cmp(&leg(&left[b]))).unwrap_or_default();
            let node = left.remove(next);
            tour.push(node);
        }
        while self.improve(&mut tour) {}
        tour
    }

    /// Moves one frontier to a better place, if there is one.
    fn improve(&self, tour: &mut Vec<usize>) -> bool {
        for from in 0..tour.len() {
            let node = tour.remove(from);
            let gained = self.detour(tour, from, node);
            let better = (0..=tour.len()).find(|&to| to != from && self.detour(tour, to, node) < gained - 1e-9);
            tour.insert(better.unwrap_or(from), node);
            if better.is_some() {
                return true;
            }
        }
        false
    }

    /// By how much a frontier lengthens a tour at a place in it.
    fn detour(&self, tour: &[usize], place: usize, node: usize) -> f64 {
        let before = place.checked_sub(1).map(|before| tour[before]);
        let here = self.leg(before, node);
        tour.get(place).map_or(here, |&after| here + self.between(node, after) - self.leg(before, after))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Pose};
    use proptest::prelude::*;

    fn candidates(places: &[(f64, f64, f64)]) -> Vec<Candidate> {
        let at = |&(x, y, size_m): &(f64, f64, f64)| {
            let (target, goal) = (Point::new(x, y), Pose::new(x, y, 0.0));
            Candidate { way_m: Some(x.hypot(y)), ..Candidate::new(target, goal, 1, size_m, &Pose::default()) }
        };
        places.iter().map(at).collect()
    }

    fn legs(places: &[(f64, f64, f64)]) -> Legs {
        Legs::new(candidates(places).iter().map(|c| (c, c.distance_m / gain_m(c))))
    }

    fn cost(legs: &Legs, tour: &[usize]) -> f64 {
        let before = [None].into_iter().chain(tour.iter().copied().map(Some));
        before.zip(tour).map(|(before, &node)| legs.leg(before, node)).sum()
    }

    #[test]
    fn long_legs_lead_to_what_is_large() {
        // 2 / 0.5 + 4.5 / 4 = 5.1 against 2.5 / 4 + 4.5 / 0.5 = 9.6
        let legs = legs(&[(2.0, 0.0, 0.5), (-2.5, 0.0, 4.0)]);
        assert_eq!(legs.best_order(), [0, 1]);
        assert!((cost(&legs, &[0, 1]) - 5.125).abs() < 1e-9 && (cost(&legs, &[1, 0]) - 9.625).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn exact_orders_are_the_best_and_good_ones_are_orders(
            places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 0.1f64..3.0), 1..7),
        ) {
            let legs = legs(&places);
            let nodes: Vec<usize> = (0..places.len()).collect();
            let best = legs.best_order();
            let least = permutations(&nodes).iter().map(|p| cost(&legs, p)).fold(f64::INFINITY, f64::min);
            prop_assert!((cost(&legs, &best) - least).abs() < 1e-9);
            let mut good = legs.good_order();
            prop_assert!(cost(&legs, &good) >= least - 1e-9);
            // No single move makes it better.
            for from in 0..good.len() {
                for to in 0..good.len() {
                    let mut moved = good.clone();
                    let node = moved.remove(from);
                    moved.insert(to, node);
                    prop_assert!(cost(&legs, &moved) >= cost(&legs, &good) - 1e-6);
                }
            }
            good.sort_unstable();
            prop_assert_eq!(good, nodes);
        }
    }

    fn permutations(nodes: &[usize]) -> Vec<Vec<usize>> {
        if nodes.is_empty() {
            return vec![Vec::new()];
        }
        let with_first = |i: usize| {
            let mut rest = nodes.to_vec();
            let first = rest.remove(i);
            permutations(&rest).into_iter().map(move |mut p| {
                p.insert(0, first);
                p
            })
        };
        (0..nodes.len()).flat_map(with_first).collect()
    }
}
