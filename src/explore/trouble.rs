//! Attempts that fail: for how long, from where, and how long to rest before the next.

use crate::geometry::{Point, Pose};

/// A robot that came no farther than this since it began to fail does not get away, metres.
const WEDGED_WITHIN_M: f64 = 0.5;
/// Failures within this distance of each other are from one place, metres.
const ONE_PLACE_M: f64 = 0.3;
/// From one place the robot backs off so many times in vain before it gives that up, and so
/// many times in all before the goals that lead there are to blame after all.
const BACK_OFFS: u32 = 3;
/// So much more that is known is new ground, square metres.
const NEW_GROUND_M2: f64 = 1.0;
/// More than this from one tick to the next is a gap, seconds.
const LONGEST_TICK_S: f64 = 5.0;
/// The longest rest between two rounds, seconds.
const LONGEST_PAUSE_S: f64 = 16.0;

/// Since the last success.
#[derive(Clone, Copy, Debug, Default)]
pub struct Trouble {
    /// When it began, and where the robot was.
    began: Option<(f64, Point)>,
    /// The farthest that the robot came from there, metres.
    farthest_m: f64,
    rounds: u32,
    /// Where goals failed last, how many in a row, and how often the robot backed off.
    spot: Option<Point>,
    failures_here: u32,
    back_offs_here: u32,
    /// Of these, how many in a row led nowhere.
    vain_here: u32,
    /// What was known at the last success, square metres.
    known_m2: f64,
    /// Since then, and when that was counted last, seconds.
    no_news_s: f64,
    last_s: Option<f64>,
}

impl Trouble {
    /// A goal was reached, or new ground seen: all is well.
    pub const fn is_over(&mut self) {
        self.began = None;
        self.rounds = 0;
        self.spot = None;
        self.failures_here = 0;
        self.back_offs_here = 0;
        self.vain_here = 0;
    }

    /// A map knows so much at a time: square metres and seconds.
    pub fn sees(&mut self, known_m2: f64, now_s: f64) {
        if known_m2 >= self.known_m2 + NEW_GROUND_M2 || known_m2 < 0.5 * self.known_m2 {
            (self.known_m2, self.no_news_s, self.last_s) = (known_m2, 0.0, Some(now_s));
            self.is_over();
        }
    }

    /// How long no new ground has been seen, seconds; what is no tick but a gap in a recording
    /// hardly counts.
    pub fn no_news_for_s(&mut self, now_s: f64) -> f64 {
        let last_s = self.last_s.replace(now_s).unwrap_or(now_s);
        self.no_news_s += (now_s - last_s).clamp(0.0, LONGEST_TICK_S);
        self.no_news_s
    }

    /// The same as of the last tick.
    pub const fn no_news_s(&self) -> f64 {
        self.no_news_s
    }

    /// The robot is at a pose.
    pub fn follow(&mut self, pose: &Pose) {
        if let Some((_, from)) = self.began {
            self.farthest_m = self.farthest_m.max(pose.distance_to(from));
        }
    }

    /// The robot got away from where it was by backing off: it can move. Whether what failed
    /// there is not to blame; goals that lead there again and again are.
    pub const fn has_got_away(&mut self) -> bool {
        self.farthest_m = f64::INFINITY;
        self.vain_here = 0;
        self.back_offs_here <= BACK_OFFS
    }

    /// The next failure at this pose is the place's, though it is the first.
    pub fn is_wedged_here(&mut self, pose: &Pose) {
        if self.spot.is_none_or(|spot| pose.distance_to(spot) > ONE_PLACE_M) {
            self.is_at(pose);
        }
    }

    /// An attempt failed at a pose. Whether the robot should back off: the second failure
    /// from one place says more about the place than about the goals.
    pub fn fail(&mut self, pose: &Pose, now_s: f64) -> bool {
        self.begin(pose, now_s);
        if self.spot.is_some_and(|spot| pose.distance_to(spot) <= ONE_PLACE_M) {
            self.failures_here += 1;
        } else {
            self.is_at(pose);
        }
        self.failures_here >= 2 && self.may_back_off()
    }

    /// Whether the robot has not backed off too often from here, and counts one more.
    pub const fn may_back_off(&mut self) -> bool {
        self.back_offs_here += 1;
        self.vain_here += 1;
        self.vain_here <= BACK_OFFS
    }

    /// Nothing is left to try in this round: the rest before the next one, seconds.
    pub fn next_round_s(&mut self, pose: &Pose, now_s: f64) -> f64 {
        self.begin(pose, now_s);
        self.rounds += 1;
        2_f64.powi(self.rounds.min(10) as i32 - 1).min(LONGEST_PAUSE_S)
    }

    /// How long attempts have failed, seconds.
    #[must_use]
    pub fn lasts_s(&self, now_s: f64) -> f64 {
        self.began.map_or(0.0, |(began_s, _)| now_s - began_s)
    }

    /// Whether the robot has not got away from where the trouble began.
    #[must_use]
    pub fn is_wedged(&self) -> bool {
        self.began.is_some() && self.farthest_m < WEDGED_WITHIN_M
    }

    /// A failure at another place than the last one's.
    fn is_at(&mut self, pose: &Pose) {
        (self.spot, self.failures_here) = (Some(pose.position()), 1);
        (self.back_offs_here, self.vain_here) = (0, 0);
    }

    fn begin(&mut self, pose: &Pose, now_s: f64) {
        if self.began.is_none() {
            (self.began, self.farthest_m) = (Some((now_s, pose.position())), 0.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_second_failure_from_one_place_is_the_places() {
        let mut trouble = Trouble::default();
        let (here, there) = (Pose::new(0.1, 0.0, 0.0), Pose::new(2.0, 0.0, 0.0));
        assert!(!trouble.fail(&here, 10.0));
        assert!(trouble.fail(&here, 20.0) && trouble.is_wedged());
        assert!(trouble.fail(&here, 30.0) && trouble.fail(&here, 40.0));
        assert!(!trouble.fail(&here, 50.0), "backing off has not helped");
        trouble.follow(&there);
        assert!(!trouble.is_wedged() && !trouble.fail(&there, 60.0));
        assert_eq!(trouble.lasts_s(70.0), 60.0);
        trouble.is_over();
        assert_eq!((trouble.lasts_s(80.0), trouble.is_wedged()), (0.0, false));
    }

    #[test]
    fn new_ground_is_news_and_a_success() {
        let mut trouble = Trouble::default();
        trouble.sees(10.0, 0.0);
        trouble.fail(&Pose::default(), 1.0);
        trouble.sees(10.5, 2.0);
        assert_eq!((trouble.no_news_for_s(4.0), trouble.lasts_s(4.0)), (4.0, 3.0));
        assert_eq!(trouble.no_news_for_s(1e9), 9.0, "years between two ticks are none");
        trouble.sees(11.1, 1e9);
        assert_eq!((trouble.no_news_for_s(1e9 + 2.0), trouble.lasts_s(1e9)), (2.0, 0.0));
    }

    #[test]
    fn rests_grow() {
        let mut trouble = Trouble::default();
        let rests: Vec<f64> = (0..7).map(|_| trouble.next_round_s(&Pose::default(), 0.0)).collect();
        assert_eq!(rests, [1.0, 2.0, 4.0, 8.0, 16.0, 16.0, 16.0]);
    }
}
