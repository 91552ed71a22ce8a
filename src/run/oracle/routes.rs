//! How long a route takes until enough has been seen, estimated.

use super::ground::Ground;
use super::seen::Seen;
use super::sights::{HEADINGS, Sights};
use crate::config::RobotConfig;
use crate::geometry::{MotionLimits, Point, Pose, shortest_angle};
use crate::planning::WaysFrom;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::rc::Rc;

/// A robot turns up to this angle as it drives, radians.
const TURNED_DRIVING_RAD: f64 = 0.9;
/// What such a turn costs, seconds for each of its radians.
const DRIVING_TURN_S: f64 = 0.4;
/// Speed of a full turn made to look round, radians per second.
const LOOK_ROUND_RPS: f64 = 1.0;
/// What a route costs more that does not see enough, seconds, and seconds for all that it
/// should have seen.
const NOT_ENOUGH_S: [f64; 2] = [100.0, 4000.0];

/// Where a route begins, and what is wanted of it.
#[derive(Clone, Debug)]
pub(super) struct Situation {
    /// The block where the robot is.
    pub block: usize,
    /// Its heading, radians.
    pub yaw: f64,
    /// What has been seen.
    pub seen: Seen,
    /// How many samples are enough.
    pub enough: usize,
}

/// What a route comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    /// Until enough has been seen, seconds; with what is added where that never is.
    pub cost_s: f64,
    /// After how many of its blocks that is.
    pub used: usize,
    /// Whether enough is seen.
    pub is_enough: bool,
}

/// The way from one block to another.
struct Leg {
    time_s: f64,
    /// Headings at both ends, radians; none of a leg that leads nowhere.
    headings: Option<[f64; 2]>,
    /// When what is seen on the way, and from which block.
    sights: Vec<(f64, usize, Rc<Seen>)>,
    /// All of that.
    seen: Seen,
}

/// Knows the blocks of a world, what is seen from them, and the legs between them.
pub(super) struct Routes {
    /// Where the robot can stand.
    pub ground: Ground,
    /// What it sees.
    pub sights: Sights,
    limits: MotionLimits,
    views: HashMap<(usize, usize), Rc<Seen>>,
    ways: HashMap<usize, Rc<WaysFrom>>,
    legs: HashMap<(usize, usize), Rc<Leg>>,
}

/// What a leg costs that leads nowhere, seconds.
const NO_WAY_S: f64 = 1e4;
/// More legs than this are forgotten, so that memory is bounded.
const MOST_LEGS: usize = 60_000;

impl Routes {
    /// Of a robot in a world.
    pub fn new(ground: Ground, sights: Sights, robot: &RobotConfig) -> Self {
        let (views, ways, legs) = (HashMap::new(), HashMap::new(), HashMap::new());
        Self { ground, sights, limits: robot.limits, views, ways, legs }
    }

    /// What is seen from a block by a robot that turns round there.
    pub fn around(&mut self, block: usize) -> Rc<Seen> {
        self.view(block, None)
    }

    fn view(&mut self, block: usize, heading_rad: Option<f64>) -> Rc<Seen> {
        let heading_rad = heading_rad.filter(|_| !self.sights.is_all_round());
        let sector_rad = TAU / HEADINGS as f64;
        let sector = heading_rad.map(|yaw| (yaw / sector_rad).round().rem_euclid(HEADINGS as f64) as usize);
        let (ground, sights) = (&self.ground, &self.sights);
        let view = self.views.entry((block, sector.unwrap_or(HEADINGS))).or_insert_with(|| {
            let stand = ground.stand(block);
            Rc::new(match sector {
                None => sights.around(stand),
                Some(sector) => sights.ahead(&Pose::new(stand.x, stand.y, sector as f64 * sector_rad)),
            })
        });
        Rc::clone(view)
    }

    /// Learns that from a block no more is seen than is known by now.
    pub fn learn(&mut self, block: usize, known: &Seen) {
        let keys = (0..=HEADINGS).map(|sector| (block, sector));
        let mut is_news = false;
        for key in keys {
            if let Some(view) = self.views.get_mut(&key)
                && view.new_to(known) > 0
            {
                Rc::make_mut(view).keep(known);
                is_news = true;
            }
        }
        if is_news {
            self.legs.retain(|_, leg| leg.sights.iter().all(|&(_, from, _)| from != block));
        }
    }

    /// The ways from a block to everywhere.
    pub fn ways_from(&mut self, block: usize) -> Rc<WaysFrom> {
        let ground = &mut self.ground;
        Rc::clone(self.ways.entry(block).or_insert_with(|| Rc::new(ground.ways_from(block))))
    }

    /// How long the straight drive along a leg takes, seconds.
    pub fn drive_s(&mut self, from: usize, to: usize) -> f64 {
        let ways = self.ways_from(to);
        self.ground.way_m(&ways, self.ground.stand(from)) / self.limits.max_linear_mps
    }

    /// What a route costs from a situation on.
    pub fn estimate(&mut self, begin: &Situation, route: &[usize]) -> Estimate {
        let mut seen = begin.seen.clone();
        let mut count = seen.count();
        let (mut time_s, mut block, mut yaw) = (0.0, begin.block, begin.yaw);
        if count >= begin.enough {
            return Estimate { cost_s: 0.0, used: 0, is_enough: true };
        }
        for (place, &next) in route.iter().enumerate() {
            let leg = self.leg(block, next);
            if let Some([set_out, arrive]) = leg.headings {
                time_s += self.turn_s(shortest_angle(yaw, set_out));
                yaw = arrive;
            }
            count = seen.count_with(&leg.seen);
            if count >= begin.enough {
                for (at_s, _, sight) in &leg.sights {
                    seen.add(sight);
                    if seen.count() >= begin.enough {
                        time_s += at_s;
                        break;
                    }
                }
                return Estimate { cost_s: time_s, used: place + 1, is_enough: true };
            }
            seen.add(&leg.seen);
            time_s += leg.time_s;
            block = next;
        }
        let lacking = (begin.enough - count) as f64 / self.sights.samples().max(1) as f64;
        Estimate { cost_s: time_s + NOT_ENOUGH_S[0] + NOT_ENOUGH_S[1] * lacking, used: route.len(), is_enough: false }
    }

    fn leg(&mut self, from: usize, to: usize) -> Rc<Leg> {
        if let Some(leg) = self.legs.get(&(from, to)) {
            return Rc::clone(leg);
        }
        if self.legs.len() >= MOST_LEGS {
            self.legs.clear();
        }
        let leg = Rc::new(self.new_leg(from, to));
        self.legs.insert((from, to), Rc::clone(&leg));
        leg
    }

    fn new_leg(&mut self, from: usize, to: usize) -> Leg {
        let ways = self.ways_from(to);
        let way = self.ground.way(&ways, self.ground.stand(from));
        let corners = self.ground.corners(&way);
        let mut times_s = vec![0.0; way.len()];
        let mut time_s = 0.0;
        let mut headings: Option<[f64; 2]> = None;
        for pair in corners.windows(2) {
            let (a, b) = (way[pair[0]], way[pair[1]]);
            let heading = Pose::facing(a, b).yaw;
            time_s += headings.map_or(0.0, |[_, last]| self.turn_s(shortest_angle(last, heading)));
            headings = Some([headings.map_or(heading, |[first, _]| first), heading]);
            let drive_s = nalgebra::distance(&a, &b) / self.limits.max_linear_mps;
            let steps = (pair[1] - pair[0]) as f64;
            for (step, place) in (pair[0]..=pair[1]).enumerate() {
                times_s[place] = time_s + drive_s * step as f64 / steps;
            }
            time_s += drive_s;
        }
        let mut sights = self.sights_along(from, &way, &times_s);
        if way.is_empty() {
            time_s = NO_WAY_S;
        } else {
            if !self.sights.is_all_round() {
                time_s += TAU / LOOK_ROUND_RPS;
            }
            sights.push((time_s, to, self.around(to)));
        }
        let mut seen = Seen::none(self.sights.samples());
        sights.iter().for_each(|(_, _, sight)| seen.add(sight));
        Leg { time_s, headings, sights, seen }
    }

    /// What is seen along a way, from each block that it passes after the one that it comes from.
    fn sights_along(&mut self, from: usize, way: &[Point], times_s: &[f64]) -> Vec<(f64, usize, Rc<Seen>)> {
        let mut sights = Vec::new();
        let mut last = Some(from);
        for (place, (&point, &at_s)) in way.iter().zip(times_s).enumerate() {
            let block = self.ground.block_at(point);
            if block == last {
                continue;
            }
            last = block;
            let before = place.checked_sub(1).map_or(point, |before| way[before]);
            let after = way.get(place + 1).copied().unwrap_or(point);
            let Some(block) = block else { continue };
            sights.push((at_s, block, self.view(block, Some(Pose::facing(before, after).yaw))));
        }
        sights
    }

    /// How long the robot turns to a side before it drives on, seconds.
    fn turn_s(&self, angle_rad: f64) -> f64 {
        let angle = angle_rad.abs();
        if angle <= TURNED_DRIVING_RAD {
            return angle * DRIVING_TURN_S;
        }
        let MotionLimits { max_angular_rps: top, max_angular_rps2: gain, max_linear_mps, max_linear_mps2, .. } =
            self.limits;
        let turn_s = if angle < top * top / gain { 2.0 * (angle / gain).sqrt() } else { angle / top + top / gain };
        // It also stops before and gains speed after.
        turn_s + max_linear_mps / max_linear_mps2
    }
}
