//! When a subscription is made anew. Pure.
//!
//! A connection that broke stays broken in rosrust, so a subscription must be made anew;
//! but each one leaves a thread and a connection behind for every publisher that is merely
//! silent, until that publisher speaks again. So silence alone is a reason only once after a
//! topic that must be talking has talked; else the master must show one: a publisher that
//! was never met, or that we are not registered any more.

use std::collections::BTreeSet;
use std::time::Duration;

/// The longest time from one look to the next.
const LONGEST: Duration = Duration::from_secs(120);
/// What comes this soon after subscribing may be a latched message: nobody talks yet.
const LATCHED_WITHIN: Duration = Duration::from_secs(3);
/// So often a publisher that cannot be met is tried again while others are silent.
const MAX_TRIES: u32 = 3;

/// How a topic talks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rhythm {
    /// Again and again: a silence longer than this is strange.
    Steady(Duration),
    /// Now and then, or once: silence says nothing. The master is looked at this often.
    Seldom(Duration),
}

impl Rhythm {
    /// From one look to the next.
    pub const fn period(self) -> Duration {
        match self {
            Self::Steady(period) | Self::Seldom(period) => period,
        }
    }
}

/// What the master says of a topic.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Listed {
    /// Who publishes it.
    pub publishers: BTreeSet<String>,
    /// Whether we are registered as hearing it.
    pub hears: bool,
}

/// What is known of a subscription, with times since it was made.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// Now.
    pub now: Duration,
    /// When the last message came by it.
    pub spoke: Option<Duration>,
    /// The publishers that connected to it.
    pub met: BTreeSet<String>,
    /// What the master says, if it answers.
    pub listed: Option<Listed>,
}

/// Decides when a subscription is made anew.
#[derive(Clone, Debug)]
pub struct Renewal {
    rhythm: Rhythm,
    /// Renewals since the last message or the last change of the publishers.
    tries: u32,
    publishers: BTreeSet<String>,
    /// What was wrong at the last look: it must still be at the next.
    suspicion: Option<BTreeSet<String>>,
    next_look: Duration,
}

impl Renewal {
    /// No subscription yet.
    pub const fn new(rhythm: Rhythm) -> Self {
        Self { rhythm, tries: 0, publishers: BTreeSet::new(), suspicion: None, next_look: rhythm.period() }
    }

    /// A subscription has been made.
    pub fn begin(&mut self) {
        self.suspicion = None;
        self.next_look = self.pause();
    }

    /// Whether the topic is silent for so long that a look at the master is worth it.
    pub fn wants_look(&self, now: Duration, spoke: Option<Duration>) -> bool {
        now >= self.next_look && now.saturating_sub(spoke.unwrap_or_default()) >= self.rhythm.period()
    }

    /// Whether the subscription is to be made anew; asked when a look is wanted.
    pub fn is_due(&mut self, seen: &Seen) -> bool {
        self.next_look = seen.now + self.pause();
        let latched_within = LATCHED_WITHIN.min(self.rhythm.period());
        let talked = seen.spoke.is_some_and(|spoke| spoke > latched_within);
        if talked && matches!(self.rhythm, Rhythm::Steady(_)) {
            self.tries = 0;
            return true;
        }
        let Some(listed) = &seen.listed else { return false };
        if listed.publishers != self.publishers {
            self.publishers.clone_from(&listed.publishers);
            self.tries = 0;
        }
        let mut wrong: BTreeSet<String> = listed.publishers.difference(&seen.met).cloned().collect();
        if !listed.hears {
            wrong.insert(String::new());
        }
        let persists = !wrong.is_empty() && self.suspicion.as_ref() == Some(&wrong);
        // Where nobody is met nothing is left behind.
        let costs = listed.publishers.intersection(&seen.met).next().is_some();
        let due = persists && (!costs || self.tries < MAX_TRIES);
        self.suspicion = (!wrong.is_empty()).then_some(wrong);
        self.tries += u32::from(due);
        due
    }

    fn pause(&self) -> Duration {
        let period = self.rhythm.period();
        period.saturating_mul(1 << self.tries.min(8)).min(LONGEST.max(period))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn s(seconds: u64) -> Duration {
        Duration::from_secs(seconds)
    }

    fn names(names: &[&str]) -> BTreeSet<String> {
        names.iter().map(|name| (*name).to_owned()).collect()
    }

    /// How many subscriptions are made in an hour of looking each second.
    fn renewals(rhythm: Rhythm, spoke: impl Fn(u64) -> Option<Duration>, met: &[&str], listed: &[&str]) -> usize {
        let mut renewal = Renewal::new(rhythm);
        let (mut count, mut began) = (0, 0);
        renewal.begin();
        for at in 0..3600 {
            let seen = Seen {
                now: s(at - began),
                spoke: spoke(count as u64),
                met: names(met),
                listed: Some(Listed { publishers: names(listed), hears: true }),
            };
            if renewal.wants_look(seen.now, seen.spoke) && renewal.is_due(&seen) {
                (count, began) = (count + 1, at);
                renewal.begin();
            }
        }
        count
    }

    #[test]
    fn silence_alone_leaves_nothing_behind() {
        for rhythm in [Rhythm::Steady(s(5)), Rhythm::Seldom(s(60))] {
            assert_eq!(renewals(rhythm, |_| None, &["/a"], &["/a"]), 0, "connected, and never spoke");
            assert_eq!(renewals(rhythm, |_| Some(s(1)), &["/a"], &["/a"]), 0, "latched");
            assert_eq!(renewals(rhythm, |_| None, &[], &[]), 0, "nobody publishes");
        }
        let once = |count| (count == 0).then_some(s(20));
        assert_eq!(renewals(Rhythm::Steady(s(5)), once, &["/a"], &["/a"]), 1, "it talked, and stopped");
        assert_eq!(renewals(Rhythm::Seldom(s(60)), once, &["/a"], &["/a"]), 0);
    }

    #[test]
    fn who_is_not_met_is_tried_again() {
        let nobody = renewals(Rhythm::Steady(s(5)), |_| None, &[], &["/a"]);
        assert!((15..40).contains(&nobody), "{nobody}: nothing is left behind, so it goes on");
        let one_of_two = renewals(Rhythm::Seldom(s(60)), |_| None, &["/b"], &["/a", "/b"]);
        assert_eq!(one_of_two, 3, "each try leaves something behind of the one that is silent");
    }

    #[test]
    fn a_master_that_forgot_us_is_told_again() {
        let mut renewal = Renewal::new(Rhythm::Seldom(s(60)));
        renewal.begin();
        let seen =
            |at, hears| Seen { now: s(at), listed: Some(Listed { hears, ..Listed::default() }), ..Seen::default() };
        assert!(!renewal.wants_look(s(59), None) && renewal.wants_look(s(60), None));
        assert!(!renewal.is_due(&seen(60, false)), "the registration may be under way");
        assert!(renewal.is_due(&seen(120, false)));
        assert!(!renewal.is_due(&Seen { now: s(180), ..Seen::default() }), "a master that is silent tells nothing");
    }
}
