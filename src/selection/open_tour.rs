//! Open tours: an order of places in which each leg costs something, from the robot on and
//! without a way back.
//!
//! Up to [`EXACT_UP_TO`] places the best order is found by dynamic programming (Held and Karp
//! 1962). O(n^2 2^n), beyond that O(n^3) a round of improvements.

/// The most places that are ordered exactly.
pub const EXACT_UP_TO: usize = 10;

/// The longest part of a tour that is moved in one, places.
const LONGEST_PART: usize = 3;

/// What the legs of all tours cost.
pub struct OpenTour {
    /// From the robot.
    pub first: Vec<f64>,
    /// From one place (row) to another (column).
    pub between: Vec<f64>,
}

impl OpenTour {
    fn between(&self, a: usize, b: usize) -> f64 {
        self.between[a * self.first.len() + b]
    }

    /// The leg to a place from the one before it, or from the robot.
    pub fn leg(&self, before: Option<usize>, node: usize) -> f64 {
        before.map_or(self.first[node], |before| self.between(before, node))
    }

    /// The order of least cost, by dynamic programming over sets.
    pub fn best_order(&self) -> Vec<usize> {
        self.exact_order(|_| true)
    }

    /// The same of the orders that begin with a place of which this holds.
    fn exact_order(&self, may_begin: impl Fn(usize) -> bool) -> Vec<usize> {
        let count = self.first.len();
        if count == 0 {
            return Vec::new();
        }
        // least[set * count + last]: cost of the best way through `set` that ends at `last`.
        let mut least = vec![f64::INFINITY; count << count];
        let mut before = vec![usize::MAX; count << count];
        for (last, &cost) in self.first.iter().enumerate().filter(|&(node, _)| may_begin(node)) {
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
    pub fn good_order(&self) -> Vec<usize> {
        let mut tour = self.nearest_neighbours(None);
        while self.improve(&mut tour) {}
        tour
    }

    /// Moves one place to a better place, if there is one.
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

    /// By how much a place lengthens a tour at a place in it.
    fn detour(&self, tour: &[usize], place: usize, node: usize) -> f64 {
        let before = place.checked_sub(1).map(|before| tour[before]);
        let here = self.leg(before, node);
        tour.get(place).map_or(here, |&after| here + self.between(node, after) - self.leg(before, after))
    }

    /// What a tour costs.
    pub fn cost(&self, tour: &[usize]) -> f64 {
        let before = [None].into_iter().chain(tour.iter().copied().map(Some));
        before.zip(tour).map(|(before, &node)| self.leg(before, node)).sum()
    }

    /// The best tour that begins with a place, and what it costs: the exact one of few places,
    /// and of many the nearest neighbours', bettered by turning parts round (2-opt) and moving
    /// parts (Or-opt) until nothing helps.
    pub fn best_from(&self, begin: usize) -> (Vec<usize>, f64) {
        let is_small = self.first.len() <= EXACT_UP_TO;
        self.with_cost(if is_small {
            self.exact_order(|node| node == begin)
        } else {
            self.bettered(self.nearest_neighbours(Some(begin)))
        })
    }

    fn with_cost(&self, tour: Vec<usize>) -> (Vec<usize>, f64) {
        let cost = self.cost(&tour);
        (tour, cost)
    }

    /// Always on to the nearest place that is left, from the robot or from a given place on.
    fn nearest_neighbours(&self, begin: Option<usize>) -> Vec<usize> {
        let mut left: Vec<usize> = (0..self.first.len()).filter(|&node| Some(node) != begin).collect();
        let mut tour: Vec<usize> = begin.into_iter().collect();
        while !left.is_empty() {
            let leg = |&node: &usize| self.leg(tour.last().copied(), node);
            let next = (0..left.len()).min_by(|&a, &b| leg(&left[a]).total_cmp(&leg(&left[b]))).unwrap_or_default();
            let node = left.remove(next);
            tour.push(node);
        }
        tour
    }

    fn bettered(&self, mut tour: Vec<usize>) -> Vec<usize> {
        let mut cost = self.cost(&tour);
        loop {
            let better = self.neighbour_tours(&tour).find(|(_, other)| *other < cost - 1e-9);
            let Some(better) = better else { return tour };
            (tour, cost) = better;
        }
    }

    /// The tours that differ by one move, the first place staying where it is, and their costs.
    fn neighbour_tours<'a>(&'a self, tour: &'a [usize]) -> impl Iterator<Item = (Vec<usize>, f64)> + 'a {
        let count = tour.len();
        let turned = (1..count).flat_map(move |from| {
            (from + 2..=count).map(move |to| {
                let mut other = tour.to_vec();
                other[from..to].reverse();
                other
            })
        });
        let moved = (1..count).flat_map(move |from| {
            (1..=LONGEST_PART.min(count - from)).flat_map(move |length| {
                (1..=count - length).filter(move |&to| to != from).map(move |to| {
                    let mut other = tour.to_vec();
                    let part: Vec<usize> = other.drain(from..from + length).collect();
                    other.splice(to..to, part);
                    other
                })
            })
        });
        turned.chain(moved).map(|tour| self.with_cost(tour))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Distances from the origin and between places, divided by what waits there.
    fn weighed(places: &[(f64, f64, f64)]) -> OpenTour {
        let first = places.iter().map(|(x, y, gain)| x.hypot(*y) / gain).collect();
        let legs = places.iter().flat_map(|a| places.iter().map(|b| (a.0 - b.0).hypot(a.1 - b.1) / b.2));
        OpenTour { first, between: legs.collect() }
    }

    proptest! {
        #[test]
        fn exact_orders_are_the_best_and_good_ones_are_orders(
            places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 0.1f64..3.0), 1..7),
        ) {
            let legs = weighed(&places);
            let nodes: Vec<usize> = (0..places.len()).collect();
            let best = legs.best_order();
            let least = permutations(&nodes).iter().map(|p| legs.cost(p)).fold(f64::INFINITY, f64::min);
            prop_assert!((legs.cost(&best) - least).abs() < 1e-9);
            let mut good = legs.good_order();
            prop_assert!(legs.cost(&good) >= least - 1e-9);
            // No single move makes it better.
            for from in 0..good.len() {
                for to in 0..good.len() {
                    let mut moved = good.clone();
                    let node = moved.remove(from);
                    moved.insert(to, node);
                    prop_assert!(legs.cost(&moved) >= legs.cost(&good) - 1e-6);
                }
            }
            good.sort_unstable();
            prop_assert_eq!(good, nodes);
        }

        #[test]
        fn tours_that_begin_somewhere_are_the_best_or_near_to_it(
            places in proptest::collection::vec((-9.0f64..9.0, -9.0f64..9.0, 1.0f64..1.1), 1..8),
        ) {
            let legs = weighed(&places);
            let nodes: Vec<usize> = (0..places.len()).collect();
            for begin in 0..places.len() {
                let (tour, cost) = legs.best_from(begin);
                let others = permutations(&nodes).into_iter().filter(|p| p[0] == begin);
                let least = others.map(|p| legs.cost(&p)).fold(f64::INFINITY, f64::min);
                prop_assert_eq!(tour[0], begin);
                prop_assert!((cost - least).abs() < 1e-9 && (legs.cost(&tour) - cost).abs() < 1e-9);
                let mut good = legs.bettered(legs.nearest_neighbours(Some(begin)));
                prop_assert!(good[0] == begin && legs.cost(&good) <= 1.3 * least + 1e-9);
                good.sort_unstable();
                prop_assert_eq!(&good, &nodes);
            }
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
