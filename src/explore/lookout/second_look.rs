//! The second look of a decision, at the raw map, where the preset sees nothing more: the
//! audit's frontiers are weighed as the preset's are, and what bars the way to them is named.

use super::{Lookout, Situation, Weighed};
use crate::explore::assess::Assessed;
use crate::explore::blacklist::SAME_PLACE_M;
use crate::explore::decided::Audited;
use crate::explore::record::{CandidateStatus, SeenFrontiers};
use crate::explore::standing::{GoalHeading, StandingGoal};
use crate::frontier::{DetectError, Frontier};
use crate::planning::{PathField, Whereabouts};
use crate::robot::MapSnapshot;
use std::sync::Arc;

/// A body that can be as near to a frontier as this gets through it, metres.
const THROUGH_M: f64 = 0.15;
/// A place smaller than this is a pocket and not the robot's world, square metres.
const POCKET_M2: f64 = 1.0;

impl Lookout {
    /// The audit's frontiers, what became of them, and what bars the way; where the settings
    /// let the explorer go on, one of them may be chosen.
    ///
    /// # Errors
    /// [`DetectError`] when this map gives no answer.
    pub(super) fn look_again(
        &mut self,
        situation: &Situation<'_>,
        map: &MapSnapshot,
        field: Option<&PathField>,
    ) -> Result<(Vec<Frontier>, Weighed, Audited), DetectError> {
        let raw = self.audit_frontiers(map, situation.robot)?;
        let mut weighed = self.weigh(&raw, situation, map, field);
        let mut audited = self.audit_of(&weighed, situation, map, field);
        if !situation.settings.finish.explore_what_the_audit_sees {
            let open = weighed.assessed.iter().filter(|a| is_open(a));
            audited.forbidden = open.clone().count();
            audited.forbidden_m = open.map(|a| a.record.size_m).sum();
            weighed.choice = None;
        }
        if weighed.choice.is_some() {
            self.frontiers = Arc::new(SeenFrontiers::new(*map.grid.info(), raw.clone()));
        }
        Ok((raw, weighed, audited))
    }

    /// What bars the way to the frontiers that are left.
    fn audit_of(
        &mut self,
        weighed: &Weighed,
        situation: &Situation<'_>,
        map: &MapSnapshot,
        field: Option<&PathField>,
    ) -> Audited {
        let robot = &situation.robot;
        let unreachable = |a: &&Assessed| a.record.status == CandidateStatus::Unreachable;
        let has_areas = self.costs.fence.fenced().is_some();
        // What the areas close is no pocket.
        let open = has_areas.then(|| situation.driven.open(&self.costs.of(map).cells, robot));
        let open = open.map(|open| PathField::reach_only(open, robot).ok());
        let widely = open.as_ref().map_or(field, Option::as_ref);
        let in_pocket = widely.is_none_or(|field| field.area_m2() < POCKET_M2);
        let (mut barred, mut fenced_off) = (0, 0);
        if weighed.assessed.iter().any(|a| unreachable(&a)) {
            let widest = self.audit.widest_reach(&map.grid, situation.driven, &mut self.costs.fence, robot);
            let radius_m = situation.settings.goal.search_radius_m;
            let standing = &mut self.standing;
            let mut could_see = |a: &&Assessed| {
                // What the robot has looked at from as near as it gets is left only where its body
                // would get through: a nook of which a step nearer shows a little more is not.
                let nearer_m = |spent_m: f64| (spent_m - SAME_PLACE_M).min(THROUGH_M);
                let radius_m = a.spent_m.map_or(radius_m, nearer_m);
                if radius_m <= 0.0 {
                    return false;
                }
                let search = StandingGoal { radius_m, heading: GoalHeading::AsApproached, refused: &|_| false };
                // The search counts whole cells.
                let near_m = radius_m + 0.71 * map.grid.info().resolution_m();
                let place = widest.as_ref().and_then(|field| standing.goal(field, robot, a.target, &search));
                place.is_some_and(|place| place.distance_to(a.target) <= near_m)
            };
            barred = weighed.assessed.iter().filter(unreachable).filter(|a| could_see(a)).count();
            let mut is_fenced_off = |a: &&Assessed| {
                // Where the robot looked at it from as near as it may, a nearer place counts.
                let radius_m = a.spent_m.map_or(radius_m, |spent_m| spent_m - SAME_PLACE_M);
                let search = StandingGoal { radius_m, heading: GoalHeading::AsApproached, refused: &|_| false };
                has_areas && radius_m > 0.0 && widely.and_then(|f| standing.goal(f, robot, a.target, &search)).is_some()
            };
            fenced_off = weighed.assessed.iter().filter(unreachable).filter(|a| is_fenced_off(a)).count();
        }
        let has_no_go = !situation.settings.no_go.is_empty();
        let locked_out = match self.costs.fence.whereabouts() {
            Whereabouts::LockedOut { no_go } if has_areas => Some(no_go),
            _ => None,
        };
        Audited { forbidden: 0, forbidden_m: 0.0, barred, in_pocket, fenced_off, has_no_go, locked_out }
    }
}

/// Whether nothing speaks against a frontier.
const fn is_open(assessed: &Assessed) -> bool {
    matches!(
        assessed.record.status,
        CandidateStatus::Chosen | CandidateStatus::Eligible | CandidateStatus::AlreadyThere
    )
}
