//! Routes that see enough and take little time: randomised covers, ordered as open tours and
//! bettered by simulated annealing.
//!
//! A cover takes, of the places that see nearly the most that is new, one at random, until all
//! together see enough (Johnson 1974, randomised). An [`OpenTour`] orders it. Annealing
//! (Kirkpatrick, Gelatt and Vecchi 1983) then moves, drops, adds and reverses its places; it
//! judges a route by the time until enough has been seen, with what is seen on the way.

use super::routes::{Estimate, Routes, Situation};
use super::seen::Seen;
use crate::selection::OpenTour;
use rand_pcg::Pcg32;
use rand_pcg::rand_core::Rng;
use std::collections::HashMap;

/// The most places; where there are more blocks, every second of every second row, or every third.
const MOST_PLACES: usize = 700;
/// Places that see at least this share of the best one's are as good for a cover.
const AS_GOOD: f64 = 0.8;
/// So many of the places nearest to one are beside it.
const BESIDE: usize = 12;
/// Rise in cost that is accepted with a chance of 1/e, seconds: at the begin and at the end.
const WARMTH_S: [f64; 2] = [5.0, 0.2];

/// The places that routes are made of, and chance.
pub(super) struct Search {
    places: Vec<usize>,
    /// For each place those beside it.
    beside: HashMap<usize, Vec<usize>>,
    random: Pcg32,
}

impl Search {
    /// Chooses places from which all is seen that can be seen from any block.
    pub fn new(routes: &mut Routes, seed: u64) -> Self {
        let blocks: Vec<usize> = routes.ground.blocks().collect();
        let on = |step: usize, block: usize, routes: &Routes| {
            let (column, row) = routes.ground.place(block);
            column.is_multiple_of(step) && row.is_multiple_of(step)
        };
        let of_step = |step: usize| blocks.iter().copied().filter(|&b| on(step, b, routes)).collect::<Vec<_>>();
        let mut step = 1;
        let mut places = of_step(step);
        while places.len() > MOST_PLACES {
            step += 1;
            places = of_step(step);
        }
        if step > 1 {
            let mut seen = Seen::none(routes.sights.samples());
            places.iter().for_each(|&place| seen.add(&routes.around(place)));
            for &block in &blocks {
                let view = routes.around(block);
                if view.new_to(&seen) > 0 {
                    seen.add(&view);
                    places.push(block);
                }
            }
        }
        let beside = places.iter().map(|&place| (place, beside(routes, &places, place))).collect();
        Self { places, beside, random: Pcg32::new(seed, 0x0a_c1e) }
    }

    /// A route made of a new cover.
    pub fn cover(&mut self, routes: &mut Routes, begin: &Situation) -> Vec<usize> {
        let mut seen = begin.seen.clone();
        let mut chosen = Vec::new();
        while seen.count() < begin.enough {
            let gains: Vec<usize> = self.places.iter().map(|&place| routes.around(place).new_to(&seen)).collect();
            let most = gains.iter().copied().max().unwrap_or(0);
            if most == 0 {
                break;
            }
            let least = (AS_GOOD * most as f64).ceil() as usize;
            let good: Vec<usize> = (0..gains.len()).filter(|&i| gains[i] >= least).collect();
            let pick = self.below(good.len());
            let place = self.places[good[pick]];
            seen.add(&routes.around(place));
            chosen.push(place);
        }
        order(routes, begin, &chosen)
    }

    /// Betters a route by so many trials; the best that was met, without what it does not need.
    pub fn anneal(
        &mut self,
        routes: &mut Routes,
        begin: &Situation,
        route: Vec<usize>,
        trials: usize,
    ) -> (Vec<usize>, Estimate) {
        let mut here = routes.estimate(begin, &route);
        let mut route = trimmed(route, &here);
        let mut best = (route.clone(), here);
        for trial in 0..trials {
            let done = trial as f64 / trials as f64;
            let warmth_s = WARMTH_S[0] * (WARMTH_S[1] / WARMTH_S[0]).powf(done);
            let Some(other) = self.neighbour(&route, begin.block) else { continue };
            let there = routes.estimate(begin, &other);
            let worse_s = there.cost_s - here.cost_s;
            if worse_s <= 0.0 || self.unit() < (-worse_s / warmth_s).exp() {
                route = trimmed(other, &there);
                here = there;
                if here.cost_s < best.1.cost_s {
                    best = (route.clone(), here);
                }
            }
        }
        best
    }

    /// Betters a route by so many trials, of which only gains are taken.
    pub fn descend(
        &mut self,
        routes: &mut Routes,
        begin: &Situation,
        route: &[usize],
        trials: usize,
    ) -> (Vec<usize>, Estimate) {
        let mut least = routes.estimate(begin, route);
        let mut route = trimmed(route.to_vec(), &least);
        // Each place that can be spared first: chance may pass it over.
        for place in (0..route.len()).rev() {
            let mut other = route.clone();
            if place < other.len() {
                other.remove(place);
                let there = routes.estimate(begin, &other);
                if there.cost_s < least.cost_s {
                    (route, least) = (trimmed(other, &there), there);
                }
            }
        }
        for _ in 0..trials {
            let Some(other) = self.neighbour(&route, begin.block) else { continue };
            let there = routes.estimate(begin, &other);
            if there.cost_s < least.cost_s {
                (route, least) = (trimmed(other, &there), there);
            }
        }
        (route, least)
    }

    /// A route that differs by one move.
    fn neighbour(&mut self, route: &[usize], begin: usize) -> Option<Vec<usize>> {
        let mut other = route.to_vec();
        let count = route.len();
        match self.below(8) {
            // Another place in its stead.
            0..=2 if count > 0 => {
                let at = self.below(count);
                other[at] = self.beside(route[at])?;
            }
            // One less.
            3 if count > 0 => {
                other.remove(self.below(count));
            }
            // A part the other way round.
            4 if count > 1 => {
                let (a, b) = (self.below(count), self.below(count));
                other[a.min(b)..=a.max(b)].reverse();
            }
            // A part elsewhere, perhaps the other way round.
            5 if count > 1 => {
                let from = self.below(count);
                let length = 1 + self.below((count - from).min(4));
                let mut part: Vec<usize> = other.drain(from..from + length).collect();
                if self.below(2) == 0 {
                    part.reverse();
                }
                let to = self.below(other.len() + 1);
                other.splice(to..to, part);
            }
            // One more: beside one that is there, or anywhere.
            _ => {
                let at = self.below(count + 1);
                let from = at.checked_sub(1).map_or(begin, |before| route[before]);
                let beside = if self.below(3) > 0 { self.beside(from) } else { None };
                let anywhere = self.below(self.places.len());
                other.insert(at, beside.or_else(|| self.places.get(anywhere).copied())?);
            }
        }
        Some(other)
    }

    /// One of the places beside a place.
    fn beside(&mut self, place: usize) -> Option<usize> {
        let count = self.beside.get(&place)?.len();
        let pick = self.below(count);
        self.beside.get(&place)?.get(pick).copied()
    }

    fn below(&mut self, count: usize) -> usize {
        // A 32-bit number scaled down: biased by less than one in a million here.
        ((u64::from(self.random.next_u32()) * count as u64) >> 32) as usize
    }

    fn unit(&mut self) -> f64 {
        f64::from(self.random.next_u32()) / f64::from(u32::MAX)
    }
}

/// The places in the order of a short open tour.
fn order(routes: &mut Routes, begin: &Situation, places: &[usize]) -> Vec<usize> {
    let first = places.iter().map(|&place| routes.drive_s(begin.block, place)).collect();
    let mut between = Vec::with_capacity(places.len() * places.len());
    for &a in places {
        for &b in places {
            between.push(routes.drive_s(a, b));
        }
    }
    OpenTour { first, between }.short_order().into_iter().map(|node| places[node]).collect()
}

/// A route as far as it is needed.
fn trimmed(mut route: Vec<usize>, estimate: &Estimate) -> Vec<usize> {
    route.truncate(estimate.used);
    route
}

/// The places nearest to one, without it.
fn beside(routes: &Routes, places: &[usize], place: usize) -> Vec<usize> {
    let stand = routes.ground.stand(place);
    let away_m = |other: usize| nalgebra::distance_squared(&routes.ground.stand(other), &stand);
    let mut others: Vec<(f64, usize)> =
        places.iter().filter(|&&other| other != place).map(|&other| (away_m(other), other)).collect();
    let nearest = BESIDE.min(others.len());
    if nearest < others.len() {
        others.select_nth_unstable_by(nearest, |a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        others.truncate(nearest);
    }
    others.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    others.into_iter().map(|(_, other)| other).collect()
}
