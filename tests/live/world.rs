//! A small house on disk, the programs that are started in it, and what is expected at the end.

use crate::rig::{Process, small_house};
use frontier_explorer::geometry::{Footprint, Pose};
use frontier_explorer::io::load_map;
use frontier_explorer::ros::Node;
use frontier_explorer::sim::{self, TargetArea};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Simulated seconds a real second.
const SPEED: f64 = 8.0;
/// The kind stand-ins of `sim_node`.
pub const KIND: &[&str] = &["_slam:=perfect", "_driver:=navigator"];
pub const SOON: Duration = Duration::from_secs(20);

/// What a saved map shows by a SLAM that never errs, percent.
pub const EXACT: f64 = 99.0;
/// And by one whose errors move the rim of all that it has seen.
pub const DRIFTED: f64 = 97.0;

/// A house, a folder, and a probe on the master.
pub struct World {
    pub folder: PathBuf,
    pub house: PathBuf,
    pub probe: Node,
}

impl World {
    pub fn new(folder: &Path) -> Self {
        let probe = Node::start("probe").unwrap();
        probe.set_param("/use_sim_time", &true).unwrap();
        Self { folder: folder.to_owned(), house: small_house(folder), probe }
    }

    pub fn simulate(&self, more: &[&str]) -> Process {
        let world = format!("_world:={}", self.house.display());
        let speed = format!("_speed:={SPEED}");
        let mut args = vec![world.as_str(), "_start:=[2.0, 1.7]"];
        if !more.iter().any(|argument| argument.starts_with("_speed:=")) {
            args.push(&speed);
        }
        args.extend(more);
        Process::start(env!("CARGO_BIN_EXE_sim_node"), &args, self.folder.join("sim.log"))
    }

    /// With a SLAM that never errs and our own navigator behind move_base's topics: for tests
    /// that count goals and failures, or wait for an end, which a SLAM that is silent at rest
    /// may put off.
    pub fn simulate_kindly(&self, more: &[&str]) -> Process {
        self.simulate(&[KIND, more].concat())
    }

    pub fn explore(&self, more: &[&str]) -> Process {
        let map_file = format!("_map_file:={}", self.map().display());
        let mut args = vec![map_file.as_str(), "_exit_when_done:=true"];
        // A preset that looks round everywhere: the house is not done before anybody sees it.
        if !more.iter().any(|argument| argument.starts_with("_config:=")) {
            args.push("_config:=wfd");
        }
        args.extend(more);
        Process::start(env!("CARGO_BIN_EXE_explore_node"), &args, self.folder.join("explore.log"))
    }

    pub fn map(&self) -> PathBuf {
        self.folder.join("map")
    }

    /// The robot has seen at least 99 % of what it can get to, as the simulator says that is
    /// ended here, and the saved map shows as much of it as is asked for, percent.
    pub fn expect_explored(&self, sim: &mut Process, in_map: f64) {
        sim.signal("TERM");
        sim.expect_code(0, SOON);
        let log = sim.log();
        let (before, _) = log.split_once(" % of the reachable area").expect("what was seen");
        let seen: f64 = before.rsplit(' ').next().and_then(|share| share.parse().ok()).expect("a share");
        let saved = load_map(&self.map().with_extension("yaml")).unwrap().grid;
        let truth = load_map(&self.house).unwrap().grid;
        let house = sim::World::new(&truth, &Default::default()).unwrap();
        let target = TargetArea::new(&house, &Footprint::RadiusM(0.18), &Pose::new(2.0, 1.7, 0.0)).unwrap();
        let saved = 100.0 * target.coverage_of(&saved);
        assert!(seen >= 99.0 && saved >= in_map, "{seen} % of the floor seen, {saved} % in the saved map");
    }
}
