//! A node of a name of its own, for a command that asks a running system something.

use anyhow::{anyhow, bail};
use frontier_explorer::ros::{Node, NodeError, stop};
use std::sync::mpsc;
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// So long is waited for a master.
const MASTER_PATIENCE: Duration = Duration::from_secs(2);
/// A node that has not begun by then hangs: the master, or who publishes `/clock`.
const BEGIN_WITHIN: Duration = Duration::from_secs(12);
/// A node may take so long to say good-bye.
const END_WITHIN: Duration = Duration::from_secs(3);

/// Lets work be done by a node whose name begins with `name`, and says good-bye to the master.
///
/// # Errors
/// When there is no master, and what the work says.
pub fn with<T>(name: &str, work: impl FnOnce(&Node) -> anyhow::Result<T>) -> anyhow::Result<T> {
    stop::listen().map_err(|why| anyhow!(why))?;
    let since_epoch = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let name = format!("{name}_{}_{}", std::process::id(), since_epoch.as_nanos());
    let node = within(BEGIN_WITHIN, move || Node::start_within(&name, Some(MASTER_PATIENCE)));
    let node = match node {
        Ok(Ok(node)) => node,
        Ok(Err(NodeError::Master(error))) => {
            bail!("{error}; start `roscore` there, or set ROS_MASTER_URI to where it runs")
        }
        Ok(Err(error)) => return Err(error.into()),
        Err(late) => bail!("the ROS master, or what publishes /clock, does not answer: {late}"),
    };
    let result = work(&node);
    // A master that hangs now keeps nobody waiting, and the result is known.
    let _ = within(END_WITHIN, move || node.finish());
    result
}

/// Does work on a thread of its own, which is left alone when it takes longer than `limit`.
///
/// # Errors
/// When it takes longer.
pub fn within<T: Send + 'static>(limit: Duration, work: impl FnOnce() -> T + Send + 'static) -> anyhow::Result<T> {
    let (sender, receiver) = mpsc::channel();
    std::thread::spawn(move || {
        // Nobody waits for what comes too late.
        let _ = sender.send(work());
    });
    receiver.recv_timeout(limit).map_err(|_| anyhow!("nothing has come for {} s", limit.as_secs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_hangs_is_left_alone() {
        assert_eq!(within(Duration::from_secs(5), || 7).unwrap(), 7);
        let late = within(Duration::from_millis(20), || std::thread::sleep(Duration::from_secs(5)));
        assert!(late.is_err());
    }
}
