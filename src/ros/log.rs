//! What the node says: to the terminal and to `/rosout`. rosrust's own log macros
//! panic when nobody reads their output any more; these lines are dropped then.

use super::msg::rosgraph_msgs::Log as LogMessage;
use crate::text::printable;
use rosrust::Publisher;
use std::fmt::Display;
use std::io::Write;
use std::sync::{Arc, Mutex, PoisonError};

/// How grave a line is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// What happens as it should.
    Info,
    /// What the user should know of.
    Warn,
    /// What keeps the node from its work.
    Error,
}

/// Writes lines in the form of roscpp's console.
#[derive(Clone)]
pub struct Log {
    name: Arc<str>,
    rosout: Arc<Mutex<Option<Publisher<LogMessage>>>>,
    last: Arc<Mutex<Option<(Level, String)>>>,
}

impl Log {
    /// A log to the terminal alone, until the node has connected.
    #[must_use]
    pub fn new(name: &str) -> Self {
        Self { name: name.into(), rosout: Arc::default(), last: Arc::default() }
    }

    /// From now on lines go to `/rosout` too, under the node's full name.
    pub(super) fn connect(&mut self, name: &str, rosout: Publisher<LogMessage>) {
        self.name = name.into();
        *self.rosout.lock().unwrap_or_else(PoisonError::into_inner) = Some(rosout);
    }

    /// Lets `/rosout` go, so that it is unregistered with the node.
    pub(super) fn disconnect(&self) {
        self.rosout.lock().unwrap_or_else(PoisonError::into_inner).take();
    }

    /// Says what happens as it should.
    pub fn info(&self, text: impl Display) {
        self.say(Level::Info, &text.to_string());
    }

    /// Says what the user should know of.
    pub fn warn(&self, text: impl Display) {
        self.say(Level::Warn, &text.to_string());
    }

    /// Says what keeps the node from its work.
    pub fn error(&self, text: impl Display) {
        self.say(Level::Error, &text.to_string());
    }

    /// Says something unless it was the last thing said: for what goes on and on.
    pub fn once(&self, level: Level, text: impl Display) {
        let text = text.to_string();
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if last != Some((level, text.clone())) {
            self.say(level, &text);
        }
    }

    fn say(&self, level: Level, text: &str) {
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = Some((level, text.to_owned()));
        let text = &printable(text);
        let (word, number) = match level {
            Level::Info => (" INFO", LogMessage::INFO),
            Level::Warn => (" WARN", LogMessage::WARN),
            Level::Error => ("ERROR", LogMessage::ERROR),
        };
        // A terminal that has gone is no reason to stop exploring.
        let _ = writeln!(std::io::stderr(), "[{word}] [{}]: {text}", self.name);
        if let Some(rosout) = &*self.rosout.lock().unwrap_or_else(PoisonError::into_inner) {
            let line = LogMessage {
                level: number,
                name: self.name.to_string(),
                msg: text.to_string(),
                ..LogMessage::default()
            };
            let _ = rosout.send(line);
        }
    }
}

/// Passes rosrust's own complaints on to the terminal.
struct Bridge;

impl log::Log for Bridge {
    fn enabled(&self, metadata: &log::Metadata<'_>) -> bool {
        metadata.level() <= log::Level::Warn && metadata.target().starts_with("rosrust")
    }

    fn log(&self, record: &log::Record<'_>) {
        if self.enabled(record.metadata()) {
            let text = record.args().to_string();
            let _ = writeln!(std::io::stderr(), "[ WARN] [rosrust]: {}", printable(&text));
        }
    }

    fn flush(&self) {}
}

/// Lets what rosrust reports through the `log` crate be seen; a program that has a
/// logger of its own keeps it.
pub(super) fn bridge() {
    if log::set_logger(&Bridge).is_ok() {
        log::set_max_level(log::LevelFilter::Warn);
    }
}
