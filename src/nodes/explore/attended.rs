//! A run of an exploration: what is asked for is done, what happens is shown, and what must outlive
//! a crash is kept.

use super::operator::{Matter, Operator};
use super::rules::Stage;
use super::session::{Activity, SessionKeeper};
use super::watcher::NodeWatcher;
use crate::explore::{Areas, Decision, Explorer, Watcher};
use crate::robot::Observation;
use crate::ros::RosRobot;
use crate::ros::log::Log;
use crate::ros::map_feed::{MapReader, Recalled};

/// The map of an earlier session, and what is known of it.
pub struct Recall {
    maps: MapReader,
    log: Log,
    /// The areas of the parameters.
    areas: Areas,
    last: Recalled,
}

impl Recall {
    /// Nothing is known of it yet; areas that turn out to lie in another frame are replaced by these.
    pub const fn new(maps: MapReader, log: Log, areas: Areas) -> Self {
        Self { maps, log, areas, last: Recalled::NotYet }
    }

    /// Says what has become of the earlier map; places that lie in another frame are forgotten.
    fn look(&mut self, watcher: &NodeWatcher<'_>, explorer: &mut Explorer) {
        let now = self.maps.recalled();
        if now == self.last {
            return;
        }
        self.last = now;
        match now {
            Recalled::Below => {
                self.log.info("the map of the session agrees with the one that comes: what was explored stays so");
            }
            Recalled::Contradicts => {
                self.log.warn(
                    "the map of the session contradicts the one that comes: the SLAM has not found itself in it. Its map, \
                     its areas, its home and what it left alone are forgotten",
                );
                explorer.forget_places();
                watcher.exchange_areas(self.areas.clone());
            }
            Recalled::Nothing | Recalled::NotYet => {}
        }
    }
}

/// Looks on while the robot explores.
pub struct Attended<'a, 'b> {
    /// Does what is asked for.
    pub operator: &'a mut Operator,
    /// Shows what happens.
    pub watcher: &'a mut NodeWatcher<'b>,
    /// Keeps the session.
    pub keeper: &'a mut SessionKeeper,
    /// Looks after the map of an earlier session.
    pub recall: &'a mut Recall,
}

impl Watcher<RosRobot> for Attended<'_, '_> {
    fn before_step(&mut self, robot: &RosRobot, explorer: &mut Explorer, observation: &Observation) {
        let Self { operator, watcher, keeper, recall } = self;
        let stage = match () {
            () if explorer.is_returning() => Stage::Returning,
            () if robot.has_begun() => Stage::Exploring,
            () => Stage::Waiting,
        };
        let explain = || watcher.explanation();
        let now_s = observation.stamp_s;
        operator.serve(&mut Matter { stage, explorer: Some(explorer), now_s, explain: &explain });
        recall.look(watcher, explorer);
        watcher.look(robot, explorer, now_s);
        let activity = if operator.is_paused() { Activity::Paused } else { Activity::Exploring };
        keeper.keep(|| watcher.session(explorer, activity));
    }

    fn after_step(&mut self, robot: &RosRobot, explorer: &Explorer, observation: &Observation, decision: &Decision) {
        self.watcher.show(robot, explorer, observation, decision);
    }

    fn stop_requested(&self) -> Option<String> {
        self.operator.stop_requested()
    }
}
