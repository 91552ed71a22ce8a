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

use super::{Candidate, GoalSelector, Score, SelectionContext};

/// The most frontiers that are ordered exactly.
pub const EXACT_UP_TO: usize = 10;

/// More frontiers than this are cut off: the least attractive legs from the robot.
const MOST: usize = 80;

/// The smallest gain, metres: a ratio needs one.
const LEAST_GAIN_M: f64 = 0.05;

/// The strategy.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mrtsp;

impl GoalSelector for Mrtsp {
    fn name(&self) -> &'static str {
        "mrtsp"
    }

    fn needs_ways(&self) -> bool {
        true
    }

    fn score(&mut self, candidates: &[Candidate], _: &SelectionContext) -> Vec<Score> {
        let legs = Legs::new(candidates);
        let mut nearest_first: Vec<usize> = (0..candidates.len()).collect();
        nearest_first.sort_by(|&a, &b| legs.first[a].total_cmp(&legs.first[b]).then(a.cmp(&b)));
        let (kept, cut_off) = nearest_first.split_at(nearest_first.len().min(MOST));
        let tour = if kept.len() <= EXACT_UP_TO { legs.best_order(kept) } else { legs.good_order(kept) };
        let mut scores = vec![Score::default(); candidates.len()];
        for (place, &index) in tour.iter().chain(cut_off).enumerate() {
            let ratio = legs.first[index];
            scores[index] = Score { total: place as f64, parts: [("place", place as f64), ("ratio", ratio)].into() };
        }
        scores
    }
}

/// The ratios of all legs.
struct Legs {
    /// From the robot.
    first: Vec<f64>,
    /// From one frontier (row) to another (column).
    between: Vec<f64>,
}

impl Legs {
    fn new(candidates: &[Candidate]) -> Self {
        let gain_m = |c: &Candidate| c.size_m.max(LEAST_GAIN_M);
        let first = candidates.iter().map(|c| c.way_m.unwrap_or(c.distance_m) / gain_m(c)).collect();
        let between = candidates
            .iter()
            .flat_map(|a| {
                let from = a.goal.position();
                candidates.iter().map(move |b| b.goal.distance_to(from) / gain_m(b))
            })
            .collect();
        Self { first, between }
    }

    fn between(&self, a: usize, b: usize) -> f64 {
        self.between[a * self.first.len() + b]
    }

    fn cost(&self, tour: &[usize]) -> f64 {
        let first = tour.first().map_or(0.0, |&index| self.first[index]);
        first + tour.windows(2).map(|pair| self.between(pair[0], pair[1])).sum::<f64>()
    }

    /// The order of least cost, by dynamic programming over sets.
    fn best_order(&self, nodes: &[usize]) -> Vec<usize> {
        let count = nodes.len();
        if count == 0 {
            return Vec::new();
        }
        // least[set * count + last]: cost of the best way through `set` that ends at `last`.
        let mut least = vec![f64::INFINITY; count << count];
        let mut before = vec![usize::MAX; count << count];
        for (last, &node) in nodes.iter().enumerate() {
            least[(1 << last) * count + last] = self.first[node];
        }
        for set in 1..1_usize << count {
            for last in (0..count).filter(|last| set & (1 << last) != 0) {
                let here = least[set * count + last];
                for next in (0..count).filter(|next| set & (1 << next) == 0) {
                    let slot = (set | 1 << next) * count + next;
                    let cost = here + self.between(nodes[last], nodes[next]);
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
        let mut order = vec![nodes[last]];
        while before[set * count + last] != usize::MAX {
            let previous = before[set * count + last];
            set &= !(1 << last);
            last = previous;
            order.push(nodes[last]);
        }
        order.reverse();
        order
    }

    /// A good order: nearest neighbour, then single moves while they help.
    fn good_order(&self, nodes: &[usize]) -> Vec<usize> {
        let mut left = nodes.to_vec();
        let mut tour: Vec<usize> = Vec::with_capacity(nodes.len());
        while !left.is_empty() {
            let leg = |&node: &usize| tour.last().map_or(self.first[node], |&last| self.between(last, node));
            let next = (0..left.len()).min_by(|&a, &b| leg(&left[a]).total_cmp(&leg(&left[b]))).unwrap_or_default();
            let node = left.remove(next);
            tour.push(node);
        }
        while self.improve(&mut tour) {}
        tour
    }

    /// Moves one frontier to a better place, if there is one.
    fn improve(&self, tour: &mut Vec<usize>) -> bool {
        let cost = self.cost(tour);
        for from in 0..tour.len() {
            let mut without = tour.clone();
            let node = without.remove(from);
            for to in (0..=without.len()).filter(|&to| to != from) {
                let mut moved = without.clone();
                moved.insert(to, node);
                if self.cost(&moved) < cost - 1e-9 {
                    *tour = moved;
                    return true;
                }
            }
        }
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Point, Pose};
    use proptest::prelude::*;

    fn candidates(places: &[(f64, f64, f64)]) -> Vec<Candidate> {
        let at = |&(x, y, size_m): &(f64, f64, f64)| {
            let distance_m = x.hypot(y);
            Candidate {
                target: Point::new(x, y),
                goal: Pose::new(x, y, 0.0),
                size_cells: 1,
                size_m,
                radius_m: 0.0,
                distance_m,
                nearest_m: distance_m,
                way_m: Some(distance_m),
            }
        };
        places.iter().map(at).collect()
    }

    #[test]
    fn long_legs_lead_to_what_is_large() {
        // 2 / 0.5 + 4.5 / 4 = 5.1 against 2.5 / 4 + 4.5 / 0.5 = 9.6
        let legs = Legs::new(&candidates(&[(2.0, 0.0, 0.5), (-2.5, 0.0, 4.0)]));
        assert_eq!(legs.best_order(&[0, 1]), [0, 1]);
        assert!((legs.cost(&[0, 1]) - 5.125).abs() < 1e-9 && (legs.cost(&[1, 0]) - 9.625).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn exact_orders_are_the_best_and_good_ones_are_orders(
            places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 0.1f64..3.0), 1..7),
        ) {
            let legs = Legs::new(&candidates(&places));
            let nodes: Vec<usize> = (0..places.len()).collect();
            let best = legs.best_order(&nodes);
            let least = permutations(&nodes).iter().map(|p| legs.cost(p)).fold(f64::INFINITY, f64::min);
            prop_assert!((legs.cost(&best) - least).abs() < 1e-9);
            let mut good = legs.good_order(&nodes);
            prop_assert!(legs.cost(&good) >= least - 1e-9);
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
