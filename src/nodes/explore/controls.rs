//! What users may do while the node runs: rest and go on, save the map, stop.

use super::areas::AreaInputs;
use super::connect::Connected;
use super::saving::save_as;
use super::settings::{ExploreNodeError, Settings};
use crate::planning::GlobalPlanner;
use crate::ros::move_base::AskingPlanner;
use crate::ros::msg::std_msgs::Bool;
use crate::ros::msg::std_srvs::{Trigger, TriggerRes};
use crate::ros::{Feed, Node, Service};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// Points and commands come seldom: so often it is looked whether all who tell them are met.
const LOOK: Duration = Duration::from_secs(60);

/// What a user asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Request {
    /// Explore other areas.
    Areas,
    /// Explore again.
    Resume,
}

/// The topics and services that take requests.
pub struct Controls {
    requests: Arc<Mutex<Vec<Request>>>,
    stop: Arc<AtomicBool>,
    map_frame: Arc<Mutex<String>>,
    _feeds: Vec<Feed>,
    _services: [Service; 2],
}

impl Controls {
    /// Begins to take requests: `explore/resume` (explore_lite), and the services `~save_map` and
    /// `~stop`.
    ///
    /// # Errors
    /// [`ExploreNodeError`] when a service cannot be offered.
    pub fn listen(node: &Node, settings: &Settings, connected: &Connected) -> Result<Self, ExploreNodeError> {
        let requests = Arc::<Mutex<Vec<Request>>>::default();
        let stop = Arc::new(AtomicBool::new(false));
        let feeds = vec![listen_to_resume(node, &requests, connected)];
        let (maps, map_file, log) = (connected.maps.clone(), settings.params.map_file.clone(), node.log().clone());
        let path = if map_file.is_empty() { "map".to_owned() } else { map_file };
        let save = node.serve::<Trigger>("~save_map", move |_| {
            let saved = match maps.newest() {
                Some(map) => save_as(&path, &map).map(|p| p.yaml.display().to_string()).map_err(|e| e.to_string()),
                None => Err("no map has come yet".to_owned()),
            };
            let (success, message) = match saved {
                Ok(file) => (true, file),
                Err(why) => (false, why),
            };
            log.info(format_args!("~save_map: {message}"));
            Ok(TriggerRes { success, message })
        })?;
        let (stopped, paused) = (Arc::clone(&stop), Arc::clone(&connected.paused));
        let stop_service = node.serve::<Trigger>("~stop", move |_| {
            stopped.store(true, Ordering::Relaxed);
            paused.store(false, Ordering::Relaxed);
            Ok(TriggerRes { success: true, message: "the exploration ends".to_owned() })
        })?;
        let map_frame = Arc::clone(&connected.map_frame);
        Ok(Self { requests, stop, map_frame, _feeds: feeds, _services: [save, stop_service] })
    }

    /// Whether the user wants the run to end; asked once for each time.
    pub fn stop_requested(&self) -> bool {
        self.stop.swap(false, Ordering::Relaxed)
    }

    /// Waits until another run is asked for; `None` when the node is told to stop.
    pub fn wait_for_another_run(&self, node: &Node, areas: &AreaInputs) -> Option<Request> {
        node.log().info("ready to explore again: publish true on explore/resume, or draw a region");
        let forever = Duration::MAX;
        let mut request = None;
        node.wait_until(forever, || {
            request = self.requests.lock().unwrap_or_else(PoisonError::into_inner).pop();
            request = request.take().or_else(|| areas.has_new().then_some(Request::Areas));
            request.is_some()
        });
        request
    }

    /// The planner that asks move_base, where the settings want it.
    pub fn asking_planner(&self, node: &Node, settings: &Settings) -> Option<Box<dyn GlobalPlanner>> {
        let Settings { params, preset, robot } = settings;
        let wanted = params.check_with_make_plan && preset.navigation.drive == crate::config::Drive::MoveBase;
        wanted.then(|| {
            let own = preset.explorer.planner.build(&robot.body());
            Box::new(AskingPlanner::new(node, &params.move_base, Arc::clone(&self.map_frame), own)) as Box<_>
        })
    }
}

fn push(requests: &Mutex<Vec<Request>>, request: Request) {
    requests.lock().unwrap_or_else(PoisonError::into_inner).push(request);
}

fn listen_to_resume(node: &Node, requests: &Arc<Mutex<Vec<Request>>>, connected: &Connected) -> Feed {
    let (requests, paused, bell) = (Arc::clone(requests), Arc::clone(&connected.paused), Arc::clone(&connected.bell));
    let log = node.log().clone();
    Feed::listen_seldom(node, "explore/resume", 5, LOOK, move |message: Bool, _| {
        let was_paused = paused.swap(!message.data, Ordering::Relaxed);
        match (was_paused, message.data) {
            (true, true) => log.info("going on"),
            (false, false) => log.info("resting: publish true on explore/resume to go on"),
            (false, true) => push(&requests, Request::Resume),
            (true, false) => {}
        }
        bell.ring();
    })
}
