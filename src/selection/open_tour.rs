//! Open tours: an order of places in which each leg costs something, from the robot on and
//! without a way back.
//!
//! Up to [`EXACT_UP_TO`] places the best order is found by dynamic programming (Held and Karp
//! 1962). O(n^2 2^n), beyond that O(n^2) a move that shortens it.

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
            self.bettered(self.nearest_neighbours(Some(begin)), 1)
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

    /// A short tour over all places: the exact one of few places, and of many the nearest
    /// neighbours', bettered as that of [`Self::best_from`] with no place kept first.
    #[cfg(any(test, feature = "report"))]
    pub fn short_order(&self) -> Vec<usize> {
        if self.first.len() <= EXACT_UP_TO {
            self.best_order()
        } else {
            self.bettered(self.nearest_neighbours(None), 0)
        }
    }

    /// Takes the first move that shortens a tour, until none does; the first `kept` places
    /// stay where they are. A move is judged in O(1) by the legs that it changes, and what may
    /// be a gain is added up as a whole.
    fn bettered(&self, mut tour: Vec<usize>, kept: usize) -> Vec<usize> {
        let mut cost = self.cost(&tour);
        loop {
            let slack = ROUNDING * (1.0 + cost.abs());
            let sums = self.sums(&tour);
            let gainful = moves(tour.len(), kept).filter(|step| {
                let change = self.change(&tour, &sums, step);
                // What is no number is added up too.
                change.is_nan() || change < slack
            });
            let better = gainful.map(|step| self.with_cost(step.of(&tour))).find(|(_, other)| *other < cost - 1e-9);
            let Some(better) = better else { return tour };
            (tour, cost) = better;
        }
    }

    /// What the legs up to each place cost, there and back.
    fn sums(&self, tour: &[usize]) -> Vec<[f64; 2]> {
        let legs = tour.windows(2).map(|pair| [self.between(pair[0], pair[1]), self.between(pair[1], pair[0])]);
        let sums = legs.scan([0.0; 2], |sum, leg| {
            *sum = [sum[0] + leg[0], sum[1] + leg[1]];
            Some(*sum)
        });
        [[0.0; 2]].into_iter().chain(sums).collect()
    }

    /// By how much a move lengthens a tour, but for rounding.
    fn change(&self, tour: &[usize], sums: &[[f64; 2]], step: &Move) -> f64 {
        let before = |place: usize| place.checked_sub(1).map(|before| tour[before]);
        let on = |from: usize, to: Option<&usize>| to.map_or(0.0, |&to| self.between(from, to));
        match *step {
            Move::Turn { from, to } => {
                let (first, last, after) = (tour[from], tour[to - 1], tour.get(to));
                let inner = (sums[to - 1][1] - sums[from][1]) - (sums[to - 1][0] - sums[from][0]);
                let rim = self.leg(before(from), last) - self.leg(before(from), first);
                rim + on(first, after) - on(last, after) + inner
            }
            Move::Shift { from, length, to } => {
                let (first, last, after) = (tour[from], tour[from + length - 1], tour.get(from + length));
                let rest = |place: usize| tour.get(if place < from { place } else { place + length });
                let next = rest(to);
                let previous = to.checked_sub(1).and_then(rest).copied();
                let leg = |before: Option<usize>, to: Option<&usize>| to.map_or(0.0, |&to| self.leg(before, to));
                let taken = leg(before(from), after) - self.leg(before(from), first) - on(last, after);
                taken + self.leg(previous, first) + on(last, next) - leg(previous, next)
            }
        }
    }
}

/// How far a sum of legs and what is computed of its changes may differ by rounding, as a share.
const ROUNDING: f64 = 1e-9;

/// What makes one tour of another.
#[derive(Clone, Copy, Debug)]
enum Move {
    /// The places from one up to another the other way round.
    Turn { from: usize, to: usize },
    /// So many places from one on, taken out and put in before one of those left.
    Shift { from: usize, length: usize, to: usize },
}

impl Move {
    /// The tour that it makes.
    fn of(self, tour: &[usize]) -> Vec<usize> {
        let mut other = tour.to_vec();
        match self {
            Self::Turn { from, to } => other[from..to].reverse(),
            Self::Shift { from, length, to } => {
                let part: Vec<usize> = other.drain(from..from + length).collect();
                other.splice(to..to, part);
            }
        }
        other
    }
}

/// The moves in tours of so many places, the first `kept` staying where they are.
fn moves(count: usize, kept: usize) -> impl Iterator<Item = Move> {
    let turns = (kept..count).flat_map(move |from| (from + 2..=count).map(move |to| Move::Turn { from, to }));
    let shifts = (kept..count).flat_map(move |from| {
        (1..=LONGEST_PART.min(count - from)).flat_map(move |length| {
            let places = (kept..=count - length).filter(move |&to| to != from);
            places.map(move |to| Move::Shift { from, length, to })
        })
    });
    turns.chain(shifts)
}

#[cfg(test)]
#[path = "open_tour_tests.rs"]
mod tests;
