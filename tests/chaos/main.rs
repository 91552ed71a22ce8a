//! Explorations among faults that come and go as a seed says: each ends as it should.
//!
//! A handful of seeds run with all tests; `FRONTIER_CHAOS_SEEDS=200 cargo test --test chaos` runs
//! the seeds from 0 to 199 as well.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

mod plan;
#[path = "../live/rig.rs"]
#[allow(dead_code)]
mod rig;

use frontier_explorer::geometry::{Footprint, Pose};
use frontier_explorer::io::load_map;
use frontier_explorer::ros::msg::rosgraph_msgs::Clock;
use frontier_explorer::ros::msg::std_msgs::String as StringMessage;
use frontier_explorer::ros::msg::std_srvs::{Trigger, TriggerReq};
use frontier_explorer::ros::{Node, call, start_embedded_master};
use frontier_explorer::sim::{TargetArea, World};
use libtest_mimic::{Arguments, Trial};
use plan::{Action, Plan};
use rig::{Heard, Process, in_own_process, write_house};
use rosrust::Publisher;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Seeds that run always.
const SEEDS: &[u64] = &[0, 1, 2, 22, 98];
/// Simulated seconds a real second.
const SPEED: f64 = 8.0;
/// An exploration that takes longer has failed.
const LIMIT: Duration = Duration::from_secs(180);
const SOON: Duration = Duration::from_secs(20);
/// Where the robot begins.
const START: (f64, f64) = (2.0, 1.7);
/// All that the robot can get to must have been seen, percent, and shown in the saved map, in which
/// the errors of SLAM move the rim.
const SEEN: f64 = 99.0;
const IN_MAP: f64 = 97.0;

fn main() {
    if let Some((name, port)) = rig::own_test() {
        let seed = name.strip_prefix("seed_").and_then(|seed| seed.parse().ok()).expect("seed_ and a number");
        let folder = tempfile::tempdir().unwrap();
        start_embedded_master(port).unwrap();
        return Run::begin(folder.path(), seed).explore_among_faults();
    }
    let more = std::env::var("FRONTIER_CHAOS_SEEDS").map_or(0, |count| count.parse().expect("a number of seeds"));
    let seeds = SEEDS.iter().copied().chain((0..more).filter(|seed| !SEEDS.contains(seed)));
    let mut arguments = Arguments::from_args();
    arguments.test_threads.get_or_insert(2);
    let trial = |seed| Trial::test(format!("seed_{seed}"), move || in_own_process(&format!("seed_{seed}")));
    libtest_mimic::run(&arguments, seeds.map(trial).collect()).exit();
}

/// One exploration and what goes wrong with it.
struct Run {
    folder: PathBuf,
    house: PathBuf,
    probe: Node,
    clock: Heard<Clock>,
    faults: Publisher<StringMessage>,
    plan: Plan,
    sim: Process,
    explore: Process,
    /// How often the explorer was started.
    starts: usize,
    /// It was to go on when nobody was there to be asked.
    resume_is_owed: bool,
    /// What was done so far, for whoever reads of a failure.
    done: Vec<String>,
}

impl Run {
    fn begin(folder: &Path, seed: u64) -> Self {
        let plan = Plan::drawn(seed);
        let probe = Node::start("probe").unwrap();
        probe.set_param("/use_sim_time", &true).unwrap();
        let house = house(folder);
        let clock = Heard::on(&probe, "/clock");
        let faults = probe.publish_latched("/sim/fault").unwrap();
        let args = [
            format!("_world:={}", house.display()),
            format!("_start:=[{}, {}]", START.0, START.1),
            format!("_speed:={SPEED}"),
            format!("_seed:={seed}"),
        ];
        let args: Vec<&str> = args.iter().map(String::as_str).collect();
        let sim = Process::start(env!("CARGO_BIN_EXE_sim_node"), &args, folder.join("sim.log"));
        let explore = explore(folder, 0);
        let folder = folder.to_owned();
        Self {
            folder,
            house,
            probe,
            clock,
            faults,
            plan,
            sim,
            explore,
            starts: 1,
            resume_is_owed: false,
            done: Vec::new(),
        }
    }

    /// Does what the plan says until the explorer has ended, and looks whether that was right.
    fn explore_among_faults(mut self) {
        self.explore.expect_log("preset", SOON);
        let (began, began_s) = (Instant::now(), self.now_s());
        for (at_s, action) in self.plan.actions.clone() {
            while self.now_s() - began_s < at_s && self.has_begun_and_not_ended() {
                std::thread::sleep(Duration::from_millis(10));
                assert!(began.elapsed() < LIMIT, "time stands still: {}", self.story());
            }
            self.act(action);
            self.done.push(format!("{:.1} s: {action:?}", self.now_s() - began_s));
            if !self.has_begun_and_not_ended() {
                break;
            }
        }
        while self.explore.try_wait().is_none() {
            assert!(began.elapsed() < LIMIT, "no end after {LIMIT:?}: {}", self.story());
            std::thread::sleep(Duration::from_millis(20));
        }
        let end = self.explore.wait(SOON).code();
        let log = self.explore.log();
        if end == Some(0) && log.contains("complete: ") {
            return self.expect_explored();
        }
        let is_right = self.plan.ends.iter().any(|name| log.contains(&format!("{name}: ")));
        assert!(end == Some(3) && is_right, "exit code {end:?}: {}", self.story());
    }

    /// Simulated time, seconds.
    fn now_s(&self) -> f64 {
        self.clock.last().map_or(0.0, |message| message.clock.seconds())
    }

    /// Whether there is still something that may go wrong: a killed explorer has not ended.
    fn has_begun_and_not_ended(&mut self) -> bool {
        self.explore.try_wait().is_none() || self.is_killed()
    }

    fn is_killed(&mut self) -> bool {
        use std::os::unix::process::ExitStatusExt as _;
        self.explore.try_wait().is_some() && self.explore.wait(SOON).signal().is_some()
    }

    fn act(&mut self, action: Action) {
        match action {
            Action::Fault(name) => self.faults.send(StringMessage { data: name.to_owned() }).unwrap(),
            Action::Kill if self.explore.try_wait().is_none() => {
                self.explore.signal("KILL");
                self.explore.wait(SOON);
            }
            Action::Restart if self.is_killed() => {
                self.explore = explore(&self.folder, self.starts);
                self.starts += 1;
                if std::mem::take(&mut self.resume_is_owed) {
                    // A session that was paused stays paused.
                    self.explore.expect_log("preset", SOON);
                    self.ask("resume");
                }
            }
            Action::Pause => self.ask("pause"),
            Action::Resume if self.is_killed() => self.resume_is_owed = true,
            Action::Resume => self.ask("resume"),
            Action::Kill | Action::Restart => {}
        }
    }

    /// Calls a control; whoever has ended meanwhile need not answer.
    fn ask(&mut self, control: &str) {
        let answer = call::<Trigger>(&self.probe, &format!("/explore/{control}"), TriggerReq {}, SOON);
        let is_done = answer.as_ref().is_ok_and(|answer| answer.success);
        if !is_done {
            // At its end it may wait for a slow disk.
            let asked = Instant::now();
            while !(self.explore.try_wait().is_some() || self.explore.log().contains("saved ")) {
                assert!(asked.elapsed() < SOON, "{control}: {answer:?}: {}", self.story());
                std::thread::sleep(Duration::from_millis(50));
            }
        }
    }

    fn expect_explored(mut self) {
        self.sim.signal("TERM");
        self.sim.expect_code(0, SOON);
        let log = self.sim.log();
        let (before, _) = log.split_once(" % of the reachable area").expect("what was seen");
        let seen: f64 = before.rsplit(' ').next().and_then(|share| share.parse().ok()).expect("a share");
        let saved = load_map(&self.folder.join("map.yaml")).unwrap().grid;
        let truth = load_map(&self.house).unwrap().grid;
        let world = World::new(&truth, &Default::default()).unwrap();
        let start = Pose::new(START.0, START.1, 0.0);
        let target = TargetArea::new(&world, &Footprint::RadiusM(0.18), &start).unwrap();
        let saved = 100.0 * target.coverage_of(&saved);
        assert!(seen >= SEEN && saved >= IN_MAP, "{seen} % seen, {saved} % in the map: {}", self.story());
        assert!(log.contains(" 0 collisions"), "{}", self.story());
    }

    /// All that is known of the run.
    fn story(&self) -> String {
        let logs = (0..self.starts).map(|start| std::fs::read_to_string(explore_log(&self.folder, start)));
        let logs: Vec<String> = logs.map(Result::unwrap_or_default).collect();
        let (done, sim, plan) = (self.done.join("\n"), self.sim.log(), &self.plan);
        format!("\n{plan:?}\n-- done\n{done}\n-- sim_node\n{sim}-- explore_node\n{}", logs.join("-- killed\n"))
    }
}

fn explore_log(folder: &Path, start: usize) -> PathBuf {
    folder.join(format!("explore-{start}.log"))
}

/// An explorer that keeps its session, and goes on with the one that is there.
fn explore(folder: &Path, start: usize) -> Process {
    let session = folder.join("session.json").display().to_string();
    let args = [
        format!("_map_file:={}", folder.join("map").display()),
        format!("_session_file:={session}"),
        format!("_resume_from:={session}"),
        "_session_period:=0.5".to_owned(),
        "_exit_when_done:=true".to_owned(),
    ];
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    Process::start(env!("CARGO_BIN_EXE_explore_node"), &args, explore_log(folder, start))
}

/// Four rooms of about 4 x 3 m, two and two on the sides of a corridor, as a map_server map.
fn house(folder: &Path) -> PathBuf {
    const WIDTH: usize = 180;
    const HEIGHT: usize = 170;
    let is_wall = |x: usize, y: usize| {
        let outer = x < 4 || y < 4 || x >= WIDTH - 4 || y >= HEIGHT - 4;
        let is_door = (40..60).contains(&x) || (125..145).contains(&x);
        let along = ((66..70).contains(&y) || (100..104).contains(&y)) && !is_door;
        let between = (88..92).contains(&x) && !(66..104).contains(&y);
        outer || along || between
    };
    write_house(folder, (WIDTH, HEIGHT), is_wall)
}
