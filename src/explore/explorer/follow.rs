//! From a decision to what is done about it: a goal, a look round, a recovery, the end.

use super::super::blacklist::Failure;
use super::super::decided::Decided;
use super::super::lookout::Situation;
use super::super::progress_monitor::ProgressMonitor;
use super::super::record::{DecisionRecord, EndReason};
use super::super::state::{AfterTurn, Drive, State};
use super::Explorer;
use crate::geometry::{Point, Pose};
use crate::robot::{CommandId, MapSnapshot, NavigationState, Observation};

/// A turn that makes a mapper send a map, radians: gmapping's default asks for 0.5.
const NUDGE_RAD: f64 = 0.7;
/// So many of them are made before the map has to come by itself.
const NUDGES: u32 = 3;

/// A strategy that weighs itself when to change its goal is not let change it when nothing new was
/// seen for so long, seconds.
const FICKLE_S: f64 = 15.0;

/// A goal that was reached.
#[derive(Clone, Copy, Debug)]
pub struct Arrival {
    /// What was to be seen from there.
    pub target: Point,
    /// The goal; the robot may have stopped a little short of it, and would again.
    pub place: Point,
    /// The version of the map that was decided on first after that.
    pub decided_at: Option<u64>,
    /// Whether it lay beside the way: then the preset may not see it, and it counts in any case.
    pub is_beside: bool,
}

impl Explorer {
    /// Goes on as if the robot had been sent to this goal by the explorer itself: a
    /// recording went there, and what is decided next shall be decided from there. A run
    /// that has ended keeps its end.
    pub fn adopt(&mut self, goal: Pose, observation: &Observation) {
        let (Some(map), Ok(pose)) = (&observation.map, &observation.pose_in_map) else { return };
        if matches!(self.state, State::Ended(_) | State::Returning { .. }) {
            return;
        }
        let distance_m = |point: &Point| goal.distance_to(*point);
        let cells = self.lookout.frontiers().cells();
        // The frontier that it was sent for is the nearest one.
        let target = cells.min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)));
        self.state = State::Driving(Drive {
            id: self.next_id(),
            goal,
            target: target.unwrap_or_else(|| goal.position()),
            is_stage: false,
            is_beside: false,
            since_s: observation.stamp_s,
            progress: ProgressMonitor::new(pose, observation.stamp_s),
            considered_s: map.stamp_s,
            considered_version: map.version(),
            done_at: None,
        });
    }

    /// Weighs the frontiers of a map and goes on accordingly.
    pub(super) fn decide(
        &mut self,
        observation: &Observation,
        map: &MapSnapshot,
        pose: Pose,
    ) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        self.counts.detections += 1;
        self.trouble.sees(self.watch.known_m2(), now_s);
        for target in self.blacklist.look_again(map) {
            let (x, y) = (target.x, target.y);
            self.notice =
                Some(format!("the map has opened around ({x:.2}, {y:.2}) m: what failed there is tried again"));
        }
        let situation = Situation {
            now_s,
            settings: &self.settings,
            blacklist: &self.blacklist,
            sights: &self.sights,
            driven: &self.driven,
            robot: pose,
            awaits_map: !self.shows_all() && !matches!(self.state, State::Driving(_)),
            beside: match &self.state {
                State::Driving(drive) => drive.is_beside.then_some(drive.target),
                _ => None,
            },
            under_way: match &self.state {
                State::Driving(drive) => Some(drive.target),
                _ => None,
            },
        };
        let decided = match self.lookout.decide(&situation, observation, map) {
            Ok(decided) => decided,
            Err(error) => {
                self.wait_for_map(now_s, &error.to_string());
                return None;
            }
        };
        self.map_lost_since_s = None;
        self.notice_outside();
        self.left_behind = decided.left_behind;
        self.count_visits(&decided);
        let mut record = decided.record.clone();
        self.follow(&decided, map, now_s, &mut record, pose);
        Some(record)
    }

    /// Frontiers that are still there, on a map of after the robot was at their goals, have
    /// been visited in vain once more: whatever cell now stands for them. A robot that drives
    /// on at once never sees a map of where it stands: the second one that comes after that
    /// will do, as the first may have been under way.
    fn count_visits(&mut self, decided: &Decided) {
        let radius_m = self.settings.taboo.radius_m;
        let version = self.watch.version();
        let is_fresh = self.shows_all();
        let shows = |arrival: &mut Arrival| is_fresh || version >= *arrival.decided_at.get_or_insert(version) + 2;
        let shown: Vec<Arrival> = self.arrivals.extract_if(.., shows).collect();
        for Arrival { target, place, is_beside, .. } in shown {
            let is_there = |point: Point| nalgebra::distance(&point, &target) <= radius_m;
            let mut targets = decided.record.candidates.iter().map(|c| Point::new(c.target.x, c.target.y));
            let mut cells = self.lookout.frontiers().cells();
            if is_beside || targets.any(is_there) || cells.any(is_there) {
                self.blacklist.record_visit(target, place);
            }
        }
    }

    /// A look round at a target is over. One that was not made is no visit: it says nothing about
    /// what could be seen. Nor is one that somebody else took away a failure.
    pub(super) fn look_is_over(&mut self, target: Point, pose: Pose, observation: &Observation, id: CommandId) {
        let place = pose.position();
        let why = match &observation.navigation.state {
            _ if observation.navigation.command != id => "the look round took too long".to_owned(),
            NavigationState::Succeeded => {
                self.blacklist.record_visit(target, place);
                return;
            }
            NavigationState::Preempted => return,
            NavigationState::Aborted(why) => format!("the look round was not made: {why}"),
            _ => "the look round took too long".to_owned(),
        };
        let failure = Failure { target, place, from: place, why: &why };
        self.blacklist.record_failure(&failure, self.watch.map());
    }

    /// Turns what was decided into the next state.
    fn follow(&mut self, decided: &Decided, map: &MapSnapshot, now_s: f64, record: &mut DecisionRecord, pose: Pose) {
        if let Some(share) = self.share_known(map)
            && self.settings.finish.good_enough_share.is_some_and(|enough| share >= enough)
            && self.shows_all()
            && decided.left_behind.frontiers > 0
        {
            let left = 100.0 * (1.0 - share);
            self.finish(
                EndReason::GoodEnough,
                now_s,
                &format!("about {left:.1} % of the free area is left, as was asked for"),
            );
            return;
        }
        if let Some(choice) = &decided.choice {
            if let State::Driving(drive) = &mut self.state
                && self.lookout.can_stand(map, drive.goal.position())
            {
                let goal = &self.settings.goal;
                let is_same = drive.goal.distance_to(choice.goal.position()) < goal.already_there_m;
                let comes_first = choice.is_beside && !drive.is_beside;
                // Of two that are about as good, a strategy may like now this one and now that one.
                let may_change = self.lookout.keeps_goals() && self.trouble.no_news_s() < FICKLE_S;
                let is_kept = !may_change && decided.is_open_near(drive.target, goal.commit_radius_m);
                if is_same || !comes_first && is_kept {
                    drive.considered_s = map.stamp_s;
                    drive.considered_version = map.version();
                    drive.done_at = None;
                    record.goal = Some(drive.goal);
                    "the goal under way is kept".clone_into(&mut record.why);
                    return;
                }
                let place = drive.goal.position();
                // What lies beside the way is left as soon as something speaks against it: twice, and
                // not for ever.
                let is_visit = drive.is_beside || !drive.is_stage && pose.distance_to(place) < goal.already_there_m;
                let here = decided.seen_from_here(drive.target, goal.commit_radius_m);
                if let Some((target, place)) = here.or(is_visit.then_some((drive.target, place))) {
                    // There but for the last steps, or where it is seen from as well.
                    self.arrivals.push(Arrival { target, place, decided_at: None, is_beside: drive.is_beside });
                } else if decided.is_barred_near(drive.target, goal.commit_radius_m, self.lookout.frontiers()) {
                    // The way there has closed as the robot came. From elsewhere it may seem open
                    // again: without a count the robot would drive to and fro for ever.
                    let why = "from here no way leads there";
                    let failure = Failure { target: drive.target, place, from: pose.position(), why };
                    self.blacklist.record_failure(&failure, self.watch.map());
                    self.notice =
                        Some(format!("the goal at ({:.2}, {:.2}) m is given up: {why}", drive.goal.x, drive.goal.y));
                }
            }
            self.counts.goals_sent += 1;
            let (id, progress) = (self.next_id(), ProgressMonitor::new(&pose, now_s));
            self.state = State::Driving(Drive {
                id,
                goal: choice.goal,
                target: choice.target,
                is_stage: choice.is_stage,
                is_beside: choice.is_beside,
                since_s: now_s,
                progress,
                considered_s: map.stamp_s,
                considered_version: map.version(),
                done_at: None,
            });
            return;
        }
        // A robot that drives on gets its next map, and gmapping sends one that stands none.
        if let State::Driving(drive) = &mut self.state
            && drive.done_at.is_none_or(|version| map.version() <= version)
            && self.lookout.can_stand(map, drive.goal.position())
        {
            drive.done_at = Some(map.version());
            (drive.considered_s, drive.considered_version) = (map.stamp_s, map.version());
            record.goal = Some(drive.goal);
            "nothing is left to choose on this map: the goal under way is kept until the next"
                .clone_into(&mut record.why);
            return;
        }
        if !self.shows_all() {
            "nothing is left to choose on this map: one that came after the last motion shall confirm it"
                .clone_into(&mut record.why);
            self.keep_confirming(map.version(), now_s);
            return;
        }
        if let Some(target) = decided.here {
            // Nothing else is left: look round once more from where the robot stands.
            "the robot already stands where the last frontier is seen from: look round".clone_into(&mut record.why);
            self.look_round(now_s, AfterTurn::LookedAt(target));
            return;
        }
        let audit = decided.audit.as_ref();
        let barred = audit.is_some_and(|audit| audit.barred > 0);
        let in_pocket = audit.is_some_and(|audit| audit.in_pocket) && decided.left_behind.unreachable > 0;
        // A look round may show a way in.
        let is_locked_out = audit.is_some_and(|audit| audit.locked_out.is_some());
        if decided.left_behind.failed > 0 || barred || in_pocket || is_locked_out {
            self.recover(decided, pose, now_s, record);
            return;
        }
        let (reason, message) = decided.why_nothing_is_left(false);
        self.finish(reason, now_s, &message);
    }

    /// The share of the free area that is known, where an end by share is asked for.
    fn share_known(&mut self, map: &MapSnapshot) -> Option<f64> {
        self.settings.finish.good_enough_share?;
        let free = self.lookout.census(map).free;
        let free_m2 = free as f64 * map.grid.info().cell_area_m2();
        Some(free_m2 / (free_m2 + self.left_behind.area_m2).max(f64::MIN_POSITIVE))
    }

    /// Whether the map shows all that could be seen from where the robot is: it came after the
    /// last motion, or it is the second since the robot came to rest. Where poses jump with every
    /// map, as a SLAM corrects them, none would ever be of after the last motion.
    pub(super) fn shows_all(&self) -> bool {
        self.watch.is_fresh() || self.at_rest_since.is_some_and(|since| self.watch.version() >= since + 2)
    }

    /// Goes on waiting for a map of after the last motion.
    fn keep_confirming(&mut self, version: u64, now_s: f64) {
        let (since_s, turns) = match &self.state {
            State::Confirming { since_s, turns, .. } => (*since_s, *turns),
            _ => (now_s, 0),
        };
        self.state = State::Confirming { since_s, turns, version };
    }

    /// A tick of waiting for a map that may end the run: decides on each that comes, and
    /// moves a little where none does.
    pub(super) fn confirm(&mut self, observation: &Observation, pose: Pose) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        let map = self.usable_map(now_s)?;
        let State::Confirming { since_s, turns, version } = &self.state else { return None };
        let (waited_s, turns) = (now_s - since_s, *turns);
        if map.version() != *version {
            return self.decide(observation, &map, pose);
        }
        // gmapping sends no map while the robot stands.
        if turns < NUDGES && waited_s >= self.settings.patience.settle_s * 2_f64.powi(turns as i32) {
            let angle_rad = if turns % 2 == 0 { NUDGE_RAD } else { -NUDGE_RAD };
            self.turn(now_s, angle_rad, AfterTurn::Confirm(turns + 1));
        }
        None
    }
}
