//! The session on disk: what is needed to go on after a crash, or on another day.

use super::settings::ExploreNodeError;
use crate::config::NodeParams;
use crate::explore::{Areas, Memory};
use crate::grid::{MapMemory, Thresholds};
use crate::io::{SaveOptions, clear_stale, load_map, read_if_there, save_map, write_atomic};
use crate::ros::Node;
use crate::ros::log::{Level, Log};
use crate::ros::map_feed::MapReader;
use crate::ros::troubles::{Trouble, Troubles};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

/// How long the last one may take to be written, at an end.
const WRITE_WITHIN: Duration = Duration::from_secs(10);
/// The first word of the file, with the version of what follows.
const FORMAT: &str = "frontier_explorer session 1";

/// What the exploration was about when the session was written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Activity {
    /// It explored.
    #[default]
    Exploring,
    /// It rested.
    Paused,
    /// Its user had stopped it.
    Stopped,
    /// It had ended by itself.
    Ended,
}

/// All but the map.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Session {
    pub(super) format: String,
    /// What the exploration was about.
    pub activity: Activity,
    /// The preset.
    pub preset: String,
    /// The frame of the map, in which all places are.
    pub map_frame: String,
    /// Seconds of exploring.
    pub elapsed_s: f64,
    /// Metres driven.
    pub distance_m: f64,
    /// What the explorer knows.
    pub memory: Memory,
    /// Where the robot may be.
    pub areas: Areas,
}

impl Session {
    /// Reads the text of a session's file.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(text: &str) -> Result<Self, String> {
        let session: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if session.format != FORMAT {
            return Err(format!("its format is {:?}: must be {FORMAT:?}", session.format));
        }
        Ok(session)
    }

    /// What the node tells of what it took over.
    fn sentence(&self) -> String {
        let home = match self.memory.home {
            Some(home) => format!("home at ({:.2}, {:.2}) m", home.x, home.y),
            None => "no home".to_owned(),
        };
        format!(
            "{:.0} s and {:.1} m of exploring, {} goals, {home}, {} targets that failed, {} areas",
            self.elapsed_s,
            self.distance_m,
            self.memory.counts.goals_sent,
            self.memory.left_alone.failed(),
            self.areas.no_go.len() + usize::from(self.areas.region.is_some())
        )
    }
}

/// A session that is gone on with.
pub struct Resumed {
    /// What was written down.
    pub session: Session,
    /// Its map, if one was written.
    pub map: Option<MapMemory>,
}

impl Resumed {
    /// Reads the session that `~resume_from` names, and says what is taken over. Where the file is
    /// not there yet, all begins anew.
    ///
    /// # Errors
    /// [`ExploreNodeError::Session`] when it is there and cannot be read.
    pub fn read(node: &Node, file: &str, thresholds: Thresholds) -> Result<Option<Self>, ExploreNodeError> {
        if file.is_empty() {
            return Ok(None);
        }
        let wrong = |why: String| ExploreNodeError::Session { file: file.to_owned(), why };
        let Some(text) = read_if_there(Path::new(file)).map_err(|error| wrong(error.to_string()))? else {
            node.log().info(format_args!("~resume_from: {file} is not there yet: a new session begins"));
            return Ok(None);
        };
        let session = Session::parse(&text).map_err(wrong)?;
        let image = map_stem(Path::new(file)).with_extension("yaml");
        let map = match read_if_there(&image).map_err(|error| wrong(error.to_string()))? {
            Some(_) => Some(load_map(&image).map_err(|error| wrong(error.to_string()))?.grid),
            None => None,
        };
        let known = match &map {
            Some(grid) => {
                let known_m2 = grid.census(&thresholds).known() as f64 * grid.info().cell_area_m2();
                format!("a map of {known_m2:.0} m2")
            }
            None => "no map".to_owned(),
        };
        node.log().info(format_args!("going on with the session of {file}: {}, {known}", session.sentence()));
        Ok(Some(Self { session, map: map.map(|grid| MapMemory::new(grid, thresholds)) }))
    }
}

/// The map lies beside the session, by its name without ending.
fn map_stem(file: &Path) -> PathBuf {
    file.with_extension("")
}

/// What is to be written, and who waits for it.
type Job = (Session, Option<Sender<()>>);

/// Writes the session, on a thread of its own.
pub struct SessionKeeper {
    writer: Option<Sender<Job>>,
    /// From one time that it is written to the next, real time.
    period: Duration,
    next: Instant,
}

impl SessionKeeper {
    /// A keeper of `~session_file`; without a name it keeps nothing. What a killed process left
    /// half written is cleared.
    pub fn new(params: &NodeParams, maps: MapReader, log: &Log, troubles: &Troubles) -> Self {
        let (file, period) = (&params.session_file, Duration::from_secs_f64(params.session_period));
        let next = Instant::now() + period;
        if file.is_empty() {
            return Self { writer: None, period, next };
        }
        let (file, stem) = (PathBuf::from(file), map_stem(Path::new(file)));
        let stale: usize = [&file, &stem.with_extension("yaml"), &stem.with_extension("pgm")]
            .iter()
            .map(|path| clear_stale(path))
            .sum();
        if stale > 0 {
            log.info(format_args!("{stale} files that were half written beside {} are cleared", file.display()));
        }
        let (sender, jobs) = channel::<Job>();
        let troubles = troubles.clone();
        std::thread::spawn(move || {
            let mut written = None;
            for (session, done) in jobs {
                match write(&file, &stem, session, &maps, &mut written) {
                    Ok(()) => {
                        troubles.clear(Trouble::Session);
                    }
                    Err(why) => troubles.report(Trouble::Session, Level::Error, why),
                }
                if let Some(done) = done {
                    // Who waited may have gone.
                    let _ = done.send(());
                }
            }
        });
        Self { writer: Some(sender), period, next }
    }

    /// Writes the session when it is time.
    pub fn keep(&mut self, session: impl FnOnce() -> Session) {
        let Some(writer) = self.writer.as_ref().filter(|_| Instant::now() >= self.next) else { return };
        self.next = Instant::now() + self.period;
        // A thread that has ended writes no more: nothing can be done about it here.
        let _ = writer.send((session(), None));
    }

    /// Writes the session now, and waits for it.
    pub fn keep_now(&mut self, session: Session) {
        let Some(writer) = &self.writer else { return };
        self.next = Instant::now() + self.period;
        let (sender, done) = channel();
        if writer.send((session, Some(sender))).is_ok() {
            let _ = done.recv_timeout(WRITE_WITHIN);
        }
    }
}

/// Writes map and session, each whole or not at all; `written` is the map's version that lies there.
fn write(
    file: &Path,
    stem: &Path,
    session: Session,
    maps: &MapReader,
    written: &mut Option<u64>,
) -> Result<(), String> {
    let failed = |why: &dyn std::fmt::Display| format!("the session is not saved as {}: {why}", file.display());
    if let Some(map) = maps.newest().filter(|map| *written != Some(map.changes.version())) {
        save_map(stem, &map.grid, &SaveOptions::default()).map_err(|error| failed(&error))?;
        *written = Some(map.changes.version());
    }
    let session = Session { format: FORMAT.to_owned(), ..session };
    let text = serde_json::to_string_pretty(&session).map_err(|error| failed(&error))?;
    write_atomic(file, text.as_bytes()).map_err(|error| failed(&error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Polygon, Pose};

    #[test]
    fn a_session_is_read_as_it_was_written() {
        let region = Polygon::try_from(vec![[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]]).unwrap();
        let session = Session {
            format: FORMAT.to_owned(),
            activity: Activity::Stopped,
            elapsed_s: 12.5,
            memory: Memory { home: Some(Pose::new(1.0, 2.0, 0.5)), ..Memory::default() },
            areas: Areas { region: Some(region), no_go: Vec::new() },
            ..Session::default()
        };
        let text = serde_json::to_string(&session).unwrap();
        assert_eq!(serde_json::from_str::<Session>(&text).unwrap(), session);
        assert!(session.sentence().contains("home at (1.00, 2.00) m, 0 targets that failed, 1 areas"));
    }
}
