//! On the way to a goal: arrival, failure, and second thoughts.

use super::super::blacklist::Failure;
use super::super::record::DecisionRecord;
use super::super::state::{AfterTurn, State};
use super::Explorer;
use super::follow::Arrival;
use crate::geometry::Pose;
use crate::grid::{INSCRIBED_COST, LETHAL_COST};
use crate::robot::{MapSnapshot, NavigationState, Observation};

/// A robot that stands too near to an obstacle and still for so long does not get away by
/// itself, seconds.
const WEDGED_STILL_S: f64 = 2.0;

/// A map that comes this much before the period is over is not left for the next, seconds.
const EARLY_S: f64 = 0.15;

impl Explorer {
    /// A tick on the way to a goal.
    pub(super) fn drive(&mut self, observation: &Observation, pose: Pose) -> Option<DecisionRecord> {
        let now_s = observation.stamp_s;
        let patience = self.settings.patience;
        let State::Driving(drive) = &mut self.state else { return None };
        let ours = observation.navigation.command == drive.id;
        match &observation.navigation.state {
            NavigationState::Succeeded if ours => {
                let (target, place) = (drive.target, drive.goal.position());
                let (is_stage, is_beside) = (drive.is_stage, drive.is_beside);
                self.counts.goals_reached += 1;
                self.recoveries_in_a_row = 0;
                self.trouble.is_over();
                self.state = State::Ready;
                if !is_stage {
                    self.arrivals.push(Arrival { target, place, decided_at: None, is_beside });
                    if self.settings.turns.at_goal {
                        self.look_round(now_s, AfterTurn::Settle);
                    }
                }
            }
            NavigationState::Aborted(why) if ours => self.fail(pose, now_s, why),
            NavigationState::Preempted if ours => self.state = State::Settling { since_s: now_s },
            state => {
                // A goal that nobody has taken up yet moves nobody.
                if ours && *state == NavigationState::Idle {
                    drive.progress.pause(now_s);
                }
                let stuck_s = drive.progress.stuck_for_s(&pose, now_s, patience.progress_distance_m);
                let still_s = drive.progress.still_for_s(&pose, now_s);
                let turns_in_vain = ours && drive.progress.turns_in_vain(&pose, now_s);
                // A robot that stands where its navigation cannot plan from gets no plan.
                let wedged = still_s >= WEDGED_STILL_S
                    && self.watch.map().and_then(|map| map.costmap.as_ref()).is_some_and(|costmap| {
                        let cost = costmap.cells.cost_at(pose.position());
                        matches!(cost, INSCRIBED_COST | LETHAL_COST)
                    });
                let trouble = if now_s - drive.since_s >= patience.goal_timeout_s {
                    Some(format!("not reached within {:.0} s", patience.goal_timeout_s))
                } else if stuck_s >= patience.progress_timeout_s {
                    Some(format!("no progress for {stuck_s:.0} s"))
                } else if wedged {
                    self.trouble.is_wedged_here(&pose);
                    Some("the robot stands too near to an obstacle to be planned for".to_owned())
                } else if turns_in_vain {
                    // Its controller finds no way out of here: in a door, beside a leg.
                    self.trouble.is_wedged_here(&pose);
                    Some("the robot turns on the spot and gets nowhere".to_owned())
                } else if still_s >= if drive.progress.has_moved() { patience.stall_s } else { patience.begin_s } {
                    if self.settings.taboo.is_final {
                        // A failure is for good there, and this one may be the place's: it backs off first.
                        self.trouble.is_wedged_here(&pose);
                    }
                    Some(format!("the robot has not moved for {still_s:.0} s"))
                } else {
                    None
                };
                if let Some(why) = trouble {
                    self.fail(pose, now_s, &why);
                } else if let Some(map) = self.watch.map().cloned() {
                    return self.reconsider(observation, &map, pose);
                }
            }
        }
        None
    }

    /// On the way: decide anew when the goal turned out to be blocked, or when the
    /// settings ask for it.
    fn reconsider(&mut self, observation: &Observation, map: &MapSnapshot, pose: Pose) -> Option<DecisionRecord> {
        let State::Driving(drive) = &mut self.state else { return None };
        if map.version() <= drive.considered_version {
            return None;
        }
        let due = self
            .settings
            .goal
            .reconsider_period_s
            .is_some_and(|period_s| observation.stamp_s - drive.considered_s >= period_s - EARLY_S);
        let blocked = !self.lookout.can_stand(map, drive.goal.position());
        if due || blocked {
            return self.decide(observation, map, pose);
        }
        None
    }

    /// The goal under way is given up.
    pub(super) fn fail(&mut self, pose: Pose, now_s: f64, why: &str) {
        let State::Driving(drive) = &self.state else { return };
        self.notice = Some(format!("the goal at ({:.2}, {:.2}) m failed: {why}", drive.goal.x, drive.goal.y));
        self.counts.goals_failed += 1;
        let (target, place, from) = (drive.target, drive.goal.position(), pose.position());
        self.blacklist.record_failure(&Failure { target, place, from, why }, self.watch.map());
        let is_the_place = self.trouble.fail(&pose, now_s);
        if self.gives_up(now_s) {
            return;
        }
        self.state = if is_the_place { self.back_off(pose, now_s) } else { State::Ready };
    }
}
