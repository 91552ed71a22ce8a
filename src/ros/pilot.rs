//! Driving by ourselves: a thread that turns commands into `cmd_vel`, with the
//! navigator that drives in the simulator too. Turns on the spot always go this way
//! unless move_base makes them; goals only where there is no move_base.

use super::clock_watch::ClockWatch;
use super::convert;
use super::log::Level;
use super::msg::geometry_msgs::Twist as TwistMessage;
use super::node::{Node, NodeError};
use super::scan_feed::ScanFeed;
use super::transforms::Transforms;
use super::troubles::{Trouble, Troubles};
use super::tuning::Tuning;
use crate::control::StopGuard;
use crate::geometry::{Areas, Body, Path, Point, Pose, Twist};
use crate::grid::Costmap;
use crate::navigation::{NavigationInput, Navigator};
use crate::robot::{Command, Navigation, NavigationState};
use crate::scan::LaserScan;
use rosrust::Publisher;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

/// A robot whose clock stands for this long does not know what happens: it stands still.
const CLOCK_LIMIT: Duration = Duration::from_millis(500);
/// From one look at the time to the next.
const SLICE: Duration = Duration::from_millis(10);
/// A lidar may begin after the node, seconds of real time.
const SCANS_WITHIN_S: f64 = 3.0;
/// How often standing still is said when a motion ends: a message may get lost.
const LAST_ZEROS: u8 = 3;

/// What the pilot needs to know.
pub struct PilotConfig {
    /// The robot's frame.
    pub base_frame: String,
    /// What may change while it drives.
    pub tuning: Tuning,
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
        troubles: &Troubles,
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
        let drive_loop = DriveLoop {
            node: node.clone(),
            config,
            guard,
            transforms,
            scans,
            troubles: troubles.clone(),
            commands,
            last: Twist::ZERO,
            zeros_sent: LAST_ZEROS,
        };
        let (theirs, stopped) = (Arc::clone(&shared), Arc::clone(&stop));
        let thread = std::thread::spawn(move || drive_loop.run(&theirs, &stopped));
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

    /// Drives within these areas from now on.
    pub fn set_areas(&self, areas: Areas) {
        lock(&self.shared).navigator.set_areas(areas);
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
struct DriveLoop {
    node: Node,
    config: PilotConfig,
    guard: StopGuard,
    transforms: Arc<Transforms>,
    scans: Option<Arc<ScanFeed>>,
    troubles: Troubles,
    commands: Publisher<TwistMessage>,
    last: Twist,
    /// How often standing still has been said.
    zeros_sent: u8,
}

impl DriveLoop {
    fn run(mut self, shared: &Mutex<Shared>, stop: &AtomicBool) {
        let mut next_s = f64::NEG_INFINITY;
        let mut clock = ClockWatch::new();
        while !stop.load(Ordering::Relaxed) && self.node.is_ok() {
            let now_s = self.node.now_s();
            // Time that has jumped back begins anew.
            if clock.stands_for(now_s) >= CLOCK_LIMIT {
                // No tick would come that could stop the robot.
                self.stand_still();
            } else if now_s >= next_s || now_s < next_s - 2.0 * self.config.control_period_s {
                next_s = now_s + self.config.control_period_s;
                self.tick(shared, now_s);
            }
            std::thread::sleep(SLICE);
        }
        for _ in 0..LAST_ZEROS {
            let _ = self.commands.send(TwistMessage::default());
        }
    }

    fn tick(&mut self, shared: &Mutex<Shared>, now_s: f64) {
        let mut shared = lock(shared);
        let scan = self.look(&shared.map_frame, now_s);
        if shared.navigation.state != NavigationState::Active {
            drop(shared);
            self.stand_still();
            return;
        }
        let base = &self.config.base_frame;
        let tolerance_s = self.config.tuning.now().transform_tolerance_s;
        let pose = self.transforms.robot(&shared.map_frame, base, now_s, tolerance_s);
        let (Ok(pose_in_map), Some((costmap, costmap_stamp_s))) = (pose, shared.costmap.clone()) else {
            drop(shared);
            self.stand_still();
            return;
        };
        if self.config.drives_to_goals && scan.is_none() {
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
        self.zeros_sent = 0;
        let _ = self.commands.send(convert::twist_message(&twist));
    }

    /// The scan that tells what is ahead. Where goals come this way and there is none, the
    /// robot stands still, and it is said why.
    fn look(&self, map_frame: &str, now_s: f64) -> Option<(Pose, LaserScan)> {
        let scans = self.scans.as_ref()?;
        if map_frame.is_empty() {
            return None;
        }
        match scans.fresh_in(map_frame, &self.transforms, now_s) {
            Ok(scan) => {
                self.troubles.clear(Trouble::Scan);
                Some(scan)
            }
            Err(why) => {
                let may_be_told = scans.has_begun() || self.node.wall_s() > SCANS_WITHIN_S;
                if self.config.drives_to_goals && may_be_told {
                    self.troubles.report(Trouble::Scan, Level::Warn, format_args!("{why}; standing still"));
                }
                None
            }
        }
    }

    /// Says zero a few times, then leaves `cmd_vel` to others.
    fn stand_still(&mut self) {
        self.last = Twist::ZERO;
        if self.zeros_sent < LAST_ZEROS {
            self.zeros_sent += 1;
            let _ = self.commands.send(TwistMessage::default());
        }
    }
}

fn lock(shared: &Mutex<Shared>) -> MutexGuard<'_, Shared> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}
