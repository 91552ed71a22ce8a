//! Being told to stop: Ctrl-C, SIGTERM, `rosnode kill`; and leaving in time then, whatever
//! the master or a peer does.
//!
//! Giving back what is registered asks the master, which may hang for ever. So a thread of
//! its own ends the process, and what must not be lost (the map) is its last will: done by
//! that thread where the node itself does not come to it.

use std::sync::atomic::{AtomicBool, AtomicI32, Ordering};
use std::sync::{Mutex, Once, OnceLock, PoisonError};
use std::time::{Duration, Instant};

static STOP: AtomicBool = AtomicBool::new(false);
/// The exit code that is settled; negative while none is.
static CODE: AtomicI32 = AtomicI32::new(-1);
static WILL: Mutex<Option<Will>> = Mutex::new(None);

/// Stops the robot and saves what must not be lost; returns the exit code.
type Will = Box<dyn FnOnce() -> u8 + Send>;

/// How long after the signal, or after its work, a process ends at the latest.
const LEAVE_WITHIN: Duration = Duration::from_millis(1800);
/// A node that has not settled its exit code by then hangs: its last will is done.
const SETTLE_WITHIN: Duration = Duration::from_millis(900);
/// What is being written then may take this long; a disk is not a master.
const WRITE_WITHIN: Duration = Duration::from_secs(10);

/// Begins to listen for SIGINT and SIGTERM. The process then ends within two seconds of a
/// signal.
///
/// # Errors
/// A sentence when the system does not let it listen.
pub fn listen() -> Result<(), String> {
    static LISTENING: OnceLock<Result<(), String>> = OnceLock::new();
    let begin = || {
        let on_signal = || {
            STOP.store(true, Ordering::Relaxed);
            leave_soon();
        };
        ctrlc::set_handler(on_signal).map_err(|e| format!("cannot listen for signals: {e}"))
    };
    LISTENING.get_or_init(begin).clone()
}

/// Whether the process was told to stop.
pub fn is_requested() -> bool {
    STOP.load(Ordering::Relaxed)
}

/// Tells the whole process to stop, as a signal would, but leaves the end to it.
pub fn request() {
    STOP.store(true, Ordering::Relaxed);
}

/// From now on the process may end with this code: nothing is lost. The last will is
/// dropped, and with it what it holds of the node.
pub fn settle(code: u8) {
    CODE.store(i32::from(code), Ordering::Relaxed);
    drop(WILL.lock().unwrap_or_else(PoisonError::into_inner).take());
}

/// What is to be done before the process ends, unless a code is settled before.
pub(crate) fn set_will(will: impl FnOnce() -> u8 + Send + 'static) {
    CODE.store(-1, Ordering::Relaxed);
    *WILL.lock().unwrap_or_else(PoisonError::into_inner) = Some(Box::new(will));
}

/// Ends the process soon, even if a peer that hangs keeps it from unregistering.
pub fn leave_in_time(code: u8) {
    settle(code);
    leave_soon();
}

fn leave_soon() {
    static LEAVING: Once = Once::new();
    LEAVING.call_once(|| {
        std::thread::spawn(leave);
    });
}

fn leave() {
    let began = Instant::now();
    while CODE.load(Ordering::Relaxed) < 0 && began.elapsed() < SETTLE_WITHIN {
        std::thread::sleep(Duration::from_millis(20));
    }
    if CODE.load(Ordering::Relaxed) < 0 {
        std::thread::spawn(|| {
            std::thread::sleep(WRITE_WITHIN);
            std::process::exit(1);
        });
        // A node that said nothing of its end has failed.
        let will = WILL.lock().unwrap_or_else(PoisonError::into_inner).take();
        settle(will.map_or(1, |will| will()));
    }
    std::thread::sleep(LEAVE_WITHIN.saturating_sub(began.elapsed()));
    std::process::exit(CODE.load(Ordering::Relaxed));
}
