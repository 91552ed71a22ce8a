//! Driving by ourselves: a thread that turns commands into `cmd_vel`, with the
//! navigator that drives in the simulator too. Turns on the spot always go this way
//! unless move_base makes them; goals only where there is no move_base.

use super::convert;
use super::log::Level;
use super::msg::geometry_msgs::Twist as TwistMessage;
use super::node::{Node, NodeError};
use super::scan_feed::ScanFeed;
use super::transforms::Transforms;
use crate::control::StopGuard;
use crate::geometry::{Body, Path, Point, Pose, Twist};
use crate::grid::Costmap;
use crate::navigation::{NavigationInput, Navigator};
use crate::robot::{Command, Navigation, NavigationState};
use crate::scan::LaserScan;
use rosrust::Publisher;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// A scan older than this no longer tells what is ahead, seconds.
const SCAN_LIMIT_S: f64 = 1.0;
/// From one look at the time to the next.
const SLICE: Duration = Duration::from_millis(10);
/// How often standing still is said when a motion ends: a message may get lost.
const FAREWELLS: u8 = 3;

/// What the pilot needs to know.
pub struct PilotConfig {
    /// The robot's frame.
    pub base_frame: String,
    /// How old its transform may be, seconds.
    pub transform_tolerance_s: f64,
    /// Seconds between commands.
    pub control_period_s: f64,
    /// The robot's body, for the last look at the scan.
    pub body: Body,
    /// Whether goals come this way, so that no motion without a scan is safe.
    pub drives_to_goals: bool,
}

/// What the thread and its owner share.
struct Shared {
    navigator: Navigator,
    navigation: Navigation,
    map_frame: String,
    costmap: Option<(Arc<Costmap>, f64)>,
}

/// The control thread; dropping it stops the robot.
pub struct Pilot {
    shared: Arc<Mutex<Shared>>,
    stop: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Pilot {
    /// Starts the thread. `cmd_vel` is offered in the node's namespace.
    ///
    /// # Errors
    /// [`NodeError`] when the topic cannot be offered.
    pub fn start(
        node: &Node,
        config: PilotConfig,
        navigator: Navigator,
        transforms: Arc<Transforms>,
        scans: Option<Arc<ScanFeed>>,
    ) -> Result<Self, NodeError> {
        let commands = node.publish("cmd_vel", 1)?;
        let shared = Arc::new(Mutex::new(Shared {
            navigator,
            navigation: Navigation { command: 0, state: NavigationState::Idle },
            map_frame: String::new(),
            costmap: None,
        }));
        let stop = Arc::new(AtomicBool::new(false));
        let guard = StopGuard::new(&config.body);
        let wheel = Wheel {
            node: node.clone(),
            config,
            guard,
            transforms,
            scans,
            commands,
            last: Twist::ZERO,
            farewells: FAREWELLS,
        };
        let (theirs, stopped) = (Arc::clone(&shared), Arc::clone(&stop));
        let thread = std::thread::spawn(move || wheel.turn(&theirs, &stopped));
        Ok(Self { shared, stop, thread: Some(thread) })
    }

    /// Takes a command; the id of the one under way changes nothing.
    pub fn command(&self, command: &Command) {
        let mut shared = lock(&self.shared);
        shared.navigator.command(command);
        let (id, state) = match *command {
            Command::Hold => (0, NavigationState::Idle),
            Command::Drive { id, .. } | Command::Turn { id, .. } | Command::BackOff { id } => {
                (id, NavigationState::Active)
            }
        };
        if shared.navigation.command != id {
            shared.navigation = Navigation { command: id, state };
        }
    }

    /// How the command is doing.
    pub fn navigation(&self) -> Navigation {
        lock(&self.shared).navigation.clone()
    }

    /// The path that is followed, if any.
    pub fn path(&self) -> Option<Path> {
        lock(&self.shared).navigator.path().cloned()
    }

    /// The newest map's costs, and when they were true, seconds.
    pub fn set_costmap(&self, frame: &str, costmap: Arc<Costmap>, stamp_s: f64) {
        let mut shared = lock(&self.shared);
        frame.clone_into(&mut shared.map_frame);
        shared.costmap = Some((costmap, stamp_s));
    }
}

impl Drop for Pilot {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has said so.
            let _ = thread.join();
        }
    }
}

/// The thread's own part.
struct Wheel {
    node: Node,
    config: PilotConfig,
    guard: StopGuard,
    transforms: Arc<Transforms>,
    scans: Option<Arc<ScanFeed>>,
    commands: Publisher<TwistMessage>,
    last: Twist,
    /// How often standing still has been said.
    farewells: u8,
}

impl Wheel {
    fn turn(mut self, shared: &Mutex<Shared>, stop: &AtomicBool) {
        let mut next_s = f64::NEG_INFINITY;
        while !stop.load(Ordering::Relaxed) && self.node.is_ok() {
            let now_s = self.node.now_s();
            // Time that has jumped back begins anew.
            if now_s >= next_s || now_s < next_s - 2.0 * self.config.control_period_s {
                next_s = now_s + self.config.control_period_s;
                self.tick(shared, now_s);
            }
            std::thread::sleep(SLICE);
        }
        for _ in 0..FAREWELLS {
            let _ = self.commands.send(TwistMessage::default());
        }
    }

    fn tick(&mut self, shared: &Mutex<Shared>, now_s: f64) {
        let mut shared = lock(shared);
        if shared.navigation.state != NavigationState::Active {
            drop(shared);
            self.stand_still();
            return;
        }
        let base = &self.config.base_frame;
        let pose = self.transforms.robot(&shared.map_frame, base, now_s, self.config.transform_tolerance_s);
        let (Ok(pose_in_map), Some((costmap, costmap_stamp_s))) = (pose, shared.costmap.clone()) else {
            drop(shared);
            self.stand_still();
            return;
        };
        let scan = self.scan(&shared.map_frame, now_s);
        if self.config.drives_to_goals && scan.is_none() {
            self.node.log().once(Level::Warn, "no scan of the last second tells what is ahead: standing still");
            drop(shared);
            self.stand_still();
            return;
        }
        let input = NavigationInput {
            stamp_s: now_s,
            pose_in_map,
            twist: self.last,
            costmap: &costmap,
            costmap_stamp_s,
            scan: scan.as_ref().map(|(pose, scan)| (pose, scan)),
        };
        let (wanted, navigation) = shared.navigator.update(&input);
        shared.navigation = navigation;
        drop(shared);
        let twist = match &scan {
            Some((lidar_in_map, scan)) => {
                let map_in_base = pose_in_map.inverse();
                let hits: Vec<Point> = scan.hits(lidar_in_map).map(|hit| map_in_base.transform(hit)).collect();
                self.guard.check(wanted, &hits, self.config.control_period_s)
            }
            None => wanted,
        };
        self.last = twist;
        self.farewells = 0;
        let _ = self.commands.send(convert::twist_message(&twist));
    }

    fn scan(&self, map_frame: &str, now_s: f64) -> Option<(Pose, LaserScan)> {
        let (pose, scan) = self.scans.as_ref()?.newest_in(map_frame, &self.transforms)?;
        (now_s - scan.stamp_s <= SCAN_LIMIT_S).then_some((pose, scan))
    }

    /// Says zero a few times, then leaves `cmd_vel` to others.
    fn stand_still(&mut self) {
        self.last = Twist::ZERO;
        if self.farewells < FAREWELLS {
            self.farewells += 1;
            let _ = self.commands.send(TwistMessage::default());
        }
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
