//! What is wrong now and keeps the exploration from going on: said at once, again every
//! quarter of a minute while it lasts, and shown in the status and in `/diagnostics`.

use super::log::{Level, Log};
use std::collections::BTreeMap;
use std::fmt::Display;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// From one time that a trouble is said to the next.
const AGAIN_AFTER: Duration = Duration::from_secs(15);
/// A trouble whose words change is said again, but not more often than this.
const CHANGED_AFTER: Duration = Duration::from_secs(2);

/// What may be wrong, the most urgent first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Trouble {
    /// `/clock` has not begun, or stands.
    Clock,
    /// No map has come.
    Map,
    /// No costmap has come.
    Costmap,
    /// The robot's place is not known.
    Pose,
    /// No scan tells what is ahead.
    Scan,
    /// Nobody drives to goals.
    MoveBase,
    /// Somebody else's goal is under way.
    Stranger,
    /// The costmap of whoever drives takes the unknown for free.
    CostmapUnknown,
    /// The map cannot be saved.
    MapFile,
    /// The session cannot be saved.
    Session,
    /// The node uses much of the machine.
    Resources,
}

struct Entry {
    level: Level,
    text: String,
    /// What was said last, without its numbers, and when.
    said: Option<(String, Instant)>,
}

/// The troubles of a node; clones are the same.
#[derive(Clone)]
pub struct Troubles {
    log: Log,
    entries: Arc<Mutex<BTreeMap<Trouble, Entry>>>,
}

impl Troubles {
    /// All is well.
    #[must_use]
    pub fn new(log: &Log) -> Self {
        Self { log: log.clone(), entries: Arc::default() }
    }

    /// Something is wrong: says so at once, unless it was said lately in the same words;
    /// numbers may differ.
    pub fn report(&self, trouble: Trouble, level: Level, text: impl Display) {
        let mut entries = self.lock();
        let entry = entries.entry(trouble).or_insert_with(|| Entry { level, text: String::new(), said: None });
        (entry.level, entry.text) = (level, text.to_string());
        self.say(entry);
    }

    /// All is well again; whether something was wrong.
    pub fn clear(&self, trouble: Trouble) -> bool {
        self.lock().remove(&trouble).is_some()
    }

    /// Says again what has lasted for long; to be called about once a second.
    pub fn repeat(&self) {
        for entry in self.lock().values_mut() {
            self.say(entry);
        }
    }

    /// What is wrong now: the gravest, and of those the most urgent.
    #[must_use]
    pub fn worst(&self) -> Option<(Level, String)> {
        let entries = self.lock();
        let worst = entries.values().map(|entry| entry.level).max()?;
        entries.values().find(|entry| entry.level == worst).map(|entry| (worst, entry.text.clone()))
    }

    /// All that is wrong now, the most urgent first.
    #[must_use]
    pub fn all(&self) -> Vec<String> {
        self.lock().values().map(|entry| entry.text.clone()).collect()
    }

    /// What is said of one trouble, while it lasts.
    #[must_use]
    pub fn text(&self, trouble: Trouble) -> Option<String> {
        self.lock().get(&trouble).map(|entry| entry.text.clone())
    }

    fn say(&self, entry: &mut Entry) {
        let words: String = entry.text.chars().filter(|c| !c.is_ascii_digit()).collect();
        let is_due = entry.said.as_ref().is_none_or(|(said, at)| {
            let wait = if *said == words { AGAIN_AFTER } else { CHANGED_AFTER };
            at.elapsed() >= wait
        });
        if is_due {
            entry.said = Some((words, Instant::now()));
            match entry.level {
                Level::Error => self.log.error(&entry.text),
                Level::Warn => self.log.warn(&entry.text),
                Level::Info => self.log.info(&entry.text),
            }
        }
    }

    fn lock(&self) -> MutexGuard<'_, BTreeMap<Trouble, Entry>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gravest_and_most_urgent_is_shown() {
        let troubles = Troubles::new(&Log::new("test"));
        assert_eq!(troubles.worst(), None);
        troubles.report(Trouble::MoveBase, Level::Warn, "no server");
        troubles.report(Trouble::Map, Level::Warn, "no map for 1 s");
        assert_eq!(troubles.worst(), Some((Level::Warn, "no map for 1 s".to_owned())));
        troubles.report(Trouble::MapFile, Level::Error, "no folder");
        assert_eq!(troubles.worst(), Some((Level::Error, "no folder".to_owned())));
        assert!(troubles.clear(Trouble::MapFile) && !troubles.clear(Trouble::MapFile));
        assert_eq!(troubles.text(Trouble::MoveBase).as_deref(), Some("no server"));
    }

    #[test]
    fn numbers_that_change_are_no_news() {
        let troubles = Troubles::new(&Log::new("test"));
        let said = |troubles: &Troubles| troubles.lock().values().next().unwrap().said.clone().unwrap();
        troubles.report(Trouble::Pose, Level::Warn, "0.6 s old");
        let first = said(&troubles);
        troubles.report(Trouble::Pose, Level::Warn, "0.7 s old");
        assert_eq!(said(&troubles), first);
        assert_eq!(troubles.worst().unwrap().1, "0.7 s old");
    }
}
