//! Being told to stop: Ctrl-C, SIGTERM, `rosnode kill`.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

static STOP: AtomicBool = AtomicBool::new(false);

/// How long a node that was told to stop may take to leave, once its work is saved.
const LEAVE_WITHIN: Duration = Duration::from_secs(3);

/// Begins to listen for SIGINT and SIGTERM.
///
/// # Errors
/// A sentence when the system does not let it listen.
pub fn listen() -> Result<(), String> {
    static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
    let begin = || {
        ctrlc::set_handler(|| STOP.store(true, Ordering::Relaxed))
            .map_err(|e| format!("cannot listen for signals: {e}"))
    };
    LISTENING.get_or_init(begin).clone()
}

/// Whether the process was told to stop.
pub fn is_requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// Tells the whole process to stop, as a signal would.
pub fn request() {
    STOP.store(true, Ordering::Relaxed);
}

/// Ends the process in a few seconds even if a peer that hangs keeps it from
/// unregistering.
pub fn leave_in_time(code: u8) {
    std::thread::spawn(move || {
        std::thread::sleep(LEAVE_WITHIN);
        std::process::exit(i32::from(code));
    });
}
