//! Our own strategy: the shortest way past all frontiers, planned anew with every map, and
//! its first place next.
//!
//! The nearest frontiers are ordered as an open tour ([`OpenTour`]) over the lengths of the
//! real ways between the places where they are seen from. The first leg also costs what the
//! robot has to turn to set out, so that it goes on rather than back; and the place that it is
//! on its way to stays the first unless another tour is shorter by more than a margin, so
//! that it does not dither. Frontiers that do not take part follow by their ways.
//!
//! | parameter | default | why |
//! |---|---|---|
//! | `most` | 16 | what lies farther away seldom changes where to go first |
//! | `turn_m_per_rad` | 1.0 | a robot that turns at 1 rad/s and drives at 0.5 m/s, twice |
//! | `free_turn_rad` | 0.15 | so much it turns as it drives |
//! | `stay_m` | 2.0 | how much shorter another tour must be |
//! | `same_m` | 4.0 | a place this near to the one under way stands for it |
//!
//! O(searches of `most` ways + orders of `most` places).

use super::open_tour::OpenTour;
use super::{Candidate, GoalSelector, Needs, Score, SelectionContext};
use crate::geometry::Point;
use crate::range::{Range, Ranged};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Parameters of the strategy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TourConfig {
    /// How many frontiers are ordered, the nearest by way.
    pub most: usize,
    /// What turning to set out costs, metres of way for each of its radians.
    pub turn_m_per_rad: f64,
    /// A turn up to this angle costs nothing, radians.
    pub free_turn_rad: f64,
    /// The place under way stays the first unless another tour is shorter by more than this,
    /// metres.
    pub stay_m: f64,
    /// The nearest place within this distance of the target under way stands for it, metres.
    pub same_m: f64,
}

impl Default for TourConfig {
    fn default() -> Self {
        Self { most: 16, turn_m_per_rad: 1.0, free_turn_rad: 0.15, stay_m: 2.0, same_m: 4.0 }
    }
}

impl TourConfig {
    /// The numbers with their ranges.
    pub(super) fn numbers(&self) -> Vec<Ranged> {
        let most = Range::within(1.0, MOST, "1 to 64").of("selection.most", self.most as f64);
        let others = [
            ("selection.turn_m_per_rad", self.turn_m_per_rad),
            ("selection.free_turn_rad", self.free_turn_rad),
            ("selection.stay_m", self.stay_m),
            ("selection.same_m", self.same_m),
        ];
        [most].into_iter().chain(others.map(|(key, value)| Range::NOT_NEGATIVE.of(key, value))).collect()
    }
}

/// More frontiers than this would take too long to order.
const MOST: f64 = 64.0;

/// The part of a score that says the place in the order, from 0.
pub const PLACE: &str = "place";
/// The part of a score that says how long the best tour is that begins there, metres: of those
/// that take part in the tour alone.
pub const TOUR_M: &str = "tour_m";

/// The strategy.
///
/// What lies on the way to the far end is seen first, though the far end alone is nearer:
///
/// ```
/// use frontier_explorer::geometry::{Point, Pose};
/// use frontier_explorer::selection::{
///     Candidate, GoalSelector, SelectionContext, StraightWays, Tour, TourConfig,
/// };
///
/// let robot_in_map = Pose::default();
/// let at = |x: f64| Candidate::new(Point::new(x, 0.0), Pose::new(x, 0.0, 0.0), 10, 0.5, &robot_in_map);
/// // 1 m behind it is less far than 2 m ahead, and to turn round costs three.
/// let candidates = [at(-1.0), at(2.0), at(5.0)];
/// let mut ways = StraightWays { robot_in_map };
/// let places = |tour: TourConfig, ways: &mut StraightWays| -> Vec<f64> {
///     let scores = Tour(tour).score(&candidates, &mut SelectionContext::straight(ways));
///     scores.iter().map(|score| score.total).collect()
/// };
/// let no_turn = TourConfig { turn_m_per_rad: 0.0, ..TourConfig::default() };
/// assert_eq!(places(no_turn, &mut ways), [0.0, 1.0, 2.0]);
/// let turn = TourConfig { turn_m_per_rad: 2.0, ..TourConfig::default() };
/// assert_eq!(places(turn, &mut ways), [2.0, 0.0, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Tour(pub TourConfig);

impl GoalSelector for Tour {
    fn name(&self) -> &'static str {
        "tour"
    }

    fn needs(&self) -> Needs {
        Needs { way: true, ways: true, ..Needs::default() }
    }

    fn keeps_goals(&self) -> bool {
        true
    }

    fn score(&mut self, candidates: &[Candidate], context: &mut SelectionContext<'_>) -> Vec<Score> {
        let way_m = |c: &Candidate| c.way_m.unwrap_or(c.distance_m);
        let mut by_way: Vec<usize> = (0..candidates.len()).collect();
        by_way.sort_by(|&a, &b| way_m(&candidates[a]).total_cmp(&way_m(&candidates[b])).then(a.cmp(&b)));
        let most = by_way.len().min(self.0.most);
        let (kept, others) = by_way.split_at_mut(most);
        // The target under way takes part however far away it is: else nothing speaks for it.
        let away_m = |&index: &usize| {
            context.under_way.map_or(f64::INFINITY, |target| nalgebra::distance(&candidates[index].target, &target))
        };
        let nearest = |places: &[usize]| places.iter().map(away_m).fold(f64::INFINITY, f64::min);
        if nearest(kept) > self.0.same_m
            && let Some(under_way) = others.iter_mut().find(|index| away_m(index) <= self.0.same_m)
            && let Some(farthest) = kept.last_mut()
        {
            std::mem::swap(under_way, farthest);
        }
        let places: Vec<Point> = kept.iter().map(|&index| candidates[index].goal.position()).collect();
        let (ways_m, turns): (Vec<f64>, Vec<f64>) = places.iter().map(|&place| context.ways.set_out(place)).unzip();
        let turning_m = |turn: &f64| (turn - self.0.free_turn_rad).max(0.0) * self.0.turn_m_per_rad;
        let first = ways_m.into_iter().map(known).zip(&turns).map(|(way_m, turn)| way_m + turning_m(turn));
        let between = places.iter().flat_map(|&from| context.ways.lengths_m(from, &places));
        let tours = OpenTour { first: first.collect(), between: between.map(known).collect() };
        let best_from: Vec<(Vec<usize>, f64)> = (0..kept.len()).map(|begin| tours.best_from(begin)).collect();
        let order = self.order(&best_from, kept, candidates, context.under_way);
        let mut scores = vec![Score::default(); candidates.len()];
        let in_order = order.iter().map(|&node| (kept[node], Some(node))).chain(others.iter().map(|&i| (i, None)));
        let mut before = None;
        for (place, (index, node)) in in_order.enumerate() {
            let leg_m = node.map_or_else(|| way_m(&candidates[index]), |node| tours.leg(before, node));
            before = node;
            let of_node = |node: usize| [("turn_rad", turns[node]), (TOUR_M, best_from[node].1)];
            let parts = [(PLACE, place as f64), ("leg_m", leg_m)].into_iter().chain(node.into_iter().flat_map(of_node));
            scores[index] = Score { total: place as f64, parts: parts.collect() };
        }
        scores
    }
}

/// The longest way between two places that can both be reached, metres: where a coarse search
/// finds none it is there all the same.
const LONGEST_M: f64 = 1e4;

const fn known(length_m: f64) -> f64 {
    length_m.min(LONGEST_M)
}

impl Tour {
    /// The best of the tours that begin at each place, or the best of those that go on to where
    /// the robot is on its way to.
    fn order(
        &self,
        best_from: &[(Vec<usize>, f64)],
        kept: &[usize],
        candidates: &[Candidate],
        under_way: Option<Point>,
    ) -> Vec<usize> {
        let Some((best, least_m)) = best_from.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
        let away_m = |node: usize| {
            under_way.map_or(f64::INFINITY, |target| nalgebra::distance(&candidates[kept[node]].target, &target))
        };
        let stays = (0..kept.len()).filter(|&node| away_m(node) <= self.0.same_m);
        let stays = stays.min_by(|&a, &b| away_m(a).total_cmp(&away_m(b))).map(|begin| &best_from[begin]);
        match stays {
            Some((tour, cost_m)) if *cost_m <= least_m + self.0.stay_m => tour.clone(),
            _ => best.clone(),
        }
    }
}
