//! The nodes at work, each test in a process of its own with a master of its own inside:
//! no ROS is needed.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

mod areas;
mod control_table;
mod controls;
mod ctl;
mod doctor;
mod exploring;
mod fake_publisher;
mod faults_driver;
mod faults_files;
mod faults_maps;
mod faults_network;
mod faults_poses;
mod faults_signals;
mod live_params;
mod motion;
mod peers;
mod relay;
mod rig;
mod senses;
mod session;
mod world;

use frontier_explorer::ros::start_embedded_master;
use libtest_mimic::{Arguments, Trial};
use rig::in_own_process;
use world::{DRIFTED, EXACT, KIND, SOON, World};

/// A test by its name.
type Test = (&'static str, fn(&World));

fn main() {
    if let Some((name, port)) = rig::own_test() {
        if name == peers::MASTER {
            return peers::serve_master(port);
        }
        let (_, test) = all().find(|(known, _)| *known == name).expect("a test of this program");
        let folder = tempfile::tempdir().unwrap();
        start_embedded_master(port).unwrap();
        test(&World::new(folder.path()));
        return;
    }
    let mut arguments = Arguments::from_args();
    // Each test drives a simulator faster than real time.
    arguments.test_threads.get_or_insert(2);
    let trials = all().map(|(name, _)| Trial::test(*name, move || in_own_process(name))).collect();
    libtest_mimic::run(&arguments, trials).exit();
}

fn all() -> impl Iterator<Item = &'static Test> {
    let own = exploring::TESTS
        .iter()
        .chain(areas::TESTS)
        .chain(control_table::TESTS)
        .chain(controls::TESTS)
        .chain(senses::TESTS)
        .chain(peers::TESTS);
    own.chain(session::TESTS)
        .chain(doctor::TESTS)
        .chain(ctl::TESTS)
        .chain(live_params::TESTS)
        .chain(faults_maps::TESTS)
        .chain(faults_driver::TESTS)
        .chain(faults_poses::TESTS)
        .chain(faults_files::TESTS)
        .chain(faults_network::TESTS)
        .chain(faults_signals::TESTS)
}
