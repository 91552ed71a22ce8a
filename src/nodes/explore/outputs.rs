//! The topics that the node offers, and the thread that keeps its status fresh.

use super::connect::Connected;
use super::resources;
use super::saving::MapSaver;
use super::settings::{ExploreNodeError, Settings};
use crate::explore::{Counts, Decision, DecisionRecord, Explorer, Phase, TimeSpent};
use crate::geometry::Path;
use crate::io::ProcessUse;
use crate::ros::convert;
use crate::ros::display::{
    FrontierMarkers, StatusInput, diagnostics, frontier_array, no_markers, region_message, status, status_sentence,
};
use crate::ros::log::Level;
use crate::ros::map_feed::MapReader;
use crate::ros::msg::diagnostic_msgs::DiagnosticArray;
use crate::ros::msg::frontier_explorer::{ExplorationStatus, FrontierArray};
use crate::ros::msg::geometry_msgs::{PolygonStamped, PoseStamped};
use crate::ros::msg::nav_msgs;
use crate::ros::msg::visualization_msgs::MarkerArray;
use crate::ros::troubles::{Trouble, Troubles};
use crate::ros::{Node, Publisher};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// From one status to the next, real time.
const STATUS_PERIOD: Duration = Duration::from_secs(1);
/// From one line of progress to the next.
const LINE_PERIOD: Duration = Duration::from_secs(15);

/// Everything that the node publishes.
pub struct Outputs {
    node: Node,
    /// Name of the preset.
    pub preset: String,
    frontiers: Publisher<MarkerArray>,
    shows_markers: AtomicBool,
    array: Publisher<FrontierArray>,
    goal: Publisher<PoseStamped>,
    path: Publisher<nav_msgs::Path>,
    region: Publisher<PolygonStamped>,
    status: Arc<Mutex<ExplorationStatus>>,
    teller: Arc<Teller>,
    markers: Mutex<FrontierMarkers>,
}

impl Outputs {
    /// Offers the topics and begins to tell the status.
    ///
    /// # Errors
    /// [`ExploreNodeError`] when a topic cannot be offered.
    pub fn offer(
        node: &Node,
        settings: &Settings,
        connected: &Connected,
        saver: &Arc<MapSaver>,
    ) -> Result<Self, ExploreNodeError> {
        let preset = settings.preset.preset.clone();
        let first = StatusInput {
            stamp_s: node.now_s(),
            frame: "map",
            phase: Phase::WaitingForMap,
            paused: false,
            preset: &preset,
            message: "waiting for the first map and the robot's place in it",
            end: None,
            elapsed_s: 0.0,
            distance_m: 0.0,
            known_area_m2: 0.0,
            free_area_m2: 0.0,
            frontiers: 0,
            counts: &Counts::default(),
            time_spent: &TimeSpent::default(),
            map_age_s: f64::NAN,
        };
        let shared = Arc::new(Mutex::new(status(&first)));
        let teller = Arc::new(Teller {
            node: node.clone(),
            status: Arc::clone(&shared),
            now: node.publish_latched("~status")?,
            health: node.publish("/diagnostics", 5)?,
            maps: connected.maps.clone(),
            paused: Arc::clone(&connected.paused),
            troubles: connected.troubles.clone(),
        });
        let (theirs, saver) = (Arc::clone(&teller), Arc::clone(saver));
        std::thread::spawn(move || tell(&theirs, &saver));
        Ok(Self {
            frontiers: node.publish_latched("~frontiers")?,
            shows_markers: AtomicBool::new(settings.params.visualize),
            array: node.publish_latched("~frontier_array")?,
            goal: node.publish_latched("~goal")?,
            path: node.publish_latched("~path")?,
            region: node.publish_latched("~region")?,
            node: node.clone(),
            preset,
            status: shared,
            teller,
            markers: Mutex::default(),
        })
    }

    /// Shows a decision.
    pub fn show_decision(&self, decision: &Decision, record: &DecisionRecord, resolution_m: f64, frame: &str) {
        let stamp_s = self.node.now_s();
        // Nobody who listens is no error of ours.
        if self.shows_markers.load(Ordering::Relaxed) {
            let mut markers = self.markers.lock().unwrap_or_else(PoisonError::into_inner);
            let _ = self.frontiers.send(markers.update(record, &decision.frontiers, resolution_m, frame, stamp_s));
        }
        let _ = self.array.send(frontier_array(record, frame, stamp_s));
        if let Some(goal) = &record.goal {
            let _ = self.goal.send(convert::stamped(goal, frame, stamp_s));
        }
        if let Some(path) = &decision.path {
            self.show_path(path, frame);
        }
    }

    /// Markers are shown from the next decision on, or taken away now.
    pub fn show_markers(&self, shows: bool) {
        if self.shows_markers.swap(shows, Ordering::Relaxed) && !shows {
            *self.markers.lock().unwrap_or_else(PoisonError::into_inner) = FrontierMarkers::default();
            let _ = self.frontiers.send(no_markers());
        }
    }

    /// Shows the path to the goal.
    pub fn show_path(&self, path: &Path, frame: &str) {
        let _ = self.path.send(convert::path_message(path, frame, self.node.now_s()));
    }

    /// Shows the region.
    pub fn show_region(&self, explorer: &Explorer, frame: &str) {
        let _ = self.region.send(region_message(explorer.region(), frame, self.node.now_s()));
    }

    /// Says that nothing was started so far.
    pub fn show_idle(&self) {
        let mut status = self.status.lock().unwrap_or_else(PoisonError::into_inner);
        status.phase = ExplorationStatus::IDLE;
        "not started: call ~start, or send a goal to the action ~explore".clone_into(&mut status.message);
    }

    /// The status as it was last told.
    pub fn status(&self) -> ExplorationStatus {
        self.teller.fresh().0
    }

    /// The same for another thread.
    pub fn teller(&self) -> impl Fn() -> ExplorationStatus + Send + Sync + 'static {
        let teller = Arc::clone(&self.teller);
        move || teller.fresh().0
    }

    /// All that is wrong now.
    pub fn troubles(&self) -> Vec<String> {
        self.teller.troubles.all()
    }

    /// Sets the status that is told once a second, and at once where its phase is another one.
    pub fn set_status(&self, new: ExplorationStatus) {
        let phase = new.phase;
        let old = std::mem::replace(&mut *self.status.lock().unwrap_or_else(PoisonError::into_inner), new);
        if old.phase != phase {
            self.tell_status();
        }
    }

    /// Tells the status at once.
    pub fn tell_status(&self) {
        self.teller.tell();
    }
}

/// Tells how the exploration is doing.
struct Teller {
    node: Node,
    status: Arc<Mutex<ExplorationStatus>>,
    now: Publisher<ExplorationStatus>,
    health: Publisher<DiagnosticArray>,
    maps: MapReader,
    paused: Arc<AtomicBool>,
    troubles: Troubles,
}

impl Teller {
    /// Tells the status with what is wrong now, and returns it.
    fn tell(&self) -> ExplorationStatus {
        let used = ProcessUse::now();
        match resources::complaint(&used) {
            Some(text) => self.troubles.report(Trouble::Resources, Level::Warn, text),
            None => _ = self.troubles.clear(Trouble::Resources),
        }
        let values = used.as_ref().map(resources::values).unwrap_or_default();
        let (fresh, worst) = self.fresh();
        let _ = self.health.send(diagnostics(self.node.name(), &fresh, worst, values));
        let _ = self.now.send(fresh.clone());
        fresh
    }

    /// The status with what is wrong now, and how grave that is.
    fn fresh(&self) -> (ExplorationStatus, Option<Level>) {
        let mut fresh = self.status.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let ended = fresh.phase == ExplorationStatus::ENDED;
        fresh.header.stamp = self.node.stamp();
        fresh.map_age_s = self.maps.newest().map_or(f64::NAN, |map| map.arrived.elapsed().as_secs_f64());
        // After the end nothing is waited for any more.
        let worst = self.troubles.worst().filter(|(level, _)| !ended || *level == Level::Error);
        if let Some((_, text)) = &worst {
            // What does not keep it from going on is said beside what it does.
            let is_said = |trouble| self.troubles.text(trouble).as_ref() == Some(text);
            let is_beside = ended || is_said(Trouble::CostmapUnknown) || is_said(Trouble::Resources);
            fresh.message = if is_beside { format!("{}; {text}", fresh.message) } else { text.clone() };
        }
        let is_under_way = !(ended || fresh.phase == ExplorationStatus::IDLE);
        if self.paused.load(Ordering::Relaxed) && is_under_way {
            fresh.phase = ExplorationStatus::PAUSED;
            "resting: call ~resume, or publish true on explore/resume, to go on".clone_into(&mut fresh.message);
        } else if let (Some(text), true) = (self.troubles.text(Trouble::Stranger), is_under_way) {
            (fresh.phase, fresh.message) = (ExplorationStatus::YIELDING, text);
        }
        (fresh, worst.map(|(level, _)| level))
    }
}

/// Tells the status once a second, also while the exploration waits or rests.
fn tell(teller: &Teller, saver: &MapSaver) {
    let node = &teller.node;
    let (mut next, mut next_line) = (Instant::now(), Instant::now() + LINE_PERIOD);
    while node.is_ok() {
        std::thread::sleep(Duration::from_millis(100));
        if Instant::now() < next {
            continue;
        }
        next = Instant::now() + STATUS_PERIOD;
        let status = teller.tell();
        if matches!(status.phase, ExplorationStatus::ENDED | ExplorationStatus::IDLE) {
            continue;
        }
        teller.troubles.repeat();
        if Instant::now() >= next_line {
            next_line = Instant::now() + LINE_PERIOD;
            saver.check_again();
            node.log().info(status_sentence(&status));
        }
    }
}
