//! A node as a program: from signals to the exit code.

use super::log::Log;
use super::node::{Node, NodeError};
use super::stop;
use std::fmt::Display;

/// Prints a node's help where its command line asks for it, and whether it did.
pub(crate) fn has_helped(text: impl FnOnce() -> String) -> bool {
    let asks = std::env::args().skip(1).any(|argument| argument == "--help" || argument == "-h");
    if asks {
        // A reader that has gone is no error.
        let _ = std::io::Write::write_all(&mut std::io::stdout(), text().as_bytes());
    }
    asks
}

/// Starts a node, lets it work, and says good-bye. Returns the exit code: what the work
/// returns, or 1 with a line on what failed. Told to stop, the process ends within two
/// seconds; what must not be lost then is for the work to say (`stop::set_will`).
pub(crate) fn run_program<E: Display>(name: &str, work: impl FnOnce(&Node) -> Result<u8, E>) -> u8 {
    let failed = |why: &dyn Display| {
        Log::new(name).error(why);
        1
    };
    if let Err(why) = stop::listen() {
        return failed(&why);
    }
    // Told to stop before it has anything to lose, it leaves as if all were done.
    stop::settle(0);
    let node = match Node::start(name) {
        Ok(node) => node,
        Err(NodeError::Stopped) => return 0,
        Err(error) => return failed(&error),
    };
    let code = work(&node).unwrap_or_else(|error| {
        node.log().error(error);
        1
    });
    stop::leave_in_time(code);
    node.finish();
    code
}
