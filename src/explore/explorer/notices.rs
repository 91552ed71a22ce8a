//! What the user is told while a run goes on: a map that jumped, a map that is stale or of no
//! use, a robot outside of its areas.

use super::Explorer;
use crate::geometry::Pose;
use crate::planning::Whereabouts;

/// A step by more than this beyond what the robot can drive is a jump, metres.
const JUMP_M: f64 = 0.5;
/// A robot that stands outside by less than this has stopped a little late, metres.
const OUTSIDE_M: f64 = 0.3;
/// From one word about a stale or useless map to the next, seconds.
const STALE_PERIOD_S: f64 = 15.0;

impl Explorer {
    /// A pose that no robot can have driven to: the map was moved under it, by a loop that
    /// closed or by a mapper that lost its way. What was seen from where counts no more.
    pub(super) fn notice_jump(&mut self, pose: &Pose, now_s: f64) {
        let Some((last_s, last)) = self.last_pose.replace((now_s, *pose)) else { return };
        let moved_m = pose.distance_to(last.position());
        if moved_m > JUMP_M + self.top_speed_mps * (now_s - last_s) {
            self.sights.forget();
            self.notice = Some(format!("the map jumped under the robot by {moved_m:.1} m"));
        }
    }

    /// Tells once that the robot stands outside of its areas, and what it does then.
    pub(super) fn notice_outside(&mut self) {
        let text = match self.lookout.whereabouts() {
            Whereabouts::Inside => return,
            Whereabouts::Leaving { way_m, .. } if way_m < OUTSIDE_M => return,
            Whereabouts::Leaving { no_go: true, way_m } => {
                format!(
                    "the robot stands in a no-go area, or beside one, and leaves it by the shortest way of {way_m:.1} m"
                )
            }
            Whereabouts::Leaving { no_go: false, way_m } => {
                format!("the robot stands outside of its region and drives in by the shortest way of {way_m:.1} m")
            }
            Whereabouts::LockedOut { no_go: true } => {
                "the robot stands in a no-go area, or beside one, and no known way leads out".to_owned()
            }
            Whereabouts::LockedOut { no_go: false } => {
                "the robot stands outside of its region and no known way leads in: of the region only what is seen from outside is explored"
                    .to_owned()
            }
        };
        if !std::mem::replace(&mut self.outside_told, true) {
            self.notice = Some(text);
        }
    }

    /// Tells, now and then, why nothing can be decided on the map that is there.
    pub(super) fn notice_useless_map(&mut self, why: &str, now_s: f64) {
        if now_s - self.stale_told_s >= STALE_PERIOD_S {
            self.stale_told_s = now_s;
            self.notice = Some(format!("another map is waited for: {why}"));
        }
    }

    /// Tells the age of a map that is overdue, now and then.
    pub(super) fn notice_stale_map(&mut self, overdue_s: f64, now_s: f64) {
        if now_s - self.stale_told_s >= STALE_PERIOD_S {
            self.stale_told_s = now_s;
            self.notice =
                Some(format!("the map is stale: no newer one has come for {overdue_s:.0} s though the robot moved"));
        }
    }
}
