//! What the user is told while a run goes on: a map that jumped, a map that is stale.

use super::Explorer;
use crate::geometry::Pose;

/// A step by more than this beyond what the robot can drive is a jump, metres.
const JUMP_M: f64 = 0.5;
/// From one word about a stale map to the next, seconds.
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

    /// Tells the age of a map that is overdue, now and then.
    pub(super) fn notice_stale_map(&mut self, overdue_s: f64, now_s: f64) {
        if now_s - self.stale_told_s >= STALE_PERIOD_S {
            self.stale_told_s = now_s;
            self.notice =
                Some(format!("the map is stale: no newer one has come for {overdue_s:.0} s though the robot moved"));
        }
    }
}
