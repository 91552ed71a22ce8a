//! Whether the robot moves, as its odometry says.

use crate::rig::{Heard, Process, eventually};
use frontier_explorer::ros::msg::nav_msgs::Odometry;
use std::time::{Duration, Instant};

/// Whether the newest odometry drives or turns.
fn moves(odometry: &Heard<Odometry>) -> bool {
    odometry.last().is_some_and(|m| m.twist.twist.linear.x.abs() > 0.1 || m.twist.twist.angular.z.abs() > 0.2)
}

pub fn expect_moving(odometry: &Heard<Odometry>, explore: &Process) {
    eventually(Duration::from_secs(60), || moves(odometry), || format!("it does not move:\n{}", explore.log()));
}

/// Standing after some time, and for one second from then on.
pub fn expect_standing(odometry: &Heard<Odometry>, after: Duration, explore: &Process, what: &str) {
    std::thread::sleep(after);
    let began = Instant::now();
    while began.elapsed() < Duration::from_secs(1) {
        assert!(!moves(odometry), "{what}: it moves:\n{}", explore.log());
        std::thread::sleep(Duration::from_millis(20));
    }
}
