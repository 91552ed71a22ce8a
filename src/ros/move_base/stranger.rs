//! Goals of others at the same action server: a person's click in RViz, a mission script. They
//! are left to their end, but not for ever. Pure; times are seconds.

/// Our goal was taken away: so long it is waited for the one that took its place, seconds.
const GRACE_S: f64 = 1.0;

/// Who else drives the robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Stranger {
    /// Nobody.
    None,
    /// Somebody, and is left to it.
    Drives {
        /// The goal's name, which tells whose it is.
        goal: String,
    },
    /// Somebody for too long.
    TakesTooLong {
        /// The goal's name.
        goal: String,
    },
}

/// Follows the goals of others.
#[derive(Clone, Debug, Default)]
pub struct StrangerWatch {
    /// The goal under way that is not ours.
    goal: Option<String>,
    /// The goal that is yielded to, nameless before it is known, and since when.
    yielded: Option<(Option<String>, f64)>,
}

impl StrangerWatch {
    /// The server told which goals are under way, ours left out.
    pub fn on_status<'a>(&mut self, mut others: impl Iterator<Item = &'a str>) {
        self.goal = others.next().map(ToOwned::to_owned);
    }

    /// Our own goal was taken away, by one that the server may not have told yet.
    pub fn on_preempted(&mut self, now_s: f64) {
        if self.yielded.is_none() {
            self.yielded = Some((None, now_s));
        }
    }

    /// Who drives now, if goals of others are left to their end for so long.
    pub fn look(&mut self, now_s: f64, limit_s: f64) -> Stranger {
        let Some(goal) = self.goal.clone() else {
            // Time that jumped back ends the wait as well.
            if let Some((None, since_s)) = self.yielded
                && (0.0..GRACE_S).contains(&(now_s - since_s))
                && limit_s > 0.0
            {
                return Stranger::Drives { goal: "not known yet".to_owned() };
            }
            self.yielded = None;
            return Stranger::None;
        };
        let since_s = match &self.yielded {
            Some((Some(known), since_s)) if *known == goal && *since_s <= now_s => *since_s,
            _ => now_s,
        };
        self.yielded = Some((Some(goal.clone()), since_s));
        if now_s - since_s < limit_s { Stranger::Drives { goal } } else { Stranger::TakesTooLong { goal } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drives(goal: &str) -> Stranger {
        Stranger::Drives { goal: goal.to_owned() }
    }

    #[test]
    fn a_goal_of_somebody_else_is_left_to_its_end_for_a_time() {
        let mut watch = StrangerWatch::default();
        assert_eq!(watch.look(0.0, 10.0), Stranger::None);
        watch.on_status(["rviz-1"].into_iter());
        assert_eq!((watch.look(1.0, 10.0), watch.look(10.9, 10.0)), (drives("rviz-1"), drives("rviz-1")));
        assert_eq!(watch.look(11.0, 10.0), Stranger::TakesTooLong { goal: "rviz-1".to_owned() });
        watch.on_status(["rviz-2"].into_iter());
        assert_eq!(watch.look(12.0, 10.0), drives("rviz-2"), "another goal has its own time");
        watch.on_status([].into_iter());
        assert_eq!(watch.look(13.0, 10.0), Stranger::None);
    }

    #[test]
    fn what_took_our_goal_away_is_waited_for() {
        let mut watch = StrangerWatch::default();
        watch.on_preempted(5.0);
        assert_eq!(watch.look(5.5, 10.0), drives("not known yet"));
        watch.on_status(["rviz-1"].into_iter());
        assert_eq!(watch.look(5.8, 10.0), drives("rviz-1"));
        watch.on_status([].into_iter());
        assert_eq!(watch.look(8.0, 10.0), Stranger::None);
        watch.on_preempted(20.0);
        assert_eq!((watch.look(20.9, 10.0), watch.look(21.1, 10.0)), (drives("not known yet"), Stranger::None));
        watch.on_preempted(30.0);
        assert_eq!(watch.look(30.1, 0.0), Stranger::None, "where goals of others are not respected");
    }
}
