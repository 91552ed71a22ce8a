//! Hours of exploring by one `explore_node`, while the simulated robot is started anew again and
//! again and its move_base, SLAM and transforms fail: what the node uses of the machine stays.
//!
//! A short one of some simulated minutes runs with all tests; `FRONTIER_SOAK_H=8 cargo test --test
//! soak` takes 8 simulated hours, about a quarter of an hour. What the node used in each round is
//! printed at the end.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

#[path = "../live/rig.rs"]
#[allow(dead_code)]
mod rig;

use frontier_explorer::ros::msg::frontier_explorer::ExplorationStatus;
use frontier_explorer::ros::msg::rosgraph_msgs::Clock;
use frontier_explorer::ros::msg::std_msgs::String as StringMessage;
use frontier_explorer::ros::msg::std_srvs::{Trigger, TriggerReq};
use frontier_explorer::ros::{Feed, Node, call, start_embedded_master};
use libtest_mimic::{Arguments, Failed, Trial};
use rig::{Process, eventually, in_own_process, small_house};
use rosrust::Publisher;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Simulated hours where nothing else is said.
const DEFAULT_H: f64 = 0.2;
/// Simulated seconds a real second that are asked for; a slow machine gives fewer.
const SPEED: f64 = 50.0;
/// After so many simulated seconds the robot, its SLAM and its move_base are started anew.
const ROUND_S: f64 = 240.0;
/// An exploration that has ended is followed by another one after this time, simulated seconds.
const REST_S: f64 = 20.0;
/// A fault begins so long after a round's begin, and lasts so long, simulated seconds.
const FAULT_S: (f64, f64) = (25.0, 20.0);
/// The faults, one a round.
const FAULTS: &[&str] = &["dead_move_base", "drop_tf", "abort_goals", "stop_map", "hang", "reject_goals"];
/// What the node uses is first looked at after this time, simulated seconds: by then all is in place.
const SETTLED_S: f64 = 1800.0;
/// What it may use more at the end: descriptors, threads, and memory as a share and in MB.
const MORE: (u64, u64, f64, f64) = (5, 5, 0.2, 5.0);
/// A publisher sees that a subscriber has died when it sends the next message, so that those of a
/// topic that is silent, as `cmd_vel` while move_base drives, stay until then: for each life of the
/// simulated robot so many.
const DEAD_A_ROUND: u64 = 2;
const SOON: Duration = Duration::from_secs(30);

fn hours() -> f64 {
    std::env::var("FRONTIER_SOAK_H").map_or(DEFAULT_H, |hours| hours.parse().expect("a number of hours"))
}

fn figures() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("soak.txt")
}

fn main() {
    if let Some((_, port)) = rig::own_test() {
        let folder = tempfile::tempdir().unwrap();
        start_embedded_master(port).unwrap();
        return Soak::begin(folder.path()).run(3600.0 * hours());
    }
    let soak = || -> Result<(), Failed> {
        let result = in_own_process("soak");
        eprintln!("{}", std::fs::read_to_string(figures()).unwrap_or_default());
        result
    };
    libtest_mimic::run(&Arguments::from_args(), vec![Trial::test("hours_of_exploring_leak_nothing", soak)]).exit();
}

/// The newest message of a topic alone: hours of them would fill the memory.
struct Newest<T> {
    message: Arc<Mutex<Option<T>>>,
    _feed: Feed,
}

impl<T: rosrust::Message> Newest<T> {
    fn on(node: &Node, topic: &str) -> Self {
        let message = Arc::<Mutex<Option<T>>>::default();
        let theirs = Arc::clone(&message);
        let feed = Feed::listen(node, topic, 5, Duration::from_secs(20), move |message: T, _| {
            *theirs.lock().unwrap() = Some(message);
        });
        Self { message, _feed: feed }
    }

    fn get(&self) -> Option<T> {
        self.message.lock().unwrap().clone()
    }
}

/// What a process uses of the machine.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Use {
    /// But for connections to processes that have died.
    descriptors: u64,
    dead: u64,
    threads: u64,
    memory_mb: f64,
}

impl Use {
    fn of(process: &Process) -> Self {
        let own = Path::new("/proc").join(process.id().to_string());
        let status = std::fs::read_to_string(own.join("status")).unwrap();
        let number = |name: &str| -> u64 {
            let rest = status.lines().find_map(|line| line.strip_prefix(name)).unwrap();
            rest.split_whitespace().next().unwrap().parse().unwrap()
        };
        let links =
            std::fs::read_dir(own.join("fd")).unwrap().filter_map(|fd| std::fs::read_link(fd.unwrap().path()).ok());
        let links: Vec<String> = links.map(|link| link.to_string_lossy().into_owned()).collect();
        let tables = ["net/tcp", "net/tcp6"].map(|table| std::fs::read_to_string(own.join(table)).unwrap_or_default());
        // The fourth column is the state, 8 where the other side has left, and the tenth the socket.
        let left = |line: &&str| line.split_whitespace().nth(3) == Some("08");
        let socket = |line: &str| format!("socket:[{}]", line.split_whitespace().nth(9).unwrap_or_default());
        let dead = tables.iter().flat_map(|table| table.lines()).filter(left).map(socket);
        let dead = dead.filter(|socket| links.contains(socket)).count() as u64;
        Self {
            descriptors: links.len() as u64 - dead,
            dead,
            threads: number("Threads:"),
            memory_mb: number("VmRSS:") as f64 / 1024.0,
        }
    }

    /// The least of some looks: connections come and go.
    fn at_rest(process: &Process) -> Self {
        let mut least = Self::of(process);
        for _ in 0..10 {
            std::thread::sleep(Duration::from_millis(50));
            let now = Self::of(process);
            least.descriptors = least.descriptors.min(now.descriptors);
            least.dead = least.dead.min(now.dead);
            least.threads = least.threads.min(now.threads);
            least.memory_mb = least.memory_mb.min(now.memory_mb);
        }
        least
    }

    /// What is too much more than so many rounds before.
    fn grown_since(&self, before: &Self, rounds: u64) -> Option<String> {
        let (descriptors, threads, share, mb) = MORE;
        let most_mb = (before.memory_mb * (1.0 + share)).max(before.memory_mb + mb);
        let is_flat = self.descriptors <= before.descriptors + descriptors
            && self.dead <= before.dead + DEAD_A_ROUND * rounds
            && self.threads <= before.threads + threads
            && self.memory_mb <= most_mb;
        (!is_flat).then(|| format!("{self:?} after {before:?}"))
    }
}

struct Soak {
    folder: PathBuf,
    house: PathBuf,
    probe: Node,
    clock: Newest<Clock>,
    status: Newest<ExplorationStatus>,
    faults: Publisher<StringMessage>,
    explore: Process,
    /// How explorations ended, and how often.
    ends: BTreeMap<String, usize>,
    rounds: usize,
}

impl Soak {
    fn begin(folder: &Path) -> Self {
        let probe = Node::start("probe").unwrap();
        probe.set_param("/use_sim_time", &true).unwrap();
        let (clock, status) = (Newest::on(&probe, "/clock"), Newest::on(&probe, "/explore/status"));
        let faults = probe.publish("/sim/fault", 5).unwrap();
        let args = [
            format!("_map_file:={}", folder.join("map").display()),
            format!("_session_file:={}", folder.join("session.json").display()),
            "_session_period:=1".to_owned(),
        ];
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let explore = Process::start(env!("CARGO_BIN_EXE_explore_node"), &args, folder.join("explore.log"));
        let (folder, house) = (folder.to_owned(), small_house(folder));
        Self { folder, house, probe, clock, status, faults, explore, ends: BTreeMap::new(), rounds: 0 }
    }

    fn run(mut self, wanted_s: f64) {
        let (began, mut total_s, mut before, mut table) = (Instant::now(), 0.0, None, String::new());
        let settled_s = SETTLED_S.min(wanted_s / 3.0);
        while total_s < wanted_s {
            total_s += self.round();
            let now = Use::at_rest(&self.explore);
            let wall_s = began.elapsed().as_secs_f64();
            writeln!(table, "{total_s:.0} s simulated, {wall_s:.0} s real: {now:?}").unwrap();
            let ends = &self.ends;
            std::fs::write(figures(), format!("{table}explorations ended: {ends:?}\n")).unwrap();
            match before {
                None if total_s >= settled_s => before = Some((now, self.rounds)),
                Some((before, rounds)) if total_s >= wanted_s => {
                    let grown = now.grown_since(&before, (self.rounds - rounds) as u64);
                    assert!(grown.is_none(), "{}\n{table}{}", grown.unwrap_or_default(), self.story());
                }
                _ => {}
            }
        }
        let complete = self.ends.get("complete").copied().unwrap_or(0);
        assert!(2 * complete >= self.rounds, "{complete} of {} rounds: {:?}", self.rounds, self.ends);
        self.explore.signal("TERM");
        self.explore.expect_code(0, SOON);
    }

    /// One life of the simulated robot; its simulated seconds.
    fn round(&mut self) -> f64 {
        let args = [
            format!("_world:={}", self.house.display()),
            "_start:=[2.0, 1.7]".to_owned(),
            format!("_speed:={SPEED}"),
            format!("_seed:={}", self.rounds),
        ];
        let args: Vec<&str> = args.iter().map(String::as_str).chain(["_slam:=perfect", "_driver:=navigator"]).collect();
        *self.clock.message.lock().unwrap() = None;
        let mut sim = Process::start(env!("CARGO_BIN_EXE_sim_node"), &args, self.folder.join("sim.log"));
        let fault = FAULTS[self.rounds % FAULTS.len()];
        self.rounds += 1;
        let clock = &self.clock;
        eventually(SOON, || clock.get().is_some(), || format!("no clock: {}", sim.log()));
        let began_s = self.now_s();
        let (mut asked_s, mut told, mut last) = (began_s - REST_S, "none", Instant::now());
        let mut was_at_s = began_s;
        while self.now_s() - began_s < ROUND_S {
            std::thread::sleep(Duration::from_millis(20));
            let now_s = self.now_s();
            if now_s > was_at_s {
                (was_at_s, last) = (now_s, Instant::now());
            }
            assert!(last.elapsed() < SOON, "time stands still: {}", self.story());
            assert!(self.explore.is_running(), "explore_node has ended: {}", self.story());
            let since_s = now_s - began_s - FAULT_S.0;
            let wanted = if (0.0..FAULT_S.1).contains(&since_s) { fault } else { "none" };
            if wanted != told {
                self.faults.send(StringMessage { data: wanted.to_owned() }).unwrap();
                told = wanted;
            }
            let status = self.status.get().filter(|status| status.phase == ExplorationStatus::ENDED);
            if let Some(status) = status.filter(|_| now_s - asked_s >= REST_S) {
                *self.ends.entry(status.end_reason).or_default() += 1;
                let _ = call::<Trigger>(&self.probe, "/explore/start", TriggerReq {}, SOON);
                asked_s = now_s;
            }
        }
        let passed_s = self.now_s() - began_s;
        // One of two SLAMs dies, and the others leave.
        sim.signal(if self.rounds.is_multiple_of(2) { "KILL" } else { "TERM" });
        sim.wait(SOON);
        passed_s
    }

    /// Simulated time, seconds.
    fn now_s(&self) -> f64 {
        self.clock.get().map_or(0.0, |message| message.clock.seconds())
    }

    /// The end of the log.
    fn story(&self) -> String {
        let log = self.explore.log();
        let lines: Vec<&str> = log.lines().rev().take(60).collect();
        format!("{:?}\n{}", self.ends, lines.into_iter().rev().collect::<Vec<_>>().join("\n"))
    }
}
